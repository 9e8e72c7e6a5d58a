//! How innovations change with small changes of parameters, many at once: along one run of the observer.
//!
//! ```text
//! error of the states    eps+ = exp(A T) (I - K C) eps + forcing        change of innovations    -(C eps + dh)
//! ```
//! A change forces the equations by what it adds to their residual where the plant is, taken linearly over a row, and the
//! channels by dh. Both are differences by the parameter, of kernels alone. So a direction costs a few evaluations and a
//! column of a product a row, and no run of its own. Guards are taken to act when they do without it: for friction that is
//! right to first order, for its force does not jump where it begins and ends to stick, and what has stuck in between forgets
//! its speed; of contacts it is a part. Modes that begin within a row act from there on.

use crate::dense::set_product;
use crate::gain::{Observer, output_matrix};
use crate::leg::{Leg, length};
use crate::observer::{When, measured};
use crate::plant::{Unsupported, size_of};
use crate::recording::Recording;
use crate::track::{Track, Vectors};
use hyde_program::{Function, Point, Program, SomeRows, Workspace, Wrt};
use nalgebra::{DMatrix, DMatrixView};
use std::collections::BTreeMap;

/// A parameter by whose small change innovations are differentiated.
pub(crate) struct Direction {
    /// The whole parameter vector with the parameter changed.
    pub(crate) p: Vec<f64>,
    /// By how much.
    pub(crate) step: f64,
}

/// What a combination of modes makes of errors and forces in a row.
pub(crate) struct Modes {
    pub(crate) exp: DMatrix<f64>,
    /// By the equations that a direction touches.
    pub(crate) first: DMatrix<f64>,
    pub(crate) second: DMatrix<f64>,
    pub(crate) outputs: DMatrix<f64>,
}

/// A product of matrices is faster than one a column from this many columns on.
const MANY: usize = 8;

/// How whitened innovations change along a track, a column a direction, channels below each other.
pub(crate) fn changes(
    track: &Track<'_>,
    program: &Program,
    recording: &Recording,
    p: &[f64],
    directions: &[Direction],
) -> Result<DMatrix<f64>, Unsupported> {
    let channels = recording.channels.len();
    let rows = recording.rows() - recording.first_row;
    let mut change = DMatrix::zeros(rows * channels, directions.len());
    let keep = |row: usize, changes: DMatrixView<'_, f64>| {
        for number in 0..directions.len() {
            for channel in 0..channels {
                change[(channel * rows + row, number)] = changes[(channel, number)];
            }
        }
    };
    along(track, program, recording, p, directions, keep)?;
    Ok(change)
}

