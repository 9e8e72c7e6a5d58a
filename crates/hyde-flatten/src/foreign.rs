//! Components that something outside the equations computes: `model C = fmu("c.fmu");`.
//!
//! The interface of an FMU is a model with one clocked part. Its variables are given to and taken from the FMU at each tick.

use crate::input::{Form, Input};
use crate::instance::{InstanceId, Member};
use crate::instantiate::InstanceTree;
use crate::names::FileIndex;
use crate::refusals::instantiate as refused;
use hyde_diag::{Diagnostic, Span};
use hyde_ir::{FlatModel, VarId, flat::Foreign};

/// Notes the clocked part of a component whose file stands for an FMU.
pub(crate) fn note_part(
    flat: &mut FlatModel,
    input: &Input<'_>,
    tree: &InstanceTree<'_>,
    (component, part): (InstanceId, InstanceId),
    file: FileIndex,
) {
    let Some((id, _)) = input.files.get(file) else {
        return;
    };
    let (Some(interface), Some(clock)) = (input.fmus.get(id), tree[part].clock) else {
        return;
    };
    let members = &tree[part].members;
    let variables = |names: &[String]| -> Vec<VarId> {
        let known = names.iter().map(|name| match members.get(name.as_str()) {
            Some(Member::Variable(var)) => Some(*var),
            Some(
                Member::Parameter(_)
                | Member::Instance(_)
                | Member::Instances(_)
                | Member::Domain(_),
            )
            | None => None,
        });
        known.flatten().collect()
    };
    let (parameters, inputs, outputs) = (
        variables(&interface.parameters),
        variables(&interface.inputs),
        variables(&interface.outputs),
    );
    let origin = tree.origin(component, tree[component].span);
    flat.foreign.push(Foreign {
        name: tree.path(component).as_str().to_owned(),
        file: interface.file.clone(),
        source: *id,
        clock,
        parameters,
        inputs,
        outputs,
        origin,
    });
}

/// An FMU has values and no derivatives: an observer, which needs those of the whole model, is refused.
pub(crate) fn refuse_observer(flat: &FlatModel, form: Form) -> Option<Diagnostic> {
    let part = flat.foreign.first().filter(|_| form != Form::Run)?;
    let place = (part.name.as_str(), part.file.as_str(), part.origin.span);
    Some(fmu_has_no_equations(place, "an observer"))
}

/// Refuses the FMU of a component, by its name, its file and where it is declared, to what would need its equations.
#[must_use]
pub fn fmu_has_no_equations((name, file, span): (&str, &str, Span), needs: &str) -> Diagnostic {
    refused::fmu_without_equations(name, file, span, needs)
}
