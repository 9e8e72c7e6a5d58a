//! The inverse of the modes: parameters from measured natural frequencies and dampings.
//!
//! Least squares over the logarithms of frequencies and the relative errors of damping ratios (of one far below the measured
//! one a logarithm), each weighed with its spread, in the logarithms of the parameters: Gauss and Newton's method with the
//! singular values of the weighed derivatives (Björck, Numerical Methods for Least Squares Problems, 1996, 9.2). A combination of parameters whose singular value is below 1 would have to change
//! by more than a factor e to be seen beyond the spread: it is left as it is, and told. Modes are paired with
//! measurements by order at first; from step to step each is the one whose vectors fit.

mod tracked;

use self::tracked::{Model, Tracked};
use crate::linearize::LinearizeError;
use crate::modes::NaturalMode;
use crate::run_error::RunError;
use hyde_program::Program;
use hyde_signal::Table;
use nalgebra::DVector;
use std::collections::BTreeMap;

/// Most steps; each costs a linearised system.
const MAX_STEPS: usize = 60;
/// The largest change of a parameter's logarithm in a step.
const LONGEST: f64 = 0.5;
/// A step of all logarithms below this ends the iteration.
const DONE: f64 = 1e-10;
/// A mode overlaps at least so much with itself a step before; else the step is halved.
const SAME: f64 = 0.5;
/// A combination of parameters counts for one of them from this part on.
const PART: f64 = 0.1;

/// A measured mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredMode {
    /// Natural frequency in Hz.
    pub frequency_hz: f64,
    /// Its standard deviation over itself.
    pub spread: f64,
    /// Damping ratio and its standard deviation over itself.
    pub damping: Option<(f64, f64)>,
}

/// A parameter that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundParameter {
    /// Its value before and after, SI.
    pub values: (f64, f64),
    /// Standard deviation of its logarithm; `None` if the measurement does not determine it.
    pub spread: Option<f64>,
}

/// A measured mode with the model's.
#[derive(Clone, Debug, PartialEq)]
pub struct PairedMode {
    /// Number of the mode in the model before, from 0.
    pub number: usize,
    /// Of the model before and after.
    pub modes: (NaturalMode, NaturalMode),
    /// By how many percent its frequency rises for a percent of each parameter.
    pub by_parameter: Vec<f64>,
}

/// A combination of parameters, from the best to the worst determined.
#[derive(Clone, Debug, PartialEq)]
pub struct Combination {
    /// Standard deviation of its logarithm.
    pub spread: f64,
    /// Exponents of the parameters, of length 1 together.
    pub exponents: Vec<f64>,
}

/// What came of a fit.
#[derive(Clone, Debug)]
pub struct ModeFit {
    /// In the order asked for.
    pub parameters: Vec<FoundParameter>,
    /// In the order measured.
    pub modes: Vec<PairedMode>,
    /// As many as parameters.
    pub combinations: Vec<Combination>,
    /// Root mean square of what is left, in spreads.
    pub left: f64,
}

/// Why there is no fit.
#[derive(Clone, Debug)]
pub enum ModeFitError {
    /// A parameter cannot be set: which.
    Parameter(RunError),
    /// It shapes the equations: its name.
    Structural(String),
    /// It is not positive: its name and value.
    NotPositive(String, f64),
    /// The model has fewer modes than were measured, or not that number.
    TooFewModes(usize),
    /// The model could not be linearised.
    Linearize(LinearizeError),
    /// A mode has no vectors that the iteration finds, or was lost: its number in the measurement, from 0.
    Lost(usize),
    /// The steps did not come to an end.
    NotConverged,
}

/// What is to be fitted.
#[derive(Clone, Copy)]
pub struct ModeFitRequest<'a> {
    /// The model, compiled with free inputs.
    pub program: &'a Program,
    /// Its records.
    pub records: &'a BTreeMap<String, Table>,
    /// Values set, SI.
    pub set: &'a [(String, f64)],
    /// Modes of its automata.
    pub in_modes: &'a [(usize, usize)],
    /// Names of the parameters.
    pub vary: &'a [String],
    /// The measurement, by ascending frequency.
    pub measured: &'a [MeasuredMode],
    /// The number of each one's mode in the model, from 0; by order and nearness if empty.
    pub numbers: &'a [usize],
}

