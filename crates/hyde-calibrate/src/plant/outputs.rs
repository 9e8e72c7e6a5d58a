//! What measured channels show of a plant, and their derivatives by the states.

use super::configuration::{Configuration, Places};
use hyde_program::{Function, Point, Program, SomeRows, Workspace, Wrt};
use nalgebra::DMatrix;

/// What the channels show, alone of all outputs.
pub(crate) fn measured(program: &Program) -> Box<dyn SomeRows + '_> {
    let measured = program.experiment.measured.iter();
    let outputs: Vec<usize> = measured.map(|measured| measured.output).collect();
    program.kernels.some_rows(Function::Outputs, &outputs)
}

/// Derivatives of the measured channels by the states, at a point of a configuration.
pub(crate) fn output_matrix(
    program: &Program,
    places: &Places,
    configuration: &Configuration<'_>,
    at: Point<'_>,
    workspace: &mut Workspace,
) -> DMatrix<f64> {
    let channels = program.experiment.measured.len();
    let entries = program.partials(Function::Outputs);
    let mut values = vec![0.0; entries.len()];
    program
        .kernels
        .partials(Function::Outputs, at, workspace, &mut values);
    let number_in =
        |list: &[usize], position: usize| list.iter().position(|&known| known == position);
    let mut c = DMatrix::zeros(channels, places.states.len());
    for (entry, value) in entries.iter().zip(values) {
        let measured = &program.experiment.measured;
        let Some(channel) = measured.iter().position(|m| m.output == entry.row) else {
            continue;
        };
        let by_state = match entry.wrt {
            Wrt::Unknown(position) => match number_in(&places.states, position) {
                Some(state) => {
                    c[(channel, state)] += value;
                    None
                }
                None => number_in(&places.algebraics, position)
                    .map(|row| configuration.by_states.row(places.states.len() + row)),
            },
            Wrt::Derivative(position) => {
                number_in(&places.states, position).map(|row| configuration.by_states.row(row))
            }
            Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => None,
        };
        if let Some(row) = by_state {
            let mut own = c.row_mut(channel);
            own += row * value;
        }
    }
    c
}
