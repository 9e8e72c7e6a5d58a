//! Calling the command, and folders for what it leaves.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

/// An example that needs nothing but what stands beside it.
pub(crate) const BENCH: &str = "examples/bench_axis/axis.hyde";

/// A lag with a step, a measure and an expectation.
pub(crate) const LAG: &str = r#"package lag "a lag that a step drives";
import SI.*;

model Lag
  input Real u;
  parameter Time T = 10 [ms];
  Real x(start = 0, fixed = true);
equation
  T*der(x) = u - x;
end Lag;

experiment step of Lag
  stimulus u = 1;
  measure Real highest = max(x);
  expect max(x) < 1.5 "no overshoot";
  stop 50 [ms] every 1 [ms];
end step;
"#;

pub(crate) fn command(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hyde"));
    command.args(arguments).current_dir(top());
    command
}

pub(crate) fn hyde(arguments: &[&str]) -> Output {
    command(arguments).output().unwrap()
}

pub(crate) fn status(output: &Output) -> i32 {
    output.status.code().unwrap()
}

pub(crate) fn text(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub(crate) fn errors(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

pub(crate) fn top() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub(crate) fn read(path: &str) -> String {
    std::fs::read_to_string(top().join(path)).unwrap()
}

/// The numbers of a CSV file below its header.
pub(crate) fn rows(csv: &str) -> Vec<Vec<f64>> {
    let lines = csv.lines().skip(1);
    lines
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect()
}

/// A folder that goes away with the test.
pub(crate) struct Folder(TempDir);

impl Folder {
    pub(crate) fn new() -> Self {
        Self(TempDir::new().unwrap())
    }

    pub(crate) fn path(&self, name: &str) -> String {
        self.0.path().join(name).to_string_lossy().into_owned()
    }

    pub(crate) fn file(&self, name: &str, content: &str) -> String {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(&path, content).unwrap();
        path.to_string_lossy().into_owned()
    }

    /// The names in a folder below, hidden ones too.
    pub(crate) fn names(&self, folder: &str) -> Vec<String> {
        let entries = std::fs::read_dir(self.0.path().join(folder)).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name());
        let mut names: Vec<String> = names.map(|n| n.to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}
