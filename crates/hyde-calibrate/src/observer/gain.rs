//! [`Observer`]: the stationary Kalman gain of the linearised model, with friction slipping.
//!
//! ```text
//! x(k+1) = exp(A T) x(k) + w        y(k) = C x(k) + e        K = P C'(C P C' + R)^-1
//! ```
//! R is what the experiment declares: white noise, and the variance q^2/12 of a quantiser of step q. Q is what no model of
//! an axis gets right: a part [`MODEL_NOISE`] of how fast each balance moves in the records, fresh at every row. States
//! whose rate is another state (an angle, a position) have none. Beside it Q has what the columns that drive the model are
//! not known to ([`super::input_noise`]). P solves the discrete Riccati equation, by structured
//! doubling (Chu, Fan, Lin and Wang, Int. J. Control 77, 2004, 767).
//!
//! A channel that is read in some rows only has a gain in these: C and R are of the channels that have a reading in the row. P
//! is one for all rows: the stationary covariance of a prediction if a channel that has a reading in every m-th row had one in
//! each, of m times the variance, which tells as much in the mean.
//!
//! Where the model is not linear in these modes, exp(A T) is the mean over the records.
//!
//! The gain is made once from the nominal model and never again within a study: innovations stay comparable.

use super::input_noise;
use crate::plant::{Configuration, Gains, Plant, Unsupported, output_matrix};
use crate::records::{Rates, Readings, Recording};
use hyde_program::{Constant, Program, Workspace};
use nalgebra::{DMatrix, DVector};

/// The part of its usual rate that a balance is not known to.
const MODEL_NOISE: f64 = 0.005;

/// Rows of a record, at most, where a model that is not linear is linearised for the mean of its steps.
const LOOKS: usize = 100;

/// How exact a step is, of the standard deviation of a predicted state.
const STEP_ERROR: f64 = 0.02;

/// A fixed observer round a model.
#[derive(Clone, Debug)]
pub struct Observer {
    /// What an innovation of a unit changes each state by, for each kind of row.
    pub(crate) gains: Gains,
    /// How often channels are read in the records that it was made for.
    pub(crate) rates: Rates,
    /// Standard deviation of each channel's innovation, SI.
    pub deviations: Vec<f64>,
    /// Standard deviation of each channel's noise and rounding, SI.
    pub noise: Vec<f64>,
    /// The step of each channel's quantiser, SI; 0 without one.
    pub(crate) rounding: Vec<f64>,
    /// Standard deviation of each predicted state, SI.
    pub(crate) spread: Vec<f64>,
    /// Covariance of what the model does not know of its states, fresh at every row, SI; empty until it is known.
    pub(crate) process: DMatrix<f64>,
    /// The names of the states.
    states: Vec<String>,
    /// Standard deviation of what each driving column is not known to, SI.
    pub inputs: Vec<f64>,
    /// Modes in which the model was linearised although the record begins in others.
    pub taken: Vec<Taken>,
}

/// An automaton that is taken in another mode than it begins in.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Taken {
    /// Its name.
    pub automaton: String,
    /// The mode that it begins in.
    pub begins: String,
    /// The mode in which the model was linearised.
    pub taken: String,
}

/// Where the gain is made: where the record begins, relations and modes as they are there, but that friction slips.
fn linearised<'a>(
    program: &'a Program,
    recording: &'a Recording,
    set: &[(usize, f64)],
) -> Result<(Plant<'a>, Vec<Taken>), Unsupported> {
    let begun = Plant::new(program, recording, set)?;
    let p = recording.parameters(program, set);
    let slipping = Plant::at(program, recording, p, &[])?;
    let moves = begun.pinned.is_empty() && !recording.beginning.is_empty();
    if moves && begun.combination() != slipping.combination() {
        return Ok((begun, Vec::new()));
    }
    let name = |automaton: usize, mode: f64| {
        let modes = &program.automata[automaton].modes;
        modes.get(mode as usize).cloned().unwrap_or_default()
    };
    let automata = program.automata.iter().enumerate();
    let taken = automata.filter_map(|(number, automaton)| {
        let modes = (begun.z[automaton.place], slipping.z[automaton.place]);
        (modes.0.to_bits() != modes.1.to_bits()).then(|| Taken {
            automaton: automaton.name.clone(),
            begins: name(number, modes.0),
            taken: name(number, modes.1),
        })
    });
    let taken = taken.collect();
    Ok((slipping, taken))
}