/// The same, row by row: `each` gets the number of a row that counts, and how its whitened innovations change, a row a
/// channel, a column a direction. The program is that of the track or one that it serves, `p` its parameters there.
pub(crate) fn along(
    track: &Track<'_>,
    program: &Program,
    recording: &Recording,
    p: &[f64],
    directions: &[Direction],
    mut each: impl FnMut(usize, DMatrixView<'_, f64>),
) -> Result<(), Unsupported> {
    let route = &track.route;
    let observer = &route.observer;
    let (states, channels) = (track.places.states.len(), recording.channels.len());
    let count = directions.len();
    let mut own = Own::new(program, p, directions);
    let mut known = Known::new(track, program, p, &own.touched);
    let touched = own.touched.len();
    // A column a direction: errors of the states, forces at the start of a row and at its end, what channels show of it.
    let mut before = DMatrix::<f64>::zeros(states + 2 * touched + channels, count);
    // Errors after it and the answers below them; forces are put over these in the next row.
    let mut after = before.clone();
    let mut now = DMatrix::<f64>::zeros(touched, count);
    let (mut then, mut reached) = (now.clone(), now.clone());
    let mut by_output = DMatrix::<f64>::zeros(channels, count);
    let mut corrected = Corrected::default();
    let (mut at, mut room) = (None, Vectors::default());
    for (row, passed) in route.rows.iter().enumerate() {
        let [before_it, next] = passed.modes;
        let seen = known.modes(row, When::Before, before_it)?;
        if own.shown {
            let at = track.point(row, When::Before, p, &mut room);
            own.seen(at, directions, &mut by_output);
        }
        let at_end = track.point(row, When::After, p, &mut room);
        own.forces(at_end, directions, &mut then);
        let legs = track.legs(row);
        let within = legs.iter().any(|leg| leg.event.is_some());
        if at.is_some() && within {
            // Modes that begin within the row act from there on: the axis may ring several times in a row's time.
            // So do forces, which jump from one mode to the next, and grow evenly in each.
            for mode in legs.split_inclusive(|leg| leg.event.is_some()) {
                let event = mode.last().and_then(|leg| leg.event.as_ref());
                if let Some(event) = event {
                    let at = track.within(row, &event.before, p, &mut room);
                    own.forces(at, directions, &mut reached);
                } else if next == before_it {
                    reached.copy_from(&then);
                } else {
                    reached.copy_from(&now);
                }
                for (number, leg) in mode.iter().enumerate() {
                    put(&mut before, states, &now);
                    let part = size_of(leg.level) as f64 / length(&mode[number..]) as f64;
                    now.zip_apply(&reached, |now, end| *now += part * (end - *now));
                    put(&mut before, states + touched, &now);
                    let errors = known.leg(leg)? * before.rows(0, states + 2 * touched);
                    put(&mut before, 0, &errors);
                }
                if let Some(event) = event {
                    fix(&event.fixed, &mut before);
                    let at = track.within(row, &event.after, p, &mut room);
                    own.forces(at, directions, &mut now);
                }
            }
        } else {
            // Forces at the end of a row are those at the start of the next, unless the correction has changed modes.
            let end = if next == before_it { &then } else { &now };
            put(&mut before, states, &now);
            put(&mut before, states + touched, end);
        }
        put(&mut before, states + 2 * touched, &by_output);
        let stepped = at.filter(|_| !within);
        let matrix = corrected.of(&known.modes, stepped, seen, observer);
        if count < MANY {
            for (mut after, before) in after.column_iter_mut().zip(before.column_iter()) {
                let after = &mut after.as_mut_slice()[..states + channels];
                set_product(matrix, before.as_slice(), after);
            }
        } else {
            let mut after = after.rows_mut(0, states + channels);
            after.gemm(1.0, matrix, &before, 0.0);
        }
        if let Some(row) = row.checked_sub(recording.first_row) {
            each(row, after.rows(states, channels));
        }
        fix(&passed.fixed, &mut after);
        std::mem::swap(&mut before, &mut after);
        std::mem::swap(&mut now, &mut then);
        at = Some(known.modes(row, When::After, next)?);
    }
    Ok(())
}

/// Copies rows to where one begins.
fn put(into: &mut DMatrix<f64>, row: usize, rows: &DMatrix<f64>) {
    let (height, own) = (into.nrows(), rows.nrows());
    if own > 0 {
        // By slices: views of matrices are copied number by number.
        let columns = into.as_mut_slice().chunks_exact_mut(height);
        for (into, column) in columns.zip(rows.as_slice().chunks_exact(own)) {
            into[row..row + own].copy_from_slice(column);
        }
    }
}

/// What a row's time and the correction at its end make of errors, forces at both ends and what channels show: corrected
/// errors, and the whitened change of innovations.
#[derive(Default)]
struct Corrected {
    /// By the modes of the row, if it is one step or none, and those at its end.
    known: BTreeMap<(Option<usize>, usize), DMatrix<f64>>,
}

impl Corrected {
    fn of(
        &mut self,
        known: &[Modes],
        stepped: Option<usize>,
        seen: usize,
        observer: &Observer,
    ) -> &DMatrix<f64> {
        let make = || {
            let outputs = &known[seen].outputs;
            let ((channels, states), touched) = (outputs.shape(), known[seen].first.ncols());
            // Errors before the correction, of errors and forces.
            let mut errors = DMatrix::zeros(states, states + 2 * touched);
            match stepped.map(|at| &known[at]) {
                Some(Modes {
                    exp, first, second, ..
                }) => {
                    errors.columns_mut(0, states).copy_from(exp);
                    // The second integral is that of a growth over the row.
                    errors
                        .columns_mut(states, touched)
                        .copy_from(&(first - second));
                    errors
                        .columns_mut(states + touched, touched)
                        .copy_from(second);
                }
                None => errors.fill_with_identity(),
            }
            let inner = states + 2 * touched;
            let mut answers = DMatrix::zeros(channels, inner + channels);
            answers
                .columns_mut(0, inner)
                .copy_from(&-(outputs * &errors));
            answers
                .columns_mut(inner, channels)
                .copy_from(&-DMatrix::identity(channels, channels));
            let mut matrix = DMatrix::zeros(states + channels, inner + channels);
            let mut kept = matrix.rows_mut(0, states);
            kept.copy_from(&(&observer.gain * &answers));
            let mut own = kept.columns_mut(0, inner);
            own += errors;
            for (channel, deviation) in observer.deviations.iter().enumerate() {
                let whitened = answers.row(channel) / *deviation;
                matrix.row_mut(states + channel).copy_from(&whitened);
            }
            matrix
        };
        self.known.entry((stepped, seen)).or_insert_with(make)
    }
}

/// What combinations of modes, and steps in them, make of errors and forces: made where they are new.
pub(crate) struct Known<'t> {
    track: &'t Track<'t>,
    program: &'t Program,
    p: &'t [f64],
    touched: Vec<usize>,
    workspace: Workspace,
    pub(crate) modes: Vec<Modes>,
    /// By the numbers of the track.
    number_of: Vec<Option<usize>>,
    rates: Vec<Option<DMatrix<f64>>>,
    legs: BTreeMap<(usize, usize), DMatrix<f64>>,
}

