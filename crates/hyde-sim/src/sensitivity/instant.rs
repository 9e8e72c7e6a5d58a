//! Sensitivities at an instant (S1): by how much it moves with the parameters, and what becomes of them there.
//!
//! While an instant is worked on the derivatives go along with it: s + f dt/dp. So what an event assigns and what a mode
//! fixes are derivatives through everything they read, however many rounds there are; at the end the flow after it takes
//! its share off again, s - f dt/dp.

use super::Sensitivities;
use crate::consistent::{Consistent, Flow};
use crate::integrator::Integrator;
use crate::moment::At;
use crate::results::GradientEndKind;
use crate::root_rates::rates_at;
use hyde_program::{Constant, Function, Target};

/// Why there is an instant to work on.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Cause {
    /// A time that no parameter moves: a tick, a row of a record where it jumps.
    Time,
    /// Scheduled relations.
    Scheduled(Vec<usize>),
    /// A root function crosses zero, in a step that began at this time.
    Crossing { relation: usize, from: f64 },
}

impl Sensitivities {
    /// Makes the derivatives go along with an instant, at its left limit.
    pub(crate) fn begin(
        &mut self,
        integrator: &mut Integrator<'_>,
        consistent: &mut Consistent,
        cause: &Cause,
    ) {
        if self.end.is_some() {
            return;
        }
        if matches!(cause, Cause::Time) {
            return;
        }
        let now = integrator.now.clone();
        let at = now.at();
        self.be_consistent(integrator.state_mut(), consistent, at);
        match cause {
            Cause::Time => {}
            Cause::Scheduled(relations) => {
                let state = integrator.state();
                let kernels = &state.program.kernels;
                let of = |&relation: &usize| {
                    kernels.instant_partials(Constant::TimeEvent(relation), &state.p)
                };
                let slopes = relations.first().map(of).unwrap_or_default();
                for (moves, direction) in self.moves.iter_mut().zip(&self.directions) {
                    let terms = slopes
                        .iter()
                        .map(|(place, slope)| slope * direction[*place]);
                    *moves = terms.sum();
                }
            }
            Cause::Crossing { relation, from } => {
                self.cross(integrator, consistent, at, *relation, *from);
            }
        }
        if self.moves.iter().all(|moves| *moves == 0.0) {
            return;
        }
        let Some(Flow { dy, dyp }) = consistent.flow(integrator.state_mut(), at) else {
            self.stop(at.t, GradientEndKind::Singular);
            return;
        };
        for (number, moves) in self.moves.iter().enumerate() {
            for index in 0..at.y.len() {
                self.now.y[number][index] += dy[index] * moves;
                self.now.yp[number][index] += dyp[index] * moves;
            }
        }
    }

    /// By how much the zero of a root function moves: dt/dp = -g_s/(g along the flow). A root function that hardly
    /// crosses zero has none: were it higher by less than the tolerance, it would not.
    fn cross(
        &mut self,
        integrator: &mut Integrator<'_>,
        consistent: &mut Consistent,
        at: At<'_>,
        relation: usize,
        from: f64,
    ) {
        let program = integrator.state().program;
        if relation >= program.relations.len() {
            self.stop(at.t, GradientEndKind::Sliding);
            return;
        }
        let slopes = self.of(Function::Roots, integrator.state_mut(), at);
        let rates = rates_at(Function::Roots, integrator.state_mut(), consistent, at);
        let Some((rates, _)) = rates else {
            self.stop(at.t, GradientEndKind::Singular);
            return;
        };
        let rate = rates[relation];
        // A parabola through the zero, with its slope there and the value where the step began.
        let before = root_at(integrator, from, relation);
        let height = self.heights[relation].max(before.abs());
        let (rtol, _) = integrator.tolerances();
        let step_s = at.t - from;
        let bent = (before + rate * step_s).abs() - rtol * height;
        let bend = 2.0 * bent.max(0.0) / (step_s * step_s);
        let beyond = 0.5 * rate * rate / bend;
        if rate == 0.0 || beyond < rtol * height {
            self.stop_at(program, at.t, GradientEndKind::Grazing, relation);
            return;
        }
        for (moves, slopes) in self.moves.iter_mut().zip(slopes) {
            *moves = -slopes[relation] / rate;
        }
        self.heights[relation] = 0.0;
    }

    /// What was assigned has the derivatives of a row of the function of assignments.
    pub(crate) fn assign(&mut self, target: Target, values: &[Vec<f64>], row: usize) {
        let (slopes, position) = match target {
            Target::State(position) => (&mut self.now.y, position),
            Target::Memory(position) => (&mut self.now.z, position),
        };
        for (slopes, values) in slopes.iter_mut().zip(values) {
            slopes[position] = values[row];
        }
    }

    /// The derivatives at a fixed time again, from the values after the instant.
    pub(crate) fn finish(&mut self, integrator: &mut Integrator<'_>, consistent: &mut Consistent) {
        if self.end.is_some() {
            return;
        }
        if let Some(slide) = integrator.state().slides.first() {
            let (program, t) = (integrator.state().program, integrator.now.t);
            let surface = slide.surface;
            self.stop_at(program, t, GradientEndKind::Sliding, surface);
            return;
        }
        let now = integrator.now.clone();
        let differential = &integrator.state().differential;
        for (slopes, moves) in self.now.y.iter_mut().zip(&mut self.moves) {
            let states = slopes.iter_mut().zip(&now.yp).zip(differential);
            for ((slope, rate), _) in states.filter(|(_, differential)| **differential) {
                *slope -= rate * *moves;
            }
            *moves = 0.0;
        }
        self.be_consistent(integrator.state_mut(), consistent, now.at());
        self.start_anew();
    }

    /// Keeps the largest values of root functions, at the end of a step.
    pub(crate) fn remember_heights(&mut self, integrator: &mut Integrator<'_>) {
        let now = integrator.now.clone();
        let state = integrator.state_mut();
        let roots = state.values(Function::Roots, now.at());
        for (height, root) in self.heights.iter_mut().zip(roots) {
            if root.is_finite() {
                *height = height.max(root.abs());
            }
        }
    }
}

fn root_at(integrator: &mut Integrator<'_>, t: f64, relation: usize) -> f64 {
    let mut then = integrator.room(t);
    integrator.interpolate(&mut then);
    let state = integrator.state_mut();
    let roots = state.values(Function::Roots, then.at());
    roots[relation]
}
