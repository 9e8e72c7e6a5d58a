//! Frequency responses of a linearised system, with its sampled loop closed.
//!
//! A sine at w drives the input. Between ticks the plant is continuous; the held values are staircases, which repeat with
//! the common period of the clocks but for a turn. The loop closes in discrete time with the plant's exact zero-order-hold
//! equivalent (Franklin, Powell, Workman, Digital Control of Dynamic Systems, ch. 4). Of the staircases the part that turns
//! with the input goes on through the continuous plant to the outputs. Above half the rate of a clock that the response
//! goes through a sampled sine has no frequency of its own: refused.
//!
//! A delay is exp(-jwT) between what it is the delay of and its value, exactly; delayed values are solved for with the
//! states.

use crate::common_period::CommonPeriod;
use crate::linearize::{Delayed, Linear};
use crate::sampled::Sampled;
use hyde_sim::Reached;
use nalgebra::{Complex, DMatrix};

/// Why there is no response.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BodeError {
    /// A frequency in Hz above half the sampling rate, also in Hz.
    AboveNyquist(f64, f64),
    /// The loop is singular at a frequency in Hz.
    Singular(f64),
}

type Matrix = DMatrix<Complex<f64>>;

/// The response of outputs (by number) to one input, at frequencies in Hz: one list an output.
///
/// # Errors
/// A frequency that the sampled loop does not have.
pub fn frequency_response(
    linear: &Linear,
    input: usize,
    outputs: &[usize],
    frequencies_hz: &[f64],
) -> Result<Vec<Vec<Complex<f64>>>, BodeError> {
    frequency_response_watched(linear, input, outputs, frequencies_hz, &Reached::default())
}

/// The same, counting the frequencies that are done.
///
/// # Errors
/// As for [`frequency_response`].
pub fn frequency_response_watched(
    linear: &Linear,
    input: usize,
    outputs: &[usize],
    frequencies_hz: &[f64],
    reached: &Reached,
) -> Result<Vec<Vec<Complex<f64>>>, BodeError> {
    let mut found = vec![Vec::with_capacity(frequencies_hz.len()); outputs.len()];
    let clocked = linear.sampled.as_ref();
    let limit_hz = clocked.map_or(f64::INFINITY, |sampled| {
        nyquist_hz(linear, sampled, outputs)
    });
    let period = clocked.and_then(|sampled| CommonPeriod::new(linear, sampled));
    let highest = frequencies_hz.iter().copied().fold(0.0, f64::max);
    if highest > limit_hz {
        return Err(BodeError::AboveNyquist(highest, limit_hz));
    }
    for (number, &f) in frequencies_hz.iter().enumerate() {
        reached.set(number as f64, frequencies_hz.len() as f64);
        let s = Complex::new(0.0, std::f64::consts::TAU * f);
        let identity = Matrix::identity(linear.a.nrows(), linear.a.nrows());
        let plant = Plant::new(identity * s - complex(&linear.a));
        let by_input = complex(&linear.b_input.columns(input, 1).into_owned());
        let mut state = plant.solve(&by_input).ok_or(BodeError::Singular(f))?;
        let mut direct = complex(&linear.d_input.columns(input, 1).into_owned());
        if let Some(period) = &period {
            let held = period
                .held(input, &state, s)
                .ok_or(BodeError::Singular(f))?;
            state += plant
                .solve(&(complex(&linear.b_held) * &held))
                .ok_or(BodeError::Singular(f))?;
            direct += complex(&linear.d_held) * &held;
        }
        if let Some(delayed) = &linear.delayed {
            let values = late(&plant, delayed, input, &state, s).ok_or(BodeError::Singular(f))?;
            state += plant
                .solve(&(complex(&delayed.b) * &values))
                .ok_or(BodeError::Singular(f))?;
            direct += complex(&delayed.d) * &values;
        }
        for (list, &output) in found.iter_mut().zip(outputs) {
            let through = complex(&linear.c.rows(output, 1).into_owned()) * &state;
            list.push(through[(0, 0)] + direct[(output, 0)]);
        }
    }
    Ok(found)
}

/// The matrix of the states, factorised; a model without states has none.
struct Plant(Option<nalgebra::LU<Complex<f64>, nalgebra::Dyn, nalgebra::Dyn>>);

impl Plant {
    fn new(matrix: Matrix) -> Self {
        Self((!matrix.is_empty()).then(|| matrix.lu()))
    }

    fn solve(&self, right: &Matrix) -> Option<Matrix> {
        match &self.0 {
            Some(factors) => factors.solve(right),
            None => Some(right.clone()),
        }
    }
}

/// Half the rate of the slowest clock whose held values reach the states or the outputs, in Hz.
fn nyquist_hz(linear: &Linear, sampled: &Sampled, outputs: &[usize]) -> f64 {
    let reaches = |held: usize| {
        let plant = linear.b_held.column(held).iter().any(|by| *by != 0.0);
        plant
            || outputs
                .iter()
                .any(|&output| linear.d_held[(output, held)] != 0.0)
    };
    let held = sampled.holder.iter().enumerate();
    let periods = held
        .filter(|(held, _)| reaches(*held))
        .map(|(_, &clock)| sampled.clocks[clock].period);
    0.5 / periods.fold(0.0, f64::max)
}

/// The delayed values d, from the response of the states to the input alone: `d = exp(-sT) (now + by_delayed*d)`.
fn late(
    plant: &Plant,
    delayed: &Delayed,
    input: usize,
    driven: &Matrix,
    s: Complex<f64>,
) -> Option<Matrix> {
    let times = delayed.times.iter().map(|time| (-s * *time).exp());
    let turn = Matrix::from_diagonal(&nalgebra::DVector::from_iterator(
        delayed.times.len(),
        times,
    ));
    let states = plant.solve(&complex(&delayed.b))?;
    let back = complex(&delayed.by_state) * states + complex(&delayed.by_delayed);
    let by_input = complex(&delayed.by_input.columns(input, 1).into_owned());
    let open = complex(&delayed.by_state) * driven + by_input;
    let size = delayed.times.len();
    let closed = (Matrix::identity(size, size) - &turn * back).lu();
    closed.solve(&(turn * open))
}

fn complex(matrix: &DMatrix<f64>) -> Matrix {
    matrix.map(|value| Complex::new(value, 0.0))
}
