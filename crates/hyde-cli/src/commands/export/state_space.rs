//! `hyde export statespace`: the linearised model as matrices with names, for MATLAB, Octave, python-control, or as JSON.

mod content;
mod octave;
mod python;

use super::identifier;
use crate::args::{ModelArgs, StateSpaceArgs};
use crate::commands::modes::{Prepared, prepared};
use crate::exit::Exit;
use crate::files;
use crate::project::{Project, Told as _, complain, print_output};
use hyde_diag::{Code, Diagnostic};
use hyde_experiment::{About, LinearizeError, StateSpace, linearize_about, poles, state_space};
use hyde_present::assumed;
use hyde_program::Program;
use hyde_study::operating_point;
use hyde_study::ports::{chosen_outputs, is_input};
use hyde_units::{counted, significant};
use serde_json::json;
use std::path::{Path, PathBuf};

/// A state space with what it is about.
struct Found {
    /// The model, and the experiment.
    name: String,
    system: StateSpace,
    /// About what it is linearised, and what is assumed there.
    about: String,
}

/// The form of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Mat,
    Json,
    Python,
    Octave,
}

impl Form {
    fn of(path: &Path) -> Result<Self, String> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        match ending.as_ref() {
            "mat" => Ok(Self::Mat),
            "json" => Ok(Self::Json),
            "py" => Ok(Self::Python),
            "m" => Ok(Self::Octave),
            _ => Err(format!(
                "`--out {}`: the ending of the file is its format: write `.mat`, `.json`, `.py` or `.m`",
                path.display()
            )),
        }
    }
}

/// Writes the file.
pub(crate) fn export(args: &StateSpaceArgs) -> Exit {
    match written(args) {
        Ok(text) => {
            if !args.model.quiet {
                print_output(&text);
            }
            Exit::Done
        }
        Err(exit) => exit,
    }
}

fn written(args: &StateSpaceArgs) -> Result<String, Exit> {
    let model = &args.model;
    let refused = |reason: String| complain(model, Exit::CommandLine, &reason);
    let form = args.out.as_deref().map(Form::of).transpose();
    let form = form.map_err(refused)?.unwrap_or(Form::Mat);
    let ready = prepared(&args.about, model, None)?;
    let default = PathBuf::from(format!("{}.mat", identifier(&ready.project)));
    let found = found(args, ready)?;
    let content = match form {
        Form::Mat => content::mat(&found),
        Form::Json => format!("{:#}\n", content::json(&found)).into_bytes(),
        Form::Python => python::text(&found).into_bytes(),
        Form::Octave => octave::text(&found).into_bytes(),
    };
    let path = args.out.as_ref().unwrap_or(&default);
    files::write(path, &content).map_err(refused)?;
    Ok(match model.json {
        true => {
            let mut told = content::names(&found);
            told["ok"] = json!(true);
            told["file"] = json!(path.display().to_string());
            format!("{told:#}")
        }
        false => told(path, &found),
    })
}

