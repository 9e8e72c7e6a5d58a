//! The response measured by stepped sines on the full hybrid model: at each frequency a run of its own, from the start of
//! the experiment, settled, then fitted over whole periods.
//!
//! The runs know nothing of each other, so several go side by side and give the same.

use crate::measures::MeasureValue;
use crate::rows::EvenRows;
use crate::run::{Options, run};
use crate::run_error::RunError;
use hyde_program::{Bode, Program};
use hyde_signal::Table;
use hyde_signal::spectrum::{Complex, harmonic_distortion, response_at};
use hyde_sim::Results;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Rows in a period: the tenth harmonic has six.
const ROWS: f64 = 64.0;
/// At most so many runs to bring a response to its level, within this part of it.
const TRIES: usize = 6;
const NEAR: f64 = 0.03;

/// How to step.
#[derive(Clone, Debug, PartialEq)]
pub struct Steps {
    /// In Hz.
    pub frequencies_hz: Vec<f64>,
    /// Of the input, at most; SI.
    pub amplitude: f64,
    /// Time in s before anything counts.
    pub settle_s: f64,
    /// Whole periods that count, at least 2.
    pub periods: u32,
    /// A response that is not to be larger.
    pub level: Option<Level>,
}

/// The amplitude of an output that the amplitude of the input is lowered for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Level {
    /// Its number among the outputs of the response.
    pub output: usize,
    /// Its amplitude, SI.
    pub most: f64,
}

/// What came of one frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct SteppedPoint {
    /// In Hz.
    pub frequency_hz: f64,
    /// Of the input, SI.
    pub amplitude: f64,
    /// The outputs of the response, in order.
    pub outputs: Vec<SteppedOutput>,
    /// Measures and expectations over the periods that count.
    pub measures: Vec<MeasureValue>,
}

/// An output at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SteppedOutput {
    /// Its fundamental over the input's.
    pub response: Complex<f64>,
    /// The share of its power that is linear in the input, 0 to 1.
    pub coherence: f64,
    /// Its harmonics over its fundamental.
    pub distortion: f64,
}

/// The stepped response that an experiment asks for; the program was compiled with a value for `INPUT.frequency`. So many
/// `threads` run side by side. What is reached of `options` counts frequencies.
///
/// # Errors
/// The first run that did not start or end, in the order of the frequencies.
pub fn stepped_response(
    program: &Program,
    records: &BTreeMap<String, Table>,
    options: &Options,
    bode: &Bode,
    steps: &Steps,
    threads: usize,
) -> Result<Vec<SteppedPoint>, RunError> {
    let (next, finished) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let count = steps.frequencies_hz.len();
    options.reached.set(0.0, count as f64);
    let work = || {
        let mut done = Vec::new();
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(&frequency_hz) = steps.frequencies_hz.get(number) else {
                return done;
            };
            let point = Sine {
                program,
                records,
                options,
                bode,
                steps,
                frequency_hz,
            };
            done.push((number, point.measured()));
            let finished = finished.fetch_add(1, Ordering::Relaxed) + 1;
            options.reached.set(finished as f64, count as f64);
        }
    };
    let mut found: Vec<_> = std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.clamp(1, count.max(1)))
            .map(|_| scope.spawn(work))
            .collect();
        let lists = workers.into_iter().map(|worker| match worker.join() {
            Ok(list) => list,
            Err(panic) => std::panic::resume_unwind(panic),
        });
        lists.flatten().collect()
    });
    found.sort_by_key(|(number, _)| *number);
    found.into_iter().map(|(_, point)| point).collect()
}

/// One frequency.
struct Sine<'a> {
    program: &'a Program,
    records: &'a BTreeMap<String, Table>,
    options: &'a Options,
    bode: &'a Bode,
    steps: &'a Steps,
    frequency_hz: f64,
}

