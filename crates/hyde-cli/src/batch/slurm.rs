//! `--engine slurm`: the shards of a batch as a job array. The truth is the journals: what Slurm says of a job is asked only
//! to know whether it still runs.

use crate::files;
use hyde_experiment::batch::indices;
use std::path::Path;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The most tasks of an array where a site has not changed `MaxArraySize`.
pub(crate) const MOST: usize = 1000;
/// How often the queue is looked at.
const POLL: Duration = Duration::from_millis(500);
/// How often shards are submitted again that left cases missing.
const ROUNDS: usize = 3;

/// A batch that Slurm works on.
pub(crate) struct Array<'a> {
    /// The folder of the batch, on a disk that all nodes see.
    pub(crate) folder: &'a Path,
    /// Its identity: the jobs are called by it, so that a second process finds those of the first.
    pub(crate) identity: String,
    /// The number of shards.
    pub(crate) shards: usize,
    /// Cases that each task solves at once.
    pub(crate) jobs: usize,
    /// Whether each FMU runs in a process of its own.
    pub(crate) sandbox: bool,
    /// Options for `sbatch`.
    pub(crate) options: &'a [String],
}

/// Why an array ended before the batch.
pub(crate) enum Ended {
    /// It was told to; what runs goes on.
    Interrupted,
    /// Slurm, or the tasks, could not go on.
    Failed(String),
}

impl Array<'_> {
    /// Submits the shards that `missing` gives until it gives none.
    pub(crate) fn run(
        &self,
        mut missing: impl FnMut() -> Result<Vec<usize>, String>,
        interrupted: &AtomicBool,
        tell: impl Fn(&str),
    ) -> Result<(), Ended> {
        // Those of a process before this one.
        self.wait(interrupted)?;
        for round in 0..ROUNDS {
            let left = missing().map_err(Ended::Failed)?;
            if left.is_empty() {
                return Ok(());
            }
            let list = indices(&left, MOST);
            for part in &list {
                tell(&format!(
                    "{} shards {part}",
                    if round == 0 {
                        "submitted"
                    } else {
                        "submitted again"
                    }
                ));
                self.submit(part).map_err(Ended::Failed)?;
            }
            self.wait(interrupted)?;
        }
        let left = missing().map_err(Ended::Failed)?;
        if left.is_empty() {
            return Ok(());
        }
        Err(Ended::Failed(format!(
            "shards {} were submitted {ROUNDS} times and have cases missing; what they said is in `{}`",
            indices(&left, MOST).join(","),
            self.folder.join("log").display()
        )))
    }

    fn submit(&self, list: &str) -> Result<(), String> {
        let log = self.folder.join("log");
        files::make_folder(&log)?;
        let hyde = std::env::current_exe().map_err(|error| error.to_string())?;
        let folder = files::real(self.folder).unwrap_or_else(|| self.folder.to_path_buf());
        let task = format!(
            "exec {} sweep {} --shard auto/{} --jobs {} --quiet{}",
            shell(&hyde.to_string_lossy()),
            shell(&folder.to_string_lossy()),
            self.shards,
            self.jobs,
            if self.sandbox { " --sandbox" } else { "" }
        );
        let mut command = Command::new("sbatch");
        command
            .arg("--parsable")
            .arg(format!("--job-name={}", self.name()))
            .arg(format!("--array={list}"))
            .arg(format!("--cpus-per-task={}", self.jobs))
            .arg(format!("--output={}", log.join("%A_%a.txt").display()))
            .args(self.options)
            .arg(format!("--wrap={task}"));
        said(&mut command).map(drop)
    }

    /// Waits until no job of the batch is in the queue.
    fn wait(&self, interrupted: &AtomicBool) -> Result<(), Ended> {
        loop {
            let name = format!("--name={}", self.name());
            let mut command = Command::new("squeue");
            command.args(["--noheader", "--format=%i", &name]);
            if said(&mut command).map_err(Ended::Failed)?.trim().is_empty() {
                return Ok(());
            }
            if interrupted.load(Ordering::Relaxed) {
                return Err(Ended::Interrupted);
            }
            std::thread::sleep(POLL);
        }
    }

    fn name(&self) -> String {
        format!("hyde-{}", self.identity.get(..12).unwrap_or(&self.identity))
    }
}

/// What a command prints; an error with what it complains of.
fn said(command: &mut Command) -> Result<String, String> {
    let program = command.get_program().to_string_lossy().into_owned();
    let output = command.output().map_err(|error| {
        if error.kind() == std::io::ErrorKind::NotFound {
            format!("there is no `{program}` here: Slurm is not installed, or not in the path")
        } else {
            format!("`{program}`: {error}")
        }
    })?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    Err(format!(
        "`{program}` failed: {}",
        String::from_utf8_lossy(&output.stderr).trim()
    ))
}

/// A word as a shell reads it.
fn shell(text: &str) -> String {
    format!("'{}'", text.replace('\'', "'\\''"))
}
