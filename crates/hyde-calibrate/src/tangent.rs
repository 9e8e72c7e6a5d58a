//! How innovations change with small changes of parameters, many at once: along one run of the observer.
//!
//! ```text
//! error of the states    eps+ = exp(A T) (I - K C) eps + forcing        change of innovations    -(C eps + dh)
//! ```
//! A change forces the equations by what it adds to their residual where the plant is, taken linearly over a row, and the
//! channels by dh. Both are differences by the parameter, of kernels alone. So a direction costs a few evaluations and a
//! column of a product a row, and no run of its own. Guards are taken to act when they do without it: for friction that is
//! right to first order, for its force does not jump where it begins and ends to stick; of contacts it is a part.

use crate::gain::{Observer, output_matrix};
use crate::observer::{Innovations, whitened};
use crate::plant::{Plant, Unsupported};
use crate::recording::Recording;
use hyde_program::{Function, Point, Program, Workspace, Wrt};
use nalgebra::DMatrix;

/// A parameter by whose small change innovations are differentiated.
pub(crate) struct Direction {
    /// The whole parameter vector with the parameter changed.
    pub(crate) p: Vec<f64>,
    /// By how much.
    pub(crate) step: f64,
}

/// Innovations of a record and how they change.
pub(crate) struct Tangents {
    pub(crate) innovations: Innovations,
    /// The change of whitened innovations a unit of each parameter, a column a direction, channels below each other.
    pub(crate) change: DMatrix<f64>,
}

/// What a combination of modes makes of errors and forces in a row.
pub(crate) struct Modes {
    pub(crate) exp: DMatrix<f64>,
    /// By the equations that a direction touches.
    pub(crate) first: DMatrix<f64>,
    pub(crate) second: DMatrix<f64>,
    pub(crate) outputs: DMatrix<f64>,
    /// The outputs with rows of zeros below them, and exp, first and second beside each other: for products of matrices.
    padded: DMatrix<f64>,
    whole: DMatrix<f64>,
}

/// Products of matrices are fast from this many rows and columns on.
const LEAST_WIDTH: usize = 8;

/// Runs the observer over a record, parameters `set`, and differentiates what it finds.
pub(crate) fn tangents(
    program: &Program,
    recording: &Recording,
    observer: &Observer,
    set: &[(usize, f64)],
    directions: &[Direction],
) -> Result<Tangents, Unsupported> {
    let mut plant = Plant::new(program, recording, set)?;
    let observer = observer.of(&plant);
    if let Some(tolerances) = observer.tolerances() {
        plant.tolerances = tolerances;
    }
    let (states, channels) = (plant.places.states.len(), recording.channels.len());
    let count = directions.len();
    let rows = recording.rows() - recording.first_row;
    let mut found = Tangents {
        innovations: Innovations {
            channels: vec![Vec::with_capacity(rows); channels],
        },
        change: DMatrix::zeros(rows * channels, count),
    };
    let mut own = Own::new(program, &plant.p, directions);
    let mut known: Vec<Modes> = Vec::new();
    let mut number_of: Vec<Option<usize>> = Vec::new();
    let touched = own.touched.len();
    let padded = channels.max(LEAST_WIDTH);
    let mut gain = DMatrix::<f64>::zeros(states, padded);
    gain.columns_mut(0, channels).copy_from(&observer.gain);
    // Errors of the states, forces at the start of a row, their growth over it.
    let mut before = DMatrix::<f64>::zeros(states + 2 * touched, count);
    let mut errors = DMatrix::<f64>::zeros(states, count);
    let mut answers = DMatrix::<f64>::zeros(padded, count);
    let mut now = DMatrix::<f64>::zeros(touched, count);
    let mut then = now.clone();
    let mut error = vec![0.0; channels];
    let mut increment = vec![0.0; states];
    for row in 0..recording.rows() {
        own.outputs(&mut plant);
        for (channel, measured) in program.experiment.measured.iter().enumerate() {
            let difference = recording.channels[channel][row] - own.values[measured.output];
            if row >= recording.first_row {
                let value = whitened(difference, observer.deviations[channel]);
                found.innovations.channels[channel].push(value);
            }
            error[channel] = if difference.is_finite() {
                difference
            } else {
                0.0
            };
        }
        let at = modes(&mut plant, &mut known, &mut number_of, &own.touched);
        answers.gemm(-1.0, &known[at].padded, &errors, 0.0);
        for (number, direction) in directions.iter().enumerate() {
            own.outputs_at(&mut plant, direction);
            for (channel, measured) in program.experiment.measured.iter().enumerate() {
                let by_output =
                    (own.others[measured.output] - own.values[measured.output]) / direction.step;
                answers[(channel, number)] -= by_output;
                if row >= recording.first_row {
                    found.change[(channel * rows + row - recording.first_row, number)] =
                        answers[(channel, number)] / observer.deviations[channel];
                }
            }
        }
        errors.gemm(1.0, &gain, &answers, 1.0);
        crate::dense::set_product(&observer.gain, &error, &mut increment);
        plant.begin_row(&increment);
        if row + 1 == recording.rows() {
            break;
        }
        let at = modes(&mut plant, &mut known, &mut number_of, &own.touched);
        own.forces(&mut plant, directions, &mut now);
        plant.advance();
        own.forces(&mut plant, directions, &mut then);
        then -= &now;
        before.rows_mut(0, states).copy_from(&errors);
        before.rows_mut(states, touched).copy_from(&now);
        before.rows_mut(states + touched, touched).copy_from(&then);
        errors.gemm(1.0, &known[at].whole, &before, 0.0);
        let states = &plant.places.states;
        for (position, _) in &plant.pinned {
            if let Some(state) = states.iter().position(|state| state == position) {
                errors.row_mut(state).fill(0.0);
            }
        }
    }
    Ok(found)
}

