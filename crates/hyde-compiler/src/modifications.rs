//! [`modifications`]: values of parameters as a modification takes them. It gives an array all of its elements, so those that
//! nobody found a value for keep the one they have:
//!
//! ```text
//! M[2] = 130 kg, guide[1].F = 30 N      M = {100, 130} [kg], guide[1].F = 30 [N]
//! ```

use crate::write_back::Calibrated;
use hyde_program::{Parameter, Program};
use hyde_units::{Kind, NamedUnit};
use std::collections::BTreeMap;

/// The modifications that give parameters their values; `p` is the parameter vector of the program that has them, and `number`
/// writes a real number in its unit.
#[must_use]
pub fn modifications(
    values: &[Calibrated],
    (program, p): (&Program, &[f64]),
    number: &dyn Fn(f64) -> String,
) -> Vec<String> {
    let mut known: Vec<&str> = Vec::new();
    let mut out = Vec::new();
    for value in values {
        let (array, element) = parted(&value.path);
        let kind = program.parameter(&value.path);
        let kind = kind.map_or(Kind::Real, |(parameter, _)| parameter.allowed.kind);
        let written = |si: f64| match kind {
            Kind::Real => number(value.unit.unit().from_si(si)),
            Kind::Integer => si.round().to_string(),
            Kind::Boolean => (si > 0.5).to_string(),
        };
        if element.is_none() {
            let own = written(value.value);
            out.push(format!("{array} = {own}{}", behind(&value.unit)));
            continue;
        }
        if known.contains(&array) {
            continue;
        }
        let mut elements = elements(array, program, p);
        for value in values {
            if let (own, Some(element)) = parted(&value.path)
                && own == array
            {
                elements.insert(element, value.value);
            }
        }
        let list: Vec<String> = elements.into_values().map(written).collect();
        out.push(format!(
            "{array} = {{{}}}{}",
            list.join(", "),
            behind(&value.unit)
        ));
        known.push(array);
    }
    out
}

/// ` [kg]`
pub(crate) fn behind(unit: &NamedUnit) -> String {
    match unit.text() {
        "" | "1" => String::new(),
        text => format!(" [{text}]"),
    }
}

/// The name of an array and the number of the element, from 1: `row[2].M[1]` is `row[2].M` and 1.
fn parted(path: &str) -> (&str, Option<usize>) {
    let closed = path
        .strip_suffix(']')
        .and_then(|path| path.rsplit_once('['));
    let element = closed.and_then(|(array, number)| Some((array, number.parse().ok()?)));
    match element {
        Some((array, number)) => (array, Some(number)),
        None => (path, None),
    }
}

/// The elements of an array by their numbers, with the values they have.
fn elements(array: &str, program: &Program, p: &[f64]) -> BTreeMap<usize, f64> {
    let mut known = program.parameters.iter();
    let parameter = known.find(|known| known.name == array);
    let of = |parameter: &Parameter| {
        let places = parameter.place..parameter.place + parameter.len;
        (1..).zip(places.map(|place| p[place])).collect()
    };
    parameter.map(of).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::parted;

    #[test]
    fn the_last_subscript_is_of_the_element() {
        assert_eq!(parted("row[2].M[1]"), ("row[2].M", Some(1)));
        assert_eq!(parted("row[2].M"), ("row[2].M", None));
        assert_eq!(parted("guide.F"), ("guide.F", None));
    }
}
