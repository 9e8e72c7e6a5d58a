//! Consistent values at an instant: derivatives of states and algebraic variables from given states.
//!
//! Newton's method on F(t, y, y') = 0 for the unknowns v = (y' of states, y of the others). Its matrix takes its columns
//! from dF/dy' and dF/dy, on the Jacobian's own sparsity. A linear system is solved by the first iteration. From the same
//! factors come the derivatives of v along the flow, which tell in which direction a root function leaves zero (M2) and
//! how large the first step may be.

use crate::failed_equation::with_equation;
use crate::failure::{Failure, FailureKind};
use crate::moment::{At, Moment};
use crate::norms::{largest_correction, largest_of, largest_part, norm};
use crate::singular;
use crate::state::State;
use hyde_ida::{LinearMethod, Pattern, Singular, SparseSolver, System, to_come};
use hyde_program::Function;

/// Newton iterations at most; halvings of a step at most.
const MAX_ITERATIONS: usize = 50;
const MAX_HALVINGS: usize = 12;
/// A step is small by these, relative and absolute; a thousand times them it may be rounding.
const TOLERANCE: f64 = 1e-12;
const LEAST_TOLERANCE: f64 = 1e-14;
const ROUNDING: f64 = 1e3;
/// Rows are solved to rounding if they leave this part of what their terms amount to, whatever the units and the condition
/// of the system are; they are not solved if they leave a million times as much, however small the step is.
const SOLVED: f64 = 1e-12;
const UNSOLVED: f64 = 1e6;
/// So many small steps may follow each other where rows are not solved: before an upright slope, as of a root near 0, they
/// grow from one to the next.
const MAX_SMALL_STEPS: usize = 8;
/// Corrections by the factors of an earlier point at most: then its own are cheaper.
const MOST_BY_OLD_FACTORS: usize = 3;

/// The derivatives along the flow of y (all of it) and of the states' y'.
#[derive(Clone, Default)]
pub(crate) struct Flow {
    pub(crate) dy: Vec<f64>,
    pub(crate) dyp: Vec<f64>,
}

/// The solver of consistent values; keeps its factors from call to call.
pub(crate) struct Consistent {
    solver: Option<SparseSolver>,
    matrix: Vec<f64>,
    /// The matrix of the factors; empty without any. Between events it often remains the same: where the residual is affine,
    /// as long as its coefficients do.
    factored: Vec<f64>,
    coefficients: Option<u64>,
    residual: Vec<f64>,
    correction: Vec<f64>,
    /// What the unknowns were before a step, and what the terms of rows amount to.
    old: Vec<f64>,
    terms: Vec<f64>,
    flow: Flow,
}

impl Consistent {
    pub(crate) fn new(state: &State<'_>) -> Self {
        let jacobian = state.program.jacobian();
        let n = state.program.n_unknowns;
        let pattern = Pattern::new(n, jacobian.column_starts.clone(), jacobian.rows.clone());
        let solver = pattern
            .ok()
            .filter(|_| n > 0)
            .and_then(|p| SparseSolver::new(p, LinearMethod::Auto).ok());
        Self {
            solver,
            matrix: vec![0.0; jacobian.len()],
            factored: Vec::new(),
            coefficients: None,
            residual: vec![0.0; n],
            correction: vec![0.0; n],
            old: Vec::with_capacity(n),
            terms: vec![0.0; n],
            flow: Flow::default(),
        }
    }

    /// Solves for the derivatives of states and the algebraic variables, in place.
    pub(crate) fn solve(
        &mut self,
        state: &mut State<'_>,
        now: &mut Moment,
        at_start: bool,
    ) -> Result<(), Box<Failure>> {
        if self.solver.is_none() {
            return Ok(());
        }
        let start = at_start.then(|| now.clone());
        let Err(failure) = self.newton(state, now, at_start) else {
            return Ok(());
        };
        let singular = matches!(
            &failure.kind,
            FailureKind::Inconsistent { singular, .. } if !singular.is_empty()
        );
        if let (Some(start), true) = (start, singular) {
            // A product of unknowns that both start at 0, such as resistance and current, says nothing there: look from
            // elsewhere once.
            now.clone_from(&start);
            for (index, value) in now.y.iter_mut().enumerate() {
                if !state.differential[index] && value.abs() < f64::MIN_POSITIVE {
                    *value = 1.0;
                }
            }
            if self.newton(state, now, at_start).is_ok() {
                return Ok(());
            }
            *now = start;
        }
        Err(failure)
    }

