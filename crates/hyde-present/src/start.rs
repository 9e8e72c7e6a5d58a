//! What initial equations determined at the start, and what yielded to them.

use hyde_program::{Firmness, Program};
use hyde_sim::Yielded;
use hyde_units::{Dimension, NamedUnit, engineering_as};
use serde_json::{Value, json};

/// One line for each of which something was said.
pub fn lines(program: &Program, yielded: &[Yielded]) -> Vec<String> {
    let line = |found: &Yielded| {
        let unit = unit(program, &found.name);
        let show = |value: f64| engineering_as(value, &unit).trim().to_owned();
        let (value, start) = (show(found.value), show(found.start));
        let name = &found.name;
        if !found.determined {
            return format!("no initial equation determines {name}: it keeps {start}");
        }
        let was = match found.firmness {
            Firmness::Free | Firmness::Open => "free".to_owned(),
            Firmness::Guess => format!("guess {start}"),
            Firmness::Default | Firmness::Given => {
                format!("instead of the fixed start {start} of its component")
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
