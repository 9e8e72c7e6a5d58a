//! Coupled electric drives: `DATAUNIF.csv` of the official archive as it is. A fit uses a whole record, so the samples for
//! estimation become a record of their own.

#![allow(
    clippy::disallowed_methods,
    reason = "the record is cut in a folder of its own"
)]

use super::command::fit;
use super::{Benchmark, CHAMPNEYS, Published, Reason, Row};
use crate::root;
use std::path::Path;

pub(super) const BENCHMARK: Benchmark = Benchmark {
    name: "ced",
    about: "coupled electric drives (Wigren, Schoukens 2017): error of the speed in ticks/s, test samples 411 to 500",
    measure,
    published: &[
        Published {
            method: "continuous-time SUBNET (Beintema et al. 2023)",
            figures: &[(LOW, 0.115), (HIGH, 0.074)],
            source: CHAMPNEYS,
        },
        Published {
            method: "polynomial NARX",
            figures: &[(LOW, 0.10), (HIGH, 0.141)],
            source: CHAMPNEYS,
        },
        Published {
            method: "Gaussian process NARX",
            figures: &[(LOW, 0.102), (HIGH, 0.090)],
            source: CHAMPNEYS,
        },
        Published {
            method: "linear state space",
            figures: &[(LOW, 0.224), (HIGH, 0.384)],
            source: CHAMPNEYS,
        },
        Published {
            method: "polynomial NARX, 7 lags (SysIdentPy)",
            figures: &[(LOW, 0.103), (HIGH, 0.107)],
            source: "SysIdentPy 0.9.0, documentation, case study of the coupled electric device",
        },
    ],
};

const FILE: &str = "examples/ced/ced.hyde";
const RECORD: &str = "DATAUNIF.csv";
/// So many samples are for estimation.
const SAMPLES: usize = 400;
const LOW: &str = "low voltages";
const HIGH: &str = "high voltages";

fn measure(program: &Path, folder: &Path) -> Result<Vec<Row>, String> {
    let row = |record, value, fitted| Row {
        record,
        unit: "ticks/s",
        value,
        fitted,
    };
    if !folder.join(RECORD).is_file() {
        let absent = Err(Reason::Absent(RECORD));
        return Ok(vec![row(LOW, absent.clone(), 0), row(HIGH, absent, 0)]);
    }
    let own = tempfile::tempdir().map_err(|error| error.to_string())?;
    let read = |path: &Path| std::fs::read_to_string(path).map_err(|error| error.to_string());
    let write = |name: &str, text: &str| {
        std::fs::write(own.path().join(name), text).map_err(|error| error.to_string())
    };
    let text = read(&folder.join(RECORD))?;
    let first: Vec<&str> = text.lines().take(1 + SAMPLES).collect();
    write(RECORD, &text)?;
    write("estimation.csv", &(first.join("\n") + "\n"))?;
    let file = root().join(FILE);
    let fitted = fit(program, &file, "ced", own.path())?;
    let number = fitted.number();
    Ok(vec![
        row(
            LOW,
            fitted.error("low_test").map_err(Reason::Failed),
            number,
        ),
        row(
            HIGH,
            fitted.error("high_test").map_err(Reason::Failed),
            number,
        ),
    ])
}