/// Finds the parameters.
///
/// # Errors
/// See [`ModeFitError`].
pub fn fit_modes(request: &ModeFitRequest<'_>) -> Result<ModeFit, ModeFitError> {
    let places = request.places()?;
    let start = Model::of(request, &[])?;
    let before: Vec<f64> = places
        .iter()
        .map(|&place| start.parameters[place])
        .collect();
    for (name, &value) in request.vary.iter().zip(&before) {
        if value.is_nan() || value <= 0.0 {
            return Err(ModeFitError::NotPositive(name.clone(), value));
        }
    }
    let numbers = start.pair(request)?;
    let mut found = start.tracked(request, &places, &numbers)?;
    let (first, mut x) = (found.clone(), DVector::<f64>::zeros(places.len()));
    for _ in 0..MAX_STEPS {
        let step = found.step();
        if step.amax() < DONE {
            return Ok(result(&before, &x, &numbers, &first, &found));
        }
        let mut part = (LONGEST / step.amax()).min(1.0);
        found = loop {
            let next = &x + &step * part;
            let values: Vec<f64> = before.iter().zip(&next).map(|(v, x)| v * x.exp()).collect();
            let tried = Model::of(request, &values)?.followed(request, &places, &found)?;
            // Near the end rounding decides whether the sum of squares still falls.
            let better = tried.squares() <= found.squares() * (1.0 + 1e-9) + 1e-18;
            if better && tried.least_overlap >= SAME {
                x = next;
                break tried;
            }
            part *= 0.5;
            if part < 1e-6 {
                return match tried.least_overlap < SAME {
                    true => Err(ModeFitError::Lost(tried.lost)),
                    false => Ok(result(&before, &x, &numbers, &first, &found)),
                };
            }
        };
    }
    Err(ModeFitError::NotConverged)
}

impl ModeFitRequest<'_> {
    fn places(&self) -> Result<Vec<usize>, ModeFitError> {
        let place = |name: &String| {
            let unknown = || ModeFitError::Parameter(RunError::NoParameter(name.clone()));
            let (parameter, element) = self.program.parameter(name).ok_or_else(unknown)?;
            if parameter.structural {
                return Err(ModeFitError::Structural(name.clone()));
            }
            if parameter.is_whole(name) {
                let error = RunError::CannotSet(name.clone(), "it is an array: name its elements");
                return Err(ModeFitError::Parameter(error));
            }
            if parameter.is_final {
                let error = RunError::CannotSet(name.clone(), "it is final");
                return Err(ModeFitError::Parameter(error));
            }
            Ok(parameter.place + element)
        };
        self.vary.iter().map(place).collect()
    }
}

fn result(
    before: &[f64],
    x: &DVector<f64>,
    numbers: &[usize],
    first: &Tracked,
    found: &Tracked,
) -> ModeFit {
    let combinations = found.combinations();
    let parameters = before.iter().zip(x).enumerate().map(|(at, (value, x))| {
        let open = |c: &Combination| c.spread >= 1.0 && c.exponents[at].abs() > PART;
        let variance = combinations
            .iter()
            .map(|c| (c.exponents[at] * c.spread).powi(2));
        FoundParameter {
            values: (*value, value * x.exp()),
            spread: (!combinations.iter().any(open)).then(|| variance.sum::<f64>().sqrt()),
        }
    });
    let modes = numbers.iter().enumerate().map(|(at, &number)| PairedMode {
        number,
        modes: (first.modes[at], found.modes[at]),
        by_parameter: found.frequency_by.row(at).iter().copied().collect(),
    });
    ModeFit {
        parameters: parameters.collect(),
        modes: modes.collect(),
        left: (found.squares() / found.rest.len() as f64).sqrt(),
        combinations,
    }
}
