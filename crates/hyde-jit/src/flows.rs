//! The flows of connections among a program's outputs: what components exchange, for who asks for it.

use hyde_ir::dae::Dae;
use hyde_ir::flat;
use hyde_program::Flow;
use std::collections::{BTreeMap, BTreeSet};

/// The flows of the connections among the outputs; one that is no output has no value of its own.
pub(crate) fn flows(dae: &Dae) -> Vec<Flow> {
    let flows = dae.experiment.flows.iter();
    let wanted: BTreeSet<&str> = flows
        .map(|flow| dae.variables[flow.var].name.as_str())
        .collect();
    if wanted.is_empty() {
        return Vec::new();
    }
    let names = dae.outputs.iter().flat_map(|output| &output.names);
    let numbered = names.map(String::as_str).zip(0..);
    let numbers: BTreeMap<&str, usize> =
        numbered.filter(|(name, _)| wanted.contains(name)).collect();
    let of = |flow: &flat::Flow| {
        let output = *numbers.get(dae.variables[flow.var].name.as_str())?;
        Some(Flow {
            name: flow.name.clone(),
            output,
        })
    };
    dae.experiment.flows.iter().filter_map(of).collect()
}
