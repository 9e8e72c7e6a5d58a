//! Linearised models against their own runs: random models with relations, modes and clocks, and random sampled loops.
//!
//! A model is run again with each start value changed a little. Over a short time without events the differences of the
//! runs must follow the linearised system, and over whole periods of the clocks the poles of the sampled loop. No number
//! of the linearised system comes into a run.
//!
//! Over a time T a wrong coefficient makes an error with T; a motion whose coefficients change on the way makes one with T^2
//! and more, and is no fault of the linearised system. Errors over T, T/2 and T/4 tell them apart.

mod loops;
mod models;

pub use loops::wrong_poles;

pub(crate) use self::models::random;
use crate::Example;
use hyde_compiler::Backend;
use hyde_experiment::{About, linearize_about, parameters};
use hyde_program::{Method, Program};
use hyde_sim::{PointTime, Setup, simulate};
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;

/// By how much start values are changed, and how far the differences may be off, as a part of the change.
const CHANGE: f64 = 1e-6;
const OFF: f64 = 5e-4;
/// The time over which differences are followed: short against the vibrations of the models, in s.
const SPAN: f64 = 1e-3;

/// What became of a model.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The linearised system is that of the run.
    Agrees,
    /// It is not, and the table of assumptions says so.
    Told,
    /// No difference of runs could be followed: an event was in the way.
    Nothing,
    /// It is not, without a word: what differs.
    Wrong(String),
}

/// Where a run ends.
struct End {
    y: Vec<f64>,
    z: Vec<f64>,
    events: usize,
}

/// Compares the linearised system of a random model with its run.
///
/// # Errors
/// The model does not compile, or does not run.
pub fn compare(seed: u64) -> Result<Verdict, String> {
    let model = random(seed);
    let example = Example::load("tests/models/ledger.hyde", None)?.replaced(&model.text, "run");
    let with_text = |reason: String| format!("{reason}\n{}", model.text);
    match compared(&example, model.at_s, &model.starts) {
        Ok(Verdict::Wrong(reason)) => Ok(Verdict::Wrong(with_text(reason))),
        other => other.map_err(with_text),
    }
}

/// The same for a model with its operating point and the parameters that are start values.
pub(crate) fn compared(example: &Example, at_s: f64, starts: &[String]) -> Result<Verdict, String> {
    let program = example
        .clone()
        .free_inputs()
        .compile(Backend::Native)?
        .program;
    let records = BTreeMap::new();
    let p = parameters(&program, &records, &[]).map_err(|error| format!("{error:?}"))?;
    let time = if at_s > 0.0 {
        PointTime::At(at_s)
    } else {
        PointTime::Start
    };
    let about = About {
        time,
        open: true,
        ..About::default()
    };
    let linear = linearize_about(&program, &records, &p, &[], about);
    let linear = linear.map_err(|error| format!("{error:?}"))?;
    let end = |set: &[(String, f64)], stop: f64| ended(&program, set, stop);
    let from = end(&[], at_s)?;
    if end(&[], at_s + SPAN)?.events != from.events {
        return Ok(Verdict::Nothing);
    }
    let held: Vec<usize> = program
        .holds
        .iter()
        .flat_map(|hold| hold.target..hold.target + hold.len)
        .collect();
    let mut followed = 0;
    for start in starts {
        let (known, _) = program.parameter(start).ok_or("no such start")?;
        let changed = [(start.clone(), p[known.place] + CHANGE)];
        let other = end(&changed, at_s)?;
        if end(&changed, at_s + SPAN)?.events != other.events {
            continue;
        }
        followed += 1;
        let states = |a: &End, b: &End| {
            let differences = linear.states.iter().map(|&state| b.y[state] - a.y[state]);
            DVector::from_iterator(linear.states.len(), differences)
        };
        let holds = held.iter().map(|&place| other.z[place] - from.z[place]);
        let holds = DVector::from_iterator(held.len(), holds);
        let before = states(&from, &other);
        let after = |span: f64| -> Result<_, String> {
            let (phi, gamma) = flow(&linear.a, &linear.b_held, span);
            let found = states(&end(&[], at_s + span)?, &end(&changed, at_s + span)?);
            Ok((found, phi * &before + gamma * &holds))
        };
        let (found, expected) = after(SPAN)?;
        let allowed = OFF * before.amax().max(expected.amax());
        if (&found - &expected).amax() <= allowed {
            continue;
        }
        let rates = [SPAN, 0.5 * SPAN, 0.25 * SPAN].map(|span| {
            let (found, expected) = after(span)?;
            Ok((found - expected) / span)
        });
        let [whole, half, quarter]: [Result<DVector<f64>, String>; 3] = rates;
        if (at_once(&whole?, &half?, &quarter?) * SPAN).amax() > allowed {
            return Ok(match linear.assumptions.is_empty() {
                false => Verdict::Told,
                true => Verdict::Wrong(format!(
                    "with {start} changed, {found} after {SPAN} s, linearised {expected}, from {before}"
                )),
            });
        }
    }
    Ok(match followed {
        0 => Verdict::Nothing,
        _ => Verdict::Agrees,
    })
}

/// What values over a time, its half and its quarter come to over none: the parabola through them (Richardson).
fn at_once(whole: &DVector<f64>, half: &DVector<f64>, quarter: &DVector<f64>) -> DVector<f64> {
    let (first, second) = (half * 2.0 - whole, quarter * 2.0 - half);
    (second * 4.0 - first) / 3.0
}

/// Runs to a time, exactly.
fn ended(program: &Program, set: &[(String, f64)], stop: f64) -> Result<End, String> {
    let records = BTreeMap::new();
    let p = parameters(program, &records, set).map_err(|error| format!("{error:?}"))?;
    // A run to nought is one over nothing.
    let mut setup = Setup::new(p, &records, stop.max(1e-12));
    setup.method = Method::Ida;
    (setup.rtol, setup.atol) = (1e-11, 1e-13);
    (setup.rows_s, setup.keep) = (Vec::new(), Some(Vec::new()));
    let results = simulate(program, &setup).map_err(|failure| format!("{:?}", failure.kind))?;
    Ok(End {
        events: results.events.len(),
        y: results.last.0,
        z: results.last.1,
    })
}

/// exp(A t), and its integral times B.
fn flow(a: &DMatrix<f64>, b: &DMatrix<f64>, t: f64) -> (DMatrix<f64>, DMatrix<f64>) {
    let (n, m) = (a.nrows(), b.ncols());
    let mut block = DMatrix::zeros(n + m, n + m);
    block.view_mut((0, 0), (n, n)).copy_from(&(a * t));
    block.view_mut((0, n), (n, m)).copy_from(&(b * t));
    let exponential = block.exp();
    (
        exponential.view((0, 0), (n, n)).into_owned(),
        exponential.view((0, n), (n, m)).into_owned(),
    )
}
