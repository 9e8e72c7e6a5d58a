//! A dimension as text: the unit an engineer would write, and the base units behind it.

use crate::dimension::BASE_UNITS;
use crate::{AngleExponent, Dimension, Exponent};
use std::fmt;

impl Dimension {
    /// The unit that is usual for the dimension: `N.m/A`, `rad/s`, `m/s2`; `1` for a bare number.
    ///
    /// The text parses back to a unit of this dimension and the factor 1.
    #[must_use]
    pub fn usual_unit(self) -> String {
        self.usual_fraction().to_string()
    }

    /// The dimension in base units: `kg.m2/(A.s2)`.
    #[must_use]
    pub fn base_units(self) -> String {
        self.base_fraction().to_string()
    }

    pub(crate) fn usual_fraction(self) -> Fraction {
        let usual = USUAL
            .iter()
            .find(|(base, ..)| Self::si(*base, 0).base == self.base);
        let Some((_, over, under)) = usual else {
            return self.base_fraction();
        };
        let mut fraction = Fraction {
            over: over.iter().map(|&text| text.to_owned()).collect(),
            under: under.iter().map(|&text| text.to_owned()).collect(),
        };
        fraction.push_angle(self);
        fraction
    }

    fn base_fraction(self) -> Fraction {
        let mut fraction = Fraction::default();
        for (symbol, exponent) in BASE_UNITS.iter().zip(self.base) {
            fraction.push(symbol, exponent);
        }
        fraction.push_angle(self);
        fraction
    }
}

/// The usual unit and, where it differs, the base units: `N (kg.m/s2)`, `rad/s`.
impl fmt::Display for Dimension {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (usual, base) = (self.usual_unit(), self.base_units());
        if usual == base {
            f.write_str(&usual)
        } else {
            write!(f, "{usual} ({base})")
        }
    }
}

/// Unit symbols over and under a fraction bar, each with its exponent.
#[derive(Default)]
pub(crate) struct Fraction {
    pub(crate) over: Vec<String>,
    pub(crate) under: Vec<String>,
}

impl Fraction {
    fn push(&mut self, symbol: &str, exponent: Exponent) {
        if exponent.is_zero() {
            return;
        }
        let (side, size) = if exponent.is_negative() {
            (&mut self.under, -exponent)
        } else {
            (&mut self.over, exponent)
        };
        side.push(match size.as_integer() {
            Some(1) => symbol.to_owned(),
            Some(whole) => format!("{symbol}{whole}"),
            None => format!("{symbol}^({size})"),
        });
    }

    /// The radian; of a product only where it is an angle, its rate, or per angle: `w*r` is m/s.
    fn push_angle(&mut self, dimension: Dimension) {
        let turning = [0, 1, 2, 4, 5, 6]
            .iter()
            .all(|&base: &usize| dimension.base[base].is_zero());
        match dimension.angle {
            AngleExponent::Composed(exponent) if !turning && !exponent.is_negative() => {}
            AngleExponent::Known(exponent) | AngleExponent::Composed(exponent) => {
                self.push("rad", exponent);
            }
            AngleExponent::Neutral => {}
        }
    }
}

impl fmt::Display for Fraction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.over.is_empty() {
            f.write_str("1")?;
        }
        f.write_str(&self.over.join("."))?;
        match &self.under[..] {
            [] => Ok(()),
            [one] => write!(f, "/{one}"),
            several => write!(f, "/({})", several.join(".")),
        }
    }
}

type Usual = ([i16; 7], &'static [&'static str], &'static [&'static str]);

