//! The frequency responses and the stability margins that an experiment asks for: of the linearised model, and as measured on
//! the full hybrid one by the sweep of its stimulus or by stepped sines; beside them what was measured on the machine.
//!
//! ```text
//! response   one response of the linearised model                  responses/response.rs
//! measured   what was measured on the machine, beside the model    responses/measured.rs
//! stepped    the response by stepped sines                         responses/stepped.rs
//! margins    the margins of loops that are cut                     responses/margins.rs
//! ```

pub mod margins;
pub mod measured;
pub mod response;
mod stepped;

pub use margins::{OfLoop, add_cuts};
pub use measured::Compared;
pub use response::Response;
pub use stepped::Stepped;

use crate::operating_point;
use crate::refusals::responses as refused;
use crate::{Aim, Fault, Project, Refused, assumptions, run_failure};
use hyde_compiler::Compiled;
use hyde_diag::Diagnostic;
use hyde_experiment::{
    About, Linear, LinearizeError, MeasuredCurve, Poles, Run, RunError, linearize_about,
    parameters, poles, swept_response,
};
use hyde_program::{Bode, Constant, Program};
use hyde_signal::Table;
use hyde_sim::{PointTime, Reached};
use response::{band, frequencies, linearised, no_rate};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// What is asked of an experiment, beside what it says itself.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The operating point: `0.3 [s]`, `start` or `steady`.
    pub at: Option<String>,
    /// Modes to linearise in: `guide=slip`.
    pub in_modes: Vec<String>,
    /// Nothing is run.
    pub linear: bool,
    /// The margins alone.
    pub margins: bool,
    /// Number of frequencies of a linearised response.
    pub points: usize,
}

/// How it is done.
pub struct How {
    /// Set by whoever wants it to end early.
    pub interrupted: Arc<AtomicBool>,
    /// How many frequencies are done.
    pub reached: Arc<Reached>,
    /// Runs of a stepped sine at once.
    pub threads: usize,
}

/// An experiment whose responses can be computed.
pub struct Prepared {
    /// The model and the experiment.
    pub project: Project,
    compiled: Compiled,
    tables: BTreeMap<String, Table>,
    parameters: Vec<f64>,
    recorded: Vec<MeasuredCurve>,
    options: Options,
    in_modes: Vec<(usize, usize)>,
}

/// The run of the experiment, which sweeps its stimulus.
pub struct OfRun {
    /// The model as it was run.
    pub compiled: Compiled,
    /// The run.
    pub run: Run,
}

/// What an experiment asks for.
pub struct Responses {
    /// The experiment.
    pub name: String,
    /// What it says of itself, else its name.
    pub title: String,
    /// The model and the experiment.
    pub project: Project,
    /// The model as it was linearised.
    pub compiled: Compiled,
    /// Its parameters.
    pub parameters: Vec<f64>,
    /// One for each `bode`.
    pub bodes: Vec<OfBode>,
    /// One for each loop that is cut.
    pub margins: Vec<OfLoop>,
    /// What was assumed of records and tables.
    pub notes: Vec<String>,
    /// The run, if there was one.
    pub run: Option<OfRun>,
}

/// The responses of one `bode`.
pub struct OfBode {
    /// From where.
    pub input: String,
    /// Its band in Hz.
    pub band: (f64, f64),
    /// About which moment it is linearised.
    pub time: PointTime,
    /// The linearised model.
    pub linear: Linear,
    /// Its poles.
    pub poles: Poles,
    /// One for each output.
    pub responses: Vec<Response>,
    /// What stepped sines gave, if they were asked for.
    pub stepped: Option<Stepped>,
}

