//! Sensitivities between events: the linearised equations along the solution, by Radau IIA of order 5.
//!
//! The path of the solution gives its values at the three stages, so that the Jacobian is the exact one there, and the
//! linear system of the stages is solved directly, once for all parameters. A one-step method needs no past: an event costs
//! it nothing, and a step is as long as the embedded formula of order 3 allows, over many of the solver's or a part of one:
//! sensitivities move where the solution rests. E. Hairer, G. Wanner: Solving Ordinary Differential Equations II (1996), §IV.5 and §IV.8.
//! The tolerance of a sensitivity is that of its variable over the size of the parameter, as in IDAS (User
//! Documentation, §5.2).

use super::{Sensitivities, Slopes};
use crate::integrator::Integrator;
use crate::results::GradientEndKind;
use hyde_ida::{LinearMethod, Pattern, SparseSolver};
use hyde_program::{Function, Jacobian, Program};

const STAGES: usize = 3;
/// 1 over the real eigenvalue of the inverse of the method's matrix: the weight of the first rate in the embedded formula.
const FIRST_WEIGHT: f64 = 0.274_888_829_595_677_36;
/// The error of a step by the embedded formula, which overestimates that of the method, over the largest sensitivity.
const RTOL: f64 = 1e-5;
/// A step is not made shorter than this part of what is asked for.
const LEAST_PART: f64 = 1e-6;

/// The method: nodes, matrix, and the values at 0 of the polynomials through the nodes.
struct Method {
    nodes: [f64; STAGES],
    matrix: [[f64; STAGES]; STAGES],
    at_zero: [f64; STAGES],
}

impl Method {
    fn radau() -> Self {
        let root = 6.0_f64.sqrt();
        let nodes = [(4.0 - root) / 10.0, (4.0 + root) / 10.0, 1.0];
        let at_zero = std::array::from_fn(|i| {
            let others = nodes.iter().enumerate().filter(|(j, _)| *j != i);
            others.map(|(_, node)| -node / (nodes[i] - node)).product()
        });
        Self {
            nodes,
            matrix: [
                [
                    (88.0 - 7.0 * root) / 360.0,
                    (296.0 - 169.0 * root) / 1800.0,
                    (-2.0 + 3.0 * root) / 225.0,
                ],
                [
                    (296.0 + 169.0 * root) / 1800.0,
                    (88.0 + 7.0 * root) / 360.0,
                    (-2.0 - 3.0 * root) / 225.0,
                ],
                [(16.0 - root) / 36.0, (16.0 + root) / 36.0, 1.0 / 9.0],
            ],
            at_zero,
        }
    }
}

/// The linear solver of the stages, and the step it likes.
pub(super) struct Propagator {
    method: Method,
    /// None where there is nothing to solve.
    solver: Option<SparseSolver>,
    /// Where each column of the Jacobian starts.
    starts: Vec<usize>,
    rows: Vec<usize>,
    matrix: Vec<f64>,
    by_value: Vec<f64>,
    by_rate: Vec<f64>,
    step_s: f64,
    /// The largest value of each sensitivity so far.
    largest: Vec<Vec<f64>>,
}

