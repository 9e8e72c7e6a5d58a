//! [`Reduced`]: what of a run becomes one number each, from each stretch of the solution and both sides of each instant.

use super::run::Run;
use crate::reductions::Reductions;
use crate::results;
use crate::setup::Setup;
use crate::state::State;
use hyde_program::{Function, Program, SomeRows, Wrt};

/// What becomes one number of a run.
pub(super) struct Reduced<'a> {
    setup: &'a Setup<'a>,
    reductions: Reductions,
    /// The kernel of what they read.
    kernel: Box<dyn SomeRows + 'a>,
    /// Whether they read rates of states, or what is not a state.
    reads_more_than_states: bool,
}

impl<'a> Reduced<'a> {
    pub(super) fn new(
        program: &'a Program,
        setup: &'a Setup<'a>,
        state: &State<'_>,
    ) -> Option<Self> {
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
            setup,
            reductions,
            kernel,
            reads_more_than_states,
        })
    }

    /// Takes in a stretch of the last step. Where the solver's polynomial is good for states alone, rates and what is not a
    /// state follow from them by the equations.
    pub(super) fn step(&mut self, run: &mut Run<'_, '_>, (from, to): (f64, f64)) {
        let mut then = run.integrator.room(from);
        self.reductions.stretch(from, to, &mut |t, out| {
            then.t = t;
            run.integrator.interpolate(&mut then);
            let inside = t.to_bits() != run.integrator.now.t.to_bits();
            let rough = inside && run.integrator.shows_states_alone();
            let state = run.integrator.state_mut();
            if rough && self.reads_more_than_states {
                run.consistent.make_exact(state, &mut then);
            } else {
                run.consistent.refine(state, &mut then);
            }
            state.evaluate_rows(&*self.kernel, then.at(), out);
        });
        self.name_what_is_not_a_number(run);
    }

    /// Takes in the values now: one side of an instant.
    pub(super) fn point(&mut self, run: &mut Run<'_, '_>) {
        let mut values = vec![0.0; self.reductions.outputs().len()];
        let now = run.integrator.now.clone();
        let state = run.integrator.state_mut();
        state.evaluate_rows(&*self.kernel, now.at(), &mut values);
        self.reductions.point(now.t, &values);
        self.name_what_is_not_a_number(run);
    }

    /// What the run is reduced to.
    pub(super) fn finish(&self) -> Vec<results::Reduced> {
        self.reductions.finish()
    }

    /// Finds the variable that is not a number: one that the reduction is written with, else the first of all.
    fn name_what_is_not_a_number(&mut self, run: &mut Run<'_, '_>) {
        for (number, t) in self.reductions.nameless() {
            let mut then = run.integrator.room(t);
            run.integrator.interpolate(&mut then);
            let state = run.integrator.state_mut();
            let values = state.values(Function::Outputs, then.at());
            let text = &self.setup.reductions[number].text;
            let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '[' | ']');
            let outputs = state.program.outputs.iter().zip(&values);
            let bad = outputs.filter(|(output, value)| value.is_nan() && !output.auxiliary);
            let bad: Vec<&str> = bad.map(|(output, _)| output.name.as_str()).collect();
            let mut words = text.split(|c| !is_name(c));
            let written = words.find(|word| bad.contains(word));
            let name = written.or(bad.first().copied()).unwrap_or(text).to_owned();
            self.reductions.name(number, name);
        }
    }
}
