//! What a run left, as a language server takes it: the course of every variable, and why it failed.

use crate::files;
use hyde_editor::{Course, Courses, Failure, Label, Outcome};
use hyde_signal::{Frame, Values};
use hyde_units::{Dimension, NamedUnit};
use serde_json::Value;
use std::path::{Path, PathBuf};

/// The file of the results.
pub(super) const RESULTS: &str = "results.parquet";

/// Larger results would fill the memory of the server: hovers do without them.
const LARGEST: u64 = 256 << 20;

/// What a run left in a folder, with its page; `said` is what it printed as JSON.
pub(super) fn outcome(folder: &Path, page: PathBuf, said: &str) -> Outcome {
    let results = folder.join(RESULTS);
    let size = std::fs::metadata(&results).map(|own| own.len());
    let fits = size.is_ok_and(|size| size <= LARGEST);
    let bytes = fits.then(|| files::read(&results).ok()).flatten();
    let frame = bytes.and_then(|bytes| hyde_signal::read_frame(&bytes).ok());
    let said: Value = serde_json::from_str(said).unwrap_or_default();
    let failures = said["diagnostics"].as_array().into_iter().flatten();
    Outcome {
        page: Ok(page),
        courses: frame.and_then(courses),
        failures: failures
            .filter(|own| own["severity"] == "error")
            .map(failure)
            .collect(),
    }
}

/// Why a command did not do what it was asked for, as it printed that as JSON.
pub(super) fn reason(said: &str) -> Option<String> {
    let said: Value = serde_json::from_str(said).ok()?;
    let first = said["diagnostics"].as_array().and_then(|list| {
        let mut errors = list.iter().filter(|own| own["severity"] == "error");
        let error = errors.next()?;
        let (code, message) = (error["code"].as_str()?, error["message"].as_str()?);
        Some(format!("{code}: {message}"))
    });
    first.or_else(|| said["error"].as_str().map(str::to_owned))
}

/// The variables of a table whose first column is the time.
fn courses(frame: Frame) -> Option<Courses> {
    let mut columns = frame.fields.into_iter().zip(frame.values);
    let (_, Values::Numbers(time)) = columns.next()? else {
        return None;
    };
    let list = columns.filter_map(|(field, values)| {
        let unit = field
            .unit
            .unwrap_or_else(|| NamedUnit::usual(Dimension::DIMENSIONLESS));
        let to_si = |value: f64| unit.unit().to_si(value);
        let values = match values {
            Values::Numbers(values) => values.into_iter().map(to_si).collect(),
            Values::Integers(values) => values.into_iter().map(|own| to_si(own as f64)).collect(),
            Values::Texts(_) => return None,
        };
        Some(Course {
            name: field.name,
            unit,
            values,
        })
    });
    let list = list.collect();
    Some(Courses { time, list })
}

/// A diagnostic as JSON has it.
fn failure(own: &Value) -> Failure {
    let text = |own: &Value| own.as_str().unwrap_or_default().to_owned();
    let count = |own: &Value| {
        let number = own.as_u64().and_then(|own| usize::try_from(own).ok());
        number.unwrap_or(1)
    };
    let labels = own["labels"].as_array().into_iter().flatten();
    let notes = own["notes"].as_array().into_iter().flatten();
    Failure {
        code: text(&own["code"]),
        message: text(&own["message"]),
        notes: notes.map(text).collect(),
        help: own["help"].as_str().map(str::to_owned),
        labels: labels
            .map(|label| Label {
                file: text(&label["file"]),
                from: (count(&label["line"]), count(&label["column"])),
                to: (count(&label["end_line"]), count(&label["end_column"])),
                text: text(&label["text"]),
            })
            .collect(),
    }
}
