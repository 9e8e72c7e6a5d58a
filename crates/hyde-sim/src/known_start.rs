//! [`known_start`]: the start of a model whose states are known to have other values than it says, as those of an axis that a
//! record finds in motion.

use crate::consistent::Consistent;
use crate::failure::Failure;
use crate::initial::{self, Round};
use crate::moment::Moment;
use crate::setup::Setup;
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
    let (Moment { y, yp, .. }, z) = (now, state.z);
    Ok(KnownStart { y, yp, z })
}
