//! [`known_start`]: the start of a model whose states are known to have other values than it says, as those of an axis that a
//! record finds in motion; and [`moved_at_start`]: what events at the start change.

use crate::consistent::Consistent;
use crate::failure::Failure;
use crate::initial::{self, Round};
use crate::moment::Moment;
use crate::setup::Setup;
use crate::simulation::Simulation;
use crate::start_modes::{initial_pins, leave_impossible_modes, leave_modes};
use crate::state::State;
use hyde_program::Program;
use hyde_signal::Table;
use std::collections::BTreeMap;

/// Values at such a start.
#[derive(Clone, Debug)]
pub struct KnownStart {
    /// The solver's vector.
    pub y: Vec<f64>,
    /// Its derivative.
    pub yp: Vec<f64>,
    /// The memory.
    pub z: Vec<f64>,
    /// The parameter vector, with what initial equations found.
    pub p: Vec<f64>,
}

/// The start of a program at a time, with consistent values; some states (position and value) are known. Modes that fix a
/// state elsewhere are left as a run leaves them. The guards of the modes then are for the caller to settle.
///
/// # Errors
/// No consistent values exist there.
pub fn known_start(
    program: &Program,
    records: &BTreeMap<String, Table>,
    parameters: &[f64],
    t: f64,
    known: &[(usize, f64)],
) -> Result<KnownStart, Box<Failure>> {
    let setup = Setup::new(parameters.to_vec(), records, 1.0);
    let mut state = State::new(program, &setup)?;
    let mut consistent = Consistent::new(&state);
    let mut now = initial::start(&mut state, t);
    leave_impossible_modes(&mut state, now.at())?;
    state.pinned = initial_pins(&mut state, now.at());
    initial::solve(&mut state, &mut consistent, &mut now, Round::First)?;
    if !known.is_empty() {
        known
            .iter()
            .for_each(|&(state, value)| now.y[state] = value);
        let is_known = |position: usize| known.iter().any(|(state, _)| *state == position);
        leave_modes(&mut state, now.at(), &|_, position| is_known(position))?;
        state.pinned = initial_pins(&mut state, now.at());
        initial::solve(&mut state, &mut consistent, &mut now, Round::StatesKept)?;
    }
    let (Moment { y, yp, .. }, State { z, p, .. }) = (now, state);
    Ok(KnownStart { y, yp, z, p })
}

/// What the start of a run changes before its first ticks: modes that the start values exclude are left, and exits whose
/// guards are true are taken. Positions and new values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MovedAtStart {
    /// In the solver's vector, of states.
    pub states: BTreeMap<usize, f64>,
    /// In the memory.
    pub memory: BTreeMap<usize, f64>,
}

/// The same of a program with its parameters, at a time.
///
/// # Errors
/// No consistent values exist there.
pub fn moved_at_start(
    program: &Program,
    records: &BTreeMap<String, Table>,
    parameters: &[f64],
    t: f64,
) -> Result<MovedAtStart, Box<Failure>> {
    let before = known_start(program, records, parameters, t, &[])?;
    let (mut guess, mut z) = (vec![0.0; program.n_unknowns], vec![0.0; program.n_memory]);
    program.kernels.start(&before.p, &mut guess, &mut z);
    let setup = Setup {
        start_s: t,
        ..Setup::new(parameters.to_vec(), records, t + 1.0)
    };
    let mut run = Simulation::new(program, &setup)?;
    let (y, after) = run.first_events()?;
    let changed = |before: &[f64], after: &[f64]| -> BTreeMap<usize, f64> {
        let pairs = before.iter().zip(after).enumerate();
        let other = pairs.filter(|(_, (before, after))| before.to_bits() != after.to_bits());
        other.map(|(place, (_, after))| (place, *after)).collect()
    };
    let differential = program.differential(&after);
    let mut states = changed(&before.y, &y);
    states.retain(|place, _| differential[*place]);
    Ok(MovedAtStart {
        states,
        memory: changed(&z, &after),
    })
}
