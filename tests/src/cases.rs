//! Small inputs with the right answer beside them: one folder a case, run as a user would run it.
//!
//! `tests/cases/NAME/case.toml` says what the case is about, where the right value comes from, the commands, and what each
//! must answer. The folder is copied before its commands run, so a command may leave files.

use crate::root;
use serde::Deserialize;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// A command that takes longer is ended: a case must never hang the tests.
const LONGEST: Duration = Duration::from_secs(120);

/// What `case.toml` says.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Case {
    /// The situation, and why the answer is right.
    pub about: String,
    /// The commands, in the order in which they run.
    pub run: Vec<Step>,
}

/// One command and what it must answer.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// The arguments of `hyde`. With `values`, `--json` is added.
    pub command: Vec<String>,
    /// The exit status.
    #[serde(default)]
    pub exit: i32,
    /// Texts that standard output and standard error contain.
    #[serde(default)]
    pub says: Vec<String>,
    /// Texts that neither contains.
    #[serde(default)]
    pub never_says: Vec<String>,
    /// Numbers of the JSON answer by their path: keys, indices, or the `name` of an element, separated by `/`.
    #[serde(default)]
    pub values: BTreeMap<String, Expected>,
}

/// A number with its tolerance.
#[derive(Clone, Copy, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expected {
    /// The right value.
    pub is: f64,
    /// The largest absolute difference from it.
    #[serde(default)]
    pub within: f64,
}

/// Every folder of `tests/cases`, by name.
///
/// # Errors
/// The folder cannot be read.
#[allow(clippy::disallowed_methods, reason = "tests list their cases")]
pub fn folders() -> Result<Vec<PathBuf>, String> {
    let all = root().join("tests/cases");
    let entries = std::fs::read_dir(&all).map_err(|e| format!("{}: {e}", all.display()))?;
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.is_dir()).collect();
    paths.sort();
    Ok(paths)
}

/// Runs a case with `hyde` and compares each answer.
///
/// # Errors
/// What differs, with the command and what it printed.
pub fn check(folder: &Path, hyde: &Path) -> Result<(), String> {
    let case = read(folder)?;
    let scratch = tempfile::tempdir().map_err(|error| error.to_string())?;
    copy(folder, scratch.path()).map_err(|error| format!("{}: {error}", folder.display()))?;
    for step in &case.run {
        let output = answer(step, hyde, scratch.path())?;
        compare(step, &output).map_err(|reason| {
            format!(
                "`hyde {}`: {reason}\n{}{}",
                step.command.join(" "),
                String::from_utf8_lossy(&output.stdout),
                String::from_utf8_lossy(&output.stderr)
            )
        })?;
    }
    Ok(())
}

#[allow(clippy::disallowed_methods, reason = "tests open their cases")]
fn read(folder: &Path) -> Result<Case, String> {
    let path = folder.join("case.toml");
    let text =
        std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))
}

fn copy(from: &Path, to: &Path) -> std::io::Result<()> {
    for entry in std::fs::read_dir(from)? {
        let entry = entry?;
        let target = to.join(entry.file_name());
        if entry.file_type()?.is_dir() {
            std::fs::create_dir_all(&target)?;
            copy(&entry.path(), &target)?;
        } else {
            std::fs::copy(entry.path(), target)?;
        }
    }
    Ok(())
}

/// What a command prints; files keep it, for a full pipe would hold the command up.
fn answer(step: &Step, hyde: &Path, folder: &Path) -> Result<Output, String> {
    let failed = |error: std::io::Error| format!("`hyde {}`: {error}", step.command.join(" "));
    let kept = || tempfile::tempfile().map_err(failed);
    let (stdout, stderr) = (kept()?, kept()?);
    let mut child = Command::new(hyde)
        .current_dir(folder)
        .args(&step.command)
        .args((!step.values.is_empty()).then_some("--json"))
        .stdin(Stdio::null())
        .stdout(stdout.try_clone().map_err(failed)?)
        .stderr(stderr.try_clone().map_err(failed)?)
        .spawn()
        .map_err(failed)?;
    let pause = Duration::from_millis(5);
    let mut waited = Duration::ZERO;
    let status = loop {
        if let Some(status) = child.try_wait().map_err(failed)? {
            break status;
        }
        if waited > LONGEST {
            drop(child.kill());
            drop(child.wait());
            return Err(format!(
                "`hyde {}` did not end within {} s",
                step.command.join(" "),
                LONGEST.as_secs()
            ));
        }
        std::thread::sleep(pause);
        waited += pause;
    };
    Ok(Output {
        status,
        stdout: whole(stdout).map_err(failed)?,
        stderr: whole(stderr).map_err(failed)?,
    })
}

fn whole(mut file: std::fs::File) -> std::io::Result<Vec<u8>> {
    use std::io::{Read as _, Seek as _};
    let mut bytes = Vec::new();
    file.rewind()?;
    file.read_to_end(&mut bytes)?;
    Ok(bytes)
}

fn compare(step: &Step, output: &Output) -> Result<(), String> {
    if output.status.code() != Some(step.exit) {
        return Err(format!("{}, expected {}", output.status, step.exit));
    }
    let printed = [&output.stdout[..], &output.stderr[..]].concat();
    let printed = String::from_utf8_lossy(&printed);
    if let Some(missing) = step.says.iter().find(|text| !printed.contains(*text)) {
        return Err(format!("does not say `{missing}`"));
    }
    if let Some(wrong) = step.never_says.iter().find(|text| printed.contains(*text)) {
        return Err(format!("says `{wrong}`"));
    }
    if step.values.is_empty() {
        return Ok(());
    }
    let json: Value = serde_json::from_slice(&output.stdout)
        .map_err(|error| format!("its output is not JSON: {error}"))?;
    for (path, expected) in &step.values {
        let found = number(&json, path).ok_or_else(|| format!("`{path}` is not a number"))?;
        let Expected { is, within } = *expected;
        if (found - is).abs() > within || found.is_nan() {
            return Err(format!(
                "`{path}` is {found}, expected {is} within {within}"
            ));
        }
    }
    Ok(())
}

/// The number at a path: keys of objects, indices of arrays or the `name` of one of their elements.
fn number(json: &Value, path: &str) -> Option<f64> {
    let found = path.split('/').try_fold(json, |value, key| {
        let Some(list) = value.as_array() else {
            return value.get(key);
        };
        key.parse::<usize>().ok().map_or_else(
            || list.iter().find(|element| element["name"] == key),
            |index| list.get(index),
        )
    });
    found?.as_f64()
}
