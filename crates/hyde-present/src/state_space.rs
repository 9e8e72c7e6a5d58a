//! A state space: as a file for MATLAB, Octave or python-control, as JSON, and in words.

pub mod content;
pub mod octave;
pub mod python;

use crate::assumed;
use hyde_experiment::StateSpace;
use hyde_program::Program;
use hyde_study::state_space::Found;
use hyde_units::{counted, significant};

/// About what it is linearised, and what is assumed there.
#[must_use]
pub fn about(found: &Found) -> String {
    let prepared = &found.prepared;
    let program = &prepared.compiled.program;
    let unstable = assumed::unstable(program, &found.linear, &found.poles);
    unstable.unwrap_or_default()
        + &loop_told(program, &found.system, found.open)
        + &assumed::text(program, &found.linear, prepared.time)
}

/// What is in the file at this path.
#[must_use]
pub fn text(path: &str, found: &Found) -> String {
    let system = &found.system;
    format!(
        "  {}\n  {}: {}, {}, {}\n{}",
        path,
        match system.sampled {
            Some(_) => "sampled",
            None => "continuous",
        },
        counted(system.states.len(), "state"),
        counted(system.inputs.len(), "input"),
        counted(system.outputs.len(), "output"),
        about(found)
    )
}

/// Which loop the system is that of.
fn loop_told(program: &Program, system: &StateSpace, open: bool) -> String {
    match system.sampled {
        Some(times) => format!(
            "closed loop, exact from one common period of the clocks to the next: {} ms\n",
            significant(1e3 * times.period_s, 6)
        ),
        None if open && !program.holds.is_empty() => {
            "plant alone: the held outputs of the clocks are inputs, behind the others\n".to_owned()
        }
        None => String::new(),
    }
}
