//! [`Cause`]: why a calibration taught nothing, where it did not: least squares of what nothing changes end at once, and look
//! as if they had converged.

use super::solution::Solution;
use super::varied::Varied;
use crate::observer::{Observer, When, run_while};
use crate::plant::Unsupported;
use crate::records::Recording;
use hyde_program::Program;
use hyde_signal::statistics::{mean, mean_square};
use std::ops::ControlFlow;

/// A parameter has no effect that changes the sum of squares by less than this over its prior's standard deviation: a unit
/// over ten of them.
pub(crate) const SILENT: f64 = 1e-2;
/// A mode that holds a state in this part of the rows, or more, never let it go.
const ALWAYS: f64 = 0.98;
/// Innovations of this part of what the signal itself does, and so many times the noise, are of a model that does not follow.
const ASTRAY: (f64, f64) = (0.5, 10.0);

/// Why nothing was learned.
#[derive(Clone, Debug, PartialEq)]
pub enum Cause {
    /// The observer stood still: a mode held a state throughout a record.
    Held {
        /// The automaton and its mode.
        mode: (String, String),
        /// The state.
        state: String,
        /// The record.
        record: String,
    },
    /// Innovations of a channel are about as large as the signal itself.
    Astray {
        /// The channel, by its number.
        channel: usize,
        /// Root mean square of the innovations, and of the signal about its mean, SI.
        rms: (f64, f64),
        /// The record.
        record: String,
    },
}

/// Whether innovations depend on each of what was varied.
pub(crate) fn audible(solution: &Solution) -> Vec<bool> {
    let effects = solution.curvature.0.diagonal();
    effects.iter().map(|effect| *effect >= SILENT).collect()
}

/// Why a calibration that ended there has nothing to say, as far as its runs show it; nothing where it has.
///
/// # Errors
/// The program has no fixed-step form.
pub fn standstill(
    program: &Program,
    recordings: &[Recording],
    observer: &Observer,
    varied: &[Varied],
    set: &[(usize, f64)],
    solution: &Solution,
) -> Result<Vec<Cause>, Unsupported> {
    let values = varied.iter().zip(&solution.values);
    let calibrated = values.map(|(varied, &value)| (varied.place, value));
    let set: Vec<(usize, f64)> = set.iter().copied().chain(calibrated).collect();
    let mut causes = Vec::new();
    for (recording, innovations) in recordings.iter().zip(&solution.innovations) {
        for (channel, list) in innovations.each_of_readings().enumerate() {
            let rows = &recording.channels[channel][recording.first_row..];
            let known: Vec<f64> = rows.iter().copied().filter(|v| v.is_finite()).collect();
            let mean = mean(&known);
            let signal: Vec<f64> = known.iter().map(|value| value - mean).collect();
            let signal = mean_square(&signal).sqrt();
            let rms = mean_square(&list).sqrt() * observer.deviations[channel];
            if rms > ASTRAY.0 * signal && rms > ASTRAY.1 * observer.noise[channel] {
                causes.push(Cause::Astray {
                    channel,
                    rms: (rms, signal),
                    record: recording.name.clone(),
                });
            }
        }
        if !causes.is_empty() || !audible(solution).contains(&true) {
            held(program, recording, observer, &set, &mut causes)?;
        }
    }
    Ok(causes)
}

/// The modes that hold a state throughout a record.
fn held(
    program: &Program,
    recording: &Recording,
    observer: &Observer,
    set: &[(usize, f64)],
    causes: &mut Vec<Cause>,
) -> Result<(), Unsupported> {
    let (mut plant, observer) = observer.on(program, recording, set)?;
    let mut counts = vec![0.0; program.pins.len()];
    let _end = run_while(&mut plant, &observer, |plant, _, when, _| {
        if matches!(when, When::Before) {
            for (count, pin) in counts.iter_mut().zip(&program.pins) {
                let here = program.mode(&plant.z, pin.automaton) == pin.mode;
                *count += f64::from(u8::from(here));
            }
        }
        ControlFlow::Continue(())
    });
    let rows = recording.rows() as f64;
    let always = program.pins.iter().zip(counts);
    let always = always.filter(|(_, count)| *count >= ALWAYS * rows);
    causes.extend(always.map(|(pin, _)| {
        let automaton = &program.automata[pin.automaton];
        Cause::Held {
            mode: (automaton.name.clone(), automaton.modes[pin.mode].clone()),
            state: program.unknown_name(pin.state),
            record: recording.name.clone(),
        }
    }));
    Ok(())
}
