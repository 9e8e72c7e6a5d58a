//! A number with a unit as an option has it: `300 [mm]`, `300 mm` or `300mm`.

use hyde_units::{Agreement, NamedUnit};

/// A value with the unit that it was written in.
#[derive(Clone, Debug)]
pub(super) struct Quantity {
    /// SI.
    pub value: f64,
    /// The unit.
    pub unit: NamedUnit,
}

/// Reads an option whose unit is of the dimension of one of some units.
pub(super) fn quantity(option: &str, text: &str, units: &[&str]) -> Result<Quantity, String> {
    let example = format!(
        "  help: write `--{option} '10 [{}]'`",
        units.join("]' or '10 [")
    );
    let wrong = |reason: String| format!("`--{option} '{text}'`: {reason}\n{example}");
    let (number, rest) = number(text.trim()).ok_or_else(|| wrong("no number".to_owned()))?;
    if !number.is_finite() {
        return Err(wrong("the number must be finite".to_owned()));
    }
    let unit = unit_text(rest);
    if unit.is_empty() {
        return Err(wrong("the unit is missing".to_owned()));
    }
    let unit = NamedUnit::parse(unit).map_err(|error| wrong(error.to_string()))?;
    let own = unit.unit().dimension;
    let fits = units.iter().any(|known| {
        let known = NamedUnit::parse(known);
        known.is_ok_and(|known| own.agreement(known.unit().dimension) == Agreement::Same)
    });
    if !fits || unit.unit().is_absolute() {
        return Err(wrong(format!("`{unit}` is not a unit of it")));
    }
    Ok(Quantity {
        value: unit.unit().to_si(number),
        unit,
    })
}

/// Reads a band: `1 .. 100 [Hz]`, in Hz.
pub(super) fn band(text: &str) -> Result<(f64, f64), String> {
    let wrong =
        || format!("`--band '{text}'` is not a band\n  help: write `--band '1 .. 100 [Hz]'`");
    let (from, to) = text.split_once("..").ok_or_else(wrong)?;
    let (to, rest) = number(to.trim()).ok_or_else(wrong)?;
    let (from, between) = number(from.trim()).ok_or_else(wrong)?;
    let unit = match unit_text(rest) {
        "" => return Err(wrong()),
        unit => unit,
    };
    // Each end may have a unit of its own.
    let si = |value: f64, unit: &str| {
        let hz = quantity("band", &format!("{value} [{unit}]"), &["Hz"])?;
        Ok::<f64, String>(hz.value)
    };
    let first = unit_text(between);
    let first = if first.is_empty() { unit } else { first };
    Ok((si(from, first)?, si(to, unit)?))
}

/// The longest number that a text begins with, and the rest.
fn number(text: &str) -> Option<(f64, &str)> {
    let ends = (1..=text.len())
        .rev()
        .filter(|&end| text.is_char_boundary(end));
    let mut found = ends.filter_map(|end| {
        let (number, rest) = text.split_at(end);
        // `inf` and `nan` are numbers to the parser, and names to the user.
        let digit = number.ends_with(|c: char| c.is_ascii_digit() || c == '.');
        let number = number.parse::<f64>().ok().filter(|_| digit)?;
        Some((number, rest))
    });
    found.next()
}

fn unit_text(text: &str) -> &str {
    text.trim()
        .trim_start_matches('[')
        .trim_end_matches(']')
        .trim()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_stands_with_or_without_brackets_and_blanks() {
        for text in ["300 [mm]", "300mm", "300 mm", "0.3m", "3e2 mm", "3e2mm"] {
            let found = quantity("travel", text, &["mm", "deg"]).unwrap();
            assert!((found.value - 0.3).abs() < 1e-15, "{text}");
        }
        let turned = quantity("travel", "180deg", &["mm", "deg"]).unwrap();
        assert!((turned.value - std::f64::consts::PI).abs() < 1e-12);
        for text in [
            "mm",
            "300",
            "inf mm",
            "300 [mm/s]",
            "300 [blah]",
            "20 [degC]",
        ] {
            let reason = quantity("travel", text, &["mm", "deg"]).unwrap_err();
            assert!(reason.contains("--travel '10 [mm]'"), "{reason}");
        }
    }

    #[test]
    fn a_band_has_two_ends() {
        assert_eq!(band("1..100Hz").unwrap(), (1.0, 100.0));
        assert_eq!(band("0.5 .. 0.1 [kHz]").unwrap(), (500.0, 100.0));
        assert_eq!(band("0.5 Hz .. 0.1 [kHz]").unwrap(), (0.5, 100.0));
        assert!(band("1, 100").is_err() && band("1 .. 2 [s]").is_err());
    }
}
