//! Units as measuring devices and drives spell them: `Nm`, `U/min`, `Ohm`, `RPM`, `pulse`.
//!
//! A model is written with the symbols of the table alone. A record is written by others, who cannot be asked to write it
//! anew: a spelling that can mean one unit only is taken for it, and whoever reads the record says so.

use crate::suggest::meant;
use crate::{NamedUnit, UnitError};

/// Spellings of turns a minute, in small letters and without blanks.
const TURNS_A_MINUTE: [&str; 6] = ["u/min", "umdr/min", "umin", "r/min", "rot/min", "tr/min"];

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

/// The unit with which the name of a column ends: `position_mm`, `Weg/mm`, `Speed (rpm)`.
///
/// A name may end like this by chance, so that it is a reason to ask, and no unit.
#[must_use]
pub fn unit_in_name(name: &str) -> Option<NamedUnit> {
    let unit = |(_, unit): (&str, &str)| {
        let unit = unit.trim_matches(['[', ']', '(', ')']);
        parse_spelled(unit).ok()
    };
    let after_all = name.split_once('/').and_then(unit);
    after_all.or_else(|| name.rsplit_once(['_', ' ', '/']).and_then(unit))
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
        ] {
            assert_eq!(parse_spelled(spelled).unwrap().text(), unit, "{spelled}");
        }
    }

    #[test]
    fn a_name_may_end_with_a_unit() {
        let unit = |name| unit_in_name(name).map(|unit| unit.text().to_owned());
        assert_eq!(unit("pos_mm").as_deref(), Some("mm"));
        assert_eq!(unit("Weg/mm").as_deref(), Some("mm"));
        assert_eq!(unit("v/mm/s").as_deref(), Some("mm/s"));
        assert_eq!(unit("Speed (rpm)").as_deref(), Some("rpm"));
        assert_eq!(unit("torque_Nm").as_deref(), Some("N.m"));
        assert_eq!(unit("pos_act"), None);
        assert_eq!(unit("mm"), None);
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
