//! How innovations change with small changes of parameters, many at once: along one run of the observer.
//!
//! ```text
//! error of the states    eps+ = exp(A T) (I - K C) eps + forcing        change of innovations    -(C eps + dh)
//! ```
//! A change forces the equations by what it adds to their residual where the plant is, taken linearly over a row, and the
//! channels by dh. Both are differences by the parameter, of kernels alone. So a direction costs a few evaluations and a
//! column of a product a row, and no run of its own. Guards are taken to act when they do without it: for friction that is
//! right to first order, for its force does not jump where it begins and ends to stick; of contacts it is a part. Modes that
//! begin within a row act from there on.

use crate::configuration::{Configuration, Places};
use crate::exponential::Step;
use crate::gain::{Observer, output_matrix};
use crate::observer::{Innovations, whitened};
use crate::plant::{Leg, Plant, Unsupported};
use crate::recording::Recording;
use hyde_program::{Function, Point, Program, Workspace, Wrt};
use nalgebra::DMatrix;
use std::collections::BTreeMap;

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
    let channels = recording.channels.len();
    let rows = recording.rows() - recording.first_row;
    let mut change = DMatrix::zeros(rows * channels, directions.len());
    let keep = |row: usize, changes: &DMatrix<f64>| {
        for number in 0..directions.len() {
            for channel in 0..channels {
                change[(channel * rows + row, number)] = changes[(channel, number)];
            }
        }
    };
    let innovations = along(program, recording, observer, set, directions, keep)?;
    Ok(Tangents {
        innovations,
        change,
    })
}

/// The same, row by row: `each` gets the number of a row that counts, and how its whitened innovations change, a row a
/// channel, a column a direction.
pub(crate) fn along(
    program: &Program,
    recording: &Recording,
    observer: &Observer,
    set: &[(usize, f64)],
    directions: &[Direction],
    mut each: impl FnMut(usize, &DMatrix<f64>),
) -> Result<Innovations, Unsupported> {
    let mut plant = Plant::new(program, recording, set)?;
    let observer = observer.of(&plant);
    if let Some(tolerances) = observer.tolerances() {
        plant.tolerances = tolerances;
    }
    let (states, channels) = (plant.places.states.len(), recording.channels.len());
    let count = directions.len();
    let rows = recording.rows() - recording.first_row;
    let mut found = Innovations {
        channels: vec![Vec::with_capacity(rows); channels],
    };
    let mut changes = DMatrix::<f64>::zeros(channels, count);
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
    let mut growth = now.clone();
    let mut by_output = DMatrix::<f64>::zeros(channels, count);
    let mut legs = Legs::default();
    let mut error = vec![0.0; channels];
    let mut increment = vec![0.0; states];
    let mut at = 0;
    for row in 0..recording.rows() {
        own.outputs(&mut plant);
        for (channel, measured) in program.experiment.measured.iter().enumerate() {
            let difference = recording.channels[channel][row] - own.values[measured.output];
            if row >= recording.first_row {
                let value = whitened(difference, observer.deviations[channel]);
                found.channels[channel].push(value);
            }
            error[channel] = if difference.is_finite() {
                difference
            } else {
                0.0
            };
        }
        let seen = modes(&mut plant, &mut known, &mut number_of, &own.touched);
        own.seen(&mut plant, directions, &mut by_output);
        let last = plant.current;
        crate::dense::set_product(&observer.gain, &error, &mut increment);
        plant.begin_row(&increment);
        own.forces(&mut plant, directions, &mut then);
        if row > 0 {
            // Forces at the end of a row are those at the start of the next, unless the correction has changed modes.
            let end = if plant.current == last { &then } else { &now };
            let within = plant.legs.iter().any(|leg| leg.fixed.is_some());
            before.rows_mut(states, touched).copy_from(&now);
            if within {
                // Modes that begin within the row act from there on: the axis may ring several times in a row's time.
                // So do forces, which may be others from one mode to the next.
                before.rows_mut(states + touched, touched).fill(0.0);
                for leg in &plant.legs {
                    before.rows_mut(0, states).copy_from(&errors);
                    let step = legs.of(&plant, leg, &own.touched);
                    errors.gemm(1.0, step, &before, 0.0);
                    if let Some(fixed) = &leg.fixed {
                        fix(&plant, fixed.iter(), &mut errors);
                        before.rows_mut(states, touched).copy_from(end);
                    }
                }
            } else {
                before.rows_mut(0, states).copy_from(&errors);
                end.sub_to(&now, &mut growth);
                before
                    .rows_mut(states + touched, touched)
                    .copy_from(&growth);
                errors.gemm(1.0, &known[at].whole, &before, 0.0);
            }
        }
        answers.gemm(-1.0, &known[seen].padded, &errors, 0.0);
        for number in 0..count {
            for channel in 0..channels {
                answers[(channel, number)] -= by_output[(channel, number)];
                changes[(channel, number)] =
                    answers[(channel, number)] / observer.deviations[channel];
            }
        }
        if let Some(row) = row.checked_sub(recording.first_row) {
            each(row, &changes);
        }
        errors.gemm(1.0, &gain, &answers, 1.0);
        fix(
            &plant,
            plant.pinned.iter().map(|(position, _)| position),
            &mut errors,
        );
        std::mem::swap(&mut now, &mut then);
        at = modes(&mut plant, &mut known, &mut number_of, &own.touched);
        if row + 1 < recording.rows() {
            plant.advance();
        }
    }
    Ok(found)
}

