//! Frequency responses of a linearised system, with its sampled loop closed.
//!
//! A sine at w drives the input. Between ticks the plant is continuous; the held values are a staircase. At the ticks
//! everything is a sampled sine of the same frequency, z = exp(jwT), so the loop closes in discrete time with the
//! plant's exact zero-order-hold equivalent (Franklin, Powell, Workman, Digital Control of Dynamic Systems, ch. 4). Of the
//! staircase the fundamental, (1 - exp(-jwT))/(jwT) exp(-jwd), goes on through the continuous plant to the outputs. Above
//! half the sampling rate a sampled sine has no frequency of its own: refused.
//!
//! A delay is exp(-jwT) between what it is the delay of and its value, exactly; delayed values are solved for with the
//! states.

use crate::linearize::{Delayed, Linear, Sampled};
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
    let mut found = vec![Vec::with_capacity(frequencies_hz.len()); outputs.len()];
    let discrete = linear
        .sampled
        .as_ref()
        .map(|sampled| Discrete::new(linear, sampled));
    for &f in frequencies_hz {
        let s = Complex::new(0.0, std::f64::consts::TAU * f);
        let identity = Matrix::identity(linear.a.nrows(), linear.a.nrows());
        let plant = (identity * s - complex(&linear.a)).lu();
        let by_input = complex(&linear.b_input.columns(input, 1).into_owned());
        let mut state = plant.solve(&by_input).ok_or(BodeError::Singular(f))?;
        let mut direct = complex(&linear.d_input.columns(input, 1).into_owned());
        if let (Some(sampled), Some(discrete)) = (&linear.sampled, &discrete) {
            if f > 0.5 / sampled.period {
                return Err(BodeError::AboveNyquist(f, 0.5 / sampled.period));
            }
            let held = discrete
                .held(linear, sampled, input, &state, s)
                .ok_or(BodeError::Singular(f))?;
            // The fundamental of the staircase.
            let turn = s * sampled.period;
            let staircase = if f > 0.0 {
                (Complex::new(1.0, 0.0) - (-turn).exp()) / turn
            } else {
                Complex::new(1.0, 0.0)
            };
            let held = held * (staircase * (-s * sampled.delay).exp());
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

/// The delayed values d, from the response of the states to the input alone: `d = exp(-sT) (now + by_delayed*d)`.
fn late(
    plant: &nalgebra::LU<Complex<f64>, nalgebra::Dyn, nalgebra::Dyn>,
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

/// The plant between ticks: `x[k+1] = phi x[k] + late h[k-1] + early h[k]`.
struct Discrete {
    phi: DMatrix<f64>,
    late: DMatrix<f64>,
    early: DMatrix<f64>,
}

impl Discrete {
    fn new(linear: &Linear, sampled: &Sampled) -> Self {
        let delay = sampled.delay.min(sampled.period);
        let (before, at_delay) = hold_equivalent(&linear.a, &linear.b_held, delay);
        let (after, at_rest) = hold_equivalent(&linear.a, &linear.b_held, sampled.period - delay);
        Self {
            phi: &after * before,
            late: &after * at_delay,
            early: at_rest,
        }
    }

    /// The held values at the ticks, from the response of the state to the input alone.
    fn held(
        &self,
        linear: &Linear,
        sampled: &Sampled,
        input: usize,
        driven: &Matrix,
        s: Complex<f64>,
    ) -> Option<Matrix> {
        let z = (s * sampled.period).exp();
        let back = Complex::new(1.0, 0.0) / z;
        let nx = linear.a.nrows();
        // States at the ticks by held values.
        let plant = (Matrix::identity(nx, nx) * z - complex(&self.phi)).lu();
        let by_held = plant.solve(&(complex(&self.late) * back + complex(&self.early)))?;
        // Memory after the tick by samples.
        let size = sampled.memory.nrows();
        let controller = (Matrix::identity(size, size) - complex(&sampled.memory) * back).lu();
        let select = complex(&sampled.select);
        let through = |samples: &Matrix| controller.solve(samples).map(|memory| &select * memory);
        let from_input = complex(&sampled.by_state) * driven
            + complex(&sampled.by_input.columns(input, 1).into_owned());
        let open = through(&from_input)?;
        let loop_gain =
            through(&(complex(&sampled.by_state) * by_held + complex(&sampled.by_held) * back))?;
        let nh = open.nrows();
        (Matrix::identity(nh, nh) - loop_gain).lu().solve(&open)
    }
}

/// exp(A t) and its integral times B, from one exponential of the block matrix (Van Loan, IEEE Trans. AC 23 (1978) 395).
fn hold_equivalent(a: &DMatrix<f64>, b: &DMatrix<f64>, t: f64) -> (DMatrix<f64>, DMatrix<f64>) {
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

fn complex(matrix: &DMatrix<f64>) -> Matrix {
    matrix.map(|value| Complex::new(value, 0.0))
}
