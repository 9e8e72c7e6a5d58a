//! `hyde sweep`: the cases of a sweep, solved here or elsewhere, kept as they finish, and made into one data set.

use crate::args::{Engine, RunArgs, SweepArgs};
use crate::batch::asked::{asked_for_nothing, from_source, ordered, written};
use crate::batch::merge::merge;
use crate::batch::order::Order;
use crate::batch::prepare::Prepared;
use crate::batch::slurm::{self, Array};
use crate::batch::store::Store;
use crate::batch::tell;
use crate::batch::work::{Ended, How, Took, solve_missing};
use crate::commands::run;
use crate::exit::Exit;
use crate::files;
use crate::interruption;
use crate::project::{Records, print_error, print_output};
use hyde_experiment::batch::{indices, shards, varied};
use hyde_study::Inputs;
use hyde_study::settings::Setting;
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
    let kept = Order::is_in(&args.file);
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
        Order::read(&args.file).map_err(|reason| complain(args, Exit::CommandLine, &reason))?
    } else {
        (ordered(args), Inputs::recording_with(written(args)))
    };
    let batch = Prepared::new(
        &order,
        &Arc::new(inputs),
        Records::Needed,
        (args.json, args.quiet),
    )?;
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
    let recorded = batch.args.inputs.clone().unwrap_or_default();
    order
        .keep(&folder, &batch.parts, batch.plan.count(), &recorded)
        .map_err(failed)?;
    let open = || Store::open(&folder.join("journal"), batch.parts.whole);
    if let Some(count) = args.missing {
        let missing = missing_shards(&batch, &open().map_err(failed)?, count);
        print_output(&indices(&missing, slurm::MOST).join("\n"));
        return Ok(Exit::Done);
    }
    let how = How {
        jobs: args.jobs.unwrap_or(0),
        interrupted: interruption::interrupted(),
        json: args.json,
        quiet: args.quiet || args.shard.is_some(),
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
    let summary = merge(&batch, &store, &folder, args.format).map_err(failed)?;
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

/// A word as a shell reads it, quoted if it has to be.
pub(crate) fn word(text: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=,:+".contains(c);
    match text.chars().all(plain) && !text.is_empty() {
        true => text.to_owned(),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
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

/// The shards of so many that have cases missing.
fn missing_shards(batch: &Prepared, store: &Store, count: usize) -> Vec<usize> {
    let list = shards(batch.plan.count(), count);
    let missing = list
        .into_iter()
        .zip(1..)
        .filter(|(range, _)| range.clone().any(|case| !store.has(&Prepared::key(case))));
    missing.map(|(_, number)| number).collect()
}

fn by_slurm(args: &SweepArgs, batch: &Prepared, folder: &Path, how: &How) -> Result<(), Exit> {
    let array = Array {
        folder,
        identity: batch.parts.whole.to_string(),
        shards: args.shards.clamp(1, slurm::MOST),
        jobs: args.jobs.unwrap_or(1),
        options: &args.slurm,
    };
    let missing = || {
        let store = Store::open(&folder.join("journal"), batch.parts.whole)?;
        Ok(missing_shards(batch, &store, array.shards))
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
    store: Result<Store, String>,
    folder: &Path,
    why: &str,
    exit: Exit,
) -> Exit {
    let done = store.map_or(0, |store| store.len());
    let kept = if args.out.is_some() || Order::is_in(&args.file) {
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
fn again(args: &SweepArgs, mut batch: Prepared, number: usize) -> Result<Exit, Exit> {
    if !(1..=batch.plan.count()).contains(&number) {
        let reason = format!("the sweep has cases 1 to {}", batch.plan.count());
        return Err(complain(args, Exit::CommandLine, &reason));
    }
    let case = batch.plan.case(number);
    let options = batch.plan.options(&case);
    let (file, model) = varied(
        &batch.project.file,
        &batch.draft,
        &batch.project.model,
        &options,
    );
    let ready = batch
        .source()
        .compile(&options, &batch.plan.settings(&case));
    batch.project.file = file;
    batch.project.model = model;
    if let Ok(ready) = ready {
        for (name, table) in ready.tables {
            if let Some(record) = batch.project.records.get_mut(&name) {
                record.table = table;
            }
        }
    }
    for (path, value) in batch.plan.settings(&case) {
        let input = batch.plan.inputs.iter().find(|input| input.name == path);
        let unit = input.and_then(|input| input.unit.as_ref());
        let setting = Setting::of(path, value, unit.cloned());
        batch.project.settings.push(setting);
    }
    let run_args = RunArgs {
        out: args.out.clone(),
        ..RunArgs::of_model(&batch.args)
    };
    Ok(run::run_project(&run_args, batch.project))
}

fn complain(args: &SweepArgs, exit: Exit, reason: &str) -> Exit {
    if args.json {
        print_output(&json!({ "event": "error", "ok": false, "error": reason }).to_string());
    } else {
        print_error(&format!("error: {reason}"));
    }
    exit
}
