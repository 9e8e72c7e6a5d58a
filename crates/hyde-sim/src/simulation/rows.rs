//! Rows of the results: on the grid asked for, and on both sides of an event.

use super::Simulation;
use crate::setup::same_instant;
use hyde_program::Function;

impl Simulation<'_> {
    /// Rows of the results up to and including `end`, from the interpolant; one at the end itself waits for its events.
    pub(super) fn rows_until(&mut self, end: f64) {
        while let Some(&t) = self.setup.rows_s.get(self.next_row) {
            if t > end || same_instant(t, end) && self.waits(end) {
                return;
            }
            let t = t.min(end);
            let n = self.program.n_unknowns;
            let (mut y, mut yp) = (vec![0.0; n], vec![0.0; n]);
            self.integrator.interpolate(t, &mut y, &mut yp);
            let state = self.integrator.state_mut();
            self.consistent.refine(state, t, &mut y, &mut yp);
            let values = self.values_at(t, &y, &yp);
            self.push_row((t, values));
            self.next_row += 1;
        }
    }

    /// Whether something happens at this instant that a row must show from both sides.
    fn waits(&self, t: f64) -> bool {
        self.schedule.due(t)
            || self.integrator.state().delays.due(t)
            || !self.schedule.relations_at(t).is_empty()
            || same_instant(
                self.integrator
                    .state()
                    .inputs
                    .next_jump(t - 1e-9 * (1.0 + t.abs())),
                t,
            )
            || t < self.integrator.t
    }

    pub(super) fn row_is_due(&self) -> bool {
        self.setup
            .rows_s
            .get(self.next_row)
            .is_some_and(|&row| same_instant(row, self.integrator.t))
    }

    pub(super) fn row(&mut self) {
        let values = self.row_values();
        self.push_row(values);
    }

    pub(super) fn row_values(&mut self) -> (f64, Vec<f64>) {
        let (t, y, yp) = (
            self.integrator.t,
            self.integrator.y.clone(),
            self.integrator.yp.clone(),
        );
        let values = self.values_at(t, &y, &yp);
        (t, values)
    }

    pub(super) fn values_at(&mut self, t: f64, y: &[f64], yp: &[f64]) -> Vec<f64> {
        let mut outputs = std::mem::take(&mut self.outputs);
        self.integrator
            .state_mut()
            .evaluate(Function::Outputs, t, y, yp, &mut outputs);
        let values = self
            .results
            .outputs
            .iter()
            .map(|&output| outputs[output])
            .collect();
        self.outputs = outputs;
        values
    }

    pub(super) fn push_row(&mut self, (t, values): (f64, Vec<f64>)) {
        self.results.time.push(t);
        for (column, value) in self.results.columns.iter_mut().zip(values) {
            column.push(value);
        }
    }
}
