//! `hyde sweep`: the cases of a sweep, solved here or elsewhere, kept as they finish, and made into one data set.

use crate::args::{Engine, ModelArgs, RunArgs, SweepArgs};
use crate::batch::asked::{asked_for_nothing, from_source, ordered, written};
use crate::batch::progress::Shown;
use crate::batch::slurm::{self, Array};
use crate::batch::store::Journals;
use crate::commands::run;
use crate::exit::Exit;
use crate::project::{self, Records, Told as _, print_error, print_output};
use crate::{files, interruption, sandbox};
use hyde_experiment::batch::{Summary, indices, shards};
use hyde_present::lines::shell_word as word;
use hyde_present::sweep::tell;
use hyde_study::sweep::{self, Ended, How, Order, Prepared, TableForm, Took, solve_missing};
use hyde_study::world::Disk;
use hyde_study::{Asked, Inputs, Store as _};
use hyde_units::counted;
use serde_json::json;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Solves what is missing of a batch and tells what came of it.
pub(crate) fn sweep(args: &SweepArgs) -> Exit {
    match swept(args) {
        Ok(exit) | Err(exit) => exit,
    }
}

fn swept(args: &SweepArgs) -> Result<Exit, Exit> {
    let kept = Order::is_in(&Disk, &args.file);
    if files::is_folder(&args.file) && !kept {
        let reason = format!("the folder `{}` contains no batch", args.file.display());
        return Err(complain(args, Exit::CommandLine, &reason));
    }
    let (order, inputs) = if kept {
        if args.sweep.is_some() || !asked_for_nothing(args) {
            let reason = format!(
                "`{}` is the folder of a batch, which defines the sweep: leave out the sweep, `--of`, `--set`, `--record`, `--data`, `--seed` and `--keep`",
                args.file.display()
            );
            return Err(complain(args, Exit::CommandLine, &reason));
        }
        Order::read(&Disk, &args.file)
            .map_err(|reason| complain(args, Exit::CommandLine, &reason))?
    } else {
        (ordered(args), Inputs::recording_with(written(args)))
    };
    let inputs = Arc::new(inputs);
    let Some(batch) = prepared(&order, &inputs, Records::Needed, (args.json, args.quiet))? else {
        return Ok(Exit::Done);
    };
    if let Some(case) = args.case {
        return again(args, batch, case);
    }
    // Without a folder it is kept nowhere.
    let scratch = tempfile::TempDir::new()
        .map_err(|error| complain(args, Exit::CommandLine, &error.to_string()))?;
    let folder: PathBuf = match (&args.out, kept) {
        (_, true) => args.file.clone(),
        (Some(out), false) => out.clone(),
        (None, false) => scratch.path().to_path_buf(),
    };
    let failed = |reason: String| complain(args, Exit::CommandLine, &reason);
    keep(&order, &batch, &inputs, &folder).map_err(failed)?;
    let open = || Journals::open(&folder.join("journal"), batch.parts.whole);
    if let Some(count) = args.missing {
        let missing = batch.missing_shards(&open().map_err(failed)?, count);
        print_output(&indices(&missing, slurm::MOST).join("\n"));
        return Ok(Exit::Done);
    }
    let how = How {
        jobs: args.jobs.unwrap_or(0),
        interrupted: interruption::interrupted(),
        progress: &Shown::new(args.json, args.quiet || args.shard.is_some()),
    };
    let shared = args.shard.is_some() || args.engine == Engine::Slurm;
    let lock = locked(&folder, shared).map_err(failed)?;
    if lock.is_some() && !shared {
        files::remove_unfinished(&folder);
    }
    let ended = |ended: Ended| match ended {
        Ended::Store(reason) => stopped(args, &batch, open(), &folder, &reason, Exit::CommandLine),
        Ended::Interrupted => stopped(
            args,
            &batch,
            open(),
            &folder,
            "interrupted",
            Exit::Interrupted,
        ),
    };
    if let Some(shard) = &args.shard {
        let range = shard_range(shard, batch.plan.count()).map_err(failed)?;
        let store = open().map_err(failed)?;
        let took = solve_missing(&batch, &store, range, &how).map_err(ended)?;
        if args.json {
            print_output(
                &json!({ "event": "shard", "ok": true, "solved": took.solved }).to_string(),
            );
        }
        return Ok(Exit::Done);
    }
    let (took, store) = match args.engine {
        Engine::Local => {
            let store = open().map_err(failed)?;
            let all = 1..=batch.plan.count();
            let took = solve_missing(&batch, &store, all, &how).map_err(ended)?;
            (took, store)
        }
        Engine::Slurm => {
            if args.out.is_none() && !kept {
                return Err(failed(
                    "`--engine slurm` needs `--out DIR`, a folder that all nodes see".to_owned(),
                ));
            }
            by_slurm(args, &batch, &folder, &how)?;
            (Took::default(), open().map_err(failed)?)
        }
    };
    let summary = merge(&batch, &store, &folder, args.format.into()).map_err(failed)?;
    let rerun = match (&args.out, kept) {
        (None, false) => from_source(args, &order),
        _ => format!("hyde sweep {}", word(&folder.to_string_lossy())),
    };
    let json = tell::json(&batch, &summary, &rerun);
    files::write(
        &folder.join("summary.json"),
        format!("{json:#}\n").as_bytes(),
    )
    .map_err(failed)?;
    if args.json {
        let mut json = json;
        json["solved"] = json!(took.solved);
        json["wall_s"] = json!(took.wall.as_secs_f64());
        json["solving_s"] = json!(took.solving.as_secs_f64());
        print_output(&json.to_string());
    } else if !args.quiet {
        print_output(&tell::text(&batch, &summary, took, &rerun));
    }
    Ok(Exit::Done)
}