    fn newton(
        &mut self,
        state: &mut State<'_>,
        now: &mut Moment,
        at_start: bool,
    ) -> Result<(), Box<Failure>> {
        state.apply_pins(now);
        self.evaluate(state, now.at())?;
        let mut last = f64::INFINITY;
        let mut small_steps = 0;
        for _ in 0..MAX_ITERATIONS {
            self.factor(state, now.at(), at_start)?;
            self.correction.copy_from_slice(&self.residual);
            if let Some(solver) = &mut self.solver {
                solver.solve(&mut self.correction);
            }
            let size = self.take_step(state, now)?;
            // Steps that are small and become no smaller are rounding: a small inductance turns that of volts into amperes
            // per second.
            let smaller = size <= 0.25 * last && size.is_finite();
            let rounding = size <= ROUNDING && !smaller;
            last = size;
            let mut done = size <= 1.0 || rounding;
            let at_once = state.coefficients().is_some();
            if (done || !smaller || at_once) && state.slides.is_empty() {
                let left = self.left_over_terms(state, now.at());
                done |= left <= SOLVED;
                small_steps += usize::from(done);
                done &= left <= UNSOLVED * SOLVED || small_steps > MAX_SMALL_STEPS;
            }
            if done {
                // States' rows that a mode fixes hold to the last bit.
                state.apply_pins(now);
                return Ok(());
            }
        }
        let worst = largest(&self.residual);
        let at = now.at();
        state.consistent_matrix(at, &mut self.matrix);
        if singular::is_singular(state, &self.matrix) {
            return Err(singular::failure(state, &self.matrix, worst, at, at_start));
        }
        let kind = FailureKind::Inconsistent {
            singular: Vec::new(),
            at_start,
        };
        let failure = Failure::new(kind, at.t).at_row(state.program, worst, at.y);
        let left = Some(self.residual[worst]);
        Err(with_equation(failure, state, at, worst, left))
    }

    /// The derivatives along the flow, after [`Consistent::solve`] at the point.
    pub(crate) fn flow(&mut self, state: &mut State<'_>, at: At<'_>) -> Option<&Flow> {
        let differential = &state.differential;
        let Flow { dy, dyp } = &mut self.flow;
        dy.clear();
        let rates = at.yp.iter().zip(differential);
        dy.extend(rates.map(|(rate, state)| if *state { *rate } else { 0.0 }));
        dyp.clear();
        dyp.resize(dy.len(), 0.0);
        if dy.is_empty() {
            return Some(&self.flow);
        }
        let mut right = std::mem::take(&mut self.correction);
        state.directional(at, &self.flow.dy, &self.flow.dyp, &mut right);
        right.iter_mut().for_each(|right| *right = -*right);
        if state.moves_by_time(Function::Residual) {
            let by_time = state.by_time(Function::Residual, at);
            let pairs = right.iter_mut().zip(by_time);
            pairs.for_each(|(right, by_time)| *right -= by_time);
        }
        let factored = self.factor_at(state, at);
        if let (Ok(()), Some(solver)) = (&factored, &mut self.solver) {
            solver.solve(&mut right);
        }
        let Flow { dy, dyp } = &mut self.flow;
        let unknowns = dy.iter_mut().zip(dyp).zip(&state.differential);
        for (((dy, dyp), state), solved) in unknowns.zip(&right) {
            (*dy, *dyp) = if *state {
                (*dy, *solved)
            } else {
                (*solved, 0.0)
            };
        }
        self.correction = right;
        factored.ok().filter(|()| self.solver.is_some())?;
        Some(&self.flow)
    }