impl Propagator {
    pub(super) fn new(program: &Program) -> Self {
        let jacobian = program.jacobian();
        let n = program.n_unknowns;
        let index = |value: &i64| usize::try_from(*value).unwrap_or(0);
        let starts: Vec<usize> = jacobian.column_starts.iter().map(index).collect();
        let rows: Vec<usize> = jacobian.rows.iter().map(index).collect();
        let count = jacobian.len();
        let wide = |value: usize| i64::try_from(value).unwrap_or(i64::MAX);
        // Three stages by three: every block has the pattern of the Jacobian.
        let mut all_starts = vec![0_i64];
        let mut all_rows = Vec::with_capacity(STAGES * STAGES * count);
        for _ in 0..STAGES {
            for column in 0..n {
                for stage in 0..STAGES {
                    let own = &rows[starts[column]..starts[column + 1]];
                    all_rows.extend(own.iter().map(|row| wide(row + stage * n)));
                }
                all_starts.push(wide(all_rows.len()));
            }
        }
        let pattern = Pattern::new(STAGES * n, all_starts, all_rows).ok();
        let solver = pattern
            .filter(|_| n > 0)
            .and_then(|pattern| SparseSolver::new(pattern, LinearMethod::Auto).ok());
        Self {
            method: Method::radau(),
            solver,
            starts,
            rows,
            matrix: vec![0.0; STAGES * STAGES * count],
            by_value: vec![0.0; count],
            by_rate: vec![0.0; count],
            step_s: f64::INFINITY,
            largest: Vec::new(),
        }
    }

    /// Puts the derivatives at one stage in their places: unknown are the rates of states and the values of the others.
    fn place_stage(&mut self, stage: usize, step_s: f64, differential: &[bool]) {
        let count = self.rows.len();
        for (column, differential) in differential.iter().enumerate() {
            let (first, end) = (self.starts[column], self.starts[column + 1]);
            for other in 0..STAGES {
                let base = STAGES * (other * count + first) + stage * (end - first);
                let own = f64::from(u8::from(other == stage));
                let factor = step_s * self.method.matrix[stage][other];
                for (place, entry) in (base..).zip(first..end) {
                    self.matrix[place] = if *differential {
                        factor * self.by_value[entry] + own * self.by_rate[entry]
                    } else {
                        own * self.by_value[entry]
                    };
                }
            }
        }
    }
}

/// What a step leads to.
struct Step {
    slopes: Slopes,
    /// Its error over the tolerance.
    error: f64,
}

impl Sensitivities {
    /// Takes note of the solver's last step, which began at `from`.
    pub(crate) fn note_step(&mut self, integrator: &mut Integrator<'_>, from: f64) {
        if self.propagator.solver.is_some() && self.end.is_none() {
            self.path.add_step(integrator, from);
        }
    }

    /// Goes on by a step of its own if one has room up to `end`, where the solver's last step ends.
    pub(crate) fn follow(&mut self, integrator: &mut Integrator<'_>, end: f64) {
        let next = self.t + self.propagator.step_s;
        if next <= end {
            self.advance(integrator, next);
        } else if self.path.is_full() {
            self.advance(integrator, end);
        }
    }

    /// Goes on to a time on the path.
    pub(crate) fn advance(&mut self, integrator: &mut Integrator<'_>, to: f64) {
        if self.propagator.solver.is_none() {
            self.t = to;
            return;
        }
        let least = LEAST_PART * (to - self.t);
        while self.end.is_none() && self.t < to {
            let left = to - self.t;
            // What is left is not cut into a long and a tiny step.
            let step_s = match self.propagator.step_s {
                step if step >= left => left,
                step if step > 0.5 * left => 0.5 * left,
                step => step,
            };
            let Some(step) = self.step(integrator, step_s) else {
                self.stop(self.t, GradientEndKind::Singular);
                return;
            };
            // Order 3 of the embedded formula.
            let factor = (0.9 * step.error.powf(-0.25)).clamp(0.2, 5.0);
            if step.error > 1.0 && step_s > least {
                self.propagator.step_s = factor.min(0.9) * step_s;
                continue;
            }
            self.now = step.slopes;
            self.t = if step_s >= left { to } else { self.t + step_s };
            self.propagator.step_s = self.propagator.step_s.min(step_s).max(factor * step_s);
            self.remember_largest();
        }
        self.path.forget(self.t);
    }