impl Observer {
    /// The observer of a program, its rates taken from the records.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub fn new(
        program: &Program,
        recordings: &[Recording],
        set: &[(usize, f64)],
    ) -> Result<Self, Unsupported> {
        let Some(first) = recordings.first() else {
            return Err(Unsupported::Start("there is no record".to_owned()));
        };
        let p = first.parameters(program, set);
        let (plant, taken) = linearised(program, first, set)?;
        let mut workspace = Workspace::new(program.n_work);
        let (places, configuration) = (&plant.places, plant.configuration());
        let c = output_matrix(program, places, configuration, plant.here(), &mut workspace);
        let noise: Vec<f64> = (0..c.nrows())
            .map(|channel| deviation(program, channel, &p))
            .collect();
        let rounding = (0..c.nrows()).map(|channel| rounding(program, channel, &p));
        let rounding = rounding.collect();
        let balances = balances(configuration);
        // Rates by the model alone first, then by the model held to the records.
        let mut observer = Self {
            gains: Gains::none(c.ncols(), c.nrows()),
            rates: Rates::of(recordings),
            deviations: vec![1.0; c.nrows()],
            noise: noise.clone(),
            rounding,
            spread: vec![f64::NAN; c.ncols()],
            process: DMatrix::zeros(0, 0),
            states: state_names(&plant),
            inputs: input_noise::deviations(program, recordings),
            taken,
        };
        let at = plant.here();
        let moved = input_noise::moved(program, places, configuration, at, &mut workspace);
        for pass in 0..2 {
            if pass > 0 {
                let between =
                    input_noise::between_rows(program, recordings, set, &observer, &(&c * &moved))?;
                for (own, between) in observer.inputs.iter_mut().zip(between) {
                    *own = own.hypot(between);
                }
            }
            let (rates, exp) = usual(&plant, recordings, set, &observer)?;
            let balances_off = DVector::from_iterator(
                rates.len(),
                rates
                    .iter()
                    .zip(&balances)
                    .map(|(rate, balance)| match balance {
                        true => (MODEL_NOISE * rate * first.step_s).powi(2),
                        false => 0.0,
                    }),
            );
            let driven = input_noise::covariance(&moved, &observer.inputs);
            let process = DMatrix::from_diagonal(&balances_off) + driven;
            let found = stationary(&exp, &c, &process, &noise, &observer.rates);
            observer.gains = found.gains;
            observer.deviations = found.deviations;
            observer.spread = found.spread;
            // While rates are not known yet, no other gain is made of them.
            if pass > 0 {
                observer.process = process;
            }
        }
        Ok(observer)
    }

    /// The observer of another model of the same axis: states keep their gain, states that are new have none.
    fn of(&self, plant: &Plant<'_>) -> Self {
        let names = state_names(plant);
        if names == self.states {
            return self.clone();
        }
        let mut spread = vec![f64::INFINITY; names.len()];
        let own = |name: &String| self.states.iter().position(|state| state == name);
        let known: Vec<Option<usize>> = names.iter().map(own).collect();
        let process = DMatrix::from_fn(names.len(), names.len(), |i, j| {
            let at = known[i].zip(known[j]);
            at.and_then(|at| self.process.get(at))
                .copied()
                .unwrap_or(0.0)
        });
        for (row, own) in known.iter().enumerate() {
            if let Some(own) = *own {
                spread[row] = self.spread[own];
            }
        }
        let gains = self.gains.map(|before| {
            let mut gain = DMatrix::zeros(names.len(), before.ncols());
            for (row, own) in known.iter().enumerate() {
                if let Some(own) = *own {
                    gain.set_row(row, &before.row(own));
                }
            }
            gain
        });
        Self {
            gains,
            spread,
            process,
            states: names,
            ..self.clone()
        }
    }

    /// Whether a state of its model has a gain.
    pub(crate) fn knows(&self, state: usize) -> bool {
        !self.spread[state].is_infinite()
    }

    /// Whether all states of another observer's model have a gain here.
    pub(crate) fn knows_states_of(&self, other: &Self) -> bool {
        let mut states = other.states.iter();
        states.all(|state| self.states.contains(state))
    }

    /// A plant at the first row of a record, its steps as exact as its observer is; and that.
    pub(crate) fn on<'a>(
        &self,
        program: &'a Program,
        recording: &'a Recording,
        set: &[(usize, f64)],
    ) -> Result<(Plant<'a>, Self), Unsupported> {
        let mut plant = Plant::new(program, recording, set)?;
        let own = self.of(&plant);
        if let Some(tolerances) = own.tolerances() {
            plant.tolerances = tolerances;
        }
        Ok((plant, own))
    }

    /// How exact a step is to be, one number a state, SI.
    fn tolerances(&self) -> Option<Vec<f64>> {
        let known = !self.spread.iter().any(|spread| spread.is_nan());
        known.then(|| {
            self.spread
                .iter()
                .map(|spread| STEP_ERROR * spread + 1e-15)
                .collect()
        })
    }
}

