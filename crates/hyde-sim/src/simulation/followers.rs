//! [`Followers`]: what goes along with a run and leaves it as it is: rows, the energy ledger, reductions, derivatives by
//! parameters, times in modes, and what is delayed.
//!
//! ```text
//! started                the start, and again behind the ticks there
//! stepped                a step of the solver, up to the first crossing in it
//! at_crossing, at_end    where the run stands then
//! left, settled, right   an instant: before what happens there, after events, and after everything
//! ended                  the end of the run, or its failure
//! ```

use super::reduce::Reduced;
use super::rows::{Row, Rows};
use super::run::Run;
use crate::delays::Limits;
use crate::meter::Meter;
use crate::past;
use crate::results::Results;
use crate::sensitivity::{Cause, Sensitivities};
use crate::setup::Setup;
use crate::state::State;
use crate::time_spent::count_modes;
use hyde_program::{Function, Program};

/// The followers of a run; those that nothing asks for cost nothing.
pub(super) struct Followers<'a> {
    pub(super) rows: Rows<'a>,
    meter: Option<Meter<'a>>,
    reduced: Option<Reduced<'a>>,
    /// They go along with events as well.
    pub(super) sensitivities: Option<Sensitivities>,
}

/// What they keep of the left side of an instant.
pub(super) struct Left {
    row: Row,
    delayed: Option<Limits>,
    /// All outputs, for the energy ledger.
    metered: Option<Vec<f64>>,
}

impl<'a> Followers<'a> {
    pub(super) fn new(
        program: &'a Program,
        setup: &'a Setup<'a>,
        state: &State<'_>,
        sensitivities: Option<Sensitivities>,
    ) -> Self {
        Self {
            rows: Rows::new(program, setup),
            meter: Meter::new(&program.experiment.ledger),
            reduced: Reduced::new(program, setup, state),
            sensitivities,
        }
    }

    /// Takes in the values at the start.
    pub(super) fn started(&mut self, run: &mut Run<'_, 'a>) {
        self.row(run).push(run.results);
        self.point(run);
    }

    /// Takes in a step, or the part of it up to a crossing; rows on the way are taken.
    pub(super) fn stepped(&mut self, run: &mut Run<'_, 'a>, (from, to): (f64, f64)) {
        if let Some(meter) = &mut self.meter {
            meter.step(run.integrator, run.consistent, (from, to));
        }
        if let Some(reduced) = &mut self.reduced {
            reduced.step(run, (from, to));
        }
        if let Some(sensitivities) = &mut self.sensitivities {
            sensitivities.note_step(run.integrator, from);
        }
        self.rows.until(run, &mut self.sensitivities, to);
        if let Some(sensitivities) = &mut self.sensitivities {
            sensitivities.follow(run.integrator, to);
        }
        count_modes(run.integrator, run.results, to - from);
        past::record(run.integrator, run.consistent, (from, to));
    }

    /// The run stands at the end of a step; whether there is something to work on.
    pub(super) fn at_end(&mut self, run: &mut Run<'_, 'a>, works: bool) {
        if let Some(sensitivities) = &mut self.sensitivities {
            sensitivities.remember_heights(run.integrator);
        }
        if works {
            self.at_crossing(run);
        }
    }

    /// The run stands at a crossing.
    pub(super) fn at_crossing(&mut self, run: &mut Run<'_, 'a>) {
        if let Some(sensitivities) = &mut self.sensitivities {
            let t = run.integrator.now.t;
            sensitivities.advance(run.integrator, t);
        }
    }

    /// Takes in the left side of an instant.
    pub(super) fn left(&mut self, run: &mut Run<'_, 'a>, cause: &Cause) -> Left {
        let delayed = past::limits(run.integrator, Some(run.consistent));
        let row = self.row(run);
        if let Some(sensitivities) = &mut self.sensitivities {
            sensitivities.begin(run.integrator, run.consistent, cause);
        }
        self.point(run);
        let metered = self.meter.as_ref().map(|_| self.rows.outputs().to_vec());
        Left {
            row,
            delayed,
            metered,
        }
    }

    /// Events have led to other values.
    pub(super) fn settled(&mut self, run: &mut Run<'_, 'a>) {
        if let Some(sensitivities) = &mut self.sensitivities {
            sensitivities.finish(run.integrator, run.consistent);
        }
    }

    /// Takes in the right side of an instant. The rows show both sides where something `happened`, or where what is held
    /// has `stepped` and they are fine enough for it.
    pub(super) fn right(
        &mut self,
        run: &mut Run<'_, 'a>,
        left: Left,
        (happened, stepped): (bool, bool),
    ) {
        if let (Some(meter), Some(before)) = (&mut self.meter, left.metered) {
            let (state, now) = run.integrator.state_now();
            meter.instant(&before, &state.values(Function::Outputs, now));
        }
        self.point(run);
        let on_grid = self.rows.are_due(run.integrator.now.t);
        let both = happened || stepped && self.rows.show_steps(on_grid, run.schedule);
        if both {
            left.row.push(run.results);
        }
        if both || on_grid {
            self.row(run).push(run.results);
        }
        if on_grid {
            self.rows.skip();
        }
        past::mark(run.integrator, run.consistent, left.delayed);
    }

    /// Takes in one side of an instant, as a point that signals are reduced with.
    pub(super) fn point(&mut self, run: &mut Run<'_, 'a>) {
        if let Some(reduced) = &mut self.reduced {
            reduced.point(run);
        }
    }

    /// What is known at the end.
    pub(super) fn ended(&mut self, results: &mut Results) {
        if let (Some(gradient), Some(sensitivities)) =
            (&mut results.gradient, &mut self.sensitivities)
        {
            gradient.end = sensitivities.end.take();
        }
        if let Some(reduced) = &self.reduced {
            results.reductions = reduced.finish();
        }
        results.energies = self.meter.as_ref().map(Meter::sums);
    }

    /// A row of the values now.
    fn row(&mut self, run: &mut Run<'_, 'a>) -> Row {
        let (state, now) = run.integrator.state_now();
        self.rows.row(state, self.sensitivities.as_ref(), now)
    }
}
