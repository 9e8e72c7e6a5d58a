//! Prints values for people: a few digits, a fitting prefix, the unit.

use crate::symbol::{PREFIXES, look_up};
use crate::{Dimension, NamedUnit};

/// Prints an SI value with the prefix that fits and the usual unit: `12.3 um`, `0.62 N.m/A`, `1.6e-3 kg.m2`.
///
/// Four significant digits. The prefix goes to the first symbol of the unit, if that takes one, and only where the
/// number would otherwise be below 0.1 or from 1000 on.
#[must_use]
pub fn engineering(si: f64, dimension: Dimension) -> String {
    if let Some(text) = infinite(si) {
        return text;
    }
    let fraction = dimension.usual_fraction();
    let unit = fraction.to_string();
    let size = round_to(si.abs(), DIGITS);
    if size != 0.0 && size.is_finite() && !(0.1..1000.0).contains(&size) {
        let prefixes = fraction
            .over
            .first()
            .map_or("", |symbol| prefixes_of(symbol));
        if let Some((prefix, value)) = fitting_prefix(size, prefixes) {
            return format!("{} {prefix}{unit}", significant(value.copysign(si), DIGITS));
        }
    }
    if unit == "1" {
        // A whole number without a unit is a count: it is not rounded.
        let whole = si.fract() == 0.0 && si.abs() < MAX_EXACT;
        significant(si, if whole { EXACT } else { DIGITS })
    } else {
        format!("{} {unit}", significant(si, DIGITS))
    }
}

/// The same in the unit of a declared type: an energy in J, not N.m, a speed in rpm, an angle in deg.
///
/// Units of SI take the prefix that fits; any other unit is shown as it is declared.
#[must_use]
pub fn engineering_as(si: f64, unit: &NamedUnit) -> String {
    if let Some(text) = infinite(si) {
        return text;
    }
    if !unit.unit().is_si() {
        return shown(unit.unit().from_si(si), unit.text());
    }
    if look_up(unit.text()).is_none_or(|(_, row)| row.text != unit.text()) {
        return engineering(si, unit.unit().dimension);
    }
    let size = round_to(si.abs(), DIGITS);
    let prefixed = size != 0.0 && size.is_finite() && !(0.1..1000.0).contains(&size);
    match fitting_prefix(size, prefixes_of(unit.text())).filter(|_| prefixed) {
        Some((prefix, value)) => {
            let value = significant(value.copysign(si), DIGITS);
            format!("{value} {prefix}{}", unit.text())
        }
        None => shown(si, unit.text()),
    }
}

/// A difference of values, such as an error: that of two temperatures in degC is in K. Multiples of units of SI take the
/// prefix that fits, and so does what is too small for its unit, for an error is much smaller than what it is an error of.
#[must_use]
pub fn engineering_difference(si: f64, unit: &NamedUnit) -> String {
    let readable = (1e-3..1e5).contains(&unit.unit().scale.remove(si).abs());
    if unit.unit().is_absolute() || unit.is_multiple_of_si() || !readable {
        engineering(si, unit.unit().dimension)
    } else {
        engineering_as(si, unit)
    }
}

/// The text of what is infinite in every unit, such as the settling time of what does not settle.
fn infinite(si: f64) -> Option<String> {
    let sign = if si < 0.0 { "-" } else { "" };
    si.is_infinite().then(|| format!("{sign}infinite"))
}

fn shown(value: f64, unit: &str) -> String {
    format!("{} {unit}", significant(value, DIGITS))
}

/// Prints an SI value in a unit the user chose: `350 mm`. Ten significant digits, so that conversion leaves no dust.
#[must_use]
pub fn format_value(si: f64, unit: &NamedUnit) -> String {
    let number = significant(unit.unit().from_si(si), 10);
    if unit.text() == "1" {
        number
    } else {
        format!("{number} {unit}")
    }
}

/// Prints a number with up to `digits` significant digits and no trailing zeros: `0.0123`, `1.6e-7`, `12000`.
#[must_use]
pub fn significant(value: f64, digits: usize) -> String {
    let rounded = round_to(value, digits);
    let plain = rounded == 0.0 || (1e-3..1e7).contains(&rounded.abs()) || !rounded.is_finite();
    // Adding zero turns a negative zero into a plain one.
    if plain {
        format!("{}", rounded + 0.0)
    } else {
        format!("{rounded:e}")
    }
}

const DIGITS: usize = 4;

/// Below this every whole number is a double, of no more than so many digits.
const MAX_EXACT: f64 = 9.007_199_254_740_992e15;
const EXACT: usize = 16;

/// The nearest double with so many significant decimal digits.
fn round_to(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits.saturating_sub(1))
        .parse()
        .unwrap_or(value)
}

/// The prefixes of thousands that go on a symbol when printing. Not on powers, nor on what has a prefix already (kg).
fn prefixes_of(symbol: &str) -> &'static str {
    match look_up(symbol) {
        Some((_, row)) if row.text == symbol => row.prefixes,
        Some(_) | None => "",
    }
}

