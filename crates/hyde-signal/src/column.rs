//! One column of a table: a name, a unit if it is known, and the values.

use crate::Series;
use hyde_units::{Agreement, Dimension, NamedUnit, Unit};
use std::borrow::Cow;
use std::fmt;

/// A named sequence of samples.
///
/// While the unit is unknown the values are what the file holds; as soon as it is known they are SI, and the unit
/// is kept to print them as the user wrote them.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    name: String,
    unit: Option<NamedUnit>,
    values: Vec<f64>,
    meaning: Option<String>,
}

/// What is written of a column, whoever has its values.
#[derive(Clone, Debug)]
pub struct Written<'a> {
    /// The name, without the unit.
    pub name: Cow<'a, str>,
    /// The unit it is written in, if known.
    pub unit: Option<Cow<'a, NamedUnit>>,
    /// The values: SI if the unit is known, else as they are in the file.
    pub values: Values<'a>,
}

/// Values of rows that belong to someone else.
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// One a row.
    Each(&'a [f64]),
    /// Without what stays.
    Series(&'a Series),
}

impl Values<'_> {
    /// Number of rows.
    pub(crate) fn len(&self) -> usize {
        match self {
            Self::Each(values) => values.len(),
            Self::Series(series) => series.len(),
        }
    }

    /// Where they stand in memory: the same values have the same address.
    pub(crate) fn address(&self) -> *const () {
        match self {
            Self::Each(values) => values.as_ptr().cast(),
            Self::Series(series) => std::ptr::from_ref(*series).cast(),
        }
    }

    fn are(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Each(own), Self::Each(other)) => std::ptr::eq(*own, *other),
            (Self::Series(own), Self::Series(other)) => std::ptr::eq(*own, *other),
            (Self::Each(_), Self::Series(_)) | (Self::Series(_), Self::Each(_)) => false,
        }
    }
}

impl Written<'_> {
    /// The values of all rows: SI if the unit is known.
    #[must_use]
    pub fn values(&self) -> Cow<'_, [f64]> {
        match self.values {
            Values::Each(values) => Cow::Borrowed(values),
            Values::Series(series) => series.values(),
        }
    }

    /// The values row after row in the column's unit: see [`Column::in_unit`].
    pub(crate) fn in_unit(&self) -> Box<dyn Iterator<Item = f64> + '_> {
        let values: Box<dyn Iterator<Item = f64> + '_> = match self.values {
            Values::Each(values) => Box::new(values.iter().copied()),
            Values::Series(series) => Box::new(series.iter()),
        };
        match self.unit.as_ref().map(|unit| unit.unit()) {
            Some(unit) if !unit.is_si() => Box::new(values.map(move |si| in_unit(si, unit))),
            Some(_) | None => values,
        }
    }

    /// Whether both have the same values in memory, and the same unit.
    pub(crate) fn reads_as(&self, other: &Self) -> bool {
        self.values.are(&other.values) && self.unit == other.unit
    }
}

/// A column was given a unit of another dimension than it has.
#[derive(Clone, Debug, PartialEq)]
pub struct UnitConflict {
    /// The column.
    pub name: String,
    /// The unit it has.
    pub has: String,
    /// The unit it was given.
    pub given: String,
}

impl Column {
    /// A column of SI values that are printed in `unit`.
    #[must_use]
    pub fn new(name: impl Into<String>, unit: NamedUnit, si_values: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            unit: Some(unit),
            values: si_values,
            meaning: None,
        }
    }

    /// A column whose unit is not known yet.
    #[must_use]
    pub fn raw(name: impl Into<String>, values: Vec<f64>) -> Self {
        Self {
            name: name.into(),
            unit: None,
            values,
            meaning: None,
        }
    }

    /// The name, without the unit.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// What its file says in another row that it shows.
    #[must_use]
    pub fn meaning(&self) -> Option<&str> {
        self.meaning.as_deref()
    }

    /// The same with what it shows.
    pub(crate) fn showing(self, meaning: Option<String>) -> Self {
        Self { meaning, ..self }
    }

    /// The unit it is read and written in, if known.
    #[must_use]
    pub fn unit(&self) -> Option<&NamedUnit> {
        self.unit.as_ref()
    }

    /// The dimension, if the unit is known.
    #[must_use]
    pub fn dimension(&self) -> Option<Dimension> {
        self.unit.as_ref().map(|unit| unit.unit().dimension)
    }

    /// The values: SI if the unit is known, else as they are in the file.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The values in the column's unit, as files hold them: each the shortest decimal that converts back to the SI value;
    /// where no double does, it is off by one unit in the last place.
    #[must_use]
    pub fn in_unit(&self) -> Cow<'_, [f64]> {
        match self.unit.as_ref().map(NamedUnit::unit) {
            Some(unit) if !unit.is_si() => {
                self.values.iter().map(|&si| in_unit(si, unit)).collect()
            }
            Some(_) | None => Cow::Borrowed(&self.values),
        }
    }

    /// The column as a file is made of it.
    #[must_use]
    pub fn written(&self) -> Written<'_> {
        Written {
            name: Cow::Borrowed(&self.name),
            unit: self.unit.as_ref().map(Cow::Borrowed),
            values: Values::Each(&self.values),
        }
    }

    /// The same column with its unit: raw values become SI. A column that has a unit is only printed in another one.
    ///
    /// # Errors
    /// If the column has a unit of another dimension.
    pub fn with_unit(self, unit: NamedUnit) -> Result<Self, UnitConflict> {
        let Some(has) = &self.unit else {
            return Ok(self.converted(unit));
        };
        let agreement = has.unit().dimension.agreement(unit.unit().dimension);
        if agreement == Agreement::Different {
            let (has, given) = (has.text().to_owned(), unit.text().to_owned());
            return Err(UnitConflict {
                name: self.name,
                has,
                given,
            });
        }
        Ok(Self {
            unit: Some(unit),
            ..self
        })
    }

    /// The values of this column and behind them those of another; none if one has a unit that the other does not agree with.
    pub(crate) fn followed_by(&self, later: &Self) -> Option<Self> {
        let agree = match (self.dimension(), later.dimension()) {
            (Some(own), Some(later)) => own.agreement(later) != Agreement::Different,
            (own, later) => own == later,
        };
        agree.then(|| {
            let mut whole = self.clone();
            whole.values.extend_from_slice(&later.values);
            whole
        })
    }

    /// The same with some of its rows.
    pub(crate) fn rows_with(&self, kept: &[bool]) -> Self {
        let values = self.values.iter().zip(kept);
        let values = values.filter(|(_, kept)| **kept).map(|(value, _)| *value);
        Self {
            values: values.collect(),
            ..self.clone()
        }
    }

    /// The column with all values so much higher, SI.
    pub(crate) fn raised(mut self, by: f64) -> Self {
        self.values.iter_mut().for_each(|value| *value += by);
        self
    }

    /// The column with its raw values made SI.
    pub(crate) fn converted(mut self, named: NamedUnit) -> Self {
        let unit = named.unit();
        if !unit.is_si() {
            for value in &mut self.values {
                *value = unit.to_si(*value);
            }
        }
        Self {
            unit: Some(named),
            ..self
        }
    }
}