impl<'t> Known<'t> {
    pub(crate) fn new(
        track: &'t Track<'t>,
        program: &'t Program,
        p: &'t [f64],
        touched: &[usize],
    ) -> Self {
        let count = track.route.configurations.len();
        Self {
            track,
            program,
            p,
            touched: touched.to_vec(),
            workspace: Workspace::new(program.n_work),
            modes: Vec::new(),
            number_of: vec![None; count],
            rates: vec![None; count],
            legs: BTreeMap::new(),
        }
    }

    /// The number of the matrices of a combination of modes, in which a row is.
    pub(crate) fn modes(
        &mut self,
        row: usize,
        when: When,
        configuration: usize,
    ) -> Result<usize, Unsupported> {
        if let Some(number) = self.number_of[configuration] {
            return Ok(number);
        }
        let track = self.track;
        let own = &track.route.configurations[configuration];
        let mut room = Vectors::default();
        let at = track.point(row, when, self.p, &mut room);
        let outputs = output_matrix(self.program, &track.places, own, at, &mut self.workspace);
        let step = &own.steps[0];
        let rates = self.rates(configuration)?;
        let made = Modes {
            exp: step.exp.clone(),
            first: &step.first * rates,
            // phi2 is that of a growth over the whole step.
            second: &step.second * rates,
            outputs,
        };
        self.modes.push(made);
        self.number_of[configuration] = Some(self.modes.len() - 1);
        Ok(self.modes.len() - 1)
    }

