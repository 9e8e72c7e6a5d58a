//! [`Splitting`]: errors where equations bend. A combination of modes has one linear part for all its rows; what derivatives
//! are elsewhere is met half before a step of it and half behind (Strang, SIAM J. Numer. Anal. 5, 1968, 506):
//!
//! ```text
//! step       exp(T/2 (A' - A)) exp(T A) exp(T/2 (A' - A))
//! A' - A     W Q: what equations that bend answer, and what errors ask of them
//! ```
//! A bristle decays by a thousandth of its time constant in one row and by many in the next. So equations of states that the
//! observer does not know are no part of A, and they and what a direction forces them by are all in Q.

use crate::linear::{Step, add_low_rank, phi1, steps};
use crate::observer::track::Track;
use crate::plant::{
    LEVELS, Places, arranged, partials, shortest_steps, uneven, v_column, x_column,
};
use hyde_program::{Function, Point, Program, Workspace, Wrt};
use hyde_signal::statistics::median;
use nalgebra::DMatrix;
use std::collections::BTreeSet;

/// What makes errors so many times as large in half a step is not met for as long.
const GROWTH: f64 = 10.0;

/// The linear part of a combination of modes whose equations bend, and where derivatives differ from it.
pub(crate) struct Splitting {
    /// Steps of the linear part.
    pub(crate) steps: Vec<Step>,
    /// The rates of the states that forces in the equations that are touched make, those of bristles apart.
    pub(crate) rates: DMatrix<f64>,
    /// The time of a row, s.
    row_s: f64,
    entries: Vec<Entry>,
    /// What unknowns and rates of states follow from the states, from residuals of the equations that bend, and from forces.
    by_state: DMatrix<f64>,
    by_residual: DMatrix<f64>,
    by_force: DMatrix<f64>,
    /// Of the equations of bristles, those that are touched: the number among those that bend, and among those.
    forced: Vec<(usize, usize)>,
    /// Rates of the states by residuals.
    answers: DMatrix<f64>,
}

/// A derivative that differs.
struct Entry {
    number: usize,
    /// The number of its equation among those that bend.
    row: usize,
    by: By,
    /// What it is in the linear part.
    base: f64,
}

/// What it is a derivative by: the number of a state, or the place of what follows.
enum By {
    State(usize),
    Other(usize),
}

/// What errors and forces do at a point beyond the linear part.
pub(crate) struct Bend {
    /// What residuals ask: of errors, a column a residual, and of forces, a row a residual.
    by_error: DMatrix<f64>,
    by_force: DMatrix<f64>,
    /// What residuals ask of themselves by the states they move, and what states answer in half a row.
    own: DMatrix<f64>,
    row: Option<DMatrix<f64>>,
}

impl Splitting {
    /// That of a combination of modes, from a point of it and the derivatives at others; `None` where nothing bends there.
    /// What bends has the median of its derivatives in the linear part: where a drag is steepest it is so by orders of magnitude.
    pub(super) fn new(
        track: &Track<'_>,
        program: &Program,
        touched: &[usize],
        at: Point<'_>,
        looks: &[Vec<f64>],
        workspace: &mut Workspace,
    ) -> Option<Self> {
        let places = &track.places;
        let all = program.partials(Function::Residual);
        let mut base = partials(program, at, workspace);
        let mut differing = uneven(program, at, workspace, &base);
        differing.retain(|&number| by(places, all[number].wrt).is_some());
        let rows: BTreeSet<usize> = differing.iter().map(|&number| all[number].row).collect();
        let rows: Vec<usize> = rows.into_iter().collect();
        if rows.is_empty() {
            return None;
        }
        let row_of = |number: usize| rows.binary_search(&all[number].row).ok();
        let by_v = |base: &[f64]| arranged(program, base, |wrt| v_column(places, wrt));
        // Equations that states unknown to the observer follow.
        let answers = by_v(&base).try_inverse()?.select_columns(&rows);
        let states = places.states.iter().enumerate();
        let unknown = states.filter(|(state, _)| !track.route.observer.knows(*state));
        let unknown: Vec<usize> = unknown.map(|(_, &place)| place).collect();
        let of_bristles = |row: usize| unknown.iter().any(|&z| answers[(z, row)].abs() > 0.0);
        let mut entries = Vec::new();
        for number in differing {
            let (row, by) = (row_of(number)?, by(places, all[number].wrt)?);
            let usual = || {
                let values = looks.iter().map(|look| look[number]);
                let known: Vec<f64> = values.filter(|value| value.is_finite()).collect();
                median(&known)
            };
            base[number] = match of_bristles(row) {
                true => 0.0,
                false => usual().unwrap_or(base[number]),
            };
            entries.push(Entry {
                number,
                row,
                by,
                base: base[number],
            });
        }
        let inverse = by_v(&base).try_inverse()?;
        let by_states = arranged(program, &base, |wrt| x_column(places, wrt));
        let by_state = -&inverse * by_states.select_columns(&places.states);
        let by_residual = -inverse.select_columns(&rows);
        let mut by_force = -inverse.select_columns(touched);
        let mut forced = Vec::new();
        for (number, row) in touched.iter().enumerate() {
            if let Some(own) = rows.binary_search(row).ok().filter(|own| of_bristles(*own)) {
                forced.push((own, number));
                by_force.column_mut(number).fill(0.0);
            }
        }
        let a = by_state.select_rows(&places.states);
        Some(Self {
            steps: steps(&a, track.route.step_s, LEVELS),
            row_s: track.route.step_s,
            rates: by_force.select_rows(&places.states),
            answers: by_residual.select_rows(&places.states),
            entries,
            by_state,
            by_residual,
            by_force,
            forced,
        })
    }

