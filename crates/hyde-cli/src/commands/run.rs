//! `hyde run`: solves an experiment and compares it with its records.
//!
//! ```text
//! solved         the experiment compiled and solved                  run/solved.rs
//! failed         what is told and kept of a run that failed          run/failed.rs
//! folder         the files of a run                                  run/folder.rs
//! trajectories   its results for Matlab                              run/trajectories.rs
//! ```

mod failed;
mod folder;
mod solved;
mod trajectories;

pub(crate) use solved::{solved, solved_of};

use crate::args::{Format, RunArgs};
use crate::exit::Exit;
use crate::project::{Project, complain, print_error, print_output};
use folder::leave;
use hyde_compiler::Compiled;
use hyde_experiment::Run;
use hyde_present::{forces, summary};
use std::time::Duration;

/// Runs an experiment, prints what happened, and leaves its files.
pub(crate) fn run(args: &RunArgs) -> Exit {
    if args.format != Format::Csv && args.out.is_none() {
        let reason = "`--format` is that of a file: write `--out DIR` too";
        return complain(&args.model, Exit::CommandLine, reason);
    }
    match solved(args) {
        Ok((project, compiled, run, took)) => finish(args, &project, &compiled, &run, took),
        Err(exit) => exit,
    }
}

/// The same for a model that is loaded.
pub(crate) fn run_project(args: &RunArgs, project: Project) -> Exit {
    match solved_of(args, project) {
        Ok((project, compiled, run, took)) => finish(args, &project, &compiled, &run, took),
        Err(exit) => exit,
    }
}

fn finish(
    args: &RunArgs,
    project: &Project,
    compiled: &Compiled,
    run: &Run,
    took: Duration,
) -> Exit {
    if let Some(folder) = &args.out
        && let Err(reason) = leave(folder, args.format, project, compiled, run)
    {
        return complain(&args.model, Exit::CommandLine, &reason);
    }
    if args.model.json {
        let mut summary = summary::json(project, compiled, run);
        if args.forces {
            summary["forces"] = forces::json(compiled, run);
        }
        print_output(&format!("{summary:#}"));
    } else if !args.model.quiet {
        print_output(&summary::text(project, compiled, run, took));
        if args.forces {
            print_output(&forces::text(compiled, run));
        }
        if let Some(folder) = &args.out {
            let asked = &compiled.program.experiment.figures;
            let figures: String = asked.iter().map(|f| format!(", {}.png", f.name)).collect();
            print_output(&format!(
                "\n  results, events.csv, summary.json{figures} and report.html are in {}",
                folder.display()
            ));
        }
    }
    if run.measures.iter().all(|measure| measure.holds) {
        return Exit::Done;
    }
    if args.model.quiet {
        for measure in run.measures.iter().filter(|measure| !measure.holds) {
            let (name, why) = (&measure.name, summary::why_missing(measure));
            print_error(&if measure.expectation {
                format!("expect {name}: does not hold{why}")
            } else {
                format!("{name}: no value{why}")
            });
        }
    }
    Exit::Expectation
}
