//! Switching surfaces g(t, y) = 0: how far the run is from them, where they lead, and how it is put on them.

use super::State;
use crate::moment::{At, Moment};
use hyde_program::{Function, Wrt};

impl State<'_> {
    /// The root functions.
    pub(crate) fn heights(&mut self, at: At<'_>) -> Vec<f64> {
        let mut roots = vec![0.0; self.program.relations.len()];
        self.evaluate_side(Function::Roots, at, &mut roots);
        roots
    }

    /// One root function.
    pub(crate) fn height(&mut self, relation: usize, at: At<'_>) -> f64 {
        self.heights(at)[relation]
    }

    /// The derivatives of a root function by the unknowns.
    pub(crate) fn gradient(&mut self, relation: usize, at: At<'_>) -> Vec<(usize, f64)> {
        let values = self.partials_side(Function::Roots, at);
        let entries = self.program.partials(Function::Roots).iter().zip(values);
        entries
            .filter_map(|(entry, value)| match entry.wrt {
                Wrt::Unknown(column) if entry.row == relation => Some((column, value)),
                Wrt::Unknown(_)
                | Wrt::Derivative(_)
                | Wrt::Delayed(_)
                | Wrt::Parameter(_)
                | Wrt::Memory(_)
                | Wrt::Time => None,
            })
            .collect()
    }

    /// The rates of root functions of states along the flow.
    pub(crate) fn height_rates(&mut self, relations: &[usize], at: At<'_>) -> Vec<f64> {
        let program = self.program;
        let mut rates = vec![0.0; program.relations.len()];
        let given = !program.columns.is_empty() || !program.delays.is_empty();
        let values = self.partials_side(Function::Roots, at);
        for (entry, value) in program.partials(Function::Roots).iter().zip(values) {
            rates[entry.row] += match entry.wrt {
                Wrt::Unknown(column) => value * at.yp[column],
                Wrt::Time if !given => value,
                Wrt::Time
                | Wrt::Derivative(_)
                | Wrt::Delayed(_)
                | Wrt::Parameter(_)
                | Wrt::Memory(_) => 0.0,
            };
        }
        if given {
            // Record columns and delayed values move with the time, and have no other derivative.
            let step = self.inputs.difference_s(at.t);
            let (now, later) = (self.heights(at), self.heights(at.later(step)));
            for (rate, (now, later)) in rates.iter_mut().zip(now.iter().zip(&later)) {
                *rate += (later - now) / step;
            }
        }
        relations.iter().map(|&relation| rates[relation]).collect()
    }

    /// The rate of one root function of states along the flow.
    pub(crate) fn height_rate(&mut self, relation: usize, at: At<'_>) -> f64 {
        self.height_rates(&[relation], at)[0]
    }

    /// Whether a root function depends on states alone, and on one at least: then its rate is known with the states'.
    pub(crate) fn is_of_states(&self, relation: usize) -> bool {
        let mut entries = self.program.partials(Function::Roots).iter();
        let mut any = false;
        let only = entries
            .by_ref()
            .filter(|entry| entry.row == relation)
            .all(|entry| match entry.wrt {
                Wrt::Unknown(column) => {
                    any = true;
                    self.differential[column]
                }
                Wrt::Derivative(_) => false,
                Wrt::Delayed(_) | Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Time => true,
            });
        only && any
    }

    /// Puts y exactly on the surfaces: the solver meets them to its tolerance.
    #[inline]
    pub(crate) fn put_on_surfaces(&mut self, now: &mut Moment) {
        if !self.slides.is_empty() {
            self.put_on(now);
        }
    }

    fn put_on(&mut self, now: &mut Moment) {
        // Once for each slide, and again where they depend on each other or bend.
        for _ in 0..3 {
            let heights = self.heights(now.at());
            if self
                .slides
                .iter()
                .all(|slide| heights[slide.surface] == 0.0)
            {
                return;
            }
            for slide in self.slides.clone() {
                let height = self.height(slide.surface, now.at());
                if height == 0.0 {
                    continue;
                }
                let along: f64 = self
                    .gradient(slide.surface, now.at())
                    .into_iter()
                    .map(|(column, value)| value * slide.direction[column])
                    .sum();
                let length = height / along;
                if length.is_finite() {
                    let parts = now.y.iter_mut().zip(&slide.direction);
                    parts.for_each(|(y, direction)| *y -= length * direction);
                }
            }
        }
    }
}
