//! Units that names of columns end with: `position_mm`, `v_mm_s`, `x.mm`, `Weg/mm`, `Speed (rpm)`.

use crate::{NamedUnit, parse_spelled};

/// What may stand between a name and its unit.
const BETWEEN: [char; 8] = ['_', ' ', '.', '-', ',', ':', '(', '['];

/// The unit with which the name of a column ends.
///
/// A name may end like this by chance, so that it is a reason to ask, and no unit.
#[must_use]
pub fn unit_in_name(name: &str) -> Option<NamedUnit> {
    let name = name.trim().trim_matches(['\'', '"']).trim();
    // The longest end that is a unit: `mm/s` of `v_mm/s`, not `s`.
    let mut ends = name.match_indices(BETWEEN).filter(|(at, _)| *at > 0);
    let behind = ends.find_map(|(at, sign)| {
        let end = &name[at + sign.len()..];
        // `feed.in` is an input of `feed`, `saddle.s` a place of the saddle.
        let is_port = sign == "." && (end == "in" || end.chars().count() == 1);
        of_end(end).filter(|_| !is_port)
    });
    let behind_slash = || {
        let mut ends = name.match_indices('/').filter(|(at, _)| *at > 0);
        ends.find_map(|(at, _)| of_end(&name[at + 1..]))
    };
    behind.or_else(behind_slash)
}

fn of_end(text: &str) -> Option<NamedUnit> {
    let text = text.trim().trim_matches(['[', ']', '(', ')']).trim();
    if text.is_empty() || text.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    let whole = parse_spelled(text).ok();
    whole.or_else(|| quotient(text))
}

/// `mm_s`, `mm_s2`, `mm_per_s`: a name cannot have the sign of a quotient.
fn quotient(text: &str) -> Option<NamedUnit> {
    let words: Vec<&str> = text.split(['_', ' ', '-', '.']).collect();
    let (above, below) = match words.as_slice() {
        [above, below] | [above, "per" | "pro", below] => (above, below),
        _ => return None,
    };
    let is_time = matches!(*below, "s" | "s2" | "ms" | "min" | "h");
    is_time.then(|| parse_spelled(&format!("{above}/{below}")).ok())?
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_may_end_with_a_unit() {
        for (name, unit) in [
            ("pos_mm", "mm"),
            ("Weg/mm", "mm"),
            ("v/mm/s", "mm/s"),
            ("v_mm/s", "mm/s"),
            ("v_mm_s", "mm/s"),
            ("v_mm_per_s", "mm/s"),
            ("a_mm_s2", "mm/s2"),
            ("v_mmps", "mm/s"),
            ("omega_degps", "deg/s"),
            ("x.mm", "mm"),
            ("v.mm/s", "mm/s"),
            ("x-mm", "mm"),
            ("Axis 1 Pos mm", "mm"),
            ("Speed (rpm)", "rpm"),
            ("'POSF(mm)'", "mm"),
            ("'SPEED(mm/min)'", "mm/min"),
            ("v (mm s^-1)", "mm.s^-1"),
            ("torque_Nm", "N.m"),
            ("motor.M_N.m", "N.m"),
        ] {
            let found = unit_in_name(name).map(|unit| unit.text().to_owned());
            assert_eq!(found.as_deref(), Some(unit), "{name}");
        }
        for name in [
            "feed.in",
            "saddle.s",
            "pos_act",
            "mm",
            "x_1",
            "joint.0.motor-pos-fb",
            "amps",
            "x_",
            "",
            "_mm_x",
        ] {
            assert_eq!(unit_in_name(name), None, "{name}");
        }
    }
}
