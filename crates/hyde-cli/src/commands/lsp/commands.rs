//! Commands that an editor starts: this program once more, in a process of its own, which ends with the session.

use super::ran;
use hyde_editor::{Action, Order, Outcome};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;

/// How often a command is asked whether it is done.
const ASKED: Duration = Duration::from_millis(20);

/// What is told how it ended.
type Done = Box<dyn FnOnce(Outcome) + Send>;

/// The commands of a session.
#[derive(Default)]
pub(super) struct Commands {
    ended: Arc<AtomicBool>,
    threads: Mutex<Vec<JoinHandle<()>>>,
}

impl Commands {
    /// Starts a command whose files go below `cache`, and comes back at once.
    pub(super) fn start(&self, cache: &Path, order: Order, done: Done) {
        let folder = folder(cache, &order);
        let ended = Arc::clone(&self.ended);
        let thread = std::thread::spawn(move || done(outcome(&order, &folder, &ended)));
        if let Ok(mut threads) = self.threads.lock() {
            threads.retain(|own| !own.is_finished());
            threads.push(thread);
        }
    }
}

impl Drop for Commands {
    fn drop(&mut self) {
        self.ended.store(true, Ordering::Relaxed);
        let threads = self.threads.lock().map(|mut own| std::mem::take(&mut *own));
        for thread in threads.unwrap_or_default() {
            drop(thread.join());
        }
    }
}

/// The same folder for the same order: a page that is still open shows the new result.
fn folder(cache: &Path, order: &Order) -> PathBuf {
    let own = format!("{}\n{}", order.file.display(), order.name);
    let hash = format!("{:x}", Sha256::digest(own.as_bytes()));
    let (hash, _) = hash.split_at(16);
    cache
        .join("pages")
        .join(format!("{}-{hash}", order.action.title().to_lowercase()))
}

/// Runs a command: the page that it wrote, and of a run the values of its variables.
fn outcome(order: &Order, folder: &Path, ended: &AtomicBool) -> Outcome {
    if order.action != Action::Run {
        return page(order, folder, ended).map(|(page, _)| page).into();
    }
    match page(order, folder, ended) {
        Ok((page, said)) => ran::outcome(folder, page, &said),
        Err(reason) => Err(reason).into(),
    }
}

/// The page that a command wrote, and what it said on standard output: JSON of a run. A run that wrote no page because the
/// model is at fault has said why there.
fn page(order: &Order, folder: &Path, ended: &AtomicBool) -> Result<(PathBuf, String), String> {
    let (word, page) = match order.action {
        Action::Run => ("run", "report.html"),
        Action::Bode => ("bode", "bode.html"),
        Action::Modes => ("modes", "modes.html"),
        Action::Diagnose => ("diagnose", "report.html"),
    };
    let page = folder.join(page);
    // Files of an earlier time are not the answer to this order.
    for old in [&page, &folder.join(ran::RESULTS)] {
        match std::fs::remove_file(old) {
            Err(error) if error.kind() != std::io::ErrorKind::NotFound => {
                return Err(error.to_string());
            }
            Ok(()) | Err(_) => {}
        }
    }
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let child = Command::new(program)
        .arg(word)
        .arg(&order.file)
        .arg(&order.name)
        .arg("--out")
        .arg(folder)
        .args(match order.action {
            Action::Run => ["--json", "--format=parquet"].as_slice(),
            Action::Bode | Action::Modes | Action::Diagnose => &["--quiet"],
        })
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn();
    let mut child = child.map_err(|error| error.to_string())?;
    // A command that says much would wait for a reader.
    let complaints = child.stderr.take().map(reader);
    let answer = child.stdout.take().map(reader);
    wait(&mut child, ended)?;
    let said = |own: Option<JoinHandle<String>>| own.and_then(|own| own.join().ok());
    let complaints = said(complaints).unwrap_or_default();
    let answer = said(answer).unwrap_or_default();
    if std::fs::exists(&page).unwrap_or(false) {
        return Ok((page, answer));
    }
    Err(match (complaints.trim(), ran::reason(&answer)) {
        (_, Some(reason)) => reason,
        ("", None) => format!("`hyde {word}` wrote no page"),
        (said, None) => said.to_owned(),
    })
}

/// Reads a stream to its end.
fn reader(stream: impl std::io::Read + Send + 'static) -> JoinHandle<String> {
    std::thread::spawn(move || std::io::read_to_string(stream).unwrap_or_default())
}

/// Waits until a command is done; ends it with the session.
fn wait(child: &mut Child, ended: &AtomicBool) -> Result<(), String> {
    loop {
        match child.try_wait() {
            Ok(Some(_)) => return Ok(()),
            Ok(None) if ended.load(Ordering::Relaxed) => {
                drop(child.kill());
                drop(child.wait());
                return Err("the session ended".to_owned());
            }
            Ok(None) => std::thread::sleep(ASKED),
            Err(error) => return Err(error.to_string()),
        }
    }
}
