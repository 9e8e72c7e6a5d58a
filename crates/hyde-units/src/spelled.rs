//! Units as measuring devices and drives spell them: `Nm`, `U/min`, `Ohm`, `RPM`, `pulse`.
//!
//! A model is written with the symbols of the table alone. A record is written by others, who cannot be asked to write it
//! anew: a spelling that can mean one unit only is taken for it, and whoever reads the record says so.

use crate::suggest::meant;
use crate::{NamedUnit, UnitError};

/// Spellings of turns a minute, in small letters and without blanks.
const TURNS_A_MINUTE: [&str; 6] = ["u/min", "umdr/min", "umin", "r/min", "rot/min", "tr/min"];

/// Units of distance and angle, of which `ps` makes a speed: `mmps`.
const MOVED: [&str; 9] = ["m", "mm", "um", "in", "ft", "rad", "mrad", "deg", "rev"];

/// Symbols in one unit that may be spelled otherwise.
const MOST_SYMBOLS: usize = 4;

/// Reads a unit that may be spelled otherwise than in a model. Its [text](NamedUnit::text) is as a model has it.
///
/// # Errors
/// As [`parse_unit`](crate::parse_unit), where the text can mean several units, or none.
pub fn parse_spelled(text: &str) -> Result<NamedUnit, UnitError> {
    let small: String = text.to_lowercase().split_whitespace().collect();
    if TURNS_A_MINUTE.contains(&small.as_str()) {
        return NamedUnit::parse("rpm");
    }
    if let Some(speed) = speed(text.trim()) {
        return Ok(speed);
    }
    let words: Vec<&str> = text.split_whitespace().collect();
    if let [_, _, ..] = words.as_slice()
        && let Ok(product) = NamedUnit::parse(&words.join("."))
    {
        return Ok(product);
    }
    let first = match NamedUnit::parse(text) {
        Ok(unit) => return Ok(unit),
        Err(error) => error,
    };
    let mut respelled = text.to_owned();
    let mut error = first.clone();
    for _ in 0..MOST_SYMBOLS {
        let Some(symbol) = respelled.get(error.at.clone()).and_then(meant) else {
            return Err(first);
        };
        let divided = respelled[..error.at.start].trim_end().ends_with('/');
        let symbol = match divided && symbol.contains('.') {
            true => format!("({symbol})"),
            false => symbol,
        };
        respelled.replace_range(error.at, &symbol);
        error = match NamedUnit::parse(&respelled) {
            Ok(unit) => return Ok(unit),
            Err(error) => error,
        };
    }
    Err(first)
}

/// `mmps`, `radps2`, `mmpmin`.
fn speed(text: &str) -> Option<NamedUnit> {
    let ends = [("ps", "s"), ("ps2", "s2"), ("pss", "s2"), ("pmin", "min")];
    ends.iter().find_map(|(end, below)| {
        let above = text.strip_suffix(end)?;
        let known = MOVED.contains(&above);
        known.then(|| NamedUnit::parse(&format!("{above}/{below}")).ok())?
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn devices_spell_units_in_their_own_way() {
        for (spelled, unit) in [
            ("Nm", "N.m"),
            ("Nm/A", "N.m/A"),
            ("1/Nm", "1/(N.m)"),
            ("kgm²", "kg.m²"),
            ("U/min", "rpm"),
            ("r / min", "rpm"),
            ("RPM", "rpm"),
            ("Ohm", "ohm"),
            ("kOhm", "kohm"),
            ("inch/sec", "in/s"),
            ("pulses", "counts"),
            ("mm", "mm"),
            ("KN", "kN"),
            ("Rpm", "rpm"),
            ("mm s^-1", "mm.s^-1"),
            ("N m", "N.m"),
            ("mmps", "mm/s"),
            ("radps2", "rad/s2"),
            ("degps", "deg/s"),
        ] {
            assert_eq!(parse_spelled(spelled).unwrap().text(), unit, "{spelled}");
        }
    }

    #[test]
    fn what_may_mean_two_things_is_no_unit() {
        for text in [
            "Nn", "G", "Arms", "mpa", "LSB", "raw", "V rms", "Grad", "oz", "x", "", "metres2s",
        ] {
            assert!(parse_spelled(text).is_err(), "{text}");
        }
    }
}
