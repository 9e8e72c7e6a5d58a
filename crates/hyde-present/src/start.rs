//! What initial equations determined at the start, and what yielded to them.

use hyde_program::{Firmness, Program};
use hyde_sim::Yielded;
use hyde_units::{Dimension, NamedUnit, engineering_as};
use serde_json::{Value, json};

/// Elements of an array that one line tells together, from this many on.
const TOGETHER: usize = 4;

/// One line for each of which something was said; one for consecutive elements of an array of which the same was said.
pub fn lines(program: &Program, yielded: &[Yielded]) -> Vec<String> {
    let told: Vec<&Yielded> = yielded
        .iter()
        .filter(|found| found.firmness != Firmness::Open)
        .collect();
    let alike = told.chunk_by(|before, found| {
        before.firmness == found.firmness
            && before.determined == found.determined
            && follows(&before.name, &found.name)
    });
    let lines = alike.flat_map(|alike| match alike {
        [] => Vec::new(),
        [first, .., last] if alike.len() >= TOGETHER => {
            let (_, number) = element(&last.name).unwrap_or(("", 0));
            let name = first.name.trim_end_matches(']');
            vec![line(program, &format!("{name}..{number}]"), alike)]
        }
        few => few
            .iter()
            .map(|found| line(program, &found.name, &[found]))
            .collect(),
    });
    lines.collect()
}

/// The name of an array and the number of one of its elements.
fn element(name: &str) -> Option<(&str, i64)> {
    let (array, number) = name.strip_suffix(']')?.rsplit_once('[')?;
    Some((array, number.parse().ok()?))
}

/// Whether an element stands directly behind another of its array.
fn follows(before: &str, name: &str) -> bool {
    match (element(before), element(name)) {
        (Some((array, number)), Some((own, next))) => array == own && next == number + 1,
        _ => false,
    }
}

/// What was said of one, or of several that are alike.
fn line(program: &Program, name: &str, alike: &[&Yielded]) -> String {
    let first = alike[0];
    let unit = unit(program, &first.name);
    let show = |value: f64| engineering_as(value, &unit).trim().to_owned();
    let range = |of: fn(&Yielded) -> f64| {
        let values = || alike.iter().map(|found| of(found));
        let least = values().fold(f64::INFINITY, f64::min);
        let most = values().fold(f64::NEG_INFINITY, f64::max);
        match show(least) == show(most) {
            true => show(least),
            false => format!("{} to {}", show(least), show(most)),
        }
    };
    let (value, start) = (range(|found| found.value), range(|found| found.start));
    let several = alike.len() > 1;
    if !first.determined {
        let keeps = if several { "they keep" } else { "it keeps" };
        return format!("no initial equation determines {name}: {keeps} {start}");
    }
    let was = match first.firmness {
        Firmness::Free | Firmness::Open => "free".to_owned(),
        Firmness::Guess => format!("guess {start}"),
        Firmness::Default | Firmness::Given => {
            format!("instead of the fixed start {start} of its component")
        }
    };
    format!("found at the start: {name} = {value} ({was})")
}

/// The same for programs; SI values.
pub fn json(program: &Program, yielded: &[Yielded]) -> Value {
    let entry = |found: &Yielded| {
        json!({
            "name": found.name,
            "value": found.value,
            "start": found.start,
            "unit": unit(program, &found.name).unit().dimension.usual_unit(),
            "was": match found.firmness {
                Firmness::Free => "free",
                Firmness::Open => "open",
                Firmness::Guess => "guess",
                Firmness::Default => "default",
                Firmness::Given => "fixed",
            },
            "determined": found.determined,
        })
    };
    yielded.iter().map(entry).collect()
}

fn unit(program: &Program, name: &str) -> NamedUnit {
    let output = program
        .output(name)
        .map(|number| program.outputs[number].unit.clone());
    let parameter = || Some(program.parameter(name)?.0.unit.clone());
    let number = || NamedUnit::usual(Dimension::DIMENSIONLESS);
    output.or_else(parameter).unwrap_or_else(number)
}