    /// Corrects the derivatives of consistent values by parameters: each right side is what the linearised equations leave,
    /// and becomes the correction of the rates of states and of the algebraic variables. Whether there is one.
    pub(crate) fn correct(
        &mut self,
        state: &mut State<'_>,
        at: At<'_>,
        rights: &mut [Vec<f64>],
    ) -> bool {
        if self.solver.is_none() {
            return true;
        }
        if self.factor_at(state, at).is_err() {
            return false;
        }
        if let Some(solver) = &mut self.solver {
            rights.iter_mut().for_each(|right| solver.solve(right));
        }
        true
    }

    /// Consistent values while sliding, where the weights follow from the rates: those of an interpolant are less exact than
    /// its values. Else the values stay.
    pub(crate) fn refine(&mut self, state: &mut State<'_>, now: &mut Moment) {
        if !state.slides.is_empty() {
            self.make_exact(state, now);
        }
    }

    /// Consistent values with the states of an interpolant. Where there are none the values stay.
    pub(crate) fn make_exact(&mut self, state: &mut State<'_>, now: &mut Moment) {
        let before = now.clone();
        if self.solve(state, now, false).is_err() {
            *now = before;
        }
    }

    /// The same to a part of the values, by the factors of an earlier point as long as these serve.
    pub(crate) fn make_near(&mut self, state: &mut State<'_>, now: &mut Moment, part: f64) {
        let before = now.clone();
        if !self.by_old_factors(state, now, part) {
            *now = before;
            self.make_exact(state, now);
        }
    }

    /// Corrects by the factors at hand. Whether what is left is no more than a part of the values: by those of here the first
    /// correction is all, by others each unknown tells with its second what is still to come. A first that is small says
    /// nothing: beside a diode that conducted when the factors were made, volts are a correction of nanovolts.
    fn by_old_factors(&mut self, state: &mut State<'_>, now: &mut Moment, part: f64) -> bool {
        if self.factored.is_empty() || !state.slides.is_empty() {
            return false;
        }
        let coefficients = self.coefficients;
        let are_of_here = coefficients.is_some() && state.coefficients_at(now.at()) == coefficients;
        let mut last: Option<Vec<f64>> = None;
        for _ in 0..MOST_BY_OLD_FACTORS {
            if self.evaluate(state, now.at()).is_err() {
                return false;
            }
            self.correction.copy_from_slice(&self.residual);
            if let Some(solver) = &mut self.solver {
                solver.solve(&mut self.correction);
            }
            now.read_solved(&state.differential, &mut self.old);
            let values = &self.old;
            now.correct_solved(&state.differential, (values, &self.correction), 1.0);
            let pairs = self.correction.iter().enumerate();
            let left: Option<Vec<f64>> = match &last {
                None => are_of_here.then(|| self.correction.clone()),
                Some(last) => Some(pairs.map(|(i, own)| to_come(last[i], *own)).collect()),
            };
            let near = |left: Vec<f64>| {
                let finite = left.iter().all(|own| own.is_finite());
                finite && TOLERANCE * size(values, &left) <= part
            };
            if left.is_some_and(near) {
                return true;
            }
            last = Some(self.correction.clone());
        }
        false
    }

    fn evaluate(&mut self, state: &mut State<'_>, at: At<'_>) -> Result<(), Box<Failure>> {
        state.evaluate(Function::Residual, at, &mut self.residual);
        let Some(row) = self.residual.iter().position(|value| !value.is_finite()) else {
            return Ok(());
        };
        Err(Failure::new(FailureKind::NotFinite, at.t).at_row(state.program, row, at.y))
    }

    fn factor(
        &mut self,
        state: &mut State<'_>,
        at: At<'_>,
        at_start: bool,
    ) -> Result<(), Box<Failure>> {
        self.factor_at(state, at).map_err(|stopped| {
            singular::failure(state, &self.matrix, stopped.unknown, at, at_start)
        })
    }