    /// What bends at a point.
    pub(super) fn bend(&self, program: &Program, at: Point<'_>, workspace: &mut Workspace) -> Bend {
        let there = partials(program, at, workspace);
        let count = self.answers.ncols();
        let mut by_error = DMatrix::zeros(count, self.by_state.ncols());
        let mut by_force = DMatrix::zeros(count, self.by_force.ncols());
        let mut coupled = DMatrix::identity(count, count);
        for entry in &self.entries {
            // Where a power of the speed is steepest it has no slope.
            let change = Some(there[entry.number]).filter(|there| there.is_finite());
            let change = change.map_or(0.0, |there| there - entry.base);
            let add = |to: &mut DMatrix<f64>, from: &DMatrix<f64>, place: usize, by: f64| {
                for column in 0..to.ncols() {
                    to[(entry.row, column)] += by * from[(place, column)];
                }
            };
            match entry.by {
                By::State(state) => by_error[(entry.row, state)] += change,
                By::Other(place) => {
                    add(&mut by_error, &self.by_state, place, change);
                    add(&mut by_force, &self.by_force, place, change);
                    add(&mut coupled, &self.by_residual, place, -change);
                }
            }
        }
        for &(row, number) in &self.forced {
            by_force[(row, number)] += 1.0;
        }
        let coupled = coupled.try_inverse();
        let coupled = coupled.unwrap_or_else(|| DMatrix::zeros(count, count));
        let by_error = &coupled * by_error;
        let own = &by_error * &self.answers;
        Bend {
            by_force: coupled * by_force,
            row: self.answered(&own, 0.5 * self.row_s),
            own,
            by_error: by_error.transpose(),
        }
    }

    /// What states answer over some time; `None` where what was 1 grows out of measure.
    fn answered(&self, own: &DMatrix<f64>, time: f64) -> Option<DMatrix<f64>> {
        grown(own, time).map(|first| &self.answers * first)
    }

    /// What bends takes errors on by half a step of a length in shortest ones, forces being as they are.
    pub(super) fn kick(
        &self,
        bend: &Bend,
        length: usize,
        forces: &DMatrix<f64>,
        errors: &mut DMatrix<f64>,
    ) {
        let known = (length == shortest_steps()).then_some(&bend.row);
        let (answered, time) = match known {
            Some(answered) => (answered, 0.5 * self.row_s),
            None => {
                let time = 0.5 * self.row_s * length as f64 / shortest_steps() as f64;
                (&self.answered(&bend.own, time), time)
            }
        };
        match answered {
            Some(answered) => {
                add_low_rank(answered, [&bend.by_error, &bend.by_force], forces, errors);
            }
            // An instant that is met in passing, as where a drag that is steepest at rest slips back, is not half a step.
            None => {
                let asked = &bend.by_force * forces * time;
                let mut errors = errors.rows_mut(0, self.answers.nrows());
                errors.gemm(1.0, &self.answers, &asked, 1.0);
            }
        }
    }
}

/// T phi1(A T); `None` where what was 1 grows out of measure.
fn grown(a: &DMatrix<f64>, time: f64) -> Option<DMatrix<f64>> {
    if a.len() == 1 {
        let z = a[0] * time;
        return (z <= GROWTH.ln()).then(|| DMatrix::from_element(1, 1, time * phi1(z)));
    }
    let step = steps(a, time, 1).remove(0);
    let bounded = step.exp.iter().all(|part| part.abs() <= GROWTH);
    bounded.then_some(step.first)
}

/// What a derivative is by; `None` where it is by no unknown.
fn by(places: &Places, wrt: Wrt) -> Option<By> {
    let number = |place| places.states.iter().position(|&state| state == place);
    match x_column(places, wrt) {
        Some(place) => number(place).map(By::State),
        None => v_column(places, wrt).map(By::Other),
    }
}
