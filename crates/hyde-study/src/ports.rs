//! The inputs, outputs and parameters of a program that goes to another tool.

use crate::near::did_you_mean;
use hyde_diag::MadeBy;
use hyde_program::{
    Constant, Firmness, Function, InitialCondition, Output, Parameter, Program, Wrt,
};
use std::collections::BTreeSet;

/// Whether a parameter is an input that another tool sets: made for a free input, whose value is reported by its name.
#[must_use]
pub fn is_input(program: &Program, parameter: &Parameter) -> bool {
    parameter.origin.made_by == MadeBy::Experiment && program.output(&parameter.name).is_some()
}

/// The numbers of the outputs named; if none is, those of the variables of the model itself, or, if it has none, of its
/// arrays, or else of every reported quantity that is not an element of an array.
///
/// # Errors
/// A name that is no reported quantity.
pub fn chosen_outputs(program: &Program, asked: &[String]) -> Result<BTreeSet<usize>, String> {
    if asked.is_empty() {
        let shown = |(_, output): &(usize, &Output)| !output.auxiliary;
        let numbers = |keep: &dyn Fn(&str) -> bool| {
            let all = program.outputs.iter().enumerate().filter(shown);
            let kept = all.filter(|(_, output)| keep(&output.name));
            kept.map(|(number, _)| number).collect::<BTreeSet<usize>>()
        };
        let inputs: Vec<&str> = program
            .parameters
            .iter()
            .filter(|parameter| is_input(program, parameter))
            .map(|parameter| parameter.name.as_str())
            .collect();
        let is_own = |name: &str| !name.contains('.') && !inputs.contains(&name);
        let mut found = numbers(&|name| is_own(name) && !name.contains('['));
        if found.is_empty() {
            found = numbers(&is_own);
        }
        if found.is_empty() {
            found = numbers(&|name| !name.contains('['));
        }
        return Ok(found);
    }
    asked
        .iter()
        .map(|name| {
            program.output(name).ok_or_else(|| {
                let known = program.outputs.iter().filter(|output| !output.auxiliary);
                let near = did_you_mean(name, known.map(|output| output.name.as_str()));
                format!("the model reports no quantity `{name}`{near}")
            })
        })
        .collect()
}

/// The places of parameters that count at the start alone: instants, fixed states, start values and initial equations are made
/// of them.
#[must_use]
pub fn fixed_places(program: &Program, parameters: &[f64]) -> BTreeSet<usize> {
    let kernels = &program.kernels;
    let mut read: BTreeSet<usize> = BTreeSet::new();
    let instants = (0..program.clocks.len()).flat_map(|clock| {
        [
            Constant::Period(clock),
            Constant::Delay(clock),
            Constant::Phase(clock),
        ]
    });
    let scheduled = (0..program.relations.len()).filter(|&r| program.relations[r].scheduled);
    for which in instants.chain(scheduled.map(Constant::TimeEvent)) {
        let partials = kernels.instant_partials(which, parameters);
        read.extend(partials.into_iter().map(|(place, _)| place));
    }
    read.extend(
        kernels
            .start_partials(parameters)
            .into_iter()
            .map(|(_, place, _)| place),
    );
    let first_pin = program.assignments.len();
    let of = |function: Function, first: usize| {
        let entries = kernels.still_entries(function).into_iter();
        entries.filter_map(move |entry| match entry.wrt {
            Wrt::Parameter(place) if entry.row >= first => Some(place),
            Wrt::Parameter(_)
            | Wrt::Unknown(_)
            | Wrt::Derivative(_)
            | Wrt::Memory(_)
            | Wrt::Delayed(_)
            | Wrt::Time => None,
        })
    };
    read.extend(of(Function::Assignments, first_pin));
    let initial = program.initial.iter().any(|condition| match condition {
        InitialCondition::Equation { .. } => true,
        InitialCondition::Fixed { firmness, .. } => *firmness == Firmness::Free,
        InitialCondition::Check { .. } => true,
    });
    if initial {
        read.extend(of(Function::Initial, 0));
    }
    if read.is_empty() {
        return read;
    }
    let plain: Vec<usize> = program
        .parameters
        .iter()
        .flat_map(|parameter| parameter.place..parameter.place + parameter.len)
        .collect();
    let directions = kernels.parameter_directions(&plain, parameters);
    let reaches = |direction: &Vec<f64>| read.iter().any(|&place| direction[place] != 0.0);
    let reached = plain.iter().zip(&directions);
    reached
        .filter(|(_, direction)| reaches(direction))
        .map(|(place, _)| *place)
        .collect()
}