    /// Factors the matrix at a point, unless the factors are its own.
    fn factor_at(&mut self, state: &mut State<'_>, at: At<'_>) -> Result<(), Singular> {
        let Some(solver) = &mut self.solver else {
            return Ok(());
        };
        let coefficients = state.coefficients_at(at);
        if coefficients.is_some() && coefficients == self.coefficients {
            return Ok(());
        }
        state.consistent_matrix(at, &mut self.matrix);
        if self.factored != self.matrix {
            self.coefficients = None;
            self.factored.clear();
            solver.factor(&self.matrix)?;
            self.factored.extend_from_slice(&self.matrix);
        }
        self.coefficients = coefficients;
        Ok(())
    }

    /// Takes the Newton step, halved until the residual does not grow, or the correction that follows from the same factors
    /// is smaller (the natural monotonicity test: Deuflhard, Newton Methods for Nonlinear Problems, §3.3): rows with large
    /// terms leave more by rounding than other rows have left to correct. Returns its size over the tolerance; of a halved
    /// one infinity.
    fn take_step(&mut self, state: &mut State<'_>, now: &mut Moment) -> Result<f64, Box<Failure>> {
        let before = norm(&self.residual);
        let mut factor = 1.0;
        let mut whole = false;
        let mut old = std::mem::take(&mut self.old);
        now.read_solved(&state.differential, &mut old);
        for halving in 0..=MAX_HALVINGS {
            now.correct_solved(&state.differential, (&old, &self.correction), factor);
            let finite = self.evaluate(state, now.at());
            let after = norm(&self.residual);
            // Near the solution the residual is rounding and may as well grow.
            let rounding = 1e-13 * before.max(1e-300);
            if finite.is_ok()
                && (after <= before
                    || after <= rounding
                    || halving == MAX_HALVINGS
                    || is_rounding(&old, &self.correction)
                    || self.next_size(&old) <= (1.0 - 0.5 * factor) * self.size(&old))
            {
                whole = halving == 0;
                break;
            }
            if halving == MAX_HALVINGS {
                finite?;
            }
            factor *= 0.5;
        }
        let size = match whole {
            true => self.size(&old),
            false => f64::INFINITY,
        };
        self.old = old;
        Ok(size)
    }

    /// What a row leaves, over what its terms amount to: the most of all rows. The derivatives are those of the last
    /// factorisation.
    fn left_over_terms(&mut self, state: &State<'_>, at: At<'_>) -> f64 {
        self.terms.iter_mut().for_each(|terms| *terms = 0.0);
        let terms = &mut self.terms;
        let add = |terms: &mut f64, term: f64| *terms += term.abs();
        let jacobian = state.program.jacobian();
        jacobian.products(state.partials.values(), (at.y, at.yp), terms, add);
        largest_part(&self.residual, &self.terms)
    }

    /// The size of the correction that the residual asks for by the factors at hand.
    fn next_size(&mut self, values: &[f64]) -> f64 {
        let Some(solver) = &mut self.solver else {
            return f64::INFINITY;
        };
        let mut next = self.residual.clone();
        solver.solve(&mut next);
        size(values, &next)
    }

    fn size(&self, values: &[f64]) -> f64 {
        size(values, &self.correction)
    }
}

/// The largest correction over its tolerance.
fn size(values: &[f64], corrections: &[f64]) -> f64 {
    let beside = 1e-3 * largest_of(values);
    largest_correction(corrections, values, (TOLERANCE, beside, LEAST_TOLERANCE))
}

/// Whether corrections of these values are so small that they may be rounding.
pub(crate) fn is_rounding(values: &[f64], corrections: &[f64]) -> bool {
    size(values, corrections) <= ROUNDING
}

fn largest(values: &[f64]) -> usize {
    let by_size = values
        .iter()
        .enumerate()
        .max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    by_size.map_or(0, |(index, _)| index)
}
