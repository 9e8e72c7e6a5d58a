//! The experiment that the arguments name, compiled and solved, with the progress on the terminal.

use super::failed::failed;
use crate::args::RunArgs;
use crate::exit::Exit;
use crate::interruption;
use crate::project::{self, Aim, Project, Records, Told as _, complain};
use crate::watch::Watch;
use hyde_compiler::Compiled;
use hyde_experiment::{Options, Run};
use std::sync::Arc;
use std::time::Duration;

/// Loads, compiles and solves.
pub(crate) fn solved(args: &RunArgs) -> Result<(Project, Compiled, Run, Duration), Exit> {
    solved_of(args, project::load(&args.model, Records::Needed)?)
}

/// Compiles and solves what was loaded.
#[allow(
    clippy::disallowed_methods,
    reason = "the command line tells how long a run took"
)]
pub(crate) fn solved_of(
    args: &RunArgs,
    mut project: Project,
) -> Result<(Project, Compiled, Run, Duration), Exit> {
    for (option, value) in [
        ("stop", args.stop),
        ("rtol", args.rtol),
        ("atol", args.atol),
    ] {
        // A record may begin below 0, and the run with it.
        let least = match option {
            "stop" if !project.records.is_empty() => f64::NEG_INFINITY,
            _ => 0.0,
        };
        if value.is_some_and(|value| value.is_nan() || value <= least) {
            let reason = format!("`--{option}` must be positive");
            return Err(complain(&args.model, Exit::CommandLine, &reason));
        }
    }
    let compiled = project.compile_or_report(
        &args.model,
        if args.ledger { Aim::Ledger } else { Aim::Run },
    )?;
    project.print_warnings(&args.model);
    let options = Options {
        set: project.set(),
        stop_s: args.stop,
        rtol: args.rtol,
        atol: args.atol,
        every_s: None,
        measured_from_s: None,
        gradient: args.gradient.clone(),
        interrupted: interruption::interrupted(),
        reached: Arc::default(),
    };
    let tables = hyde_study::tables(&project.records);
    let start = std::time::Instant::now();
    let watch = Watch::of_run(args.model.quiet, &options.reached);
    let outcome = hyde_experiment::run(&compiled.program, &tables, &options);
    drop(watch);
    match outcome {
        Ok(run) => {
            let took = start.elapsed();
            Ok((project, compiled, run, took))
        }
        Err(error) => Err(failed(args, project, &compiled, &options, &error)),
    }
}
