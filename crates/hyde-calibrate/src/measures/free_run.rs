//! The closed-loop free run: the exact model with its own control, driven by the stimuli of a record alone (L1, measure c).
//!
//! Replays are not made here: the reference drives the model, and nothing holds it to what was measured. Model and record
//! are low-passed alike, without phase, and both ends are left out.

use crate::records::Recording;
use hyde_experiment::{Options, RunError};
use hyde_program::Program;
use hyde_signal::filter::LowPass;
use hyde_signal::statistics::rms;

/// Corner in Hz and order of the low-pass, which runs both ways.
const CORNER_HZ: f64 = 100.0;
const ORDER: usize = 4;
/// What is left out at each end in s.
const END_S: f64 = 0.1;

/// A channel of a free run, at the rows that count.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeChannel {
    /// Its name.
    pub name: String,
    /// The rows in s.
    pub time_s: Vec<f64>,
    /// Record less model, low-passed, SI.
    pub error: Vec<f64>,
    /// The model, low-passed, SI.
    pub model: Vec<f64>,
    /// Root mean square of white noise behind the low-pass, of one before it.
    pub passed: f64,
}

impl FreeChannel {
    /// Root mean square of the error, SI.
    #[must_use]
    pub fn rms(&self) -> f64 {
        rms(&self.error)
    }

    /// By how much two runs differ that ought to be the same: the rms of the difference, SI.
    #[must_use]
    pub fn differs(&self, other: &Self) -> f64 {
        let pairs = self.model.iter().zip(&other.model);
        rms(&pairs.map(|(a, b)| a - b).collect::<Vec<f64>>())
    }
}

/// Runs a program over a record with its loop closed, with some parameters set by name (SI); those that shape its equations
/// have been set before.
///
/// # Errors
/// The run has none, or ends before its end; see [`RunError`].
pub fn free_run(
    program: &Program,
    recording: &Recording,
    set: &[(String, f64)],
) -> Result<Vec<FreeChannel>, RunError> {
    let shapes = |name: &str| {
        let known = program.parameter(name);
        known.is_some_and(|(parameter, _)| parameter.structural)
    };
    let plain = set.iter().filter(|(name, _)| !shapes(name));
    let options = Options {
        set: plain.cloned().collect(),
        ..Options::default()
    };
    let run = hyde_experiment::run(program, &recording.tables, &options)?;
    let filter = LowPass::butterworth(ORDER, CORNER_HZ, 1.0 / recording.step_s).ok();
    // Where a record is too slow or too short for the filter, it has nothing that the filter would take away.
    let passed = |values: &[f64]| -> Vec<f64> {
        let filtered = filter.as_ref().map(|f| f.zero_phase(values));
        match filtered {
            Some(Ok(filtered)) => filtered,
            Some(Err(_)) | None => values.to_vec(),
        }
    };
    let ends = (END_S / recording.step_s).round() as usize;
    let of = |channel: &hyde_experiment::Channel| {
        let (measured, model) = (passed(&channel.measured), passed(&channel.simulated));
        let rows = ends..measured.len().saturating_sub(ends).max(ends);
        let rows = if rows.is_empty() {
            0..measured.len()
        } else {
            rows
        };
        let mut impulse = vec![0.0; 2 * ends.max(100) + 1];
        let middle = impulse.len() / 2;
        impulse[middle] = 1.0;
        let answer = passed(&impulse);
        FreeChannel {
            name: channel.name.clone(),
            time_s: channel.time[rows.clone()].to_vec(),
            error: rows.clone().map(|row| measured[row] - model[row]).collect(),
            model: model[rows].to_vec(),
            passed: answer.iter().map(|h| h * h).sum::<f64>().sqrt(),
        }
    };
    Ok(run.channels.iter().map(of).collect())
}
