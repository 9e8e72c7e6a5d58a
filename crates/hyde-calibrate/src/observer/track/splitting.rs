//! [`Splitting`]: errors where equations bend. A combination of modes has one linear part for all its rows; what derivatives
//! are elsewhere is met half before a step of it and half behind (Strang, SIAM J. Numer. Anal. 5, 1968, 506):
//!
//! ```text
//! step       exp(T/2 (A' - A)) exp(T A) exp(T/2 (A' - A))
//! A' - A     W Q: what equations that bend answer, and what errors ask of them
//! ```
//! A bristle decays by a thousandth of its time constant in one row and by many in the next. So equations of states that the
//! observer does not know are no part of A, and they and what a direction forces them by are all in Q.

use super::Route;
use crate::linear::{Step, add_low_rank, phi1, steps};
use crate::plant::{LEVELS, arranged, partials, shortest_steps, uneven, v_column, x_column};
use hyde_program::{Function, PartialEntry, Point, Workspace};
use hyde_signal::statistics::median;
use nalgebra::DMatrix;
use std::collections::BTreeSet;

/// What makes errors so many times as large in half a step is not met for as long.
const GROWTH: f64 = 10.0;

/// The linear part of a combination of modes whose equations bend, and where derivatives differ from it.
pub(crate) struct Splitting {
    /// Steps of the linear part.
    pub(crate) steps: Vec<Step>,
    /// The time of a row, s.
    row_s: f64,
    /// Equations that bend, by number, and whether each is one of bristles.
    rows: Vec<usize>,
    of_bristles: Vec<bool>,
    entries: Vec<Entry>,
    /// What a unit of each residual makes of rates and algebraic variables: the inverse of dF/dv, its sign turned.
    by_residual: DMatrix<f64>,
    /// Places of what follows from the states, by which a derivative differs; and how it follows, a row each, from the states
    /// and from residuals of the equations that bend.
    followers: Vec<usize>,
    by_state: DMatrix<f64>,
    by_bending: DMatrix<f64>,
    /// Places of the states, and their rates by residuals of the equations that bend.
    states: Vec<usize>,
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

/// What it is a derivative by: the number of a state, or that of a follower.
#[derive(Clone, Copy)]
enum By {
    State(usize),
    Follower(usize),
}

/// What errors and forces do at a point beyond the linear part.
pub(crate) struct Bend {
    /// What residuals ask: of errors, a column a residual, and of followers and of forces of their own, a row a residual.
    by_error: DMatrix<f64>,
    by_follower: DMatrix<f64>,
    by_own_force: DMatrix<f64>,
    /// What residuals ask of themselves by the states they move, and what states answer in half a row.
    own: DMatrix<f64>,
    row: Option<DMatrix<f64>>,
}

/// How forces in some equations act in a linear part.
#[derive(Default)]
pub(crate) struct Forcing {
    /// The rates of the states that they make, those of bristles apart.
    pub(crate) rates: DMatrix<f64>,
    /// The followers.
    followers: DMatrix<f64>,
    /// Forces in equations of bristles: the number among those that bend, and among the forces.
    forced: Vec<(usize, usize)>,
}

impl Splitting {
    /// That of a combination of modes of a route; `None` where nothing bends there. What bends has the median of its
    /// derivatives at some `rows` in the linear part: where a drag is steepest it is so by orders of magnitude.
    pub(super) fn new(
        route: &Route<'_>,
        configuration: usize,
        rows: &[Point<'_>],
        workspace: &mut Workspace,
    ) -> Option<Self> {
        let (program, places) = (route.program, &route.places);
        let at = route.configurations[configuration].made.point(&route.p);
        let all = program.partials(Function::Residual);
        let mut base = partials(program, at, workspace);
        let of_state = |wrt| {
            let place = x_column(places, wrt)?;
            places.states.iter().position(|&state| state == place)
        };
        let of_follower = |wrt| v_column(places, wrt);
        let mut differing = uneven(program, at, workspace, &base);
        differing.retain(|&number| {
            let wrt = all[number].wrt;
            of_state(wrt).is_some() || of_follower(wrt).is_some()
        });
        if differing.is_empty() {
            return None;
        }
        let looks: Vec<Vec<f64>> = rows
            .iter()
            .map(|&row| partials(program, row, workspace))
            .collect();
        let rows: BTreeSet<usize> = differing.iter().map(|&number| all[number].row).collect();
        let rows: Vec<usize> = rows.into_iter().collect();
        let followers = differing.iter();
        let followers = followers.filter_map(|&number| of_follower(all[number].wrt));
        let followers: BTreeSet<usize> = followers.collect();
        let followers: Vec<usize> = followers.into_iter().collect();
        let by_v = |base: &[f64]| arranged(program, base, |wrt| v_column(places, wrt));
        // Equations that states unknown to the observer follow.
        let answers = by_v(&base).try_inverse()?.select_columns(&rows);
        let states = places.states.iter().enumerate();
        let unknown = states.filter(|(state, _)| !route.observer.knows(*state));
        let unknown: Vec<usize> = unknown.map(|(_, &place)| place).collect();
        let follows = |row| unknown.iter().any(|&z| answers[(z, row)].abs() > 0.0);
        let of_bristles: Vec<bool> = (0..rows.len()).map(follows).collect();
        let mut entries = Vec::new();
        for number in differing {
            let PartialEntry { row, wrt } = all[number];
            let row = rows.binary_search(&row).ok()?;
            let by = match of_state(wrt) {
                Some(state) => By::State(state),
                None => By::Follower(followers.binary_search(&of_follower(wrt)?).ok()?),
            };
            let usual = || {
                let values = looks.iter().map(|look| look[number]);
                let known: Vec<f64> = values.filter(|value| value.is_finite()).collect();
                median(&known)
            };
            base[number] = match of_bristles[row] {
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
        let by_residual = -by_v(&base).try_inverse()?;
        let by_states = arranged(program, &base, |wrt| x_column(places, wrt));
        let by_state = &by_residual * by_states.select_columns(&places.states);
        let a = by_state.select_rows(&places.states);
        let by_bending = by_residual.select_columns(&rows);
        Some(Self {
            steps: steps(&a, route.step_s, LEVELS),
            row_s: route.step_s,
            by_state: by_state.select_rows(&followers),
            answers: by_bending.select_rows(&places.states),
            by_bending: by_bending.select_rows(&followers),
            states: places.states.clone(),
            rows,
            of_bristles,
            entries,
            by_residual,
            followers,
        })
    }

    /// How forces act in some equations; those in none act on nothing.
    pub(crate) fn forcing(&self, equations: &[Option<usize>]) -> Forcing {
        let mut by_force = acting(&self.by_residual, equations);
        let mut forced = Vec::new();
        for (number, equation) in equations.iter().enumerate() {
            let own = equation.and_then(|equation| self.rows.binary_search(&equation).ok());
            if let Some(own) = own.filter(|&own| self.of_bristles[own]) {
                forced.push((own, number));
                by_force.column_mut(number).fill(0.0);
            }
        }
        Forcing {
            rates: by_force.select_rows(&self.states),
            followers: by_force.select_rows(&self.followers),
            forced,
        }
    }

    /// What bends, by the derivatives at a point.
    pub(super) fn bend(&self, there: &[f64]) -> Bend {
        let count = self.rows.len();
        let mut by_error = DMatrix::zeros(count, self.states.len());
        let mut by_follower = DMatrix::zeros(count, self.followers.len());
        for entry in &self.entries {
            // Where a power of the speed is steepest it has no slope.
            let change = Some(there[entry.number]).filter(|there| there.is_finite());
            let change = change.map_or(0.0, |there| there - entry.base);
            match entry.by {
                By::State(state) => by_error[(entry.row, state)] += change,
                By::Follower(number) => by_follower[(entry.row, number)] += change,
            }
        }
        by_error += &by_follower * &self.by_state;
        let coupled = DMatrix::identity(count, count) - &by_follower * &self.by_bending;
        let coupled = coupled.try_inverse();
        let coupled = coupled.unwrap_or_else(|| DMatrix::zeros(count, count));
        let by_error = &coupled * by_error;
        let own = &by_error * &self.answers;
        Bend {
            by_follower: &coupled * by_follower,
            by_own_force: coupled,
            row: self.answered(&own, 0.5 * self.row_s),
            own,
            by_error: by_error.transpose(),
        }
    }

    /// What states answer over some time; `None` where what was 1 grows out of measure.
    fn answered(&self, own: &DMatrix<f64>, time: f64) -> Option<DMatrix<f64>> {
        grown(own, time).map(|first| &self.answers * first)
    }

    /// The second half of what bends in a row that is one step, by errors where it begins: these times thin matrices `u v'` come
    /// on top of what the step makes of them.
    pub(crate) fn at_end(&self, bend: &Bend) -> [DMatrix<f64>; 2] {
        match &bend.row {
            Some(answered) => [answered.clone(), self.steps[0].exp.tr_mul(&bend.by_error)],
            None => {
                let (states, count) = self.answers.shape();
                [self.answers.clone(), DMatrix::zeros(states, count)]
            }
        }
    }

    /// What `v` is by forces at the begin of the row, and below them those at its end, which a step has behind its errors.
    pub(crate) fn at_end_by_forces(
        &self,
        bend: &Bend,
        (step, forcing): (&DMatrix<f64>, &Forcing),
    ) -> DMatrix<f64> {
        let (states, touched) = (self.states.len(), forcing.rates.ncols());
        let by_force = bend.by_force(forcing).transpose();
        let (mut v, part) = match &bend.row {
            Some(_) => (
                step.columns(states, 2 * touched).tr_mul(&bend.by_error),
                1.0,
            ),
            None => (
                DMatrix::zeros(2 * touched, by_force.ncols()),
                0.5 * self.row_s,
            ),
        };
        let mut at_end = v.rows_mut(touched, touched);
        at_end += by_force * part;
        v
    }

    /// What bends takes errors on by half a step of a length in shortest ones, forces being as they are.
    pub(crate) fn kick(
        &self,
        bend: &Bend,
        length: usize,
        (forcing, forces): (&Forcing, &DMatrix<f64>),
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
        let by_force = bend.by_force(forcing);
        match answered {
            Some(answered) => {
                add_low_rank(answered, [&bend.by_error, &by_force], forces, errors);
            }
            // An instant that is met in passing, as where a drag that is steepest at rest slips back, is not half a step.
            None => {
                let asked = by_force * forces * time;
                let mut errors = errors.rows_mut(0, self.answers.nrows());
                errors.gemm(1.0, &self.answers, &asked, 1.0);
            }
        }
    }
}

impl Bend {
    /// What residuals ask of forces, a row a residual.
    fn by_force(&self, forcing: &Forcing) -> DMatrix<f64> {
        let mut by_force = &self.by_follower * &forcing.followers;
        for &(row, number) in &forcing.forced {
            let mut own = by_force.column_mut(number);
            own += self.by_own_force.column(row);
        }
        by_force
    }
}

/// What forces in some equations make, by what a unit of each residual makes; those in none make nothing.
pub(crate) fn acting(by_residual: &DMatrix<f64>, equations: &[Option<usize>]) -> DMatrix<f64> {
    let mut by_force = DMatrix::zeros(by_residual.nrows(), equations.len());
    for (number, equation) in equations.iter().enumerate() {
        if let Some(equation) = *equation {
            by_force.set_column(number, &by_residual.column(equation));
        }
    }
    by_force
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
