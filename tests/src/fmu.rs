//! FMUs in an importer: FMPy, which `./dev test` and `./dev figures` install into `target/fmpy`.

use crate::root;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The Python that has FMPy.
///
/// # Errors
/// It is not there, and how to get it.
#[allow(clippy::disallowed_methods, reason = "tests look for the importer")]
pub fn python() -> Result<PathBuf, String> {
    let python = root().join("target/fmpy/bin/python");
    match python.is_file() {
        true => Ok(python),
        false => Err("FMPy is not installed in target/fmpy: `./dev test` does it".to_owned()),
    }
}

/// The program that simulates FMUs with fmi-rs.
///
/// # Errors
/// It is not there, and how to get it.
#[allow(clippy::disallowed_methods, reason = "tests look for the importer")]
pub fn fmi_rs() -> Result<PathBuf, String> {
    let program = root().join("target/fmi-rs/release/hyde-fmi-rs");
    match program.is_file() {
        true => Ok(program),
        false => Err("fmi-rs is not built in target/fmi-rs: `./dev test` does it".to_owned()),
    }
}

/// How fmi-rs uses an FMU.
pub const FMI_RS_KINDS: [&str; 2] = ["FmiRs", "FmiRsEvents"];

/// How an FMU is used: as in `tests/fmu/compare.py`.
pub const KINDS: [&str; 3] = ["CoSimulation", "CoSimulationEvents", "ModelExchange"];

/// A model whose FMU is compared with its run.
#[derive(Clone, Copy, Debug)]
pub struct Compared<'a> {
    /// File below the project.
    pub file: &'a str,
    /// Experiment.
    pub experiment: &'a str,
    /// Version of FMI.
    pub fmi: &'a str,
    /// Further arguments of `hyde run`.
    pub run: &'a [&'a str],
    /// The relative tolerance of an importer that integrates.
    pub tolerance: &'a str,
    /// How it is used.
    pub kinds: &'a [&'a str],
}

/// How far an FMU is from the run of its experiment.
#[derive(Clone, Debug, PartialEq)]
pub struct Agreement {
    /// How it was used.
    pub kind: String,
    /// The largest difference over the range of its quantity, and where.
    pub deviation: (f64, String),
    /// Samples and quantities that were compared, and events.
    pub compared: (u64, u64, u64),
    /// How far an event is from that of the run, in us.
    pub event_time_error_us: f64,
}

/// Exports a model, simulates it in FMPy, and compares it with `hyde run`.
///
/// # Errors
/// What failed; findings of `fmpy.validation` are a failure.
#[allow(clippy::disallowed_methods, reason = "tests leave files in a folder")]
pub fn compare(hyde: &Path, compared: &Compared<'_>) -> Result<Vec<Agreement>, String> {
    let python = python()?;
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    let (run, fmu) = (folder.path().join("run"), folder.path().join("model.fmu"));
    let model = [compared.file, compared.experiment];
    let mut command = Command::new(hyde);
    command.arg("run").args(model).args(compared.run);
    command
        .args(["--quiet", "--format", "json", "--out"])
        .arg(&run);
    succeed(&mut command)?;
    let mut command = Command::new(hyde);
    command.args(["export", "fmu"]).args(model);
    command
        .args(["--quiet", "--fmi", compared.fmi, "--out"])
        .arg(&fmu);
    succeed(&mut command)?;
    let mut command = Command::new(python);
    if compared
        .kinds
        .iter()
        .any(|kind| FMI_RS_KINDS.contains(kind))
    {
        command.env("FMI_RS", fmi_rs()?);
    }
    command.arg("tests/fmu/compare.py").arg(&fmu);
    command
        .arg(run.join("results.json"))
        .arg(run.join("events.csv"));
    command.arg(compared.tolerance).args(compared.kinds);
    let printed = succeed(&mut command)?;
    let found: Value = serde_json::from_str(printed.lines().last().unwrap_or_default())
        .map_err(|error| format!("{error}: {printed}"))?;
    if found["findings"]
        .as_array()
        .is_none_or(|list| !list.is_empty())
    {
        return Err(format!("fmpy.validation: {}", found["findings"]));
    }
    let number = |value: &Value| value.as_f64().ok_or_else(|| found.to_string());
    let count = |value: &Value| value.as_u64().ok_or_else(|| found.to_string());
    let of_kind = |kind: &&str| {
        let own = &found["kinds"][kind];
        Ok(Agreement {
            kind: (*kind).to_owned(),
            deviation: (number(&own["deviation"])?, own["where"].to_string()),
            compared: (
                count(&own["compared"])?,
                count(&own["quantities"])?,
                count(&own["events"])?,
            ),
            event_time_error_us: number(&own["event_time_error_us"])?,
        })
    };
    compared.kinds.iter().map(of_kind).collect()
}

/// What a command prints if it succeeds.
///
/// # Errors
/// What it says otherwise.
pub fn succeed(command: &mut Command) -> Result<String, String> {
    let output = command.current_dir(root()).output();
    let output = output.map_err(|error| format!("{command:?}: {error}"))?;
    match output.status.success() {
        true => Ok(String::from_utf8_lossy(&output.stdout).into_owned()),
        false => Err(format!(
            "{command:?}: {}{}",
            String::from_utf8_lossy(&output.stdout),
            String::from_utf8_lossy(&output.stderr)
        )),
    }
}
