//! `emps_force_error_…_percent`: the measured axis diagnosed on the first half of its record, judged on the second.
//!
//! All are the closed loop over the whole record, the force compared in the second half only. Diagnosed: the effects that
//! `hyde diagnose` finds in the first half, the same parameters fitted there with them, and the controller as the diagnosis of
//! that half says that it is to be written. After: the refined model of the example, fitted there.

use super::promise::{Figure, Measured, Promise, Session};
use crate::{Example, root};
use serde_json::Value;
use std::path::Path;
use std::process::Command;

pub(super) const BEFORE: Figure = Figure {
    name: "emps_force_error_before_percent",
    unit: "%",
    promise: Promise::Within(5.9, 6.0),
    measure: before,
};

pub(super) const DIAGNOSED: Figure = Figure {
    name: "emps_force_error_diagnosed_percent",
    unit: "%",
    promise: Promise::AtMost(2.6),
    measure: diagnosed,
};

pub(super) const AFTER: Figure = Figure {
    name: "emps_force_error_after_percent",
    unit: "%",
    promise: Promise::AtMost(2.5),
    measure: after,
};

const FILE: &str = "examples/emps/emps.hyde";
const RECORD: &str = "emps/emps_est.csv";
/// The row where the second half begins, and its time.
const HALF: usize = 12_420;
const SECOND: (&str, &str) = ("skip 49 [ms]", "skip 12.42 [s]");

fn before(session: &Session) -> Result<Measured, String> {
    let record = session.data.join(RECORD);
    if !record.is_file() {
        return Ok(absent());
    }
    let example = Example::load(FILE, Some("tracking"))?.record("file", record);
    force(&example.rewritten(SECOND.0, SECOND.1)).map(Measured::Value)
}

fn absent() -> Measured {
    let what = "emps/emps_est.csv, the record of EMPS (nonlinearbenchmark.org), is not below the data folder";
    Measured::Absent(what.to_owned())
}

/// The relative error of the force in percent.
fn force(example: &Example) -> Result<f64, String> {
    let (_, run) = example.run()?;
    let channel = run.channels.iter().find(|channel| channel.name == "force");
    channel
        .map(|channel| channel.relative_percent)
        .ok_or_else(|| "the experiment measures no force".to_owned())
}

fn after(session: &Session) -> Result<Measured, String> {
    let record = session.data.join(RECORD);
    if !record.is_file() {
        return Ok(absent());
    }
    // This very program is the command.
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    crate::benchmarks::second_half(&own, &record).map(Measured::Value)
}

#[allow(
    clippy::disallowed_methods,
    reason = "the record is cut in two in a folder of its own"
)]
fn diagnosed(session: &Session) -> Result<Measured, String> {
    let record = session.data.join(RECORD);
    if !record.is_file() {
        return Ok(absent());
    }
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| error.to_string());
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).map_err(|error| error.to_string())
    };
    let (model, rows) = (read(&root().join(FILE))?, read(&record)?);
    let halves = halves(&rows);
    write("fit-1.csv", &halves[0])?;
    write("holdout-1.csv", &halves[1])?;
    write("emps.hyde", &model)?;
    let found = hyde(folder.path(), &["diagnose", "emps.hyde", "emps", "--json"])?;
    let effects = effects(&found)?;
    if effects.is_empty() {
        return Err(format!("no effect was found: {}", found["sentence"]));
    }
    let with: Vec<String> = effects.iter().map(Effect::text).collect();
    let text = model
        .replace("of Axis(q0", "of Found(q0")
        .replace("calibrate emps of Axis", "calibrate emps of Found")
        .replace(
            "offset in -20 .. 20 [N];",
            &format!(
                "offset in -20 .. 20 [N]{};",
                effects.iter().map(Effect::varied).collect::<String>()
            ),
        )
        .replace(
            "experiment tracking",
            &format!(
                "model Found = Axis with {};\n\nexperiment tracking",
                with.join(", ")
            ),
        );
    write("found.hyde", &text)?;
    let fitted = hyde(folder.path(), &["fit", "found.hyde", "emps", "--json"])?;
    let parameters = fitted["parameters"].as_array();
    let set = |mut example: Example| -> Result<Example, String> {
        for parameter in parameters.ok_or("the fit has no parameters")? {
            let (name, value) = (parameter["name"].as_str(), parameter["value"].as_f64());
            let (Some(name), Some(value)) = (name, value) else {
                return Err(format!("not understood: {parameter}"));
            };
            example = example.set(name, value);
        }
        Ok(example)
    };
    let edits = found["command_timings"].as_array().into_iter().flatten();
    let edits =
        edits.filter_map(|own| own["edit"]["from"].as_str().zip(own["edit"]["to"].as_str()));
    let mended = edits.fold(text, |text, (from, to)| text.replace(from, to));
    let example = Example::load(FILE, Some("tracking"))?.record("file", &record);
    let example = example.replaced(&mended, "tracking");
    force(&set(example.rewritten(SECOND.0, SECOND.1))?).map(Measured::Value)
}

