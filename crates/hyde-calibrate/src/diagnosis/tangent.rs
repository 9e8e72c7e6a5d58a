//! How innovations change with a small size of an effect, for many shapes at once: along one run of the observer.
//!
//! ```text
//! error of the states    eps+ = exp(A T) (I - K C) eps + forcing        change of innovations    -(C eps + dh)
//! ```
//! The effect forces the equations by what it adds to their residual where the plant is, taken linearly over a row, and the
//! channels by dh. Both are differences by the size, of kernels alone. So a shape costs two evaluations and a product a row,
//! and no run of its own. Guards are taken to act when they do without it: what the effect does to them is seen when it is
//! tried.

use crate::gain::{Observer, output_matrix};
use crate::plant::Plant;
use crate::recording::Recording;
use hyde_program::{Function, Point, Program, Workspace};
use nalgebra::DMatrix;

/// A size by whose small value innovations are differentiated.
pub(crate) struct Direction {
    /// The whole parameter vector with the size at `step`.
    pub(crate) p: Vec<f64>,
    /// That value.
    pub(crate) step: f64,
}

/// What a combination of modes makes of errors and forces in a row.
pub(crate) struct Modes {
    pub(crate) exp: DMatrix<f64>,
    pub(crate) first: DMatrix<f64>,
    pub(crate) second: DMatrix<f64>,
    pub(crate) outputs: DMatrix<f64>,
}

/// One direction on its way.
struct Course {
    error: Vec<f64>,
    force: Vec<f64>,
    change: Vec<Vec<f64>>,
}

/// The change of whitened innovations a unit of each size, channels of the record behind each other. `p` are the parameters
/// without the effect.
pub(crate) fn tangents(
    program: &Program,
    recording: &Recording,
    observer: &Observer,
    set: &[(usize, f64)],
    directions: &[Direction],
) -> Option<Vec<Vec<f64>>> {
    let mut plant = Plant::new(program, recording, set).ok()?;
    let observer = observer.of(&plant);
    if let Some(tolerances) = observer.tolerances() {
        plant.tolerances = tolerances;
    }
    let (states, channels) = (plant.places.states.len(), recording.channels.len());
    let mut courses: Vec<Course> = directions
        .iter()
        .map(|_| Course {
            error: vec![0.0; states],
            force: vec![0.0; program.n_unknowns],
            change: vec![Vec::with_capacity(recording.rows()); channels],
        })
        .collect();
    let mut known: Vec<Option<Modes>> = Vec::new();
    let mut own = Own::new(program);
    let mut error = vec![0.0; channels];
    let mut increment = vec![0.0; states];
    let mut room = vec![0.0; states];
    let mut answer = vec![0.0; channels];
    for row in 0..recording.rows() {
        own.outputs(&mut plant);
        for (channel, measured) in program.experiment.measured.iter().enumerate() {
            let difference = recording.channels[channel][row] - own.values[measured.output];
            error[channel] = if difference.is_finite() {
                difference
            } else {
                0.0
            };
        }
        let at = modes(&mut plant, &mut known);
        for (direction, course) in directions.iter().zip(&mut courses) {
            own.outputs_at(&mut plant, &direction.p);
            crate::dense::set_product(&known_at(&known, at)?.outputs, &course.error, &mut answer);
            for (channel, measured) in program.experiment.measured.iter().enumerate() {
                let by_output =
                    (own.others[measured.output] - own.values[measured.output]) / direction.step;
                answer[channel] = -(answer[channel] + by_output);
                if row >= recording.first_row {
                    course.change[channel].push(answer[channel] / observer.deviations[channel]);
                }
            }
            crate::dense::add_product(&observer.gain, &answer, &mut course.error);
        }
        crate::dense::set_product(&observer.gain, &error, &mut increment);
        plant.begin_row(&increment);
        if row + 1 == recording.rows() {
            break;
        }
        let at = modes(&mut plant, &mut known);
        own.plain(&mut plant);
        for (direction, course) in directions.iter().zip(&mut courses) {
            own.force_at(&mut plant, direction);
            course.force.copy_from_slice(&own.force);
        }
        plant.advance();
        let modes = known_at(&known, at)?;
        let fixed: Vec<usize> = plant
            .pinned
            .iter()
            .filter_map(|(position, _)| {
                plant
                    .places
                    .states
                    .iter()
                    .position(|state| state == position)
            })
            .collect();
        own.plain(&mut plant);
        for (direction, course) in directions.iter().zip(&mut courses) {
            own.force_at(&mut plant, direction);
            crate::dense::set_product(&modes.exp, &course.error, &mut room);
            for (equation, (&now, &then)) in course.force.iter().zip(&own.force).enumerate() {
                if now != 0.0 || then != 0.0 {
                    let (first, second) =
                        (modes.first.column(equation), modes.second.column(equation));
                    for ((value, first), second) in
                        room.iter_mut().zip(first.iter()).zip(second.iter())
                    {
                        *value += first * now + second * (then - now);
                    }
                }
            }
            fixed.iter().for_each(|&state| room[state] = 0.0);
            course.error.copy_from_slice(&room);
        }
    }
    Some(
        courses
            .into_iter()
            .map(|course| course.change.concat())
            .collect(),
    )
}