/// One process has the folder, or any number of shards do. Where files cannot be locked the journals suffice.
fn locked(folder: &Path, shared: bool) -> Result<Option<std::fs::File>, String> {
    let file = files::open_lock(&folder.join("lock"))?;
    let locked = if shared {
        file.try_lock_shared()
    } else {
        file.try_lock()
    };
    match locked {
        Ok(()) => Ok(Some(file)),
        Err(std::fs::TryLockError::WouldBlock) => Err(format!(
            "another process is working in `{}`: wait for it, or end it",
            folder.display()
        )),
        Err(std::fs::TryLockError::Error(_)) => Ok(None),
    }
}

/// The cases of `3/16`, or of `auto/16` with the number that a scheduler gives its task.
#[allow(
    clippy::disallowed_methods,
    reason = "schedulers give the number of a task in the environment"
)]
fn shard_range(text: &str, cases: usize) -> Result<RangeInclusive<usize>, String> {
    let wrong = || {
        format!("`--shard {text}`: write `3/16`, or `auto/16` for the number from the scheduler")
    };
    let (number, count) = text.split_once('/').ok_or_else(wrong)?;
    let count: usize = count
        .parse()
        .ok()
        .filter(|count| *count > 0)
        .ok_or_else(wrong)?;
    let number = if number == "auto" {
        let names = [
            "SLURM_ARRAY_TASK_ID",
            "PBS_ARRAY_INDEX",
            "LSB_JOBINDEX",
            "SGE_TASK_ID",
        ];
        let found = names.iter().find_map(|name| std::env::var(name).ok());
        found.ok_or_else(|| format!("`--shard {text}`: none of {} is set", names.join(", ")))?
    } else {
        number.to_owned()
    };
    let number: usize = number
        .parse()
        .ok()
        .filter(|number| (1..=count).contains(number))
        .ok_or_else(wrong)?;
    // A batch of few cases has fewer shards.
    let empty = RangeInclusive::new(1, 0);
    Ok(shards(cases, count)
        .get(number - 1)
        .cloned()
        .unwrap_or(empty))
}

