//! Rows of the results: on the grid asked for, and on both sides of an event.

use super::Simulation;
use crate::moment::At;
use crate::setup::same_instant;
use hyde_program::Function;

/// A row of the results.
pub(super) struct Row {
    t: f64,
    /// The outputs kept, each value once.
    values: Vec<f64>,
    /// Their derivatives by each parameter, if they are asked for.
    slopes: Vec<Vec<f64>>,
}

impl Simulation<'_> {
    /// Rows of the results up to and including `end`, from the interpolant; one at the end itself waits for its events.
    pub(super) fn rows_until(&mut self, end: f64) {
        while let Some(&t) = self.setup.rows_s.get(self.next_row) {
            if t > end || same_instant(t, end) && self.waits(end) {
                return;
            }
            let t = t.min(end);
            let mut then = self.integrator.room(t);
            self.integrator.solution(&mut then);
            let state = self.integrator.state_mut();
            self.consistent.refine(state, &mut then);
            let values = self.values_at(then.at());
            if let Some(sensitivities) = &mut self.sensitivities {
                sensitivities.advance(&mut self.integrator, t);
            }
            let slopes = self.slopes_at(then.at());
            self.push_row(Row { t, values, slopes });
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
            || t < self.integrator.now.t
    }

    pub(super) fn row_is_due(&self) -> bool {
        self.setup
            .rows_s
            .get(self.next_row)
            .is_some_and(|&row| same_instant(row, self.integrator.now.t))
    }

    pub(super) fn row(&mut self) {
        let values = self.row_values();
        self.push_row(values);
    }

    pub(super) fn row_values(&mut self) -> Row {
        let now = self.integrator.now.clone();
        let values = self.values_at(now.at());
        let slopes = self.slopes_at(now.at());
        Row {
            t: now.t,
            values,
            slopes,
        }
    }

    /// The derivatives of the kept outputs by each parameter.
    fn slopes_at(&mut self, at: At<'_>) -> Vec<Vec<f64>> {
        let Some(sensitivities) = &self.sensitivities else {
            return Vec::new();
        };
        let kept = &self.results.outputs;
        if sensitivities.end.is_some() {
            let parameters = self.setup.sensitivities.unwrap_or_default();
            return vec![vec![f64::NAN; kept.len()]; parameters.len()];
        }
        let state = self.integrator.state_mut();
        let all = sensitivities.of(Function::Outputs, state, at);
        let of_kept = |all: Vec<f64>| kept.iter().map(|&output| all[output]).collect();
        all.into_iter().map(of_kept).collect()
    }

    pub(super) fn values_at(&mut self, at: At<'_>) -> Vec<f64> {
        let mut outputs = std::mem::take(&mut self.outputs);
        self.integrator
            .state_mut()
            .evaluate(Function::Outputs, at, &mut outputs);
        let values = self.distinct.iter().map(|&output| outputs[output]);
        let values = values.collect();
        self.outputs = outputs;
        values
    }

    pub(super) fn push_row(&mut self, row: Row) {
        self.results.time.push(row.t);
        for (column, value) in self.results.columns.iter_mut().zip(row.values) {
            column.push(value);
        }
        let columns = self.results.gradient.iter_mut();
        let columns = columns.flat_map(|gradient| &mut gradient.columns);
        for (columns, slopes) in columns.zip(row.slopes) {
            for (column, slope) in columns.iter_mut().zip(slopes) {
                column.push(slope);
            }
        }
    }
}
