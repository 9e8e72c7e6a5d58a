//! What initial equations determined at the start, and what yielded to them.

use hyde_program::{Firmness, Program};
use hyde_sim::Yielded;
use hyde_units::{Dimension, engineering};
use serde_json::{Value, json};

/// One line for each of which something was said.
pub(crate) fn lines(program: &Program, yielded: &[Yielded]) -> Vec<String> {
    let line = |found: &Yielded| {
        let dimension = dimension(program, &found.name);
        let show = |value: f64| engineering(value, dimension).trim().to_owned();
        let (value, start) = (show(found.value), show(found.start));
        let name = &found.name;
        if !found.determined {
            return format!("no initial equation determines {name}: it keeps {start}");
        }
        let was = match found.firmness {
            Firmness::Free | Firmness::Open => "free".to_owned(),
            Firmness::Guess => format!("guess {start}"),
            Firmness::Default | Firmness::Given => {
                format!("the fixed start {start} of its component yields")
            }
        };
        format!("found at the start: {name} = {value} ({was})")
    };
    let told = yielded
        .iter()
        .filter(|found| found.firmness != Firmness::Open);
    told.map(line).collect()
}

/// The same for programs; SI values.
pub(crate) fn json(program: &Program, yielded: &[Yielded]) -> Value {
    let entry = |found: &Yielded| {
        json!({
            "name": found.name,
            "value": found.value,
            "start": found.start,
            "unit": dimension(program, &found.name).usual_unit(),
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

fn dimension(program: &Program, name: &str) -> Dimension {
    let output = program
        .output(name)
        .map(|number| program.outputs[number].dimension);
    let parameter = program
        .parameter(name)
        .map(|(parameter, _)| parameter.dimension);
    output.or(parameter).unwrap_or(Dimension::DIMENSIONLESS)
}