    /// One step; none where the linear system is singular.
    fn step(&mut self, integrator: &mut Integrator<'_>, step_s: f64) -> Option<Step> {
        let n = self.propagator.starts.len() - 1;
        let m = self.directions.len();
        let jacobian: &Jacobian = integrator.state().program.jacobian();
        let mut then = integrator.room(self.t);
        let mut rights = vec![vec![0.0; STAGES * n]; m];
        // The right sides are what is left with the states as they were and zeros for all that is unknown.
        let before = self.now.clone();
        let differential = integrator.state().differential.clone();
        for (slopes, rates) in self.now.y.iter_mut().zip(&mut self.now.yp) {
            rates.fill(0.0);
            let pairs = slopes.iter_mut().zip(&differential);
            pairs
                .filter(|(_, state)| !**state)
                .for_each(|(slope, _)| *slope = 0.0);
        }
        for stage in 0..STAGES {
            then.t = self.t + self.propagator.method.nodes[stage] * step_s;
            self.path.read(&mut then);
            let state = integrator.state_mut();
            let values = self.of(Function::Residual, state, then.at());
            for (right, values) in rights.iter_mut().zip(values) {
                right[stage * n..][..n].copy_from_slice(&values);
            }
            state.residual_partials(then.at());
            let propagator = &mut self.propagator;
            jacobian.assemble(state.partials.values(), 1.0, 0.0, &mut propagator.by_value);
            jacobian.assemble(state.partials.values(), 0.0, 1.0, &mut propagator.by_rate);
            propagator.place_stage(stage, step_s, &differential);
        }
        let Propagator {
            solver,
            matrix,
            method,
            ..
        } = &mut self.propagator;
        let solver = solver.as_mut()?;
        if solver.factor(matrix).is_err() {
            self.now = before;
            return None;
        }
        rights.iter_mut().for_each(|right| solver.solve(right));
        let mut slopes = before.clone();
        let mut differences = vec![vec![0.0; n]; m];
        for (number, right) in rights.iter().enumerate() {
            for index in 0..n {
                let stage = |stage: usize| -right[stage * n + index];
                let rates: [f64; STAGES] = std::array::from_fn(stage);
                if !differential[index] {
                    slopes.y[number][index] = rates[STAGES - 1];
                    continue;
                }
                let sum = |weights: &[f64; STAGES]| -> f64 {
                    weights.iter().zip(rates).map(|(w, rate)| w * rate).sum()
                };
                slopes.y[number][index] += step_s * sum(&method.matrix[STAGES - 1]);
                slopes.yp[number][index] = rates[STAGES - 1];
                let first = before.yp[number][index];
                differences[number][index] = FIRST_WEIGHT * step_s * (first - sum(&method.at_zero));
            }
        }
        self.now = before;
        let error = self.error(integrator, &slopes, &differences);
        Some(Step { slopes, error })
    }

    /// The largest error over its tolerance.
    fn error(&self, integrator: &Integrator<'_>, after: &Slopes, errors: &[Vec<f64>]) -> f64 {
        let (rtol, atol) = integrator.tolerances();
        let of_solution = integrator.largest();
        let mut most = 0.0_f64;
        for (number, errors) in errors.iter().enumerate() {
            let largest = self.propagator.largest.get(number);
            for (index, error) in errors.iter().enumerate() {
                let known = largest.map_or(0.0, |largest| largest[index]);
                let size = known.max(after.y[number][index].abs());
                let floor = (rtol * of_solution[index] + atol) / self.sizes[number];
                most = most.max(error.abs() / (RTOL * size + floor));
            }
        }
        if most.is_nan() { f64::INFINITY } else { most }
    }

    fn remember_largest(&mut self) {
        let (largest, now) = (&mut self.propagator.largest, &self.now.y);
        if largest.is_empty() {
            largest.clone_from(now);
        }
        for (largest, now) in largest.iter_mut().flatten().zip(now.iter().flatten()) {
            *largest = largest.max(now.abs());
        }
    }

    /// The solution starts anew. A step that was right before is not too long a beginning.
    pub(super) fn start_anew(&mut self) {
        self.path.clear();
    }
}
