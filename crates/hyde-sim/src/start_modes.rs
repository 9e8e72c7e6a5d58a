//! Modes that cannot be with the values that states have, at the start and after an impact: they are left.

use crate::active::is_active;
use crate::failure::{Failure, FailureKind};
use crate::moment::At;
use crate::state::State;
use hyde_program::{Firmness, Function, InitialCondition, Program, ReactionKind, Target};

/// The states that the modes in the memory fix, with their values.
pub(crate) fn initial_pins(state: &mut State<'_>, at: At<'_>) -> Vec<(usize, f64)> {
    let program: &Program = state.program;
    if program.pins.is_empty() {
        return Vec::new();
    }
    let values = state.values(Function::Assignments, at);
    let pins = program.pins_in(&state.z);
    pins.map(|(row, pin)| (pin.state, values[row])).collect()
}

/// Leaves initial modes that fix a state whose fixed start value is another one. A guide that moves at the start slips.
pub(crate) fn leave_impossible_modes(
    state: &mut State<'_>,
    at: At<'_>,
) -> Result<(), Box<Failure>> {
    let program: &Program = state.program;
    let declared = |_: usize, position: usize| {
        program.initial.iter().any(|condition| match condition {
            InitialCondition::Fixed {
                state,
                len,
                firmness: Firmness::Default | Firmness::Given,
                yields: false,
                ..
            } => (*state..*state + *len).contains(&position),
            InitialCondition::Fixed { .. }
            | InitialCondition::Equation { .. }
            | InitialCondition::Check { .. } => false,
        })
    };
    leave_modes(state, at, &declared).map(drop)
}

/// Leaves modes that fix a state to another value than it has, where that value was `given` to the state (of an automaton,
/// at a position): by the first exit to a mode in which the model can be. Gives the reactions that this takes.
pub(crate) fn leave_modes(
    state: &mut State<'_>,
    at: At<'_>,
    given: &dyn Fn(usize, usize) -> bool,
) -> Result<Vec<usize>, Box<Failure>> {
    let At { t, y, .. } = at;
    let program: &Program = state.program;
    let mut taken = Vec::new();
    for automaton in 0..program.automata.len() {
        let Some((pin, value)) = violated(state, automaton, at, given) else {
            continue;
        };
        let here = program.mode(&state.z, automaton);
        let before = state.z.clone();
        let mut found = None;
        for (number, reaction) in program.reactions.iter().enumerate() {
            let ReactionKind::Transition {
                automaton: of,
                from,
                to,
                ..
            } = reaction.kind
            else {
                continue;
            };
            if of != automaton || from != here {
                continue;
            }
            let values = state.values(Function::Assignments, at);
            for index in reaction.assignments.clone() {
                if let Target::Memory(position) = program.assignments[index].target {
                    state.z[position] = values[index];
                }
            }
            program.set_mode(&mut state.z, automaton, to);
            if violated(state, automaton, at, given).is_none()
                && !leaves_at_once(state, automaton, to, at)
            {
                found = Some(number);
                break;
            }
            state.z.copy_from_slice(&before);
        }
        let Some(found) = found else {
            let name = program.unknown_name(program.pins[pin].state);
            let kind = FailureKind::Impact(name, y[program.pins[pin].state], value);
            return Err(Failure::new(kind, t).at_origin(&program.pins[pin].origin));
        };
        taken.push(found);
    }
    Ok(taken)
}

/// The pin of an automaton's mode that a given value contradicts, with its value.
fn violated(
    state: &mut State<'_>,
    automaton: usize,
    at: At<'_>,
    given: &dyn Fn(usize, usize) -> bool,
) -> Option<(usize, f64)> {
    let program = state.program;
    let mode = program.mode(&state.z, automaton);
    let values = state.values(Function::Assignments, at);
    program.pins.iter().enumerate().find_map(|(number, pin)| {
        let value = values[program.assignments.len() + number];
        let tolerance = 1e-9 * value.abs().max(at.y[pin.state].abs());
        let other = (at.y[pin.state] - value).abs() > tolerance;
        (pin.automaton == automaton && pin.mode == mode && other && given(automaton, pin.state))
            .then_some((number, value))
    })
}

/// Whether an exit of a mode is true as soon as it is entered.
fn leaves_at_once(state: &mut State<'_>, automaton: usize, mode: usize, at: At<'_>) -> bool {
    let program = state.program;
    let roots = state.values(Function::Roots, at);
    for (number, root) in roots.into_iter().enumerate() {
        if is_active(state, number) {
            state.z[number] = f64::from(u8::from(root > 0.0));
        }
    }
    let conditions = state.conditions(at);
    program.reactions.iter().zip(conditions).any(|(reaction, now)| {
        matches!(reaction.kind, ReactionKind::Transition { automaton: of, from, .. } if of == automaton && from == mode)
            && now
    })
}
