//! A unit: its dimension and how its values become SI.

use crate::symbol::{is_symbol_character, look_up};
use crate::{Dimension, Scale, UnitError, parse_unit};
use std::fmt;

/// What a value in a unit means: a value v is `(v + offset) * scale` in SI.
///
/// The offset is in the unit itself (273.15 for degC) and zero for all but temperatures.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// The dimension, angle-neutral where the unit leaves the angle open.
    pub dimension: Dimension,
    /// The factor to SI.
    pub scale: Scale,
    /// Added to a value before it is scaled, in the unit.
    pub offset: f64,
}

impl Unit {
    /// The unit 1.
    pub const ONE: Self = Self {
        dimension: Dimension::DIMENSIONLESS,
        scale: Scale::ONE,
        offset: 0.0,
    };

    /// The SI value of a value in this unit.
    #[must_use]
    pub fn to_si(self, value: f64) -> f64 {
        self.scale.apply(value + self.offset)
    }

    /// The value in this unit of an SI value.
    #[must_use]
    pub fn from_si(self, si: f64) -> f64 {
        self.scale.remove(si) - self.offset
    }

    /// The SI value of a *difference* of two values in this unit: 1 degC more is 1 K more.
    #[must_use]
    pub fn difference_to_si(self, value: f64) -> f64 {
        self.scale.apply(value)
    }

    /// Whether it has a zero point of its own, so that a difference of its values is in another unit.
    #[must_use]
    pub fn is_absolute(self) -> bool {
        self.offset != 0.0
    }

    /// Whether its values are SI as they stand.
    #[must_use]
    pub fn is_si(self) -> bool {
        self.scale.is_one() && self.offset == 0.0
    }
}

/// A unit with the text it was written as, to print values as the user writes them.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedUnit {
    text: String,
    unit: Unit,
}

impl NamedUnit {
    /// Reads a unit and keeps its text.
    ///
    /// # Errors
    /// As [`parse_unit`].
    pub fn parse(text: &str) -> Result<Self, UnitError> {
        Ok(Self {
            unit: parse_unit(text)?,
            text: text.trim().to_owned(),
        })
    }

    /// The SI unit that is usual for a dimension: `N.m`, `rad/s`.
    #[must_use]
    pub fn usual(dimension: Dimension) -> Self {
        let unit = Unit {
            dimension,
            ..Unit::ONE
        };
        Self {
            text: dimension.usual_unit(),
            unit,
        }
    }

    /// The unit of SI in which its values are kept: itself if it is one, else the usual one of its dimension.
    #[must_use]
    pub fn si(&self) -> Self {
        if self.unit.is_si() {
            self.clone()
        } else {
            Self::usual(self.unit.dimension)
        }
    }

    /// Whether it is made of symbols of SI and their multiples alone: `mm/s`, but not `rpm`, `bar` or `degC`.
    #[must_use]
    pub fn is_multiple_of_si(&self) -> bool {
        let mut symbols = self
            .text
            .split(|c| !is_symbol_character(c))
            .filter(|symbol| !symbol.is_empty());
        symbols.all(|symbol| {
            look_up(symbol).is_some_and(|(_, row)| {
                row.offset == 0.0 && (row.scale.is_one() || row.text == "g")
            })
        })
    }

    /// The text, `mm/rev`.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The unit.
    #[must_use]
    pub fn unit(&self) -> Unit {
        self.unit
    }
}

impl fmt::Display for NamedUnit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}

