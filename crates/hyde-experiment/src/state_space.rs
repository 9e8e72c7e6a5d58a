//! A linearised system as a state space with named inputs, outputs and states: continuous, or of a loop that clocks close
//! its exact map from one common period to the next.
//!
//! ```text
//! x' = A x + B u,      y = C x + D u        without clocks
//! x[k+1] = A x[k] + B u[k], y[k] = C x[k] + D u[k]   with clocks; u is constant from t[k] to t[k+1]
//! ```
//! All are deviations from the operating point, in SI units. Of a plant whose clocks are left out ([`crate::About::open`]) the
//! held values are inputs behind the others. With clocks the state is that of the plant, the memory of the
//! clocked parts and the held values, all just before the ticks at t[k]; the ticks at t[k] read u[k].

use crate::common_period::CommonPeriod;
use crate::linearize::Linear;
use crate::sampled::{Clocked, Sampled};
use hyde_program::{Function, Program, Workspace};
use nalgebra::DMatrix;

/// A signal of a state space.
#[derive(Clone, Debug, PartialEq)]
pub struct StateSpaceSignal {
    /// Its name; of memory that no reported quantity shows `memory[n]`.
    pub name: String,
    /// Its unit in SI, `1` of a bare number; `None` if it is not known.
    pub unit: Option<String>,
    /// Its value at the operating point.
    pub value: f64,
}

/// When the states of a system with clocks are seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleTimes {
    /// The common period of the clocks in s.
    pub period_s: f64,
    /// The first instant at or behind 0, in s.
    pub first_s: f64,
}

/// A linear system.
#[derive(Clone, Debug)]
pub struct StateSpace {
    /// States by states.
    pub a: DMatrix<f64>,
    /// States by inputs.
    pub b: DMatrix<f64>,
    /// Outputs by states.
    pub c: DMatrix<f64>,
    /// Outputs by inputs.
    pub d: DMatrix<f64>,
    /// The states.
    pub states: Vec<StateSpaceSignal>,
    /// The inputs.
    pub inputs: Vec<StateSpaceSignal>,
    /// The outputs.
    pub outputs: Vec<StateSpaceSignal>,
    /// Of a system with clocks.
    pub sampled: Option<SampleTimes>,
}