/// Both halves of the record, the time of either from 0: the record's own clock drifts by less than a thousandth of a row.
fn halves(rows: &str) -> [String; 2] {
    let mut lines = rows.lines();
    let head = format!("{}\n", lines.next().unwrap_or_default());
    let mut halves = [head.clone(), head];
    for (number, line) in lines.enumerate() {
        let half = usize::from(number >= HALF);
        let time = (number - half * HALF) as f64 * 1e-3;
        let rest = line.split_once(',').map_or("", |(_, rest)| rest);
        halves[half].push_str(&format!("{time:.3},{rest}\n"));
    }
    halves
}

/// An effect that was found, its values with their SI units.
struct Effect {
    name: String,
    site: String,
    values: Vec<(String, f64, String)>,
}

impl Effect {
    /// As it is written behind `with`.
    fn text(&self) -> String {
        let values = self.values.iter();
        let values = values.map(|(name, value, unit)| format!("{name} = {value} [{unit}]"));
        let values: Vec<String> = values.collect();
        format!("{}({}) on {}", self.name, values.join(", "), self.site)
    }

    /// As it is written behind `vary`: about what was found.
    fn varied(&self) -> String {
        let each = self.values.iter().map(|(name, value, unit)| {
            let (low, high) = match *value < 0.0 {
                true => (3.0 * value, 0.1 * value),
                false => (0.1 * value, 3.0 * value),
            };
            format!(
                ", {}.{}.{name} in {low} .. {high} [{unit}]",
                self.site, self.name
            )
        });
        each.collect()
    }
}

fn effects(found: &Value) -> Result<Vec<Effect>, String> {
    let list = found["effects"].as_array().ok_or("no effects are told")?;
    let each = list.iter().map(|one| {
        let text = |name: &str| one[name].as_str().unwrap_or_default().to_owned();
        let mut values = Vec::new();
        for part in ["sizes", "shape"] {
            for (name, value) in one[part].as_object().into_iter().flatten() {
                // The phase of a sine and a cosine is no parameter.
                if name != "phase" {
                    let number = value["value"].as_f64().ok_or("a value is no number")?;
                    let unit = value["unit"].as_str().unwrap_or("1").to_owned();
                    values.push((name.clone(), number, unit));
                }
            }
        }
        Ok(Effect {
            name: text("effect"),
            site: text("site"),
            values,
        })
    });
    each.collect()
}

/// Runs the command, which this very program is, and reads what it prints.
fn hyde(folder: &Path, arguments: &[&str]) -> Result<Value, String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let output = Command::new(own)
        .current_dir(folder)
        .args(arguments)
        .output()
        .map_err(|error| error.to_string())?;
    serde_json::from_slice(&output.stdout)
        .map_err(|error| format!("{error}: {}", String::from_utf8_lossy(&output.stderr)))
}