fn by_slurm(args: &SweepArgs, batch: &Prepared, folder: &Path, how: &How<'_>) -> Result<(), Exit> {
    let array = Array {
        folder,
        identity: batch.parts.whole.to_string(),
        shards: args.shards.clamp(1, slurm::MOST),
        jobs: args.jobs.unwrap_or(1),
        options: &args.slurm,
    };
    let missing = || {
        let store = Journals::open(&folder.join("journal"), batch.parts.whole)?;
        Ok(batch.missing_shards(&store, array.shards))
    };
    let tell = |text: &str| {
        if args.json {
            print_output(&json!({ "event": "slurm", "text": text }).to_string());
        } else if !args.quiet {
            print_error(text);
        }
    };
    match array.run(missing, &how.interrupted, tell) {
        Ok(()) => Ok(()),
        Err(slurm::Ended::Failed(reason)) => Err(complain(args, Exit::Solver, &reason)),
        Err(slurm::Ended::Interrupted) => {
            let reason = "interrupted; the jobs go on: run the same command again to wait for them";
            Err(complain(args, Exit::Interrupted, reason))
        }
    }
}

/// Tells why a batch ended before its end, and what is there of it.
fn stopped(
    args: &SweepArgs,
    batch: &Prepared,
    store: Result<Journals, String>,
    folder: &Path,
    why: &str,
    exit: Exit,
) -> Exit {
    let done = store.map_or(0, |store| store.count());
    let kept = if args.out.is_some() || Order::is_in(&Disk, &args.file) {
        format!(
            "; to resume: hyde sweep {}",
            word(&folder.to_string_lossy())
        )
    } else {
        String::new()
    };
    let reason = format!(
        "{why}, with {done} of {} done{kept}",
        counted(batch.plan.count(), "case")
    );
    complain(args, exit, &reason)
}

/// Runs one case as `hyde run` runs an experiment.
fn again(args: &SweepArgs, batch: Prepared, number: usize) -> Result<Exit, Exit> {
    if !(1..=batch.plan.count()).contains(&number) {
        let reason = format!("the sweep has cases 1 to {}", batch.plan.count());
        return Err(complain(args, Exit::CommandLine, &reason));
    }
    let model = model_args(&batch.asked.file, (args.json, args.quiet));
    let run_args = RunArgs {
        out: args.out.clone(),
        ..RunArgs::of_model(&model)
    };
    Ok(run::run_project(&run_args, batch.project_of(number)))
}

/// Prepares an order; what is wrong with it is printed, and warnings are.
pub(crate) fn prepared(
    order: &Order,
    inputs: &Arc<Inputs>,
    needed: Records,
    output: (bool, bool),
) -> Result<Option<Prepared>, Exit> {
    let model = model_args(&order.file, output);
    let base = Asked {
        inputs: Some(Arc::clone(inputs)),
        fmu_host: sandbox::host(),
        ..Asked::of_file(&order.file)
    };
    let batch =
        Prepared::new(order, &base, needed).map_err(|own| project::refused(&model, &own))?;
    if let Some(batch) = &batch {
        batch.project.print_warnings(&model);
    }
    Ok(batch)
}

fn model_args(file: &Path, (json, quiet): (bool, bool)) -> ModelArgs {
    ModelArgs {
        json,
        quiet,
        ..ModelArgs::of_file(file)
    }
}

/// Makes a folder the one of this batch.
fn keep(order: &Order, batch: &Prepared, inputs: &Inputs, folder: &Path) -> Result<(), String> {
    let identity = (&batch.parts, batch.plan.count());
    for (path, content) in order.files(&Disk, folder, identity, inputs)? {
        files::make_folder(path.parent().unwrap_or(folder))?;
        files::write(&path, &content)?;
    }
    Ok(())
}

/// Makes the data set of a batch whose store has every case. A file is there whole or not at all.
fn merge(
    batch: &Prepared,
    store: &Journals,
    folder: &Path,
    form: TableForm,
) -> Result<Summary, String> {
    let mut summary = None;
    files::write_with(&folder.join(form.file("cases")), |file| {
        summary = Some(sweep::cases(batch, store, form, file)?);
        Ok(())
    })?;
    if !batch.dataset.kept.is_empty() {
        files::write_with(&folder.join(form.file("trajectories")), |file| {
            sweep::trajectories(batch, store, form, file)
        })?;
    }
    Ok(summary.unwrap_or_default())
}

fn complain(args: &SweepArgs, exit: Exit, reason: &str) -> Exit {
    if args.json {
        print_output(&json!({ "event": "error", "ok": false, "error": reason }).to_string());
    } else {
        print_error(&format!("error: {reason}"));
    }
    exit
}