/// The largest prefix that leaves the number at 1 or above, and the number it leaves; none if no prefix helps.
fn fitting_prefix(size: f64, allowed: &str) -> Option<(char, f64)> {
    let candidates = PREFIXES
        .iter()
        .rev()
        .filter(|(prefix, _)| allowed.contains(*prefix));
    candidates
        .filter(|(prefix, _)| !"cdh".contains(*prefix))
        .map(|&(prefix, scale)| (prefix, round_to(scale.remove(size), DIGITS)))
        .find(|(_, value)| (1.0..1000.0).contains(value))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parse_unit;

    fn shown(si: f64, unit: &str) -> String {
        engineering(si, parse_unit(unit).unwrap().dimension)
    }

    #[test]
    fn numbers_get_the_prefix_that_fits() {
        for (si, unit, text) in [
            (1.23e-5, "m", "12.3 um"),
            (0.62, "N.m/A", "0.62 N.m/A"),
            (0.35, "m", "0.35 m"),
            (0.01, "m", "10 mm"),
            (-4e-6, "m", "-4 um"),
            (1.6e8, "N/m", "160 MN/m"),
            (6.0e3, "N.m/rad", "6 kN.m"),
            (79.3e9, "Pa", "79.3 GPa"),
            (3.2e-3, "H", "3.2 mH"),
            (0.004, "V", "4 mV"),
            (1e-3, "s", "1 ms"),
            (1.9e-4, "rad", "190 urad"),
            (0.005, "m/s", "5 mm/s"),
            (104.719_755, "rad/s", "104.7 rad/s"),
            (5000.0, "rad/s", "5000 rad/s"),
            (31415.0, "1", "31415"),
            (31_415.25, "1", "31420"),
            (310.0, "kg", "310 kg"),
            (1250.0, "kg", "1250 kg"),
            (8.2e-3, "kg.m2", "0.0082 kg.m2"),
            (1.2e-5, "kg.m2", "1.2e-5 kg.m2"),
            (2.5e-3, "m2", "0.0025 m2"),
            (35.0, "1/s", "35 1/s"),
            (0.02, "1", "0.02"),
            (0.0, "N", "0 N"),
            (-0.0, "N", "0 N"),
            (999.96, "N", "1 kN"),
            (9.99996e-4, "m", "1 mm"),
            (1e-30, "m", "1e-30 m"),
            (f64::NAN, "m", "NaN m"),
            (f64::INFINITY, "m", "infinite"),
        ] {
            assert_eq!(shown(si, unit), text);
        }
    }

    #[test]
    fn values_of_a_declared_type_keep_its_symbol() {
        let show = |si, unit| engineering_as(si, &NamedUnit::parse(unit).unwrap());
        assert_eq!(show(1250.0, "J"), "1.25 kJ");
        assert_eq!(show(-0.004, "J"), "-4 mJ");
        assert_eq!(show(50.0, "Hz"), "50 Hz");
        // No symbol of SI alone: the usual unit of the dimension.
        assert_eq!(show(20.0, "N.m/rad"), "20 N.m");
        // Any other unit is there because its reader thinks in it.
        assert_eq!(show(0.35, "mm"), "350 mm");
        assert_eq!(show(50.0 * std::f64::consts::PI, "rpm"), "1500 rpm");
        assert_eq!(show(6e5, "bar"), "6 bar");
        assert_eq!(show(303.15, "degC"), "30 degC");
    }

    #[test]
    fn a_difference_of_temperatures_is_in_kelvin() {
        let show = |si, unit| engineering_difference(si, &NamedUnit::parse(unit).unwrap());
        assert_eq!(show(0.5, "degC"), "0.5 K");
        assert_eq!(show(0.5, "degF"), "0.5 K");
        assert_eq!(show(500.0, "bar"), "0.005 bar");
        assert_eq!(show(3.168e-4, "rev"), "316.8 urad");
        assert_eq!(show(7.397e-7, "mm"), "739.7 nm");
        assert_eq!(show(std::f64::consts::PI / 30.0, "rpm"), "1 rpm");
    }

    #[test]
    fn values_print_in_the_unit_they_were_written_in() {
        let show = |si, unit| format_value(si, &NamedUnit::parse(unit).unwrap());
        assert_eq!(show(0.35, "mm"), "350 mm");
        assert_eq!(
            show(0.01 / (2.0 * std::f64::consts::PI), "mm/rev"),
            "10 mm/rev"
        );
        assert_eq!(show(50.0 * std::f64::consts::PI, "rpm"), "1500 rpm");
        assert_eq!(show(293.15, "degC"), "20 degC");
        assert_eq!(show(0.5, "1"), "0.5");
    }

    #[test]
    fn what_is_infinite_has_no_unit() {
        let unit = NamedUnit::parse("s").unwrap();
        assert_eq!(engineering_as(f64::INFINITY, &unit), "infinite");
        let time = unit.unit().dimension;
        assert_eq!(engineering(f64::NEG_INFINITY, time), "-infinite");
    }

    #[test]
    fn significant_digits_drop_trailing_zeros() {
        assert_eq!(significant(0.012_300_4, 4), "0.0123");
        assert_eq!(significant(1.0 / 3.0, 3), "0.333");
        assert_eq!(significant(123_456.0, 3), "123000");
        assert_eq!(significant(-1.6e-7, 3), "-1.6e-7");
        assert_eq!(significant(2e9, 3), "2e9");
    }
}
