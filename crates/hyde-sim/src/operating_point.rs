//! A point to linearise about: the start of the model in chosen modes, with consistent values.

use crate::consistent::Consistent;
use crate::failure::Failure;
use crate::initial;
use crate::setup::Setup;
use crate::start_modes::initial_pins;
use crate::state::State;
use hyde_program::{Program, ReactionKind};
use hyde_signal::Table;
use std::collections::BTreeMap;

/// Values of the solver's vector and the memory at a point.
#[derive(Clone, Debug)]
pub struct OperatingPoint {
    /// The solver's vector.
    pub y: Vec<f64>,
    /// Its derivative.
    pub yp: Vec<f64>,
    /// The memory.
    pub z: Vec<f64>,
    /// The delayed values.
    pub delayed: Vec<f64>,
}

/// The start of a program in the modes given (automaton and mode). Of the other automata, one whose first mode fixes a
/// state is put into the mode of that mode's first exit.
///
/// # Errors
/// No consistent values exist there.
pub fn operating_point(
    program: &Program,
    records: &BTreeMap<String, Table>,
    parameters: &[f64],
    modes: &[(usize, usize)],
) -> Result<OperatingPoint, Box<Failure>> {
    let setup = Setup::new(parameters.to_vec(), records, 1.0);
    let mut state = State::new(program, &setup)?;
    let mut consistent = Consistent::new(&state);
    let (mut y, mut yp) = initial::start(&mut state, 0.0);
    state.pinned = initial_pins(&mut state, 0.0, &y, &yp);
    initial::solve(
        &mut state,
        &mut consistent,
        0.0,
        &mut y,
        &mut yp,
        initial::Round::First,
    )?;
    for (number, automaton) in program.automata.iter().enumerate() {
        let current = crate::guards::current_mode(program, &state.z, number);
        let chosen = modes
            .iter()
            .find(|(automaton, _)| *automaton == number)
            .map(|(_, mode)| *mode);
        let pins = program
            .pins
            .iter()
            .any(|pin| pin.automaton == number && pin.mode == current);
        let first_exit = program
            .reactions
            .iter()
            .find_map(|reaction| match reaction.kind {
                ReactionKind::Transition {
                    automaton,
                    from,
                    to,
                    ..
                } if automaton == number && from == current => Some(to),
                ReactionKind::Transition { .. }
                | ReactionKind::When { .. }
                | ReactionKind::Edge(_)
                | ReactionKind::Assert(_) => None,
            });
        let mode = chosen.or(first_exit.filter(|_| pins)).unwrap_or(current);
        state.z[automaton.place] = mode as f64;
    }
    state.pinned = initial_pins(&mut state, 0.0, &y, &yp);
    initial::solve(
        &mut state,
        &mut consistent,
        0.0,
        &mut y,
        &mut yp,
        initial::Round::StatesKept,
    )?;
    let delayed = state.delayed().to_vec();
    Ok(OperatingPoint {
        y,
        yp,
        z: state.z,
        delayed,
    })
}
