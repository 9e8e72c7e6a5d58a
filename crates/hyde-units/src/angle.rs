//! The unit to write where the angle is missing from one, or too many in it: `mm` for a lead is `mm/rev`.

use crate::{Agreement, AngleExponent, Dimension, parse_unit};

/// The units that a unit becomes with the angle that a dimension asks for: in turns, then in radians.
///
/// One of them where the angle is taken out; none where no usual unit has it.
#[must_use]
pub fn with_angle_of(text: &str, wanted: Dimension) -> Vec<String> {
    let text = text.trim();
    let fits = |candidate: &String| {
        parse_unit(candidate).is_ok_and(|unit| {
            unit.dimension.agreement(wanted) == Agreement::Same
                && matches!(unit.dimension.angle(), AngleExponent::Known(_))
        })
    };
    if let Some(plain) = without_angle(text).into_iter().find(fits) {
        return vec![plain];
    }
    let found: Vec<String> = with_angle(text).into_iter().filter(fits).collect();
    let in_radians = |unit: &&String| unit.contains("rad");
    let turns = found.iter().find(|unit| !in_radians(unit));
    let radians = found.iter().find(in_radians);
    turns.into_iter().chain(radians).cloned().collect()
}

fn with_angle(text: &str) -> Vec<String> {
    let mut list = Vec::new();
    if text == "1/min" {
        list.push("rpm".to_owned());
    }
    for angle in ["rev", "rad"] {
        list.push(match text {
            "1" => angle.to_owned(),
            "Hz" => format!("{angle}/s"),
            _ => match text.split_once('/') {
                Some(("1", under)) => format!("{angle}/{under}"),
                Some((over, under)) => format!("{over}.{angle}/{under}"),
                None => format!("{text}.{angle}"),
            },
        });
        list.push(format!("{text}/{angle}"));
    }
    list
}

fn without_angle(text: &str) -> Vec<String> {
    let mut list = Vec::new();
    match text {
        "rpm" => list.push("1/min".to_owned()),
        "rps" => list.push("1/s".to_owned()),
        "rev" | "rad" | "deg" => list.push("1".to_owned()),
        _ => {}
    }
    for angle in ["rev", "rad"] {
        list.extend(text.strip_suffix(&format!("/{angle}")).map(str::to_owned));
        list.extend(text.strip_prefix(angle).map(|rest| format!("1{rest}")));
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_unit_with_the_angle_is_the_one_of_data_sheets() {
        for (given, wanted, units) in [
            ("mm", "mm/rev", &["mm/rev", "mm/rad"][..]),
            ("in", "m/rad", &["in/rev", "in/rad"]),
            ("1/min", "rad/s", &["rpm", "rad/min"]),
            ("1/s", "rad/s", &["rev/s", "rad/s"]),
            ("Hz", "rad/s", &["rev/s", "rad/s"]),
            ("1/s2", "rad/s2", &["rev/s2", "rad/s2"]),
            ("1", "rad", &["rev", "rad"]),
            ("rpm", "Hz", &["1/min"]),
            ("rev/s", "1/s", &["1/s"]),
            ("mm/rev", "mm", &["mm"]),
            ("A.s", "A.s/rad", &["A.s/rev", "A.s/rad"]),
            ("N", "N.m", &[]),
        ] {
            let dimension = parse_unit(wanted).unwrap().dimension;
            assert_eq!(
                with_angle_of(given, dimension),
                units,
                "{given} as {wanted}"
            );
        }
    }
}