#[cfg(test)]
#[allow(
    clippy::float_cmp,
    reason = "conversion factors are the nearest doubles by contract"
)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn si(value: f64, text: &str) -> f64 {
        parse_unit(text).unwrap().to_si(value)
    }

    #[test]
    fn decimal_units_give_the_nearest_double() {
        assert_eq!(si(350.0, "mm"), 0.35);
        assert_eq!(si(10.0, "mm"), 0.01);
        assert_eq!(si(3.2, "mH"), 3.2e-3);
        assert_eq!(si(0.3, "um"), 0.3e-6);
        assert_eq!(si(100.0, "us"), 1e-4);
        assert_eq!(si(79.3, "GPa"), 79.3e9);
        assert_eq!(si(40.0, "mm"), 0.04);
        assert_eq!(si(30.0, "%"), 0.3);
        assert_eq!(si(1.0, "in"), 0.0254);
        assert_eq!(si(5.0, "g"), 0.005);
        assert_eq!(si(1.0, "gn"), 9.80665);
        assert_eq!(si(1.5, "bar"), 1.5e5);
        assert_eq!(si(250.0, "N/um"), 2.5e8);
        assert_eq!(si(2.0, "l"), 0.002);
        assert_eq!(si(36.0, "km/h"), 10.0);
        assert_eq!(si(1.0, "kWh"), 3.6e6);
        assert_eq!(si(25.0, "cm2"), 25e-4);
        assert_eq!(si(7.85, "g/cm3"), 7850.0);
        assert_eq!(si(60.0, "1/min"), 1.0);
    }

    /// NIST SP 811, appendix B: the customary units from the pound (0.453 592 37 kg), the inch and standard gravity.
    #[test]
    fn units_of_data_sheets_have_the_values_of_nist() {
        for (unit, value) in [
            ("ft", 0.3048),
            ("mil", 2.54e-5),
            ("thou", 2.54e-5),
            ("kgf", 9.80665),
            ("gf", 9.80665e-3),
            ("lbm", 0.453_592_37),
            ("ozm", 0.028_349_523_125),
            ("lbf", 4.448_221_615_260_5),
            ("ozf", 0.278_013_850_953_781_3),
            ("psi", 6_894.757_293_168_362),
            ("hp", 745.699_871_582_270_2),
            ("PS", 735.498_75),
            ("rps", 2.0 * PI),
            ("inc", 1.0),
            ("counts", 1.0),
        ] {
            assert!((si(1.0, unit) - value).abs() <= 1e-15 * value, "{unit}");
        }
        for (unit, value) in [
            ("kgf.cm", 0.098_066_5),
            ("ozf.in", 7.061_551_814_226_043e-3),
            ("lbf.in", 0.112_984_829_027_616_7),
            ("lbf.ft", 1.355_817_948_331_400_4),
            ("V/krpm", 30e-3 / PI),
            ("N.m/krpm", 30e-3 / PI),
            ("lbm.ft2", 0.042_140_110_093_804_8),
            ("counts/rev", 1.0 / (2.0 * PI)),
        ] {
            assert!((si(1.0, unit) - value).abs() <= 4e-16 * value, "{unit}");
        }
    }

    #[test]
    fn turns_convert_with_two_pi_and_hertz_does_not() {
        assert_eq!(si(10.0, "mm/rev"), 0.01 / (2.0 * PI));
        assert_eq!(si(1.0, "rev"), 2.0 * PI);
        assert_eq!(si(180.0, "deg"), PI);
        assert_eq!(si(1500.0, "rpm"), 50.0 * PI);
        assert_eq!(si(1500.0, "rev/min"), 50.0 * PI);
        assert_eq!(si(3600.0, "arcsec"), PI / 180.0);
        assert_eq!(si(60.0, "arcmin"), PI / 180.0);
        assert_eq!(si(50.0, "Hz"), 50.0);
        assert_eq!(si(1.0, "deg/rev"), 1.0 / 360.0);
        assert_eq!(si(7.0, "V/rpm"), 7.0 * 30.0 / PI);
        assert_eq!(si(10_000.0, "1/rev"), 5000.0 / PI);
    }

    #[test]
    fn temperatures_have_an_offset_and_differences_none() {
        assert_eq!(si(20.0, "degC"), 293.15);
        assert_eq!(si(-459.67, "degF"), 0.0);
        // 5/9 is no double: two roundings.
        assert!((si(212.0, "degF") - 373.15).abs() <= 2.0 * f64::EPSILON * 373.15);
        let celsius = parse_unit("degC").unwrap();
        assert_eq!(celsius.from_si(273.15), 0.0);
        assert_eq!(celsius.difference_to_si(0.5), 0.5);
        assert!(!celsius.is_si());
        assert!(parse_unit("N.m/rad").unwrap().is_si());
    }

    #[test]
    fn there_and_back_is_the_same_to_rounding() {
        let texts = [
            "mm", "um", "rpm", "mm/rev", "arcsec", "in", "km/h", "kWh", "GPa", "degF", "deg/rev",
        ];
        for text in texts {
            let unit = parse_unit(text).unwrap();
            for k in 1..500 {
                let value = f64::from(k) * 0.37;
                let back = unit.from_si(unit.to_si(value));
                // At most six roundings there and back; the offset of degF is 460 times an ulp of the value.
                let tolerance = 6.0 * f64::EPSILON * (value + unit.offset);
                assert!(
                    (back - value).abs() <= tolerance,
                    "{value} {text} came back as {back}"
                );
            }
        }
    }

    #[test]
    fn a_named_unit_prints_as_written() {
        let lead = NamedUnit::parse(" mm/rev ").unwrap();
        assert_eq!(lead.to_string(), "mm/rev");
        assert_eq!(lead.unit(), parse_unit("mm/rev").unwrap());
        assert_eq!(
            NamedUnit::usual(parse_unit("rpm").unwrap().dimension).text(),
            "rad/s"
        );
    }
}
