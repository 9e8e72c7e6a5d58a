//! `hyde sweep`: the cases of a sweep, solved here or elsewhere, kept as they finish, and made into one data set.
//!
//! ```text
//! work       the cases solved in this process or by Slurm             sweep/work.rs
//! told       the summary, as a file and on the terminal               sweep/told.rs
//! ```

mod told;
mod work;

use crate::args::{Engine, RunArgs, SweepArgs};
use crate::batch::asked::order_of;
use crate::batch::folder::{keep, locked, merge};
use crate::batch::prepared::{model_args, prepared};
use crate::batch::progress::Shown;
use crate::batch::shard::shard_range;
use crate::batch::slurm;
use crate::commands::run;
use crate::exit::Exit;
use crate::project::{Records, print_error, print_output};
use crate::{files, interruption};
use hyde_experiment::batch::indices;
use hyde_study::sweep::{How, Order, Prepared};
use hyde_study::world::Disk;
use serde_json::json;
use std::path::PathBuf;
use std::sync::Arc;
use told::tell;
use work::Work;

/// Solves what is missing of a batch and tells what came of it.
pub(crate) fn sweep(args: &SweepArgs) -> Exit {
    match swept(args) {
        Ok(exit) | Err(exit) => exit,
    }
}

fn swept(args: &SweepArgs) -> Result<Exit, Exit> {
    let failed = |reason: String| complain(args, Exit::CommandLine, &reason);
    let kept = Order::is_in(&Disk, &args.file);
    let (order, inputs) = order_of(args, kept).map_err(failed)?;
    let inputs = Arc::new(inputs);
    let model = model_args(&order.file, args);
    let Some(batch) = prepared(&order, &inputs, Records::Needed, &model)? else {
        return Ok(Exit::Done);
    };
    if let Some(case) = args.case {
        return again(args, batch, case);
    }
    // Without a folder it is kept nowhere.
    let scratch = tempfile::TempDir::new().map_err(|error| failed(error.to_string()))?;
    let folder: PathBuf = match (&args.out, kept) {
        (_, true) => args.file.clone(),
        (Some(out), false) => out.clone(),
        (None, false) => scratch.path().to_path_buf(),
    };
    keep(&order, &batch, &inputs, &folder).map_err(failed)?;
    let work = Work {
        args,
        batch: &batch,
        folder: &folder,
        kept,
    };
    match (args.missing, &args.shard) {
        (Some(count), _) => missing(&work, count),
        (None, Some(shard)) => part(&work, shard),
        (None, None) => whole(&work, &order),
    }
}

/// Prints which cases are not solved yet, as an array job takes them.
fn missing(work: &Work<'_>, count: usize) -> Result<Exit, Exit> {
    let missing = work.batch.missing_shards(&work.store()?, count);
    print_output(&indices(&missing, slurm::MOST).join("\n"));
    Ok(Exit::Done)
}

/// Solves the cases of one part of a batch that other processes may work on as well.
fn part(work: &Work<'_>, shard: &str) -> Result<Exit, Exit> {
    let failed = |reason: String| complain(work.args, Exit::CommandLine, &reason);
    let range = shard_range(shard, work.batch.plan.count()).map_err(failed)?;
    let _lock = locked(work.folder, true).map_err(failed)?;
    let solved = work.solve(range, &how(work.args, &Shown::new(work.args.json, true)))?;
    if work.args.json {
        let told = json!({ "event": "shard", "ok": true, "solved": solved.solved });
        print_output(&told.to_string());
    }
    Ok(Exit::Done)
}

/// Solves every case, here or by Slurm, and tells what came of them.
fn whole(work: &Work<'_>, order: &Order) -> Result<Exit, Exit> {
    let Work { args, folder, .. } = work;
    let failed = |reason: String| complain(args, Exit::CommandLine, &reason);
    let shared = args.engine == Engine::Slurm;
    let lock = locked(folder, shared).map_err(failed)?;
    if lock.is_some() && !shared {
        files::remove_unfinished(folder);
    }
    let shown = Shown::new(args.json, args.quiet);
    let how = how(args, &shown);
    let took = match args.engine {
        Engine::Local => work.solve(1..=work.batch.plan.count(), &how)?,
        Engine::Slurm => work.by_slurm(&how)?,
    };
    let summary = merge(work.batch, &work.store()?, folder, args.format.into()).map_err(failed)?;
    tell(work, order, &summary, took).map_err(failed)?;
    Ok(Exit::Done)
}

fn how<'a>(args: &SweepArgs, shown: &'a Shown) -> How<'a> {
    How {
        jobs: args.jobs.unwrap_or(0),
        interrupted: interruption::interrupted(),
        progress: shown,
    }
}

/// Runs one case as `hyde run` runs an experiment.
fn again(args: &SweepArgs, batch: Prepared, number: usize) -> Result<Exit, Exit> {
    if !(1..=batch.plan.count()).contains(&number) {
        let reason = format!("the sweep has cases 1 to {}", batch.plan.count());
        return Err(complain(args, Exit::CommandLine, &reason));
    }
    let model = model_args(&batch.asked.file, args);
    let run_args = RunArgs {
        out: args.out.clone(),
        ..RunArgs::of_model(&model)
    };
    Ok(run::run_project(&run_args, batch.project_of(number)))
}

fn complain(args: &SweepArgs, exit: Exit, reason: &str) -> Exit {
    if args.json {
        print_output(&json!({ "event": "error", "ok": false, "error": reason }).to_string());
    } else {
        print_error(&format!("error: {reason}"));
    }
    exit
}