impl Sine<'_> {
    /// Lowers the amplitude until the response that has a level is there. Where it jumps over the level, as with play, the
    /// largest below is taken.
    fn measured(&self) -> Result<SteppedPoint, RunError> {
        let mut point = self.at(self.steps.amplitude)?;
        let Some(level) = self.steps.level else {
            return Ok(point);
        };
        // The largest amplitude that was too small, the smallest that was too large.
        let (mut low, mut high) = (0.0, f64::INFINITY);
        let mut before: Option<(f64, f64)> = None;
        let mut below: Option<SteppedPoint> = None;
        for _ in 0..TRIES {
            let Some(output) = point.outputs.get(level.output) else {
                break;
            };
            let amplitude = point.amplitude;
            let size = output.response.norm() * amplitude;
            let full = amplitude >= self.steps.amplitude && size <= level.most;
            if full || (size / level.most - 1.0).abs() < NEAR || size.is_nan() {
                return Ok(point);
            }
            if size < level.most {
                low = amplitude;
                below = Some(point.clone());
            } else {
                high = amplitude;
            }
            // As a power of the amplitude, by the last two; in proportion at first.
            let power = before.map_or(1.0, |(other, was)| {
                (size / was).ln() / (amplitude / other).ln()
            });
            let next = amplitude * (level.most / size).powf(1.0 / power);
            let next = if low < next && next < high {
                next
            } else {
                0.5 * (low + high.min(self.steps.amplitude))
            };
            before = Some((amplitude, size));
            point = self.at(next.min(self.steps.amplitude))?;
        }
        Ok(below.unwrap_or(point))
    }

    fn at(&self, amplitude: f64) -> Result<SteppedPoint, RunError> {
        let period = 1.0 / self.frequency_hz;
        let settling = (self.steps.settle_s * self.frequency_hz).ceil();
        let counted = f64::from(self.steps.periods.max(2));
        let mut options = self.options.clone();
        let input = &self.bode.input;
        options
            .set
            .push((format!("{input}.frequency"), self.frequency_hz));
        options.set.push((format!("{input}.amplitude"), amplitude));
        options.stop_s = Some((settling + counted) * period);
        options.every_s = Some(period / ROWS);
        let from = settling * period;
        options.measured_from_s = Some(from);
        options.reached = Arc::default();
        let run = run(self.program, self.records, &options)?;
        let mut results = run.results;
        let before = results.time.partition_point(|t| *t < from - 1e-6 * period);
        results.time.drain(..before);
        for column in &mut results.columns {
            *column = column.iter().skip(before).collect();
        }
        let outputs = self.bode.outputs.iter();
        let outputs = outputs.map(|(_, output)| self.fitted(&results, *output, from, amplitude));
        Ok(SteppedPoint {
            frequency_hz: self.frequency_hz,
            amplitude,
            outputs: outputs.collect(),
            measures: run.measures,
        })
    }

    /// An output against the sine that drives the input. NaN where it was not reported.
    fn fitted(&self, results: &Results, output: usize, from: f64, amplitude: f64) -> SteppedOutput {
        let rows = EvenRows::of(results, from, 1.0 / (ROWS * self.frequency_hz));
        // Whole periods end before the first row of the next.
        let to = rows.time.len().saturating_sub(1);
        let none = SteppedOutput {
            response: Complex::new(f64::NAN, f64::NAN),
            coherence: f64::NAN,
            distortion: f64::NAN,
        };
        let Some(values) = results.column(output) else {
            return none;
        };
        let (time, values) = (&rows.time[..to], &rows.values(&values)[..to]);
        let turn = std::f64::consts::TAU * self.frequency_hz;
        let driven: Vec<f64> = time.iter().map(|t| amplitude * (turn * t).sin()).collect();
        let fit = response_at(&[self.frequency_hz], time, &driven, values);
        let distortion = harmonic_distortion(self.frequency_hz, time, values);
        match (fit, distortion) {
            (Ok(fit), Ok(distortion)) => SteppedOutput {
                response: fit.response[0],
                coherence: fit.coherence[0],
                distortion,
            },
            (Err(_), _) | (_, Err(_)) => none,
        }
    }
}
