//! [`state_space`]: the linearised model as matrices with names.

use crate::modes::Prepared;
use crate::ports::{chosen_outputs, is_input};
use crate::refusals::responses as refused;
use crate::{Fault, Refused, operating_point};
use hyde_diag::Diagnostic;
use hyde_experiment::{About, Linear, LinearizeError, Poles, StateSpace, linearize_about, poles};
use hyde_program::Program;

/// A state space with what it is about.
pub struct Found {
    /// The model, and about what it is linearised.
    pub prepared: Prepared,
    /// The linearised model.
    pub linear: Linear,
    /// Its poles.
    pub poles: Poles,
    /// The matrices.
    pub system: StateSpace,
    /// It is that of the plant alone.
    pub open: bool,
}

impl Found {
    /// The model, and the experiment.
    #[must_use]
    pub fn name(&self) -> String {
        let program = &self.prepared.compiled.program;
        match &self.prepared.project.experiment {
            Some(experiment) => format!("{} of {}", experiment, program.name),
            None => program.name.clone(),
        }
    }
}

/// Makes the state space from the inputs to the outputs that are named, from all to all if none is; `open` of the plant alone.
///
/// # Errors
/// There is no such input or output, or no state space: why.
pub fn state_space(
    mut prepared: Prepared,
    (input, output): (&[String], &[String]),
    open: bool,
) -> Result<Found, Refused> {
    let program = &prepared.compiled.program;
    let inputs = inputs(program, input).map_err(Refused::Asked)?;
    let outputs = chosen_outputs(program, output).map_err(Refused::Asked)?;
    let outputs: Vec<usize> = match output.is_empty() {
        true => outputs.into_iter().collect(),
        // In the order in which they are named.
        false => output.iter().filter_map(|n| program.output(n)).collect(),
    };
    let refused = |mut prepared: Prepared, diagnostic: Diagnostic| {
        prepared.project.diagnostics.push(diagnostic);
        prepared.project.refused(Fault::Model)
    };
    if let Some(input) = inputs
        .iter()
        .find(|input| program.experiment.differentiated.contains(input))
    {
        let diagnostic = differentiated(program, input);
        return Err(refused(prepared, diagnostic));
    }
    let about = About {
        time: prepared.time,
        modes: &prepared.chosen,
        open,
        ..About::default()
    };
    let (tables, p) = (&prepared.tables, &prepared.parameters);
    let linear = match linearize_about(program, tables, p, &inputs, about) {
        Ok(linear) => linear,
        Err(LinearizeError::Failed(failure)) => return Err(prepared.no_point(failure)),
        Err(error) => {
            return Err(match no_system(program, &error) {
                Some(diagnostic) => refused(prepared, diagnostic),
                None => Refused::Asked(format!(
                    "there is no state space: {}",
                    operating_point::why_not(&error)
                )),
            });
        }
    };
    let system = hyde_experiment::state_space(program, &linear, (&inputs, &outputs));
    let Some(system) = system else {
        let diagnostic = delayed(program);
        prepared.project.diagnostics.push(diagnostic);
        return Err(prepared.project.refused(Fault::Model));
    };
    Ok(Found {
        poles: poles(&linear),
        prepared,
        linear,
        system,
        open,
    })
}

/// The inputs that are asked for, or all.
fn inputs(program: &Program, asked: &[String]) -> Result<Vec<String>, String> {
    let all = program.parameters.iter();
    let all = all.filter(|parameter| is_input(program, parameter));
    let all: Vec<String> = all.map(|parameter| parameter.name.clone()).collect();
    if asked.is_empty() {
        return Ok(all);
    }
    match asked.iter().find(|name| !all.contains(name)) {
        None => Ok(asked.to_vec()),
        Some(other) if all.is_empty() => Err(format!(
            "the model has no free input `{other}`: it has none; declare one, `input Force F;`"
        )),
        Some(other) => Err(format!(
            "the model has no free input `{other}`; its inputs are `{}`",
            all.join("`, `")
        )),
    }
}

fn differentiated(program: &Program, input: &str) -> Diagnostic {
    let parameter = program.parameter(input);
    let parameter = parameter.map(|(parameter, _)| parameter.origin.span);
    refused::state_space_needs_derivative(input, parameter)
}

fn delayed(program: &Program) -> Diagnostic {
    let delay = program.delays.first();
    refused::delay_in_state_space(delay.map(|delay| delay.origin.span))
}

/// Why there is no linearised model, where that has a place in the file.
fn no_system(program: &Program, error: &LinearizeError) -> Option<Diagnostic> {
    match error {
        LinearizeError::DelayAndClock => Some(delayed(program)),
        LinearizeError::NoCommonPeriod | LinearizeError::LongDelay => {
            let why = operating_point::why_not(error);
            let clock = program.clocks.first().map(|clock| clock.origin.span);
            Some(refused::no_common_period(&why, clock))
        }
        LinearizeError::NoInput(_)
        | LinearizeError::TooLarge(_)
        | LinearizeError::Singular
        | LinearizeError::BeforeStart(..)
        | LinearizeError::Failed(_) => None,
    }
}
