//! [`Rows`]: the rows of the results, on the grid asked for and on both sides of an event.

use super::run::Run;
use crate::clocks::Schedule;
use crate::moment::At;
use crate::results::{Gradient, Results};
use crate::sensitivity::Sensitivities;
use crate::setup::{Setup, same_instant};
use crate::state::State;
use hyde_program::{Function, Program};
use hyde_signal::Series;
use std::collections::HashMap;

/// Takes the rows of a run.
pub(super) struct Rows<'a> {
    setup: &'a Setup<'a>,
    /// The number of the next row on the grid.
    next: usize,
    /// The outputs kept, by number, and the column of each.
    kept: Vec<usize>,
    places: Vec<usize>,
    /// The output of each column.
    distinct: Vec<usize>,
    /// All outputs as they were last evaluated.
    outputs: Vec<f64>,
}

/// A row of the results.
pub(super) struct Row {
    t: f64,
    /// The outputs kept, each value once.
    values: Vec<f64>,
    /// Their derivatives by each parameter, if they are asked for.
    slopes: Vec<Vec<f64>>,
}

impl<'a> Rows<'a> {
    pub(super) fn new(program: &Program, setup: &'a Setup<'a>) -> Self {
        let all = || (0..program.outputs.len()).collect();
        let kept: Vec<usize> = setup.keep.clone().unwrap_or_else(all);
        let (places, distinct) = shared_columns(program, &kept);
        Self {
            setup,
            next: 0,
            kept,
            places,
            distinct,
            outputs: vec![0.0; program.outputs.len()],
        }
    }

    /// Results without rows.
    pub(super) fn results(&self, program: &Program) -> Results {
        let gradient = |parameters: &[usize]| Gradient {
            parameters: parameters.to_vec(),
            columns: vec![vec![Vec::new(); self.kept.len()]; parameters.len()],
            end: None,
        };
        let automata = program.automata.iter();
        Results {
            gradient: self.setup.sensitivities.map(gradient),
            columns: vec![Series::default(); self.distinct.len()],
            places: self.places.clone(),
            outputs: self.kept.clone(),
            mode_times: automata
                .map(|automaton| vec![0.0; automaton.modes.len()])
                .collect(),
            ..Results::default()
        }
    }

    /// Rows up to and including `end`, from the interpolant; one at the end itself waits for its events.
    pub(super) fn until(
        &mut self,
        run: &mut Run<'_, '_>,
        sensitivities: &mut Option<Sensitivities>,
        end: f64,
    ) {
        while let Some(&t) = self.setup.rows_s.get(self.next) {
            if t > end || same_instant(t, end) && waits(run, end) {
                return;
            }
            let mut then = run.integrator.room(t.min(end));
            run.integrator.solution(run.consistent, &mut then);
            let state = run.integrator.state_mut();
            let values = self.values(state, then.at());
            if let Some(sensitivities) = sensitivities {
                sensitivities.advance(run.integrator, then.t);
            }
            let state = run.integrator.state_mut();
            let slopes = self.slopes(state, sensitivities.as_ref(), then.at());
            let t = then.t;
            Row { t, values, slopes }.push(run.results);
            self.next += 1;
        }
    }

    /// A row of the values at a moment.
    pub(super) fn row(
        &mut self,
        state: &mut State<'_>,
        sensitivities: Option<&Sensitivities>,
        at: At<'_>,
    ) -> Row {
        Row {
            t: at.t,
            values: self.values(state, at),
            slopes: self.slopes(state, sensitivities, at),
        }
    }

    /// All outputs at a moment.
    pub(super) fn evaluate(&mut self, state: &mut State<'_>, at: At<'_>) -> &[f64] {
        state.evaluate(Function::Outputs, at, &mut self.outputs);
        &self.outputs
    }

    /// All outputs as they were last evaluated.
    pub(super) fn outputs(&self) -> &[f64] {
        &self.outputs
    }

    fn values(&mut self, state: &mut State<'_>, at: At<'_>) -> Vec<f64> {
        self.evaluate(state, at);
        let values = self.distinct.iter().map(|&output| self.outputs[output]);
        values.collect()
    }

    /// The derivatives of the kept outputs by each parameter.
    fn slopes(
        &self,
        state: &mut State<'_>,
        sensitivities: Option<&Sensitivities>,
        at: At<'_>,
    ) -> Vec<Vec<f64>> {
        let Some(sensitivities) = sensitivities else {
            return Vec::new();
        };
        if sensitivities.end.is_some() {
            let parameters = self.setup.sensitivities.unwrap_or_default();
            return vec![vec![f64::NAN; self.kept.len()]; parameters.len()];
        }
        let all = sensitivities.of(Function::Outputs, state, at);
        let of_kept = |all: Vec<f64>| self.kept.iter().map(|&output| all[output]).collect();
        all.into_iter().map(of_kept).collect()
    }

    /// Whether a row on the grid is due.
    pub(super) fn are_due(&self, t: f64) -> bool {
        let next = self.setup.rows_s.get(self.next);
        next.is_some_and(|&row| same_instant(row, t))
    }

    /// The next row on the grid was taken.
    pub(super) fn skip(&mut self) {
        self.next += 1;
    }

    /// No rows on the grid up to a time.
    pub(super) fn begin_behind(&mut self, t: f64) {
        let rows = &self.setup.rows_s;
        let behind = |row: f64| row <= t || same_instant(row, t);
        while rows.get(self.next).is_some_and(|&row| behind(row)) {
            self.next += 1;
        }
    }

    /// Whether a step of what a clock holds shows. Where rows are finer than ticks it is a staircase; coarser rows would be
    /// multiplied.
    pub(super) fn show_steps(&self, on_grid: bool, schedule: &Schedule) -> bool {
        on_grid || self.setup.row_spacing() < schedule.shortest_period()
    }
}

impl Row {
    /// Adds it to the results.
    pub(super) fn push(self, results: &mut Results) {
        results.time.push(self.t);
        for (column, value) in results.columns.iter_mut().zip(self.values) {
            column.push(value);
        }
        let columns = results.gradient.iter_mut();
        let columns = columns.flat_map(|gradient| &mut gradient.columns);
        for (columns, slopes) in columns.zip(self.slopes) {
            for (column, slope) in columns.iter_mut().zip(slopes) {
                column.push(slope);
            }
        }
    }
}

/// Whether something happens at this instant that a row must show from both sides.
fn waits(run: &Run<'_, '_>, t: f64) -> bool {
    let state = run.integrator.state();
    run.schedule.due(t)
        || state.delays.due(t)
        || !run.schedule.relations_at(t).is_empty()
        || same_instant(state.inputs.next_jump(t - 1e-9 * (1.0 + t.abs())), t)
        || t < run.integrator.now.t
}

/// The column of each output kept, and the output that each column is of: those that have the same value have one.
fn shared_columns(program: &Program, keep: &[usize]) -> (Vec<usize>, Vec<usize>) {
    let mut distinct = Vec::new();
    let mut column_of: HashMap<usize, usize> = HashMap::new();
    let column = |&output: &usize| {
        let first = program.outputs[output].same_as.unwrap_or(output);
        *column_of.entry(first).or_insert_with(|| {
            distinct.push(output);
            distinct.len() - 1
        })
    };
    let places = keep.iter().map(column).collect();
    (places, distinct)
}
