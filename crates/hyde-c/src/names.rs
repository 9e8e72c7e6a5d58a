//! [`Names`]: names of C for inputs, parameters and outputs: `saddle.s` is `saddle_s`; each is used once.

use crate::fixed_step::FixedStep;
use std::collections::BTreeSet;

/// The members of the three enumerations, in order.
pub(crate) struct Names {
    pub(crate) inputs: Vec<String>,
    pub(crate) parameters: Vec<String>,
    pub(crate) outputs: Vec<String>,
}

impl Names {
    pub(crate) fn of(model: &FixedStep<'_>) -> Self {
        let outputs = model.outputs.iter();
        let outputs = outputs.map(|&number| model.program.outputs[number].name.as_str());
        Self {
            inputs: unique(
                &model.name,
                "in",
                model.inputs.iter().map(|own| own.name.as_str()),
            ),
            parameters: unique(
                &model.name,
                "p",
                model.settable.iter().map(|own| own.name.as_str()),
            ),
            outputs: unique(&model.name, "out", outputs),
        }
    }
}

/// `NAME_out_saddle_s`; a name that is there already gets a number.
fn unique<'n>(model: &str, kind: &str, names: impl Iterator<Item = &'n str>) -> Vec<String> {
    let mut known = BTreeSet::new();
    let mut found = Vec::new();
    for name in names {
        let plain = format!("{model}_{kind}_{}", in_c(name));
        let mut own = plain.clone();
        let mut number = 2;
        while !known.insert(own.clone()) {
            own = format!("{plain}_{number}");
            number += 1;
        }
        found.push(own);
    }
    found
}

/// Letters and digits of ASCII; anything else is `_`, once in a row and not at the end.
fn in_c(name: &str) -> String {
    let mut text = String::new();
    for letter in name.chars() {
        match letter.is_ascii_alphanumeric() {
            true => text.push(letter),
            false if text.ends_with('_') => {}
            false => text.push('_'),
        }
    }
    text.trim_end_matches('_').to_owned()
}