impl StateSpace {
    /// The four matrices with their names, each by rows.
    #[must_use]
    pub fn matrices(&self) -> [(&'static str, Vec<Vec<f64>>); 4] {
        let rows = |matrix: &DMatrix<f64>| {
            let rows = matrix.row_iter();
            rows.map(|row| row.iter().copied().collect()).collect()
        };
        [
            ("A", rows(&self.a)),
            ("B", rows(&self.b)),
            ("C", rows(&self.c)),
            ("D", rows(&self.d)),
        ]
    }
}

/// The state space of a linearised system with these inputs, as it was linearised with them, and these outputs of the
/// program; `None` of a system with delays, which has no finite state.
#[must_use]
pub fn state_space(
    program: &Program,
    linear: &Linear,
    (inputs, outputs): (&[String], &[usize]),
) -> Option<StateSpace> {
    if linear.delayed.is_some() {
        return None;
    }
    let values = reported(program, linear);
    let signal = |number: usize| StateSpaceSignal {
        name: program.outputs[number].name.clone(),
        unit: Some(program.outputs[number].dimension.usual_unit()),
        value: values[number],
    };
    let input = |name: &String| match program.output(name) {
        Some(number) => signal(number),
        None => StateSpaceSignal {
            name: name.clone(),
            unit: None,
            value: 0.0,
        },
    };
    let mut states: Vec<StateSpaceSignal> = linear
        .states
        .iter()
        .map(|&position| {
            let name = program.unknown_name(position);
            let number = program.output(&name);
            StateSpaceSignal {
                unit: number.map(|number| program.outputs[number].dimension.usual_unit()),
                value: linear.point.y[position],
                name,
            }
        })
        .collect();
    let rows = |matrix: &DMatrix<f64>| matrix.select_rows(outputs);
    let mut inputs: Vec<StateSpaceSignal> = inputs.iter().map(input).collect();
    let d = rows(&linear.d_input);
    let outputs_told = outputs.iter().map(|&number| signal(number)).collect();
    let Some(sampled) = &linear.sampled else {
        let shown = (0..linear.d_held.ncols()).map(|column| shows_held(program, linear, column));
        inputs.extend(shown.enumerate().map(|(column, shown)| {
            match shown {
                Some(number) => signal(number),
                None => StateSpaceSignal {
                    name: format!("held[{}]", column + 1),
                    unit: None,
                    value: held_targets(program)
                        .nth(column)
                        .map_or(f64::NAN, |target| linear.point.z[target]),
                },
            }
        }));
        return Some(StateSpace {
            a: linear.a.clone(),
            b: beside(&linear.b_input, &linear.b_held),
            c: rows(&linear.c),
            d: beside(&d, &rows(&linear.d_held)),
            states,
            inputs,
            outputs: outputs_told,
            sampled: None,
        });
    };
    let (held_linear, held_sampled) = with_inputs_held(linear, sampled);
    let period = CommonPeriod::new(&held_linear, &held_sampled)?;
    let whole = period.transition();
    let size = whole.nrows() - inputs.len();
    let memory = memory_names(program, sampled, &linear.point.z);
    let holds = held_names(program, sampled, &memory, &linear.point.z);
    states.extend(memory);
    states.extend(holds);
    Some(StateSpace {
        a: whole.view((0, 0), (size, size)).into_owned(),
        b: whole.view((0, size), (size, inputs.len())).into_owned(),
        c: beside(
            &beside(&rows(&linear.c), &rows(&sampled.outputs)),
            &rows(&linear.d_held),
        ),
        d,
        states,
        inputs,
        outputs: outputs_told,
        sampled: Some(SampleTimes {
            period_s: period.period_s(),
            first_s: period.first_s(),
        }),
    })
}

/// The values of all reported quantities at the operating point.
fn reported(program: &Program, linear: &Linear) -> Vec<f64> {
    let mut values = vec![0.0; program.rows(Function::Outputs)];
    let mut work = Workspace::new(program.n_work);
    let at = linear.point.at();
    program
        .kernels
        .evaluate(Function::Outputs, at, &mut work, &mut values);
    values
}

/// The same system with its inputs among the held values: no clock changes them.
fn with_inputs_held(linear: &Linear, sampled: &Sampled) -> (Linear, Sampled) {
    let inputs = linear.b_input.ncols();
    let clocks = sampled.clocks.iter().map(|clock| Clocked {
        by_held: beside(&clock.by_held, &clock.by_input),
        ..clock.clone()
    });
    let clocks: Vec<Clocked> = clocks.collect();
    let rows = sampled.select.nrows();
    let select = sampled.select.clone().resize_vertically(rows + inputs, 0.0);
    let nobody = std::iter::repeat_n(clocks.len(), inputs);
    let held = Sampled {
        select,
        holder: sampled.holder.iter().copied().chain(nobody).collect(),
        outputs: sampled.outputs.clone(),
        written: sampled.written.clone(),
        clocks,
    };
    let linear = Linear {
        b_held: beside(&linear.b_held, &linear.b_input),
        ..linear.clone()
    };
    (linear, held)
}

fn beside(left: &DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    let columns = left.ncols();
    let mut both = left.clone();
    both = both.resize_horizontally(columns + right.ncols(), 0.0);
    both.columns_mut(columns, right.ncols()).copy_from(right);
    both
}

/// The memory of clocked parts, by the reported quantity that shows it.
fn memory_names(program: &Program, sampled: &Sampled, values: &[f64]) -> Vec<StateSpaceSignal> {
    let shown = &sampled.outputs;
    let name = |column: usize| {
        let alone = |row: &usize| {
            let others = (0..shown.ncols()).filter(|&other| other != column);
            let output = &program.outputs[*row];
            (shown[(*row, column)] - 1.0).abs() == 0.0
                && others.into_iter().all(|other| shown[(*row, other)] == 0.0)
                && output.discrete
                && !output.auxiliary
        };
        (0..shown.nrows()).find(alone)
    };
    let signal = |column: usize| {
        let value = values[sampled.written[column]];
        match name(column) {
            Some(number) => StateSpaceSignal {
                name: program.outputs[number].name.clone(),
                unit: Some(program.outputs[number].dimension.usual_unit()),
                value,
            },
            None => StateSpaceSignal {
                name: format!("memory[{}]", column + 1),
                unit: None,
                value,
            },
        }
    };
    (0..shown.ncols()).map(signal).collect()
}

/// The positions of the held values in the memory.
fn held_targets(program: &Program) -> impl Iterator<Item = usize> + '_ {
    let holds = program.holds.iter();
    holds.flat_map(|hold| hold.target..hold.target + hold.len)
}

/// The reported quantity that is a held value, whatever the states are.
fn shows_held(program: &Program, linear: &Linear, column: usize) -> Option<usize> {
    let alone = |&row: &usize| {
        let held = linear.d_held.row(row);
        let others = held
            .iter()
            .enumerate()
            .filter(|(other, _)| *other != column);
        let nothing_else = others
            .map(|(_, value)| value)
            .chain(linear.c.row(row).iter())
            .chain(linear.d_input.row(row).iter())
            .all(|value| value.abs() == 0.0);
        nothing_else && (held[column] - 1.0).abs() == 0.0 && !program.outputs[row].auxiliary
    };
    (0..linear.d_held.nrows()).find(alone)
}

/// The held values, by the memory that they hold.
fn held_names(
    program: &Program,
    sampled: &Sampled,
    memory: &[StateSpaceSignal],
    values: &[f64],
) -> Vec<StateSpaceSignal> {
    let signal = |(row, target): (usize, usize)| {
        let held = (0..memory.len()).find(|&column| sampled.select[(row, column)] != 0.0);
        let held = held.map(|column| &memory[column]);
        StateSpaceSignal {
            name: match held {
                Some(held) => format!("hold({})", held.name),
                None => format!("held[{}]", row + 1),
            },
            unit: held.and_then(|held| held.unit.clone()),
            value: values[target],
        }
    };
    held_targets(program).enumerate().map(signal).collect()
}
