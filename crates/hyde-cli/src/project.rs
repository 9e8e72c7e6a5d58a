//! What the arguments name, loaded by [`hyde_study`]; what is wrong with it is printed, and gives the exit status.

use crate::args::ModelArgs;
use crate::exit::Exit;
pub(crate) use crate::output::{print_diagnostics, print_error, print_output};
use crate::{output, render, sandbox};
use hyde_compiler::{Candidate, Compiled, Laws};
use hyde_diag::{Diagnostics, Sources};
use hyde_experiment::RunError;
use hyde_program::Program;
use hyde_study::run_failure;
pub(crate) use hyde_study::{Aim, Asked, Loaded, Project, Records};
use hyde_study::{Fault, Refused};
use serde_json::json;

/// What the arguments ask for; ends where they cannot be read.
pub(crate) fn asked(args: &ModelArgs) -> Result<Asked, Exit> {
    let asked = Asked {
        experiment: args.experiment.clone(),
        model: args.model.clone(),
        data: args.data.clone(),
        whole_library: args.whole_library,
        inputs: args.inputs.clone(),
        fmu_host: sandbox::host(args.sandbox),
        ..Asked::of_file(&args.file)
    };
    let asked = asked.with_texts(&args.settings, &args.records);
    asked.map_err(|reason| complain(args, Exit::CommandLine, &reason))
}

/// Loads what the arguments name; reports and ends where that has errors.
pub(crate) fn load(args: &ModelArgs, needed: Records) -> Result<Project, Exit> {
    chosen(args, parsed(args)?, needed)
}

/// What the arguments name in their file, which is parsed; reports and ends where that has errors.
pub(crate) fn chosen(args: &ModelArgs, loaded: Loaded, needed: Records) -> Result<Project, Exit> {
    let project = chosen_silently(args, loaded, needed)?;
    if project.diagnostics.has_errors() {
        return Err(project.finish_with_errors(args));
    }
    Ok(project)
}

fn chosen_silently(args: &ModelArgs, loaded: Loaded, needed: Records) -> Result<Project, Exit> {
    let project = loaded.choose(&asked(args)?, needed);
    let project = project.map_err(|reason| complain(args, Exit::CommandLine, &reason))?;
    if !project.fmus.is_empty() && !args.sandbox {
        output::keep_own();
    }
    Ok(project)
}

/// The file that the arguments name, parsed; what is wrong in it stays among its diagnostics.
pub(crate) fn parsed(args: &ModelArgs) -> Result<Loaded, Exit> {
    let loaded = Loaded::of(&asked(args)?);
    loaded.map_err(|reason| complain(args, Exit::CommandLine, &reason))
}

/// The files that a command is about: the one named, or those of the package in the folder named.
pub(crate) fn files_of(args: &ModelArgs) -> Result<Vec<ModelArgs>, Exit> {
    let files = hyde_study::files_of(&asked(args)?).map_err(|own| refused(args, &own))?;
    let files = files.into_iter();
    Ok(files
        .map(|file| ModelArgs {
            file,
            ..args.clone()
        })
        .collect())
}

/// The file, parsed once, and the arguments for each of its experiments, if none is named; no arguments where a file of a folder
/// has nothing to compile.
pub(crate) fn experiments_of(
    args: &ModelArgs,
    folder: bool,
) -> Result<(Loaded, Vec<ModelArgs>), Exit> {
    let loaded = parsed(args)?;
    if args.experiment.is_some() || args.model.is_some() {
        return Ok((loaded, vec![args.clone()]));
    }
    let named = |name: &str| ModelArgs {
        experiment: Some(name.to_owned()),
        ..args.clone()
    };
    let experiments = loaded.file.experiments();
    let mut each: Vec<ModelArgs> = experiments.map(|own| named(&own.name.text)).collect();
    let nothing = folder && loaded.file.models().next().is_none();
    if each.is_empty() && nothing && loaded.diagnostics.has_errors() {
        return Err(refused(args, &loaded.refused()));
    }
    if each.is_empty() && !nothing {
        each.push(args.clone());
    }
    Ok((loaded, each))
}

