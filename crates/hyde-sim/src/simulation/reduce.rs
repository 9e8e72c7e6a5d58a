//! What of a run becomes one number: each stretch of the solution, and both sides of each instant.

use super::Simulation;
use crate::reductions::Reductions;
use crate::setup::Setup;
use crate::state::State;
use hyde_program::{Function, Program, SomeRows, Wrt};

/// What becomes one number of a run.
pub(super) struct Reduced<'a> {
    pub(super) reductions: Reductions,
    /// The kernel of what they read.
    kernel: Box<dyn SomeRows + 'a>,
    /// Whether they read rates of states, or what is not a state.
    reads_more_than_states: bool,
}

impl<'a> Reduced<'a> {
    pub(super) fn new(program: &'a Program, setup: &Setup<'_>, state: &State<'_>) -> Option<Self> {
        let reductions = Reductions::new(&setup.reductions, setup.reduced_from_s)?;
        let outputs = reductions.outputs();
        let kernel = program.kernels.some_rows(Function::Outputs, outputs);
        let entries = program.kernels.entries(Function::Outputs).into_iter();
        let mut read = entries.filter(|entry| outputs.contains(&entry.row));
        let reads_more_than_states = read.any(|entry| match entry.wrt {
            Wrt::Derivative(_) => true,
            Wrt::Unknown(place) => !state.differential[place],
            Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => false,
        });
        Some(Self {
            reductions,
            kernel,
            reads_more_than_states,
        })
    }
}

impl Simulation<'_> {
    /// Takes in a stretch of the last step. Where the solver's polynomial is good for states alone, rates and what is not a
    /// state follow from them by the equations.
    pub(super) fn reduce_stretch(&mut self, from: f64, to: f64) {
        let Some(mut reduced) = self.reduced.take() else {
            return;
        };
        let mut then = self.integrator.room(from);
        reduced.reductions.stretch(from, to, &mut |t, out| {
            then.t = t;
            self.integrator.interpolate(&mut then);
            let inside = t.to_bits() != self.integrator.now.t.to_bits();
            let rough = inside && self.integrator.shows_states_alone();
            let state = self.integrator.state_mut();
            if rough && reduced.reads_more_than_states {
                self.consistent.make_exact(state, &mut then);
            } else {
                self.consistent.refine(state, &mut then);
            }
            state.evaluate_rows(&*reduced.kernel, then.at(), out);
        });
        self.reduced = Some(reduced);
        self.name_what_is_not_a_number();
    }

    /// Takes in the values now: one side of an instant.
    pub(super) fn reduce_instant(&mut self) {
        let Some(reduced) = &mut self.reduced else {
            return;
        };
        let mut values = vec![0.0; reduced.reductions.outputs().len()];
        let integrator = &mut self.integrator;
        let now = integrator.now.clone();
        let state = integrator.state_mut();
        state.evaluate_rows(&*reduced.kernel, now.at(), &mut values);
        reduced.reductions.point(now.t, &values);
        self.name_what_is_not_a_number();
    }

    /// Finds the variable that is not a number: one that the reduction is written with, else the first of all.
    fn name_what_is_not_a_number(&mut self) {
        let Some(reduced) = &self.reduced else {
            return;
        };
        for (number, t) in reduced.reductions.nameless() {
            let mut then = self.integrator.room(t);
            self.integrator.interpolate(&mut then);
            let mut values = vec![0.0; self.program.outputs.len()];
            let state = self.integrator.state_mut();
            state.evaluate(Function::Outputs, then.at(), &mut values);
            let text = &self.setup.reductions[number].text;
            let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '[' | ']');
            let outputs = self.program.outputs.iter().zip(&values);
            let bad = outputs.filter(|(output, value)| value.is_nan() && !output.auxiliary);
            let bad: Vec<&str> = bad.map(|(output, _)| output.name.as_str()).collect();
            let mut words = text.split(|c| !is_name(c));
            let written = words.find(|word| bad.contains(word));
            let name = written.or(bad.first().copied()).unwrap_or(text).to_owned();
            if let Some(reduced) = &mut self.reduced {
                reduced.reductions.name(number, name);
            }
        }
    }
}
