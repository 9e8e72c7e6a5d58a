//! A run that failed: its diagnostic, and what it computed so far, marked as incomplete.

use super::folder::leave;
use crate::args::RunArgs;
use crate::exit::Exit;
use crate::project::{Project, complain, print_diagnostics, print_error, print_output};
use crate::render;
use hyde_compiler::Compiled;
use hyde_experiment::{Options, RunError};
use hyde_study::run_failure;
use hyde_units::significant;
use serde_json::json;

/// Prints why a run failed, and keeps what it computed so far.
pub(super) fn failed(
    args: &RunArgs,
    mut project: Project,
    compiled: &Compiled,
    options: &Options,
    error: &RunError,
) -> Exit {
    let name = project.experiment.as_deref();
    let mut experiments = project.file.experiments();
    let experiment = experiments.find(|known| name == Some(known.name.text.as_str()));
    let (diagnostic, fault) = run_failure::diagnostic(error, &compiled.program, experiment);
    let exit = Exit::from(fault);
    let reason = diagnostic.message.clone();
    if exit == Exit::Interrupted {
        complain(&args.model, exit, &diagnostic.message);
    } else {
        project.diagnostics.push(diagnostic);
        tell(args, &project);
    }
    // The rows so far are kept, marked as incomplete.
    if let (Some(folder), RunError::Failed(failure)) = (&args.out, error) {
        let (program, tables) = (&compiled.program, hyde_study::tables(&project.records));
        let run = hyde_experiment::incomplete(program, &tables, options, failure, reason);
        let kept = run
            .map_err(|_| "nothing of this run can be kept".to_owned())
            .and_then(|run| leave(folder, args.format, &project, compiled, &run));
        match kept {
            Ok(()) if args.model.quiet => {}
            Ok(()) => print_error(&format!(
                "the results up to {} s are in {}, marked as incomplete",
                significant(failure.t, 7),
                folder.display()
            )),
            Err(reason) => print_error(&format!("error: {reason}")),
        }
    }
    exit
}

/// Prints the diagnostics of a run.
fn tell(args: &RunArgs, project: &Project) {
    if args.model.json {
        let diagnostics = render::to_json(&project.diagnostics, &project.sources);
        print_output(&format!(
            "{:#}",
            json!({ "ok": false, "diagnostics": diagnostics })
        ));
    } else {
        print_diagnostics(&project.diagnostics, &project.sources, "");
    }
}