/// The number of the matrices of the modes the plant is in, made where they are new.
pub(crate) fn modes(
    plant: &mut Plant<'_>,
    known: &mut Vec<Modes>,
    number_of: &mut Vec<Option<usize>>,
    touched: &[usize],
) -> usize {
    let at = plant.current;
    number_of.resize(number_of.len().max(at + 1), None);
    if let Some(number) = number_of[at] {
        return number;
    }
    let outputs = output_matrix(plant);
    let configuration = plant.configuration();
    let step = &configuration.steps[0];
    let of_states = -configuration.inverse.select_rows(&plant.places.states);
    let rows = of_states.select_columns(touched);
    let (first, second) = (&step.first * &rows, &step.second * &rows);
    let (n, r) = (step.exp.nrows(), touched.len());
    let mut whole = DMatrix::zeros(n, n + 2 * r);
    whole.columns_mut(0, n).copy_from(&step.exp);
    whole.columns_mut(n, r).copy_from(&first);
    whole.columns_mut(n + r, r).copy_from(&second);
    let mut padded = DMatrix::zeros(outputs.nrows().max(LEAST_WIDTH), n);
    padded.rows_mut(0, outputs.nrows()).copy_from(&outputs);
    known.push(Modes {
        exp: step.exp.clone(),
        first,
        second,
        outputs,
        padded,
        whole,
    });
    number_of[at] = Some(known.len() - 1);
    known.len() - 1
}

/// Evaluations of the model with other parameters where the plant is.
pub(crate) struct Own {
    /// The equations that some direction changes.
    pub(crate) touched: Vec<usize>,
    workspace: Workspace,
    pub(crate) values: Vec<f64>,
    others: Vec<f64>,
    force: Vec<f64>,
    plain: Vec<f64>,
}

impl Own {
    pub(crate) fn new(program: &Program, p: &[f64], directions: &[Direction]) -> Self {
        let moved = |place: usize| {
            directions
                .iter()
                .any(|direction| direction.p[place].to_bits() != p[place].to_bits())
        };
        let entries = program.kernels.still_entries(Function::Residual);
        let mut touched: Vec<usize> = entries
            .iter()
            .filter(|entry| matches!(entry.wrt, Wrt::Parameter(place) if moved(place)))
            .map(|entry| entry.row)
            .collect();
        touched.sort_unstable();
        touched.dedup();
        Self {
            touched,
            workspace: Workspace::new(program.n_work),
            values: vec![0.0; program.outputs.len()],
            others: vec![0.0; program.outputs.len()],
            force: vec![0.0; program.n_unknowns],
            plain: vec![0.0; program.n_unknowns],
        }
    }

    pub(crate) fn outputs(&mut self, plant: &mut Plant<'_>) {
        let program = plant.program;
        let (at, _) = plant.point();
        program
            .kernels
            .evaluate(Function::Outputs, at, &mut self.workspace, &mut self.values);
    }

    fn outputs_at(&mut self, plant: &mut Plant<'_>, direction: &Direction) {
        let program = plant.program;
        let (at, _) = plant.point();
        let with = Point {
            p: &direction.p,
            ..at
        };
        program.kernels.evaluate(
            Function::Outputs,
            with,
            &mut self.workspace,
            &mut self.others,
        );
    }

    /// What a unit of each size adds to the residual of the equations that are touched.
    pub(crate) fn forces(
        &mut self,
        plant: &mut Plant<'_>,
        directions: &[Direction],
        out: &mut DMatrix<f64>,
    ) {
        let program = plant.program;
        let (at, _) = plant.point();
        let kernels = &program.kernels;
        kernels.evaluate(Function::Residual, at, &mut self.workspace, &mut self.plain);
        for (number, direction) in directions.iter().enumerate() {
            let with = Point {
                p: &direction.p,
                ..at
            };
            kernels.evaluate(
                Function::Residual,
                with,
                &mut self.workspace,
                &mut self.force,
            );
            for (row, &equation) in self.touched.iter().enumerate() {
                let plain = self.plain[equation];
                let change = self.force[equation] - plain;
                // Below the rounding of the residual there is nothing.
                out[(row, number)] = if change.abs() <= 1e-13 * plain.abs() {
                    0.0
                } else {
                    change / direction.step
                };
            }
        }
    }
}