/// The value in a unit: the shortest that converts to `si`, 15 digits if they do, else the doubles next to the quotient.
#[must_use]
pub fn in_unit(si: f64, unit: Unit) -> f64 {
    if unit.is_si() {
        return si;
    }
    let value = unit.from_si(si);
    let same = |candidate: &f64| unit.to_si(*candidate).to_bits() == si.to_bits();
    if let Some(short) = fifteen_digits(value).filter(same) {
        return short;
    }
    let short = format!("{value:.14e}").parse().unwrap_or(value);
    let candidates = [short, value, value.next_up(), value.next_down()];
    candidates.into_iter().find(same).unwrap_or(value)
}

/// The double next to a decimal of 15 digits that is next to a value, or beside that where the value is between two; without
/// text. `None` where powers of ten are no doubles.
fn fifteen_digits(value: f64) -> Option<f64> {
    let power = 14_i32.saturating_sub(value.abs().log10().floor() as i32);
    let ten = 10_f64.powi(power.abs());
    // Both are exact up to here: whole numbers of 15 digits, and so many powers of ten. What is made of them is rounded once.
    let exact = value != 0.0 && power.abs() <= 22;
    exact.then(|| match power >= 0 {
        true => (value * ten).round() / ten,
        false => (value / ten).round() * ten,
    })
}

impl fmt::Display for UnitConflict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { name, has, given } = self;
        write!(f, "column `{name}` is in {has}, it cannot be in {given}")
    }
}

impl std::error::Error for UnitConflict {}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "conversion is exact for these values")]
mod tests {
    use super::*;

    fn unit(text: &str) -> NamedUnit {
        NamedUnit::parse(text).unwrap()
    }

    #[test]
    fn digits_in_a_unit_are_those_of_its_text() {
        for text in ["mm", "um", "rpm", "deg", "degC", "kN", "min"] {
            let unit = unit(text).unit();
            for k in 1..4000_u64 {
                let noise = k.wrapping_mul(0x9e37_79b9_7f4a_7c15);
                let mantissa = f64::from_bits(0x3ff0_0000_0000_0000 | noise >> 12) - 1.5;
                let written = 0.1 * (k % 700) as f64;
                for si in [
                    mantissa * 10_f64.powi((k % 30) as i32 - 20),
                    unit.to_si(written),
                ] {
                    let value = unit.from_si(si);
                    let short: f64 = format!("{value:.14e}").parse().unwrap();
                    if unit.to_si(short).to_bits() == si.to_bits() {
                        assert_eq!(in_unit(si, unit), short, "{si} in {text}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_unit_given_later_makes_the_values_si() {
        let column = Column::raw("qg_mm", vec![1.0, 350.0])
            .with_unit(unit("mm"))
            .unwrap();
        assert_eq!(column.values(), [0.001, 0.35]);
        assert_eq!(column.dimension(), Some(Dimension::LENGTH));
    }

    #[test]
    fn a_unit_is_changed_for_printing_only() {
        let column = Column::new("x", unit("m"), vec![0.35])
            .with_unit(unit("mm"))
            .unwrap();
        assert_eq!(column.values(), [0.35]);
        assert_eq!(column.unit().unwrap().text(), "mm");
    }

    #[test]
    fn another_dimension_is_refused() {
        let error = Column::new("x", unit("m"), vec![])
            .with_unit(unit("N"))
            .unwrap_err();
        assert_eq!(error.to_string(), "column `x` is in m, it cannot be in N");
    }
}