pub(crate) fn state_names(plant: &Plant<'_>) -> Vec<String> {
    plant
        .places
        .states
        .iter()
        .map(|&state| plant.program.unknown_name(state))
        .collect()
}

/// The standard deviation, SI, of a channel whose noise and rounding are not declared.
pub const UNDECLARED_NOISE: f64 = 1e-4;

/// Standard deviation of a channel: declared noise and rounding, or [`UNDECLARED_NOISE`].
pub(crate) fn deviation(program: &Program, channel: usize, p: &[f64]) -> f64 {
    let noise = program.kernels.constant(Constant::Noise(channel), p);
    let (noise, width) = (noise.unwrap_or(0.0), rounding(program, channel, p));
    let variance = noise * noise + width * width / 12.0;
    if variance > 0.0 {
        variance.sqrt()
    } else {
        UNDECLARED_NOISE
    }
}

/// The step of a channel's quantiser; 0 without one.
fn rounding(program: &Program, channel: usize, p: &[f64]) -> f64 {
    let width = program.kernels.constant(Constant::Rounding(channel), p);
    width.unwrap_or(0.0)
}

/// The states that a balance moves: all but those whose rate is another state.
#[allow(
    clippy::float_cmp,
    reason = "a rate that is another state is so exactly"
)]
fn balances(configuration: &Configuration<'_>) -> Vec<bool> {
    let row = |index: usize| {
        let row = configuration.by_states.row(index);
        let others = row.iter().filter(|&&entry| entry != 0.0).count();
        let ones = row.iter().filter(|&&entry| entry == 1.0).count();
        !(others == 1 && ones == 1)
    };
    (0..configuration.by_states.ncols()).map(row).collect()
}

/// Stationary gains with what they leave: standard deviations of innovations and of predicted states.
pub(crate) struct Stationary {
    pub(crate) gains: Gains,
    deviations: Vec<f64>,
    spread: Vec<f64>,
}

/// The stationary gains of a step exp(A T) with outputs C, the variance of the model's noise and the deviation of each channel's.
pub(crate) fn stationary(
    exp: &DMatrix<f64>,
    c: &DMatrix<f64>,
    process: &DMatrix<f64>,
    noise: &[f64],
    rates: &Rates,
) -> Stationary {
    let in_the_mean = noise.iter().zip(&rates.parts);
    let in_the_mean: Vec<f64> = in_the_mean.map(|(sd, part)| sd / part.sqrt()).collect();
    let p = riccati(exp, c, process, &in_the_mean);
    let mut s = c * &p * c.transpose();
    for (channel, sd) in noise.iter().enumerate() {
        s[(channel, channel)] += sd * sd;
    }
    Stationary {
        gains: gains(&p, c, noise, &rates.kinds),
        deviations: s.diagonal().iter().map(|v| v.sqrt()).collect(),
        spread: p.diagonal().iter().map(|v| v.max(0.0).sqrt()).collect(),
    }
}

/// The gains by a covariance of the prediction, for some kinds of rows; `noise` is the standard deviation of each channel.
fn gains(p: &DMatrix<f64>, c: &DMatrix<f64>, noise: &[f64], kinds: &[Readings]) -> Gains {
    Gains::of_kinds(noise.len(), kinds, |readings| {
        let channels = 0..noise.len();
        let known: Vec<usize> = channels.filter(|&channel| readings[channel]).collect();
        let seen = c.select_rows(&known);
        let mut s = &seen * p * seen.transpose();
        for (row, &channel) in known.iter().enumerate() {
            s[(row, row)] += noise[channel] * noise[channel];
        }
        let inverse = s.clone().try_inverse();
        let inverse = inverse.unwrap_or_else(|| DMatrix::zeros(s.nrows(), s.ncols()));
        let own = p * seen.transpose() * inverse;
        let mut gain = DMatrix::zeros(p.nrows(), noise.len());
        for (column, &channel) in known.iter().enumerate() {
            gain.set_column(channel, &own.column(column));
        }
        gain
    })
}

