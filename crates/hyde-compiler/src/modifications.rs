//! [`modifications`]: values of parameters as a modification takes them. It gives an array all of its elements, so those that
//! nobody found a value for keep the one they have:
//!
//! ```text
//! M[2] = 130 kg, guide[1].F = 30 N      M = {100, 130} [kg], guide.F = {30, 20} [N]
//! ```

use crate::write_back::Calibrated;
use hyde_program::Program;
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
    let mut known: Vec<String> = Vec::new();
    let mut out = Vec::new();
    for value in values {
        let (array, subscripts) = parted(&value.path);
        let kind = program.parameter(&value.path);
        let kind = kind.map_or(Kind::Real, |(parameter, _)| parameter.allowed.kind);
        let written = |si: f64| match kind {
            Kind::Real => number(value.unit.unit().from_si(si)),
            Kind::Integer => si.round().to_string(),
            Kind::Boolean => (si > 0.5).to_string(),
        };
        if subscripts.is_empty() {
            let own = written(value.value);
            out.push(format!("{array} = {own}{}", behind(&value.unit)));
            continue;
        }
        if known.contains(&array) {
            continue;
        }
        let mut elements = elements(&array, program, p);
        for value in values {
            let (own, subscripts) = parted(&value.path);
            if own == array {
                elements.insert(subscripts, value.value);
            }
        }
        let elements: Vec<(Vec<usize>, f64)> = elements.into_iter().collect();
        let list = list(&elements, 0, &written);
        out.push(format!("{array} = {list}{}", behind(&value.unit)));
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

/// The name without its subscripts, and these: `row[2].M[1]` is `row.M`, 2 and 1.
fn parted(path: &str) -> (String, Vec<usize>) {
    let (mut name, mut subscripts) = (String::new(), Vec::new());
    for part in path.split('[') {
        let closed = part.split_once(']');
        let subscript = closed.and_then(|(number, rest)| Some((number.parse().ok()?, rest)));
        match subscript {
            Some((number, rest)) => {
                subscripts.push(number);
                name.push_str(rest);
            }
            None => name.push_str(part),
        }
    }
    (name, subscripts)
}

/// The elements of an array by their subscripts, with the values they have.
fn elements(array: &str, program: &Program, p: &[f64]) -> BTreeMap<Vec<usize>, f64> {
    let places = 0..p.len();
    let named = places.filter_map(|place| {
        let (_, name) = program.parameter_at(place)?;
        let (own, subscripts) = parted(&name);
        (own == array && !subscripts.is_empty()).then_some((subscripts, p[place]))
    });
    named.collect()
}

/// `{100, 130}`, and lists in lists, of elements in the order of their subscripts.
fn list(elements: &[(Vec<usize>, f64)], level: usize, number: &dyn Fn(f64) -> String) -> String {
    match elements {
        [(subscripts, value)] if subscripts.len() == level => number(*value),
        _ => {
            let groups = elements.chunk_by(|(a, _), (b, _)| a.get(level) == b.get(level));
            let groups: Vec<String> = groups.map(|own| list(own, level + 1, number)).collect();
            format!("{{{}}}", groups.join(", "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{list, parted};

    #[test]
    fn subscripts_become_lists_in_lists() {
        assert_eq!(parted("row[2].M[1]"), ("row.M".to_owned(), vec![2, 1]));
        assert_eq!(parted("guide.F"), ("guide.F".to_owned(), Vec::new()));
        let elements: Vec<(Vec<usize>, f64)> = [[1, 1], [1, 2], [2, 1], [2, 2]]
            .into_iter()
            .zip(1_u32..)
            .map(|(subscripts, value)| (subscripts.to_vec(), f64::from(value)))
            .collect();
        let text = list(&elements, 0, &|value| value.to_string());
        assert_eq!(text, "{{1, 2}, {3, 4}}");
    }
}
