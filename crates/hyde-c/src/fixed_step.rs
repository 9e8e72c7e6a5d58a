//! [`FixedStep`]: a program that is stepped with a fixed step, with its clocks in steps; or the part of it that cannot be.

use crate::refusals;
use hyde_diag::Diagnostic;
use hyde_program::{Constant, Program};
use hyde_study::ports::{fixed_places, is_input};

/// A clock or delay is a whole number of steps, to this part of a step.
const WHOLE: f64 = 1e-6;

/// Consistent values at the start.
#[derive(Clone, Debug, Default)]
pub struct Start {
    /// The solver's vector.
    pub y: Vec<f64>,
    /// Its derivative.
    pub yp: Vec<f64>,
    /// The memory.
    pub z: Vec<f64>,
}

/// The times of a clock in steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ClockSteps {
    pub(crate) period: i64,
    pub(crate) phase: i64,
    pub(crate) delay: i64,
}

/// Where an input is written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Input {
    pub(crate) name: String,
    pub(crate) unit: String,
    /// A position in the parameters, or, of a column of a record, among the inputs of the program.
    pub(crate) place: usize,
    pub(crate) column: bool,
}

/// A parameter that may be set.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Settable {
    pub(crate) name: String,
    pub(crate) unit: String,
    pub(crate) place: usize,
}

/// A program with a fixed step.
#[derive(Clone)]
pub struct FixedStep<'a> {
    pub(crate) program: &'a Program,
    pub(crate) parameters: &'a [f64],
    pub(crate) name: String,
    pub(crate) step_s: f64,
    pub(crate) start_s: f64,
    pub(crate) start: Start,
    pub(crate) clocks: Vec<ClockSteps>,
    pub(crate) inputs: Vec<Input>,
    pub(crate) settable: Vec<Settable>,
    pub(crate) outputs: Vec<usize>,
    /// Positions of the parameters that were set on export, or come from a record.
    pub(crate) given: Vec<usize>,
}

impl<'a> FixedStep<'a> {
    /// A program with its parameters, its consistent start, the step in s, the outputs by number, and the positions of
    /// parameters that were set.
    ///
    /// # Errors
    /// The part that cannot be expressed, with what to write instead.
    pub fn of(
        program: &'a Program,
        parameters: &'a [f64],
        (start_s, start): (f64, Start),
        (name, step_s): (&str, f64),
        (outputs, given): (Vec<usize>, Vec<usize>),
    ) -> Result<Self, Box<Diagnostic>> {
        expressible(program)?;
        let clocks = (0..program.clocks.len())
            .map(|clock| clock_steps(program, parameters, clock, step_s))
            .collect::<Result<_, _>>()?;
        Ok(Self {
            program,
            parameters,
            name: name.to_owned(),
            step_s,
            start_s,
            start,
            clocks,
            inputs: inputs(program),
            settable: settable(program, parameters),
            outputs,
            given,
        })
    }

    /// The number of inputs.
    #[must_use]
    pub fn inputs(&self) -> usize {
        self.inputs.len()
    }

    /// The number of parameters that may be set.
    #[must_use]
    pub fn parameters(&self) -> usize {
        self.settable.len()
    }
}

fn expressible(program: &Program) -> Result<(), Box<Diagnostic>> {
    if let Some(delay) = program.delays.first() {
        return Err(Box::new(refusals::has_delay(delay.origin.span)));
    }
    if let Some(selection) = program.selections.first() {
        let names: Vec<String> = selection
            .candidates
            .iter()
            .map(|&position| program.unknown_name(position))
            .collect();
        let block = selection.candidates.first().and_then(|&p| program.block(p));
        let origin = block.and_then(|block| block.origins.first());
        let equation = origin.map(|origin| origin.span);
        return Err(Box::new(refusals::chooses_states(&names, equation)));
    }
    Ok(())
}

fn clock_steps(
    program: &Program,
    parameters: &[f64],
    clock: usize,
    step_s: f64,
) -> Result<ClockSteps, Box<Diagnostic>> {
    let constant = |which| program.kernels.constant(which, parameters);
    let own = &program.clocks[clock];
    let steps = |what: &str, which| {
        let time = constant(which).unwrap_or(f64::NAN);
        let steps = time / step_s;
        let whole = steps.round();
        if (steps - whole).abs() <= WHOLE && whole < 1e15 {
            return Ok(whole as i64);
        }
        let time = hyde_units::significant(1e3 * time, 9);
        let step = hyde_units::significant(1e3 * step_s, 9);
        let clock = (own.name.as_str(), own.origin.span);
        Err(Box::new(refusals::not_whole_steps(
            (what, &time),
            clock,
            &step,
        )))
    };
    let found = ClockSteps {
        period: steps("period", Constant::Period(clock))?,
        phase: steps("first tick", Constant::Phase(clock))?,
        delay: steps("delay", Constant::Delay(clock))?,
    };
    let here = own.origin.span;
    match (found.period < 1, found.delay > found.period) {
        (true, _) => Err(Box::new(refusals::no_period(here))),
        (_, true) => Err(Box::new(refusals::delay_longer_than_period(here))),
        (false, false) => Ok(ClockSteps {
            phase: match found.phase < 0 {
                true => found.phase.rem_euclid(found.period),
                false => found.phase,
            },
            ..found
        }),
    }
}

fn inputs(program: &Program) -> Vec<Input> {
    let mut found = Vec::new();
    for parameter in program.parameters.iter().filter(|p| is_input(program, p)) {
        found.push(Input {
            name: parameter.name.clone(),
            unit: parameter.dimension.usual_unit(),
            place: parameter.place,
            column: false,
        });
    }
    for (number, column) in program.columns.iter().enumerate() {
        let next = if column.next { ".next" } else { "" };
        found.push(Input {
            name: format!("{}.{}{next}", column.record, column.column),
            unit: "the unit of the record in SI".to_owned(),
            place: 2 * number,
            column: true,
        });
    }
    found
}

fn settable(program: &Program, parameters: &[f64]) -> Vec<Settable> {
    let fixed = fixed_places(program, parameters);
    let mut found = Vec::new();
    for parameter in &program.parameters {
        let never = parameter.structural || parameter.is_final || parameter.found;
        if never || is_input(program, parameter) {
            continue;
        }
        for place in parameter.place..parameter.place + parameter.len {
            let from_record = program.record_values.iter().any(|own| own.place == place);
            if let (Some((_, name)), false, false) = (
                program.parameter_at(place),
                fixed.contains(&place),
                from_record,
            ) {
                found.push(Settable {
                    name,
                    unit: parameter.dimension.usual_unit(),
                    place,
                });
            }
        }
    }
    found
}