impl Prepared {
    /// Compiles the experiment of a project for its linearised model.
    ///
    /// # Errors
    /// The model, the experiment or the options are at fault.
    pub fn new(mut project: Project, options: &Options) -> Result<Self, Refused> {
        if project.diagnostics.has_errors() {
            return Err(project.refused(Fault::Model));
        }
        let compiled = match project.compile(Aim::Linearize) {
            Ok(compiled) => compiled,
            Err(fault) => return Err(project.refused(fault)),
        };
        let program = &compiled.program;
        let no_cut = program.experiment.cuts.is_empty();
        if no_cut && options.margins {
            let reason = "the signal at which to open the loop is missing: write `margins of SIGNAL;` in the experiment, or give the option `--cut SIGNAL`; for example the output of a controller";
            return Err(Refused::Asked(reason.to_owned()));
        }
        if no_cut && program.experiment.bodes.is_empty() {
            let reason = "the experiment has no `bode` or `margins`: write `bode from u to y over 1 .. 50 [Hz];` or `margins of SIGNAL;`";
            return Err(Refused::Asked(reason.to_owned()));
        }
        let tables = crate::tables(&project.records);
        let parameters = match parameters(program, &tables, &project.set()) {
            Ok(parameters) => parameters,
            Err(error) => return Err(failed(project, program, &error)),
        };
        let recorded = match measured::curves(program, &tables, &parameters) {
            Ok(recorded) => recorded,
            Err(diagnostic) => return Err(refused(project, *diagnostic)),
        };
        let in_modes = options.in_modes.iter();
        let in_modes = in_modes.map(|text| operating_point::in_mode(program, text));
        let in_modes = in_modes.collect::<Result<_, _>>().map_err(Refused::Asked)?;
        Ok(Self {
            project,
            compiled,
            tables,
            parameters,
            recorded,
            options: options.clone(),
            in_modes,
        })
    }

    fn bodes(&self) -> &[Bode] {
        match self.options.margins {
            true => &[],
            false => &self.compiled.program.experiment.bodes,
        }
    }

    /// Whether the experiment is to be run, for the sweep of its stimulus.
    #[must_use]
    pub fn needs_run(&self) -> bool {
        !self.options.linear && self.bodes().iter().any(|bode| bode.stepped.is_none())
    }

    /// Computes the responses and the margins; `run` is that of the experiment, if it needs one.
    ///
    /// # Errors
    /// There is no response or margin: why.
    pub fn responses(mut self, run: Option<OfRun>, how: &How) -> Result<Responses, Refused> {
        let name = self.project.experiment.clone().unwrap_or_default();
        let mut found = Vec::new();
        for number in 0..self.bodes().len() {
            let (mut of, stepped) = match self.bode(&name, number, run.as_ref(), how) {
                Ok(of) => of,
                Err(Failed::Diagnosed(diagnostic)) => {
                    return Err(refused(self.project, *diagnostic));
                }
                Err(Failed::NoPoint(error)) => {
                    return Err(failed(self.project, &self.compiled.program, &error));
                }
                Err(Failed::Asked(reason)) => return Err(Refused::Asked(reason)),
            };
            if stepped {
                let responses = &mut of.responses;
                of.stepped = match stepped::measured(&mut self.project, number, responses, how) {
                    Ok(stepped) => stepped,
                    Err(stepped::Failed::Diagnosed(fault)) => {
                        return Err(self.project.refused(fault));
                    }
                    Err(stepped::Failed::Refused(refused)) => return Err(refused),
                };
            }
            found.push(of);
        }
        let program = &self.compiled.program;
        let about = (self.options.at.as_deref(), &self.in_modes[..]);
        let (tables, p) = (&self.tables, &self.parameters);
        let diagnostics = &mut self.project.diagnostics;
        let Some(margins) = margins::all(&name, program, tables, p, about, diagnostics) else {
            return Err(self.project.refused(Fault::Model));
        };
        let notes = assumptions::of_model(&self.project, program, p);
        Ok(Responses {
            title: title(&self.project, &name, &program.name),
            name,
            project: self.project,
            compiled: self.compiled,
            parameters: self.parameters,
            bodes: found,
            margins,
            notes,
            run,
        })
    }