fn known_at(known: &[Option<Modes>], at: usize) -> Option<&Modes> {
    known.get(at).and_then(Option::as_ref)
}

/// The number of the combination of modes the plant is in, its matrices made.
pub(crate) fn modes(plant: &mut Plant<'_>, known: &mut Vec<Option<Modes>>) -> usize {
    let at = plant.current;
    known.resize_with(known.len().max(at + 1), || None);
    if known[at].is_none() {
        let outputs = output_matrix(plant);
        let configuration = plant.configuration();
        let step = &configuration.steps[0];
        let rows = -configuration.inverse.select_rows(&plant.places.states);
        known[at] = Some(Modes {
            exp: step.exp.clone(),
            first: &step.first * &rows,
            second: &step.second * &rows,
            outputs,
        });
    }
    at
}

/// Evaluations of the model with other parameters where the plant is.
pub(crate) struct Own {
    workspace: Workspace,
    pub(crate) values: Vec<f64>,
    others: Vec<f64>,
    pub(crate) force: Vec<f64>,
    plain: Vec<f64>,
}

impl Own {
    pub(crate) fn new(program: &Program) -> Self {
        Self {
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

    fn outputs_at(&mut self, plant: &mut Plant<'_>, p: &[f64]) {
        let program = plant.program;
        let (at, _) = plant.point();
        program.kernels.evaluate(
            Function::Outputs,
            Point { p, ..at },
            &mut self.workspace,
            &mut self.others,
        );
    }

    /// The residual without the effect: rounding.
    pub(crate) fn plain(&mut self, plant: &mut Plant<'_>) {
        let program = plant.program;
        let (at, _) = plant.point();
        program
            .kernels
            .evaluate(Function::Residual, at, &mut self.workspace, &mut self.plain);
    }

    /// What a unit of the size adds to the residual, after [`Own::plain`] there.
    pub(crate) fn force_at(&mut self, plant: &mut Plant<'_>, direction: &Direction) {
        let program = plant.program;
        let (at, _) = plant.point();
        let with = Point {
            p: &direction.p,
            ..at
        };
        program.kernels.evaluate(
            Function::Residual,
            with,
            &mut self.workspace,
            &mut self.force,
        );
        for (force, plain) in self.force.iter_mut().zip(&self.plain) {
            let change = *force - plain;
            // Below the rounding of the residual there is nothing.
            *force = if change.abs() <= 1e-13 * plain.abs() {
                0.0
            } else {
                change / direction.step
            };
        }
    }
}