fn found(args: &StateSpaceArgs, ready: Prepared) -> Result<Found, Exit> {
    let model = &args.model;
    let Prepared {
        mut project,
        compiled,
        tables,
        parameters: p,
        chosen,
        time,
    } = ready;
    let program = &compiled.program;
    let refused = |reason: String| complain(model, Exit::CommandLine, &reason);
    let inputs = inputs(program, &args.input).map_err(refused)?;
    let outputs = chosen_outputs(program, &args.output).map_err(refused)?;
    let outputs: Vec<usize> = match args.output.is_empty() {
        true => outputs.into_iter().collect(),
        // In the order in which they are named.
        false => args
            .output
            .iter()
            .filter_map(|n| program.output(n))
            .collect(),
    };
    if let Some(input) = inputs
        .iter()
        .find(|input| program.experiment.differentiated.contains(input))
    {
        let diagnostic = differentiated(program, input);
        project.diagnostics.push(diagnostic);
        return Err(project.finish_with_errors(model));
    }
    let about = About {
        time,
        modes: &chosen,
        open: args.open,
    };
    let linear = linearize_about(program, &tables, &p, &inputs, about);
    let linear = linear.map_err(|error| no_system(&mut project, model, program, error))?;
    let Some(system) = state_space(program, &p, &linear, (&inputs, &outputs)) else {
        project.diagnostics.push(delayed(program));
        return Err(project.finish_with_errors(model));
    };
    let of = match &project.experiment {
        Some(experiment) => format!("{} of {}", experiment, program.name),
        None => program.name.clone(),
    };
    let unstable = assumed::unstable(program, &p, &linear, &poles(&linear));
    Ok(Found {
        name: of,
        about: unstable.unwrap_or_default()
            + &loop_told(program, &system, args.open)
            + &assumed::text(program, &linear, time),
        system,
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

/// Which loop the system is that of.
fn loop_told(program: &Program, system: &StateSpace, open: bool) -> String {
    match system.sampled {
        Some(times) => format!(
            "closed loop, exact from one common period of the clocks to the next: {} ms\n",
            significant(1e3 * times.period_s, 6)
        ),
        None if open && !program.holds.is_empty() => {
            "plant alone: the held outputs of the clocks are inputs, behind the others\n".to_owned()
        }
        None => String::new(),
    }
}

fn told(path: &Path, found: &Found) -> String {
    let system = &found.system;
    format!(
        "  {}\n  {}: {}, {}, {}\n{}",
        path.display(),
        match system.sampled {
            Some(_) => "sampled",
            None => "continuous",
        },
        counted(system.states.len(), "state"),
        counted(system.inputs.len(), "input"),
        counted(system.outputs.len(), "output"),
        found.about
    )
}

fn differentiated(program: &Program, input: &str) -> Diagnostic {
    let message = format!(
        "the equations need the time derivative of `{input}`, so a state space has no such input"
    );
    let parameter = program.parameter(input);
    let diagnostic = Diagnostic::error(Code::CannotExport, message);
    let diagnostic = match parameter {
        Some((parameter, _)) => {
            diagnostic.label(parameter.origin.span, "differentiated in the model")
        }
        None => diagnostic,
    };
    diagnostic.help("name the other inputs with `--input`, or use that derivative as the input: for a prescribed motion the acceleration, with speed and position as its integrals")
}

fn delayed(program: &Program) -> Diagnostic {
    let message =
        "a model with a `delay` has infinitely many states, and a state space finitely many";
    let diagnostic = Diagnostic::error(Code::CannotExport, message);
    let diagnostic = match program.delays.first() {
        Some(delay) => diagnostic.label(delay.origin.span, "delayed here"),
        None => diagnostic,
    };
    diagnostic.help("`hyde bode` has the exact response; for a state space write the delay as a rational function, or inside a `clocked` part as values of earlier ticks")
}

/// Reports why there is no linearised system.
fn no_system(
    project: &mut Project,
    model: &ModelArgs,
    program: &Program,
    error: LinearizeError,
) -> Exit {
    match error {
        LinearizeError::Failed(failure) => project.report_no_point(model, program, failure),
        LinearizeError::DelayAndClock => {
            project.diagnostics.push(delayed(program));
            project.finish_with_errors(model)
        }
        LinearizeError::NoCommonPeriod | LinearizeError::LongDelay => {
            let reason = operating_point::why_not(&error);
            let diagnostic = Diagnostic::error(Code::CannotExport, reason);
            let diagnostic = match program.clocks.first() {
                Some(clock) => diagnostic.label(clock.origin.span, "a clock of the loop"),
                None => diagnostic,
            };
            let help = "choose periods that are multiples of one another and delays below a period, or export the plant alone with `--open`";
            project.diagnostics.push(diagnostic.help(help));
            project.finish_with_errors(model)
        }
        LinearizeError::NoInput(_) | LinearizeError::TooLarge(_) | LinearizeError::Singular => {
            let reason = format!(
                "there is no state space: {}",
                operating_point::why_not(&error)
            );
            complain(model, Exit::CommandLine, &reason)
        }
    }
}
