//! The states of a model: which of them the equations left to choose, which are none, and whose start value is no condition.

use crate::lines::wrapped;
use hyde_compiler::States;
use hyde_diag::Origin;
use hyde_study::Project;
use serde_json::{Value, json};

/// Lines on states where the equations left a choice, or a start value is no condition of the model.
#[must_use]
pub fn text(model: &str, states: &States, project: &Project) -> Vec<String> {
    let place = |origin: &Origin| project.sources.place(origin.span);
    let mut lines = Vec::new();
    for choice in &states.chosen {
        let places: Vec<String> = choice.constraints.iter().map(place).collect();
        lines.push(format!(
            "  {model}: {} of {} is chosen as a state during the run, constrained at {}",
            choice.states,
            choice.candidates.join(", "),
            places.join(", ")
        ));
    }
    for (name, origin) in &states.dependent {
        lines.push(format!(
            "  {model}: {name} is not a state; it is determined at {}",
            place(origin)
        ));
    }
    if !states.filled.is_empty() {
        let list = states.filled.join(", ");
        let equations = match states.equations {
            0 => " alone".to_owned(),
            1 => " or the initial equation".to_owned(),
            count => format!(" or one of {count} initial equations"),
        };
        lines.push(format!(
            "  {model}: initial value from `start`{equations}: {list}"
        ));
    }
    // Eighty columns: what does not fit goes on below, deeper in.
    let wrapped = lines.iter().flat_map(|line| {
        let parts = wrapped(line.trim_start(), 74).into_iter().enumerate();
        parts.map(|(number, part)| match number {
            0 => format!("  {part}"),
            _ => format!("      {part}"),
        })
    });
    wrapped.collect()
}

/// The states of a model as JSON.
#[must_use]
pub fn json(model: &str, states: &States, project: &Project) -> Value {
    let place = |origin: &Origin| project.sources.place(origin.span);
    let chosen: Vec<Value> = states
        .chosen
        .iter()
        .map(|choice| {
            let places: Vec<String> = choice.constraints.iter().map(place).collect();
            json!({ "states": choice.states, "of": choice.candidates, "constraints": places })
        })
        .collect();
    let dependent: Vec<Value> = states
        .dependent
        .iter()
        .map(|(name, origin)| json!({ "name": name, "constraint": place(origin) }))
        .collect();
    json!({
        "model": model, "states": states.states, "chosen": chosen, "dependent": dependent,
        "start_only": states.filled,
    })
}
