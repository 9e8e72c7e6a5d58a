//! Whether a value from outside fits a parameter: `--set`, `vary`, a table of cases.

use crate::program::Parameter;
use hyde_units::{
    Agreement, AngleExponent, Kind, NamedUnit, format_value, significant, with_angle_of,
};

/// A value from outside.
#[derive(Clone, Copy, Debug)]
pub struct Given<'u> {
    /// SI.
    pub value: f64,
    /// The unit it was written in; none where none was.
    pub unit: Option<&'u NamedUnit>,
    /// It was written as `true` or `false`.
    pub truth: bool,
}

/// Why a value does not fit, and what to write instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Misfit {
    /// The reason, to stand behind the parameter's name: "is in rad/s, …".
    pub reason: String,
    /// Values that would fit, as written: `3000 [rpm]`.
    pub instead: Vec<String>,
}

impl Misfit {
    /// The values that would fit, in a sentence.
    #[must_use]
    pub fn help(&self) -> Option<String> {
        match self.instead.as_slice() {
            [turns, radians] => Some(format!(
                "write `{turns}` if it counts turns, `{radians}` if radians"
            )),
            [only] => Some(format!("write `{only}`")),
            _ => None,
        }
    }
}

impl Parameter {
    /// Whether a name means all elements of an array: no single value is for it.
    #[must_use]
    pub fn is_whole(&self, name: &str) -> bool {
        self.len > 1 && self.name == name
    }

    /// Why a value does not fit the parameter, if it does not.
    #[must_use]
    pub fn misfit(&self, given: &Given<'_>) -> Option<Misfit> {
        let misfit = |reason: String, instead: Vec<String>| Some(Misfit { reason, instead });
        let shown = self.unit.text();
        if given.truth && self.allowed.kind != Kind::Boolean {
            return misfit("is a number, not `true` or `false`".to_owned(), Vec::new());
        }
        if given.unit.is_some_and(|unit| unit.unit().is_absolute()) && given.value < 0.0 {
            return misfit("cannot be below absolute zero".to_owned(), Vec::new());
        }
        match given.unit {
            None if given.value == 0.0 || !self.needs_unit() => {}
            None => {
                let instead = vec![format!("{} [{shown}]", given.value)];
                return misfit("has a unit".to_owned(), instead);
            }
            Some(unit) => match unit.unit().dimension.agreement(self.dimension) {
                Agreement::Same => {}
                Agreement::Different => {
                    return misfit(
                        format!("is in {shown}, not in {}", unit.unit().dimension),
                        Vec::new(),
                    );
                }
                Agreement::AngleDiffers => {
                    let number = significant(unit.unit().from_si(given.value), 10);
                    let instead = with_angle_of(unit.text(), self.dimension);
                    let instead = instead.iter().map(|unit| format!("{number} [{unit}]"));
                    let reason = format!(
                        "is in {shown}, and {unit} has another angle in it: 2*pi would be lost"
                    );
                    return misfit(reason, instead.collect());
                }
            },
        }
        let refusal = self.allowed.refusal(given.value, &self.unit)?;
        misfit(
            format!(
                "cannot be {}: {refusal}",
                format_value(given.value, &self.unit)
            ),
            Vec::new(),
        )
    }

    /// A number without a unit would be taken as SI: of an angle that is declared in degrees, as radians.
    fn needs_unit(&self) -> bool {
        let angle = matches!(self.dimension.angle(), AngleExponent::Known(e) if !e.is_zero());
        !self.dimension.is_dimensionless() || angle && !self.unit.unit().is_si()
    }
}
