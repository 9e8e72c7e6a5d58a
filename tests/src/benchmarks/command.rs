//! The command `hyde` as its user has it: a fit, and runs with the parameters that it found.

use serde_json::Value;
use std::path::Path;
use std::process::Command;

/// A calibration of an example.
pub(super) struct Fitted<'a> {
    program: &'a Path,
    file: &'a Path,
    folder: &'a Path,
    /// What `--set` takes for each parameter.
    settings: Vec<String>,
}

/// Fits a file's calibration to the records of a folder.
pub(super) fn fit<'a>(
    program: &'a Path,
    file: &'a Path,
    calibration: &str,
    folder: &'a Path,
) -> Result<Fitted<'a>, String> {
    let mut command = Command::new(program);
    command.arg("fit").arg(file).arg(calibration);
    let found = answer(command.arg("--data").arg(folder))?;
    let parameters = found["parameters"].as_array();
    let parameters = parameters.ok_or("the fit has no parameters")?.iter();
    let settings = parameters.map(|parameter| {
        let (name, value) = (parameter["name"].as_str()?, parameter["value"].as_f64()?);
        let unit = match parameter["unit"].as_str()? {
            "1" => String::new(),
            unit => format!(" [{unit}]"),
        };
        Some(format!("{name}={value:?}{unit}"))
    });
    let settings: Option<Vec<String>> = settings.collect();
    Ok(Fitted {
        program,
        file,
        folder,
        settings: settings.ok_or("a parameter of the fit has no value")?,
    })
}

impl Fitted<'_> {
    /// How many parameters were fitted.
    pub(super) fn number(&self) -> usize {
        self.settings.len()
    }

    /// The channels of a run with the fitted parameters: the root mean square of each, or `relative_percent`.
    pub(super) fn errors(
        &self,
        file: &Path,
        experiment: &str,
        record: Option<&str>,
        key: &str,
    ) -> Result<Vec<f64>, String> {
        let mut command = Command::new(self.program);
        command.arg("run").arg(file).arg(experiment);
        command.arg("--data").arg(self.folder);
        command.args(record.iter().flat_map(|record| ["--record", record]));
        command.args(self.settings.iter().flat_map(|setting| ["--set", setting]));
        let run = answer(&mut command)?;
        let channels = run["channels"].as_array();
        let errors = channels.into_iter().flatten();
        let errors: Option<Vec<f64>> = errors.map(|channel| channel[key].as_f64()).collect();
        errors
            .filter(|errors| !errors.is_empty())
            .ok_or_else(|| format!("`{experiment}` compares nothing"))
    }

    /// The error of the only channel of an experiment of the fitted file.
    pub(super) fn error(&self, experiment: &str) -> Result<f64, String> {
        Ok(self.errors(self.file, experiment, None, "rms")?[0])
    }
}

fn answer(command: &mut Command) -> Result<Value, String> {
    let output = command.arg("--json").output();
    let output = output.map_err(|error| error.to_string())?;
    serde_json::from_slice(&output.stdout)
        .map_err(|error| format!("{error}: {}", String::from_utf8_lossy(&output.stderr)))
}