    /// Times errors, and forces at the begin and the end of a step below them, this is errors at its end.
    fn leg(&mut self, leg: &Leg) -> Result<&DMatrix<f64>, Unsupported> {
        let key = (leg.configuration, leg.level);
        if !self.legs.contains_key(&key) {
            let step = &self.track.route.configurations[leg.configuration].steps[leg.level];
            let rates = self.rates(leg.configuration)?;
            let n = step.exp.nrows();
            let forces = rates.ncols();
            let (first, second) = (&step.first * rates, &step.second * rates);
            let mut matrix = DMatrix::zeros(n, n + 2 * forces);
            matrix.columns_mut(0, n).copy_from(&step.exp);
            // The second integral is that of a growth over the step.
            matrix.columns_mut(n, forces).copy_from(&(first - &second));
            matrix.columns_mut(n + forces, forces).copy_from(&second);
            self.legs.insert(key, matrix);
        }
        Ok(&self.legs[&key])
    }

    /// The rates of the states that forces in the equations that are touched make.
    fn rates(&mut self, configuration: usize) -> Result<&DMatrix<f64>, Unsupported> {
        if self.rates[configuration].is_none() {
            let track = self.track;
            let inverse = track
                .inverse(self.program, configuration, self.p, &mut self.workspace)
                .ok_or_else(Unsupported::singular)?;
            let of_states = -inverse.select_rows(&track.places.states);
            self.rates[configuration] = Some(of_states.select_columns(&self.touched));
        }
        self.rates[configuration]
            .as_ref()
            .ok_or_else(Unsupported::singular)
    }
}

/// States that modes fix have no error, a row a state: what the observer corrects them by is lost.
fn fix(states: &[usize], errors: &mut DMatrix<f64>) {
    for &state in states {
        errors.row_mut(state).fill(0.0);
    }
}

/// Evaluations of the model with other parameters where the plant is.
pub(crate) struct Own<'p> {
    /// The equations that some direction changes.
    pub(crate) touched: Vec<usize>,
    /// Their residuals.
    residual: Box<dyn SomeRows + 'p>,
    /// What the channels show.
    measured: Box<dyn SomeRows + 'p>,
    /// Whether some direction changes what is measured.
    pub(crate) shown: bool,
    workspace: Workspace,
    /// What the channels show without a change.
    values: Vec<f64>,
    others: Vec<f64>,
    force: Vec<f64>,
    plain: Vec<f64>,
}

impl<'p> Own<'p> {
    pub(crate) fn new(program: &'p Program, p: &[f64], directions: &[Direction]) -> Self {
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
        let channels = program.experiment.measured.len();
        Self {
            residual: program.kernels.some_rows(Function::Residual, &touched),
            measured: measured(program),
            shown: !rows(Function::Outputs).is_empty(),
            workspace: Workspace::new(program.n_work),
            values: vec![0.0; channels],
            others: vec![0.0; channels],
            force: vec![0.0; touched.len()],
            plain: vec![0.0; touched.len()],
            touched,
        }
    }

    /// What a unit of each size adds to what the channels show, where it does: a column a direction.
    pub(crate) fn seen(&mut self, at: Point<'_>, directions: &[Direction], out: &mut DMatrix<f64>) {
        self.measured
            .evaluate(at, &mut self.workspace, &mut self.values);
        for (number, direction) in directions.iter().enumerate() {
            let with = Point {
                p: &direction.p,
                ..at
            };
            self.measured
                .evaluate(with, &mut self.workspace, &mut self.others);
            for (channel, (with, plain)) in self.others.iter().zip(&self.values).enumerate() {
                out[(channel, number)] = (with - plain) / direction.step;
            }
        }
    }

    /// What a unit of each size adds to the residual of the equations that are touched: a column a direction.
    pub(crate) fn forces(
        &mut self,
        at: Point<'_>,
        directions: &[Direction],
        out: &mut DMatrix<f64>,
    ) {
        self.residual
            .evaluate(at, &mut self.workspace, &mut self.plain);
        for (number, direction) in directions.iter().enumerate() {
            let with = Point {
                p: &direction.p,
                ..at
            };
            self.residual
                .evaluate(with, &mut self.workspace, &mut self.force);
            for (row, (with, plain)) in self.force.iter().zip(&self.plain).enumerate() {
                let change = with - plain;
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
