//! [`Work`]: the cases of a batch, solved in this process or by Slurm.

use super::complain;
use crate::args::SweepArgs;
use crate::batch::slurm::{self, Array};
use crate::batch::store::Journals;
use crate::exit::Exit;
use crate::project::{print_error, print_output};
use hyde_present::lines::shell_word as word;
use hyde_study::Store as _;
use hyde_study::sweep::{Ended, How, Prepared, Took, solve_missing};
use hyde_units::counted;
use serde_json::json;
use std::ops::RangeInclusive;
use std::path::Path;

/// A batch in its folder.
pub(super) struct Work<'a> {
    pub(super) args: &'a SweepArgs,
    pub(super) batch: &'a Prepared,
    pub(super) folder: &'a Path,
    /// The folder was one of a batch before.
    pub(super) kept: bool,
}

impl Work<'_> {
    /// The finished cases.
    pub(super) fn store(&self) -> Result<Journals, Exit> {
        let store = Journals::open(&self.folder.join("journal"), self.batch.parts.whole);
        store.map_err(|reason| self.failed(&reason))
    }

    /// Solves the missing cases of a range in this process.
    pub(super) fn solve(&self, range: RangeInclusive<usize>, how: &How<'_>) -> Result<Took, Exit> {
        let store = self.store()?;
        solve_missing(self.batch, &store, range, how).map_err(|ended| match ended {
            Ended::Store(reason) => self.stopped(&reason, Exit::CommandLine),
            Ended::Interrupted => self.stopped("interrupted", Exit::Interrupted),
        })
    }

    /// Has Slurm solve the missing cases.
    pub(super) fn by_slurm(&self, how: &How<'_>) -> Result<Took, Exit> {
        let (args, batch, folder) = (self.args, self.batch, self.folder);
        if args.out.is_none() && !self.kept {
            return Err(
                self.failed("`--engine slurm` needs `--out DIR`, a folder that all nodes see")
            );
        }
        let array = Array {
            folder,
            identity: batch.parts.whole.to_string(),
            shards: args.shards.clamp(1, slurm::MOST),
            jobs: args.jobs.unwrap_or(1),
            sandbox: args.fmus.sandbox,
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
            Ok(()) => Ok(Took::default()),
            Err(slurm::Ended::Failed(reason)) => Err(complain(args, Exit::Solver, &reason)),
            Err(slurm::Ended::Interrupted) => {
                let reason =
                    "interrupted; the jobs go on: run the same command again to wait for them";
                Err(complain(args, Exit::Interrupted, reason))
            }
        }
    }

    /// Tells why a batch ended before its end, and what is there of it.
    fn stopped(&self, why: &str, exit: Exit) -> Exit {
        let (args, batch, folder) = (self.args, self.batch, self.folder);
        let store = Journals::open(&folder.join("journal"), batch.parts.whole);
        let done = store.map_or(0, |store| store.count());
        let kept = if args.out.is_some() || self.kept {
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

    fn failed(&self, reason: &str) -> Exit {
        complain(self.args, Exit::CommandLine, reason)
    }
}
