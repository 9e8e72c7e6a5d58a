//! FMUs as components in tests: what a run with them leaves, and models that two files of tests use.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests open files, and unwrap what must be there"
)]

use crate::fmu::succeed;
use crate::root;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the command in a folder.
#[must_use]
pub fn hyde(command: &str, folder: &Path, arguments: &[&str]) -> Output {
    let mut command = Command::new(command);
    command
        .current_dir(folder)
        .args(arguments)
        .output()
        .unwrap()
}

/// What a run that succeeds leaves: the columns by name.
#[must_use]
pub fn columns(command: &str, folder: &Path, arguments: &[&str]) -> Value {
    let out = tempfile::tempdir().unwrap();
    let path = out.path().to_string_lossy().into_owned();
    let more = ["--quiet", "--format", "json", "--out", path.as_str()];
    let all: Vec<&str> = arguments.iter().copied().chain(more).collect();
    let output = hyde(command, folder, &all);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{arguments:?}: {said}");
    let text = std::fs::read_to_string(out.path().join("results.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// The values of a column.
#[must_use]
pub fn column(results: &Value, name: &str) -> Vec<f64> {
    let values = results[name]["values"].as_array();
    let values = values.unwrap_or_else(|| panic!("no column {name}"));
    values.iter().map(|value| value.as_f64().unwrap()).collect()
}

/// The largest difference of two columns of the same length.
#[must_use]
pub fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let pairs = a.iter().zip(b);
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// A folder with the FMUs of Hyde.
#[must_use]
pub fn of_hyde(command: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let model = root().join("tests/models/fmu_import.hyde");
    for fmi in ["3", "2"] {
        let out = folder.path().join(format!("lag{fmi}.fmu"));
        let mut export = Command::new(command);
        export.args(["export", "fmu", "--quiet", "--fmi", fmi]);
        succeed(export.arg(&model).arg("--out").arg(out)).unwrap();
    }
    folder
}

/// Writes a file.
pub fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).unwrap();
}

/// A loop with the FMU that `of_hyde` gives, and with its equations.
pub const LOOP: &str = r#"
import SI.*;

model Controller = fmu("lag3.fmu", k = 3, step = 1 [ms]);

model Loop
  Controller c;
  Velocity v(start = 0, fixed = true);
equation
  c.u = 0.1 [m/s] - v;
  2 [kg]*der(v) = c.F;
end Loop;

model Same "with the equations of the FMU"
  Velocity v(start = 0, fixed = true);
  Velocity u = hold(c.u);
  Force F = hold(c.F);
  Real x(start = 0, fixed = true);
  clocked c(1 [ms])
    Velocity u = sample(0.1 [m/s] - v);
    Force F = (300 [N])*sample(x);
  end c;
equation
  20 [ms]*der(x) = u/(1 [m/s]) - x;
  2 [kg]*der(v) = F;
end Same;

experiment imported of Loop
  solve auto(rtol = 1e-9) stop 0.3 [s] every 5 [ms];
end imported;

experiment native of Same
  solve auto(rtol = 1e-9) stop 0.3 [s] every 5 [ms];
end native;

sweep gains of imported
  vary c.k in 1 .. 4;
  grid 4;
  expect last(v) > 0 [m/s];
end gains;
"#;

/// Height in m and number of bounces of a ball at a time: falls from a height in m and keeps a part of its speed.
#[must_use]
pub fn thrown(t: f64, fall: f64, keeps: f64) -> (f64, f64) {
    let g = 9.81_f64;
    let first = (2.0 * fall / g).sqrt();
    if t < first {
        return (fall - g * t * t / 2.0, 0.0);
    }
    let (mut rest, mut v, mut count) = (t - first, g * first * keeps, 1.0);
    while rest >= 2.0 * v / g && count < 30.0 {
        rest -= 2.0 * v / g;
        v *= keeps;
        count += 1.0;
    }
    (v * rest - g * rest * rest / 2.0, count)
}
