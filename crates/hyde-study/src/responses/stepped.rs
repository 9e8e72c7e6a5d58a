//! The stepped sine of an experiment: planned and run.

use super::How;
use super::response::{Response, band, frequencies};
use crate::run_failure;
use crate::settings::Setting;
use crate::{Aim, Fault, Project, Refused};
use hyde_compiler::Compiled;
use hyde_experiment::{Level, Options, SteppedPoint, Steps, parameters, stepped_response};
use hyde_program::{Constant, Program};
use hyde_units::{Dimension, NamedUnit};

/// What came out at each frequency.
pub struct Stepped {
    /// The model as it was run.
    pub compiled: Compiled,
    /// What came out.
    pub points: Vec<SteppedPoint>,
}

impl Stepped {
    /// Whether every expectation held at every frequency.
    #[must_use]
    pub fn holds(&self) -> bool {
        let measures = self.compiled.program.experiment.measures.iter();
        measures.enumerate().all(|(number, known)| {
            let mut points = self.points.iter();
            match known.expectation {
                true => points.all(|point| point.measures[number].holds),
                false => points
                    .find(|point| point.measures[number].missing.is_some())
                    .is_none_or(|point| point.measures[number].holds),
            }
        })
    }
}

/// Runs the response of that number, and puts what came out beside the linearised responses.
pub(super) fn measured(
    project: &mut Project,
    number: usize,
    responses: &mut [Response],
    how: &How,
) -> Result<Option<Stepped>, Failed> {
    let Some(input) = responses.first().map(|response| response.input.clone()) else {
        return Ok(None);
    };
    // Which frequency does not matter here: a run sets its own.
    let hertz = NamedUnit::usual(Dimension::FREQUENCY);
    let frequency = Setting::of(format!("{input}.frequency"), 1.0, Some(hertz));
    project.settings.push(frequency);
    let compiled = project.compile(Aim::Run);
    project.settings.pop();
    let compiled = compiled.map_err(Failed::Diagnosed)?;
    let program = &compiled.program;
    let diagnosed = |project: &mut Project, error| {
        let (diagnostic, fault) = run_failure::diagnostic(&error, program, None);
        project.diagnostics.push(diagnostic);
        Failed::Diagnosed(fault)
    };
    let tables = crate::tables(&project.records);
    let p =
        parameters(program, &tables, &project.set()).map_err(|error| diagnosed(project, error))?;
    let steps = steps(program, number, &p).ok_or_else(|| {
        let reason =
            "`by stepped` needs a positive amplitude, two points or more, and two periods or more";
        Failed::Refused(Refused::Because(reason.to_owned(), Fault::Model))
    })?;
    let options = Options {
        set: project.set(),
        interrupted: how.interrupted.clone(),
        reached: how.reached.clone(),
        ..Options::default()
    };
    let bode = &program.experiment.bodes[number];
    let points = stepped_response(program, &tables, &options, bode, &steps, how.threads)
        .map_err(|error| diagnosed(project, error))?;
    for (output, response) in responses.iter_mut().enumerate() {
        let of =
            |point: &SteppedPoint| (point.frequency_hz, point.amplitude, point.outputs[output]);
        response.stepped = points.iter().map(of).collect();
    }
    Ok(Some(Stepped { compiled, points }))
}

/// Why there is no answer.
pub(super) enum Failed {
    /// The project has it among its diagnostics.
    Diagnosed(Fault),
    /// The reason.
    Refused(Refused),
}

/// What the experiment says of its steps; `None` where that makes no sense.
fn steps(program: &Program, number: usize, p: &[f64]) -> Option<Steps> {
    let constant = |which| program.kernels.constant(which, p);
    let bode = &program.experiment.bodes[number];
    let amplitude = constant(Constant::Amplitude(number))?;
    let (points, periods) = (
        constant(Constant::Points(number))?,
        constant(Constant::Periods(number))?,
    );
    let settle_s = constant(Constant::Settle(number))?;
    let sound = amplitude > 0.0 && (2.0..1e4).contains(&points) && (2.0..1e4).contains(&periods);
    let level = match bode.stepped?.keep {
        None => None,
        Some(output) => {
            let most = constant(Constant::Level(number))?;
            Some(Level { output, most })
        }
    };
    let sound = sound && settle_s >= 0.0 && level.is_none_or(|level| level.most > 0.0);
    sound.then_some(Steps {
        frequencies_hz: frequencies(band(program, number, p)?, points.round() as usize),
        amplitude,
        settle_s,
        periods: periods.round() as u32,
        level,
    })
}
