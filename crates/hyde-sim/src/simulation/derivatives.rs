//! Derivatives of rates, algebraic variables and outputs by states and parameters at the caller's point, by the implicit function
//! theorem on the equations as they are there.

use super::Simulation;
use crate::moment::At;
use crate::session::Variation;
use hyde_program::{Function, Wrt};

impl Simulation<'_> {
    /// The derivative in a direction.
    pub(crate) fn vary(
        &mut self,
        states: &[(usize, f64)],
        parameters: &[(usize, f64)],
    ) -> Option<Variation> {
        let n = self.program.n_unknowns;
        let mut place = self.place().clone();
        // The solver's rates are as good as its tolerance; the linearised equations are to be those of a consistent point.
        let state = self.integrator.state_mut();
        self.consistent.make_exact(state, &mut place);
        let at = place.at();
        let state = self.integrator.state_mut();
        if !state.slides.is_empty() {
            return None;
        }
        let (mut dy, mut dyp) = (vec![0.0; n], vec![0.0; n]);
        for &(position, by) in states {
            dy[position] = by;
        }
        for &(position, _) in &state.pinned {
            dy[position] = 0.0;
        }
        let mut right = vec![0.0; n];
        state.directional(at, &dy, &dyp, &mut right);
        for (row, value) in along(state, Function::Residual, parameters, at) {
            right[row] += value;
        }
        right.iter_mut().for_each(|value| *value = -*value);
        let mut rights = [right];
        if n > 0 && !self.consistent.correct(state, at, &mut rights) {
            return None;
        }
        let [solved] = rights;
        for (index, value) in solved.into_iter().enumerate() {
            if state.differential[index] {
                dyp[index] = value;
            } else {
                dy[index] = value;
            }
        }
        for &(position, _) in &state.pinned {
            dyp[position] = 0.0;
        }
        let mut outputs = vec![0.0; self.program.outputs.len()];
        let partials = state.partials(Function::Outputs, at);
        let entries = self.program.partials(Function::Outputs);
        for (entry, value) in entries.iter().zip(partials) {
            outputs[entry.row] += match entry.wrt {
                Wrt::Unknown(column) => value * dy[column],
                Wrt::Derivative(column) => value * dyp[column],
                Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => 0.0,
            };
        }
        for (row, value) in along(state, Function::Outputs, parameters, at) {
            outputs[row] += value;
        }
        Some(Variation {
            y: dy,
            yp: dyp,
            outputs,
        })
    }
}

/// The derivative of a function in a direction of parameters: rows and values.
fn along(
    state: &mut crate::state::State<'_>,
    function: Function,
    parameters: &[(usize, f64)],
    at: At<'_>,
) -> Vec<(usize, f64)> {
    if parameters.is_empty() {
        return Vec::new();
    }
    let kernels = &state.program.kernels;
    let places: Vec<usize> = parameters.iter().map(|(place, _)| *place).collect();
    state.read_all(at.t);
    let (point, workspace) = state.point(at);
    let found = kernels.parameter_partials(function, &places, point, workspace);
    let by = |entry: hyde_program::PartialEntry, value: f64| {
        let Wrt::Parameter(place) = entry.wrt else {
            return None;
        };
        let (_, by) = parameters.iter().find(|(known, _)| *known == place)?;
        Some((entry.row, value * by))
    };
    found
        .into_iter()
        .filter_map(|(entry, value)| by(entry, value))
        .collect()
}
