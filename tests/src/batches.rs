//! Batches as their users run them: the backlash axis P3 for many gaps, killed, split and measured.

use crate::cluster::Cluster;
use crate::root;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;
use tempfile::TempDir;

/// A folder with the model of a batch, and the command that runs it.
pub struct Batch {
    folder: TempDir,
    hyde: PathBuf,
}

impl Batch {
    /// P3 for `cases` gaps from 5 to 50 um, each solved up to `stop_s`, by this command.
    ///
    /// # Errors
    /// The model cannot be read or written.
    #[allow(clippy::disallowed_methods, reason = "a model is written for a batch")]
    pub fn backlash(hyde: &Path, cases: usize, stop_s: f64) -> Result<Self, String> {
        let model = root().join("tests/models/p3_batch.hyde");
        let text = std::fs::read_to_string(&model).map_err(|error| error.to_string())?;
        let text = text.replace("stop 10 [s]", &format!("stop {stop_s} [s]"));
        let text = text.replace("grid 1000;", &format!("grid {cases};"));
        let folder = TempDir::new().map_err(|error| error.to_string())?;
        std::fs::write(folder.path().join("p3_batch.hyde"), text)
            .map_err(|error| error.to_string())?;
        Ok(Self {
            folder,
            hyde: hyde.to_path_buf(),
        })
    }

    /// A path in the folder.
    #[must_use]
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// `hyde sweep` into the folder `out` with more arguments; as JSON.
    #[must_use]
    pub fn sweep(&self, out: &str, arguments: &[&str]) -> Command {
        let mut command = Command::new(&self.hyde);
        command
            .arg("sweep")
            .arg(self.path("p3_batch.hyde"))
            .args(["gaps", "--json", "--out"]);
        command
            .arg(self.path(out))
            .args(arguments)
            .stdin(Stdio::null());
        command
    }

    /// Runs it to its end.
    ///
    /// # Errors
    /// It failed.
    pub fn run(&self, out: &str, arguments: &[&str]) -> Result<Finished, String> {
        let output = self
            .sweep(out, arguments)
            .output()
            .map_err(|error| error.to_string())?;
        let text = String::from_utf8_lossy(&output.stdout).into_owned();
        if !output.status.success() {
            return Err(format!("{text}{}", String::from_utf8_lossy(&output.stderr)));
        }
        Ok(Finished(text))
    }

    /// The bytes of its data set.
    ///
    /// # Errors
    /// There is none.
    #[allow(clippy::disallowed_methods, reason = "what a batch left is read")]
    pub fn dataset(&self, out: &str) -> Result<Vec<u8>, String> {
        std::fs::read(self.path(out).join("cases.parquet")).map_err(|error| error.to_string())
    }

    /// How many bytes its journals have.
    #[must_use]
    #[allow(clippy::disallowed_methods, reason = "a folder is looked at")]
    pub fn journal_bytes(&self, out: &str) -> u64 {
        let entries = std::fs::read_dir(self.path(out).join("journal"));
        let files = entries.into_iter().flatten().flatten();
        files
            .filter_map(|entry| entry.metadata().ok())
            .map(|file| file.len())
            .sum()
    }

    /// Runs it on a private Slurm in four shards, kills the process of one task, and compares: `None` where Slurm is not
    /// installed, else whether all was submitted again that was needed and the data set has the bytes of `expected`.
    ///
    /// # Errors
    /// Slurm, or the batch, failed.
    pub fn on_slurm(&self, expected: &[u8]) -> Result<Option<bool>, String> {
        let Some(cluster) = Cluster::start(&self.path("slurm"))? else {
            return Ok(None);
        };
        let mut command = self.sweep("cluster", &["--engine", "slurm", "--shards", "4"]);
        let mut child = cluster
            .of(&mut command)
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| error.to_string())?;
        let killed = kill_one_task(&mut child, &self.path("cluster"))?;
        let output = child
            .wait_with_output()
            .map_err(|error| error.to_string())?;
        let said = String::from_utf8_lossy(&output.stdout);
        if !output.status.success() {
            return Err(format!("on Slurm: {said}"));
        }
        let again = said
            .lines()
            .filter(|line| line.contains("submitted again"))
            .count();
        Ok(Some(
            killed && again == 1 && self.dataset("cluster")? == expected,
        ))
    }
}

/// What a batch that ended said.
pub struct Finished(String);

impl Finished {
    /// A number of its summary, or of its start.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        number(&self.0, name)
    }
}

/// The last number of that name among lines of JSON.
#[must_use]
pub fn number(lines: &str, name: &str) -> Option<f64> {
    let (_, rest) = lines.rsplit_once(&format!("\"{name}\":"))?;
    let end = rest.find([',', '}', '\n']).unwrap_or(rest.len());
    rest[..end].trim().parse().ok()
}

/// Kills the first task of a batch's array that has put a case into its journal. False if all ended before.
#[allow(clippy::disallowed_methods, reason = "processes are looked for")]
fn kill_one_task(batch: &mut Child, folder: &Path) -> Result<bool, String> {
    let wanted = folder.to_string_lossy().into_owned();
    loop {
        if batch
            .try_wait()
            .map_err(|error| error.to_string())?
            .is_some()
        {
            return Ok(false);
        }
        for entry in std::fs::read_dir("/proc")
            .map_err(|error| error.to_string())?
            .flatten()
        {
            let Ok(line) = std::fs::read(entry.path().join("cmdline")) else {
                continue;
            };
            let words: Vec<&[u8]> = line.split(|byte| *byte == 0).collect();
            // `exec` made the task's shell this very process: hyde sweep FOLDER --shard auto/4.
            let is_task =
                words.get(2) == Some(&wanted.as_bytes()) && words.get(3) == Some(&&b"--shard"[..]);
            if is_task && has_written(&folder.join("journal")) {
                let id = entry.file_name().to_string_lossy().into_owned();
                let killed = Command::new("kill").args(["-9", &id]).status();
                return Ok(killed.is_ok_and(|status| status.success()));
            }
        }
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// Whether a journal has more than its header.
#[allow(clippy::disallowed_methods, reason = "a folder is looked at")]
fn has_written(journals: &Path) -> bool {
    let entries = std::fs::read_dir(journals).into_iter().flatten().flatten();
    entries
        .into_iter()
        .any(|entry| entry.metadata().is_ok_and(|file| file.len() > 100))
}