/// What steps within a row make of errors and forces.
#[derive(Default)]
struct Legs {
    known: BTreeMap<(usize, usize), DMatrix<f64>>,
}

impl Legs {
    fn of(&mut self, plant: &Plant<'_>, leg: &Leg, touched: &[usize]) -> &DMatrix<f64> {
        let make = || {
            let configuration = &plant.configurations[leg.configuration].1;
            let rates = rates_by_forces(configuration, &plant.places, touched);
            beside(&configuration.steps[leg.level], &rates)
        };
        self.known
            .entry((leg.configuration, leg.level))
            .or_insert_with(make)
    }
}

/// The rates of the states that forces in some equations make.
fn rates_by_forces(
    configuration: &Configuration,
    places: &Places,
    touched: &[usize],
) -> DMatrix<f64> {
    let of_states = -configuration.inverse.select_rows(&places.states);
    of_states.select_columns(touched)
}

/// What a step makes of errors and forces: exp, and the integrals for forces at its start and for their growth.
fn beside(step: &Step, rates: &DMatrix<f64>) -> DMatrix<f64> {
    let (n, r) = (step.exp.nrows(), rates.ncols());
    let mut whole = DMatrix::zeros(n, n + 2 * r);
    whole.columns_mut(0, n).copy_from(&step.exp);
    whole.columns_mut(n, r).copy_from(&(&step.first * rates));
    // phi2 is that of a growth over the whole step.
    whole
        .columns_mut(n + r, r)
        .copy_from(&(&step.second * rates));
    whole
}

/// States that modes fix have no error: what the observer corrects them by is lost.
fn fix<'a>(
    plant: &Plant<'_>,
    positions: impl Iterator<Item = &'a usize>,
    errors: &mut DMatrix<f64>,
) {
    for position in positions {
        let mut states = plant.places.states.iter();
        if let Some(state) = states.position(|state| state == position) {
            errors.row_mut(state).fill(0.0);
        }
    }
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
    let rates = rates_by_forces(configuration, &plant.places, touched);
    let whole = beside(step, &rates);
    let (n, r) = (step.exp.nrows(), touched.len());
    let mut padded = DMatrix::zeros(outputs.nrows().max(LEAST_WIDTH), n);
    padded.rows_mut(0, outputs.nrows()).copy_from(&outputs);
    known.push(Modes {
        exp: step.exp.clone(),
        first: whole.columns(n, r).into_owned(),
        second: whole.columns(n + r, r).into_owned(),
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
    /// Whether some direction changes what is measured.
    shown: bool,
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
        let rows = |function: Function| -> Vec<usize> {
            let entries = program.kernels.still_entries(function).into_iter();
            entries
                .filter(|entry| matches!(entry.wrt, Wrt::Parameter(place) if moved(place)))
                .map(|entry| entry.row)
                .collect()
        };
        let mut touched = rows(Function::Residual);
        touched.sort_unstable();
        touched.dedup();
        Self {
            shown: !rows(Function::Outputs).is_empty(),
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

    /// What a unit of each size adds to what the channels show, where it does.
    pub(crate) fn seen(
        &mut self,
        plant: &mut Plant<'_>,
        directions: &[Direction],
        out: &mut DMatrix<f64>,
    ) {
        if !self.shown {
            return;
        }
        let program = plant.program;
        let (at, _) = plant.point();
        let kernels = &program.kernels;
        for (number, direction) in directions.iter().enumerate() {
            let with = Point {
                p: &direction.p,
                ..at
            };
            kernels.evaluate(
                Function::Outputs,
                with,
                &mut self.workspace,
                &mut self.others,
            );
            for (channel, measured) in program.experiment.measured.iter().enumerate() {
                let change = self.others[measured.output] - self.values[measured.output];
                out[(channel, number)] = change / direction.step;
            }
        }
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