    /// The responses of one `bode`, but for stepped sines; whether those are asked for comes with them.
    fn bode(
        &self,
        name: &str,
        number: usize,
        run: Option<&OfRun>,
        how: &How,
    ) -> Result<(OfBode, bool), Failed> {
        let (program, p) = (&self.compiled.program, &self.parameters);
        let bode = &self.bodes()[number];
        if program.experiment.differentiated.contains(&bode.input) {
            return Err(Failed::Diagnosed(Box::new(no_rate(bode))));
        }
        let band = band(program, number, p)
            .or_else(|| measured::band(program, number, &self.recorded))
            .ok_or_else(|| Failed::Asked("the band of frequencies is empty".to_owned()))?;
        let frequency = frequencies(band, self.options.points);
        let time = program.kernels.constant(Constant::RespondsAt(number), p);
        let time = operating_point::moment(self.options.at.as_deref(), bode.at, time);
        let time = time.map_err(Failed::Asked)?;
        let about = About {
            time,
            modes: &[&self.in_modes[..], &bode.modes].concat(),
            ..About::default()
        };
        let input = std::slice::from_ref(&bode.input);
        let nothing = |reason: String| {
            let diagnostic = refused::no_response_from(&reason, bode.origin.span);
            Failed::Diagnosed(Box::new(diagnostic))
        };
        let linear = linearize_about(program, &self.tables, p, input, about).map_err(|error| {
            if let LinearizeError::Failed(failure) = error {
                return Failed::NoPoint(RunError::Failed(failure));
            }
            nothing(format!(
                "there is no linearised response: {}",
                operating_point::why_not(&error)
            ))
        })?;
        let poles = poles(&linear);
        let asked = (bode, frequency.as_slice());
        let responses = linearised(name, program, asked, (&linear, &poles), &how.reached);
        let mut responses = responses.map_err(nothing)?;
        let of_run = run.map(|own| (&own.compiled.program, &own.run));
        let (recorded, tables) = (&self.recorded, &self.tables);
        let compared = measured::compared(program, number, recorded, &linear, tables, of_run);
        // A run that follows what was measured sweeps nothing.
        let sweeps = !compared.iter().any(Compared::has_run);
        for one in compared {
            let output = one.place.1;
            responses[output].measured.push(one);
        }
        if let (None, Some((program, run))) = (&bode.stepped, of_run)
            && sweeps
        {
            let own = &program.experiment.bodes[number];
            for swept in swept_response(own, &run.results, band) {
                let mut of = responses.iter_mut();
                if let Some(response) = of.find(|response| response.output == swept.output) {
                    response.swept = Some(swept.response);
                }
            }
        }
        let of = OfBode {
            input: bode.input.clone(),
            band,
            time,
            linear,
            poles,
            responses,
            stepped: None,
        };
        Ok((of, bode.stepped.is_some() && !self.options.linear))
    }
}

impl Responses {
    /// Whether every expectation held.
    #[must_use]
    pub fn holds(&self) -> bool {
        let run = self.run.iter().flat_map(|own| &own.run.measures);
        let mut stepped = self.bodes.iter().filter_map(|bode| bode.stepped.as_ref());
        run.into_iter().all(|measure| measure.holds) && stepped.all(Stepped::holds)
    }
}

/// Why there is no response of a `bode`.
enum Failed {
    Diagnosed(Box<Diagnostic>),
    NoPoint(RunError),
    Asked(String),
}

/// The project as a refusal, for one more reason.
fn refused(mut project: Project, diagnostic: Diagnostic) -> Refused {
    project.diagnostics.push(diagnostic);
    project.refused(Fault::Model)
}

/// The project as a refusal, as its model cannot be run.
fn failed(mut project: Project, program: &Program, error: &RunError) -> Refused {
    let (diagnostic, fault) = run_failure::diagnostic(error, program, None);
    project.diagnostics.push(diagnostic);
    project.refused(fault)
}

/// What the experiment says of itself, else its name.
fn title(project: &Project, name: &str, model: &str) -> String {
    let mut experiments = project.file.experiments();
    let own = experiments.find(|experiment| experiment.name.text == name);
    own.and_then(|experiment| experiment.doc.clone())
        .unwrap_or_else(|| format!("{name} of {model}"))
}