/// Base exponents (kg, m, A, s, K, mol, cd) and the unit that an engineer writes for them, over and under the bar.
/// What is missing here is written in base units: `m/s2`, `kg.m2`, `A.s`.
#[rustfmt::skip]
const USUAL: &[Usual] = &[
    ([1, 1, 0, -2, 0, 0, 0],   &["N"],           &[]),
    ([1, 2, 0, -2, 0, 0, 0],   &["N", "m"],      &[]),
    ([1, 3, 0, -2, 0, 0, 0],   &["N", "m2"],     &[]),
    ([1, 1, 0, -1, 0, 0, 0],   &["N", "s"],      &[]),
    ([1, 2, 0, -1, 0, 0, 0],   &["N", "m", "s"], &[]),
    ([1, 0, 0, -2, 0, 0, 0],   &["N"],           &["m"]),
    ([1, 0, 0, -1, 0, 0, 0],   &["N", "s"],      &["m"]),
    ([-1, 0, 0, 2, 0, 0, 0],   &["m"],           &["N"]),
    ([1, -1, 0, -2, 0, 0, 0],  &["Pa"],          &[]),
    ([1, -1, 0, -1, 0, 0, 0],  &["Pa", "s"],     &[]),
    ([1, -2, 0, -2, 0, 0, 0],  &["N"],           &["m3"]),
    ([1, 2, 0, -3, 0, 0, 0],   &["W"],           &[]),
    ([1, 2, 0, -2, -1, 0, 0],  &["J"],           &["K"]),
    ([0, 2, 0, -2, -1, 0, 0],  &["J"],           &["kg", "K"]),
    ([1, 2, 0, -3, -1, 0, 0],  &["W"],           &["K"]),
    ([1, 0, 0, -3, -1, 0, 0],  &["W"],           &["m2", "K"]),
    ([1, 1, 0, -3, -1, 0, 0],  &["W"],           &["m", "K"]),
    ([-1, -2, 0, 3, 1, 0, 0],  &["K"],           &["W"]),
    ([1, 2, -1, -3, 0, 0, 0],  &["V"],           &[]),
    ([1, 1, -1, -3, 0, 0, 0],  &["V"],           &["m"]),
    ([1, 2, -1, -2, 0, 0, 0],  &["N", "m"],      &["A"]),
    ([1, 1, -1, -2, 0, 0, 0],  &["N"],           &["A"]),
    ([1, 2, -2, -3, 0, 0, 0],  &["ohm"],         &[]),
    ([-1, -2, 2, 3, 0, 0, 0],  &["S"],           &[]),
    ([1, 2, -2, -2, 0, 0, 0],  &["H"],           &[]),
    ([-1, -2, 2, 4, 0, 0, 0],  &["F"],           &[]),
    ([1, 0, -1, -2, 0, 0, 0],  &["T"],           &[]),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Agreement, parse_unit};

    fn shown(text: &str) -> String {
        parse_unit(text).unwrap().dimension.to_string()
    }

    #[test]
    fn reads_well_in_a_message() {
        for (unit, text) in [
            ("N", "N (kg.m/s2)"),
            ("J", "N.m (kg.m2/s2)"),
            ("N.m/rad", "N.m (kg.m2/s2)"),
            ("V.s/rad", "N.m/A (kg.m2/(A.s2))"),
            ("ohm", "ohm (kg.m2/(A2.s3))"),
            ("kg.m2", "kg.m2"),
            ("m/s", "m/s"),
            ("m/s2", "m/s2"),
            ("rpm", "rad/s"),
            ("Hz", "1/s"),
            ("mm/rev", "m/rad"),
            ("A.s/rad", "A.s/rad"),
            ("N/rad", "N/rad (kg.m/(s2.rad))"),
            ("N.rad/m", "N.rad/m (kg.rad/s2)"),
            ("1", "1"),
            ("deg", "rad"),
            ("m^(1/2)", "m^(1/2)"),
            ("J/(kg.K)", "J/(kg.K) (m2/(s2.K))"),
            ("degC", "K"),
        ] {
            assert_eq!(shown(unit), text, "{unit}");
        }
    }

    #[test]
    fn a_known_angle_on_a_torque_is_shown() {
        let force = parse_unit("N").unwrap().dimension;
        let lead = parse_unit("mm/rev").unwrap().dimension;
        assert_eq!(force.multiply(lead).to_string(), "N.m/rad (kg.m2/(s2.rad))");
    }

    #[test]
    fn every_usual_unit_parses_back() {
        for (base, ..) in USUAL {
            for angle in -2..=2 {
                let dimension = Dimension::si(*base, angle);
                for text in [dimension.usual_unit(), dimension.base_units()] {
                    let unit = parse_unit(&text).unwrap();
                    let agreement = unit.dimension.agreement(dimension);
                    assert_eq!(agreement, Agreement::Same, "{text}");
                    assert!(unit.is_si(), "{text}");
                }
            }
        }
    }

    #[test]
    fn no_base_is_named_twice() {
        for (i, (base, ..)) in USUAL.iter().enumerate() {
            assert!(
                USUAL[..i].iter().all(|(other, ..)| other != base),
                "{base:?}"
            );
        }
    }
}