/// Over the records: the root mean square of each state's rate, and the mean step exp(A T) in the modes of a plant. Where the
/// model is not linear, no one point has it: a drag with a power of the speed below 1 holds an axis that rests, and hardly
/// damps it once it moves.
fn usual(
    linearised: &Plant<'_>,
    recordings: &[Recording],
    set: &[(usize, f64)],
    observer: &Observer,
) -> Result<(Vec<f64>, DMatrix<f64>), Unsupported> {
    let program = linearised.program;
    let configuration = linearised.configuration();
    let at_linearised = &configuration.steps[0].exp;
    let n = at_linearised.nrows();
    let (mut squares, mut rows) = (vec![0.0; n], 0.0);
    let (mut steps, mut looks) = (DMatrix::zeros(n, n), 0.0);
    for recording in recordings {
        let (mut plant, observer) = observer.on(program, recording, set)?;
        let mut rates = vec![0.0; n];
        let apart = recording.rows().div_ceil(LOOKS);
        super::over_record::run(&mut plant, &observer, |plant, row, _| {
            plant.rates(&mut rates);
            for (sum, rate) in squares.iter_mut().zip(&rates) {
                *sum += rate * rate;
            }
            rows += 1.0;
            let looks_here = !configuration.affine && row.is_multiple_of(apart);
            if looks_here
                && plant.combination() == linearised.combination()
                && let Some(step) = plant.step_here()
            {
                steps += step;
                looks += 1.0;
            }
        });
    }
    let rms = squares
        .into_iter()
        .map(|sum: f64| (sum / f64::max(rows, 1.0)).sqrt());
    let step = match looks > 0.0 {
        true => steps / looks,
        false => at_linearised.clone(),
    };
    Ok((rms.collect(), step))
}

/// The covariance of the prediction.
fn riccati(exp: &DMatrix<f64>, c: &DMatrix<f64>, q: &DMatrix<f64>, noise: &[f64]) -> DMatrix<f64> {
    let n = exp.nrows();
    // In units in which channels see each state with about their noise, sizes are alike.
    let largest = |state: usize| {
        let parts = c
            .column(state)
            .iter()
            .zip(noise)
            .map(|(c, sd)| c.abs() / sd)
            .collect::<Vec<_>>();
        parts
            .into_iter()
            .fold(q[(state, state)].sqrt().recip().min(1e12), f64::max)
    };
    let scale = DVector::from_iterator(n, (0..n).map(|state| 1.0 / largest(state).max(1e-12)));
    let unscale = scale.map(|s| 1.0 / s);
    let scaled = DMatrix::from_diagonal(&unscale) * exp * DMatrix::from_diagonal(&scale);
    let seen = c * DMatrix::from_diagonal(&scale);
    let weights = DMatrix::from_diagonal(&DVector::from_iterator(
        noise.len(),
        noise.iter().map(|sd| 1.0 / (sd * sd)),
    ));
    let mut a = scaled.transpose();
    let mut g = seen.transpose() * weights * seen;
    let mut h = DMatrix::from_diagonal(&unscale) * q * DMatrix::from_diagonal(&unscale);
    for _ in 0..60 {
        let w = DMatrix::identity(n, n) + &g * &h;
        let Some(inverse) = w.try_inverse() else {
            break;
        };
        let step = a.transpose() * &h * &inverse * &a;
        let new_a = &a * &inverse * &a;
        let new_g = &g + &a * &inverse * &g * a.transpose();
        let size = step.norm();
        h += step;
        h = (&h + h.transpose()) * 0.5;
        g = (&new_g + new_g.transpose()) * 0.5;
        a = new_a;
        if size <= 1e-12 * h.norm() {
            break;
        }
    }
    DMatrix::from_diagonal(&scale) * h * DMatrix::from_diagonal(&scale)
}