impl From<Fault> for Exit {
    fn from(fault: Fault) -> Self {
        match fault {
            Fault::Asked => Self::CommandLine,
            Fault::Model => Self::Model,
            Fault::Solver => Self::Solver,
            Fault::Expectation => Self::Expectation,
            Fault::Interrupted => Self::Interrupted,
        }
    }
}

/// What the command line makes of a project: errors are printed and end the command.
pub(crate) trait Told {
    /// Compiles; reports and ends with the errors otherwise.
    fn compile_or_report(&mut self, args: &ModelArgs, aim: Aim) -> Result<Compiled, Exit>;

    /// Which effects fit where on the model, as long as that is in order; reports and ends otherwise.
    fn candidates_or_report(&mut self, args: &ModelArgs) -> Result<Vec<Candidate>, Exit>;

    /// Where a law may act on the model and what it may be made of, as long as both are in order; reports and ends otherwise.
    fn laws_or_report(&mut self, args: &ModelArgs) -> Result<Laws, Exit>;

    /// Prints warnings, if any, on standard error.
    fn print_warnings(&self, args: &ModelArgs);

    /// Prints the diagnostics of a model that is at fault.
    fn finish_with_errors(&self, args: &ModelArgs) -> Exit;

    /// Reports why a model cannot be given its parameters.
    fn report_refused(&mut self, args: &ModelArgs, program: &Program, error: &RunError) -> Exit;
}

impl Told for Project {
    fn compile_or_report(&mut self, args: &ModelArgs, aim: Aim) -> Result<Compiled, Exit> {
        self.compile(aim).map_err(|fault| {
            self.finish_with_errors(args);
            fault.into()
        })
    }

    fn candidates_or_report(&mut self, args: &ModelArgs) -> Result<Vec<Candidate>, Exit> {
        let found = self.candidates();
        found.ok_or_else(|| self.finish_with_errors(args))
    }

    fn laws_or_report(&mut self, args: &ModelArgs) -> Result<Laws, Exit> {
        let found = self.laws();
        found.ok_or_else(|| self.finish_with_errors(args))
    }

    fn print_warnings(&self, args: &ModelArgs) {
        if !self.diagnostics.is_empty() && !args.quiet {
            print_diagnostics(&self.diagnostics, &self.sources, "");
        }
    }

    fn finish_with_errors(&self, args: &ModelArgs) -> Exit {
        report_errors(args, &self.sources, &self.diagnostics)
    }

    fn report_refused(&mut self, args: &ModelArgs, program: &Program, error: &RunError) -> Exit {
        let (diagnostic, fault) = run_failure::diagnostic(error, program, None);
        self.diagnostics.push(diagnostic);
        self.finish_with_errors(args);
        fault.into()
    }
}

/// Reports why a study has no answer.
pub(crate) fn refused(args: &ModelArgs, refused: &Refused) -> Exit {
    match refused {
        Refused::Asked(reason) => complain(args, Exit::CommandLine, reason),
        Refused::Because(reason, fault) => complain(args, (*fault).into(), reason),
        Refused::Model {
            sources,
            diagnostics,
            fault,
        } => {
            report_errors(args, sources, diagnostics);
            (*fault).into()
        }
    }
}

/// Prints the diagnostics of what is at fault.
pub(crate) fn report_errors(
    args: &ModelArgs,
    sources: &Sources,
    diagnostics: &Diagnostics,
) -> Exit {
    if args.json {
        let list = render::to_json(diagnostics, sources);
        print_output(&format!(
            "{:#}",
            json!({ "ok": false, "diagnostics": list })
        ));
    } else {
        let count = diagnostics.error_count();
        let errors = if count == 1 {
            "1 error".to_owned()
        } else {
            format!("{count} errors")
        };
        let file = args.file.display();
        let last = format!("{file}: {errors}; `hyde explain CODE` tells more");
        print_diagnostics(diagnostics, sources, &last);
    }
    Exit::Model
}

/// Tells what is wrong with the command line, and gives back the exit status.
pub(crate) fn complain(args: &ModelArgs, exit: Exit, reason: &str) -> Exit {
    if args.json {
        print_output(&format!("{:#}", json!({ "ok": false, "error": reason })));
    } else {
        print_error(&format!("error: {reason}"));
    }
    exit
}
