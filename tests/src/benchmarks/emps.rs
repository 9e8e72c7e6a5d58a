//! Electro-Mechanical Positioning System: `DATA_EMPS.mat` and `DATA_EMPS_PULSES.mat` of the official archive as they are, or the
//! same columns as CSV.

#![allow(
    clippy::disallowed_methods,
    reason = "the record is cut in two in a folder of its own"
)]

use super::command::fit;
use super::{Benchmark, CHAMPNEYS, Published, Reason, Row};
use crate::root;
use hyde_signal::Layout;
use std::fmt::Write as _;
use std::path::Path;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "emps",
    about: "Electro-Mechanical Positioning System (Janot et al. 2019): error of the position without control loop in mm, and of \
            the force in the loop in % of its norm",
    measure,
    published: &[
        Published {
            method: "dynoNet (Forgione, Piga 2021)",
            figures: &[(PULSES, 2.64)],
            source: CHAMPNEYS,
        },
        Published {
            method: "continuous-time SUBNET (Beintema et al. 2023)",
            figures: &[(PULSES, 4.61)],
            source: CHAMPNEYS,
        },
        Published {
            method: "polynomial NARX",
            figures: &[(PULSES, 5.17)],
            source: CHAMPNEYS,
        },
        Published {
            method: "linear state space",
            figures: &[(PULSES, 5.53)],
            source: CHAMPNEYS,
        },
        Published {
            method: "model of the authors, whole record for estimation",
            figures: &[(SECOND, 5.848)],
            source: "Janot, Gautier, Brunot, Data Set and Reference Models of EMPS, 2019, nonlinearbenchmark.org",
        },
    ],
};

const FILE: &str = "examples/emps/emps.hyde";
/// The official records, and the names that they have as CSV.
const ESTIMATION: [&str; 2] = ["DATA_EMPS.mat", "emps_est.csv"];
const TEST: [&str; 2] = ["DATA_EMPS_PULSES.mat", "emps_pulses.csv"];
const SECOND: &str = "force, second half";
const FITTED: &str = "position, record of the fit";
const PULSES: &str = "position, PULSES";
const GIVEN: &str = "position, PULSES given";
const FORCE: &str = "force, PULSES given";
/// The sample where the second half begins, and the text of the model that leaves out the first 49.
const HALF: usize = 12_420;
const SKIPPED: (&str, &str) = ("skip 49 [ms]", "skip 12.42 [s]");

fn measure(program: &Path, folder: &Path) -> Result<Vec<Row>, String> {
    let row = |record, unit, value, fitted| Row {
        record,
        unit,
        value,
        fitted,
    };
    let found = |names: [&str; 2]| {
        names
            .map(|name| folder.join(name))
            .into_iter()
            .find(|path| path.is_file())
    };
    let absent = |names: [&'static str; 2]| Err(Reason::Absent(names[0]));
    let all = [
        (SECOND, "%"),
        (FITTED, "mm"),
        (PULSES, "mm"),
        (GIVEN, "mm"),
        (FORCE, "%"),
    ];
    let Some(estimation) = found(ESTIMATION) else {
        let rows = all.map(|(record, unit)| row(record, unit, absent(ESTIMATION), 0));
        return Ok(rows.into());
    };
    let own = tempfile::tempdir().map_err(|error| error.to_string())?;
    write(
        &own.path().join(ESTIMATION[0]),
        &official(&estimation)?.text(0..usize::MAX),
    )?;
    let test = found(TEST);
    if let Some(test) = &test {
        write(
            &own.path().join(TEST[0]),
            &official(test)?.text(0..usize::MAX),
        )?;
    }
    let file = root().join(FILE);
    let whole = fit(program, &file, "refined", own.path())?;
    let number = whole.number();
    let pulses = format!("official={}", own.path().join(TEST[0]).display());
    let mm = |experiment, record| Ok(1e3 * whole.errors(&file, experiment, record, "rms")?[0]);
    let force = || Ok(whole.errors(&file, "closed_pulses", None, "relative_percent")?[0]);
    let tested = |value: Result<f64, String>| match &test {
        Some(_) => value.map_err(Reason::Failed),
        None => absent(TEST),
    };
    Ok(vec![
        row(
            SECOND,
            "%",
            second_half(program, &estimation).map_err(Reason::Failed),
            number,
        ),
        row(
            FITTED,
            "mm",
            mm("open", None).map_err(Reason::Failed),
            number,
        ),
        row(PULSES, "mm", tested(mm("open", Some(&pulses))), number),
        row(GIVEN, "mm", tested(mm("open_pulses", None)), number),
        row(FORCE, "%", tested(force()), number),
    ])
}

/// The relative error in percent of the force in the control loop in the second half of the record for estimation, with the
/// refined model fitted on the first half, by a program that is the command `hyde`.
///
/// # Errors
/// If the record is none, or the fit or the run fails.
pub fn second_half(program: &Path, estimation: &Path) -> Result<f64, String> {
    let own = tempfile::tempdir().map_err(|error| error.to_string())?;
    let (first, second) = (own.path().join("first"), own.path().join("second.hyde"));
    let record = official(estimation)?;
    write(&first.join(ESTIMATION[0]), &record.text(0..HALF))?;
    let whole = own.path().join(ESTIMATION[0]);
    write(&whole, &record.text(0..usize::MAX))?;
    let file = root().join(FILE);
    let model = std::fs::read_to_string(&file).map_err(|error| error.to_string())?;
    write(&second, &model.replace(SKIPPED.0, SKIPPED.1))?;
    let fitted = fit(program, &file, "refined", &first)?;
    let record = format!("official={}", whole.display());
    let errors = fitted.errors(&second, "closed", Some(&record), "relative_percent")?;
    Ok(errors[0])
}

/// A record with the official names of its columns.
struct Official {
    columns: Vec<(String, Vec<f64>)>,
}

/// Reads a record; as CSV its columns have their units in their names, `qm_m`, and its first one is the time.
fn official(path: &Path) -> Result<Official, String> {
    let bytes = std::fs::read(path).map_err(|error| error.to_string())?;
    let layout = Layout {
        every_s: Some(1e-3),
        ..Layout::default()
    };
    let table = hyde_signal::read(&bytes, &layout).map_err(|error| error.to_string())?;
    let columns = table.columns().iter().filter_map(|column| {
        let name = match column.name() {
            "qg" | "qg_m" => "qg",
            "qm" | "qm_m" => "qm",
            "vir" | "vir_V" => "vir",
            "pulses_N" => "pulses_N",
            _ => return None,
        };
        Some((name.to_owned(), column.values().to_vec()))
    });
    Ok(Official {
        columns: columns.collect(),
    })
}

impl Official {
    /// Some of its samples as CSV.
    fn text(&self, samples: std::ops::Range<usize>) -> String {
        let names: Vec<&str> = self.columns.iter().map(|(name, _)| name.as_str()).collect();
        let mut text = names.join(",");
        let length = self.columns.first().map_or(0, |(_, values)| values.len());
        for sample in samples.start..samples.end.min(length) {
            let separators = std::iter::once("\n").chain(std::iter::repeat(","));
            for ((_, values), separator) in self.columns.iter().zip(separators) {
                // Writing to a string cannot fail.
                let _ = write!(text, "{separator}{}", values[sample]);
            }
        }
        text.push('\n');
        text
    }
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    let folder = path.parent().unwrap_or(path);
    std::fs::create_dir_all(folder)
        .and_then(|()| std::fs::write(path, text))
        .map_err(|error| format!("{}: {error}", path.display()))
}
