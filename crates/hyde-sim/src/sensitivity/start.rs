//! Sensitivities at the start: of start values, and through the linearised initial system.

use super::Sensitivities;
use crate::consistent::Consistent;
use crate::initial::{Round, Shape};
use crate::moment::At;
use crate::results::GradientEndKind;
use crate::state::State;
use hyde_program::Function;

impl Sensitivities {
    /// The derivatives after the initial system was solved: its states follow from start values and initial equations, or
    /// stay as they are.
    pub(crate) fn start(
        &mut self,
        state: &mut State<'_>,
        consistent: &mut Consistent,
        at: At<'_>,
        round: Round,
    ) {
        let count = match round {
            Round::First => {
                self.take_start_values(state, true);
                state.program.n_initial_equations()
            }
            Round::Again => {
                self.take_start_values(state, false);
                state.program.n_initial_equations()
            }
            Round::StatesKept => 0,
        };
        if round != Round::StatesKept {
            self.take_pins(state, at);
        }
        if count > 0 {
            self.solve(state, at, count);
        }
        self.be_consistent(state, consistent, at);
    }

    /// The derivatives of the start values, those of the memory too if asked for.
    fn take_start_values(&mut self, state: &State<'_>, memory: bool) {
        let program = state.program;
        let n = program.n_unknowns;
        self.now
            .y
            .iter_mut()
            .flatten()
            .for_each(|slope| *slope = 0.0);
        for (row, place, value) in program.kernels.start_partials(&state.p) {
            for (number, direction) in self.directions.iter().enumerate() {
                let slope = value * direction[place];
                match row.checked_sub(n) {
                    None => self.now.y[number][row] += slope,
                    Some(row) if memory => self.now.z[number][row] += slope,
                    Some(_) => {}
                }
            }
        }
    }

    /// The states that modes fix have the derivatives of what they are fixed to.
    fn take_pins(&mut self, state: &mut State<'_>, at: At<'_>) {
        if state.pinned.is_empty() {
            return;
        }
        let slopes = self.of(Function::Assignments, state, at);
        let program = state.program;
        for (number, pin) in program.pins.iter().enumerate() {
            if state.in_mode(pin.automaton, pin.mode) {
                for (now, slopes) in self.now.y.iter_mut().zip(&slopes) {
                    now[pin.state] = slopes[program.assignments.len() + number];
                }
            }
        }
    }

    /// The linearised initial system. Fixed states keep their derivatives.
    fn solve(&mut self, state: &mut State<'_>, at: At<'_>, count: usize) {
        let Ok(shape) = Shape::new(state, count, at.t) else {
            self.stop(at.t, GradientEndKind::Singular);
            return;
        };
        let fixed = self.now.y.clone();
        let unknown = self.now.y.iter_mut().chain(&mut self.now.yp).flatten();
        unknown.for_each(|slope| *slope = 0.0);
        let residual = self.of(Function::Residual, state, at);
        let equations = self.of(Function::Initial, state, at);
        let (n, states) = (shape.n, shape.column_of_rate.clone());
        let mut rights: Vec<Vec<f64>> = Vec::new();
        for ((residual, equations), fixed) in residual.iter().zip(&equations).zip(&fixed) {
            let mut right = residual.clone();
            right.extend(&equations[..shape.count]);
            right.extend(shape.fixed.iter().map(|&state| -fixed[state]));
            rights.push(right);
        }
        if !shape.solve(state, at, &mut rights) {
            self.stop(at.t, GradientEndKind::Singular);
            return;
        }
        for (number, right) in rights.iter().enumerate() {
            for index in 0..n {
                self.now.y[number][index] = -right[index];
                if let Some(column) = states[index] {
                    self.now.yp[number][index] = -right[column];
                }
            }
        }
    }
}
