//! FMUs of random models ([`crate::differential::random`]): in FMPy, and under valgrind from instantiation to freeing.

use crate::differential::random;
use crate::fmu::{python, succeed};
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::Command;

/// FMUs of random models in a folder, FMI 3.0 and 2.0 in turn.
pub struct RandomFmus {
    folder: tempfile::TempDir,
    fmus: Vec<PathBuf>,
    /// Seeds of models that the compiler refuses with a diagnostic.
    pub refused: Vec<u64>,
}

impl RandomFmus {
    /// Exports the models of some seeds.
    ///
    /// # Errors
    /// The command crashed.
    #[allow(clippy::disallowed_methods, reason = "tests leave files in a folder")]
    pub fn export(hyde: &Path, seeds: std::ops::Range<u64>) -> Result<Self, String> {
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let (mut fmus, mut refused) = (Vec::new(), Vec::new());
        for seed in seeds {
            let place = |end: &str| folder.path().join(format!("seed{seed}.{end}"));
            let (model, fmu) = (place("hyde"), place("fmu"));
            std::fs::write(&model, random(seed).text).map_err(|error| error.to_string())?;
            let mut command = Command::new(hyde);
            command.args(["export", "fmu"]).arg(&model);
            let version = if seed % 2 == 0 { "3" } else { "2" };
            command.args(["run", "--quiet", "--fmi", version, "--out"]);
            let output = command.arg(&fmu).output();
            let output = output.map_err(|error| error.to_string())?;
            match output.status.code() {
                Some(0) => fmus.push(fmu),
                Some(1..=5) => refused.push(seed),
                _ => {
                    let said = String::from_utf8_lossy(&output.stderr);
                    return Err(format!("seed {seed}: {}: {said}", output.status));
                }
            }
        }
        Ok(Self {
            folder,
            fmus,
            refused,
        })
    }

    /// How many there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.fmus.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.fmus.is_empty()
    }

    /// Simulates them in FMPy, and gives back what failed.
    ///
    /// # Errors
    /// There is no FMPy.
    pub fn failures(&self) -> Result<Vec<String>, String> {
        let mut command = Command::new(python()?);
        command.arg("tests/fmu/random_models.py").args(&self.fmus);
        let found = self.answers(&mut command)?;
        let failed = found.into_iter().filter(|(_, answer)| answer != "done");
        Ok(failed
            .map(|(name, answer)| format!("{name}: {answer}"))
            .collect())
    }

    /// Runs them under valgrind, and gives back the bytes definitely lost and the errors of memory with what was told.
    ///
    /// # Errors
    /// There is no compiler of C, no FMPy, or a call fails.
    pub fn memory(&self) -> Result<(u64, u64, String), String> {
        let program = self.folder.path().join("lifecycle");
        let python = python()?;
        let headers = "import fmpy, pathlib; print(pathlib.Path(fmpy.__file__).parent / 'c-code')";
        let headers = succeed(Command::new(&python).args(["-c", headers]))?;
        let mut compiler = Command::new("cc");
        compiler.args(["-std=c11", "-D_GNU_SOURCE", "-g", "-I", headers.trim()]);
        compiler.arg("tests/fmu/lifecycle.c").arg("-o");
        succeed(compiler.arg(&program).arg("-ldl"))?;
        let mut command = Command::new(python);
        command.arg("tests/fmu/lifecycle.py").arg(program);
        let found = self.answers(command.args(&self.fmus))?;
        let (mut lost, mut errors, mut told) = (0, 0, String::new());
        for (name, answer) in found {
            let number = |key: &str| answer[key].as_u64().ok_or(format!("{name}: {answer}"));
            lost += number("lost")?;
            errors += number("errors")?;
            if let Some(text) = answer["told"].as_str() {
                told.push_str(&format!("{name}:\n{text}\n"));
            }
        }
        Ok((lost, errors, told))
    }

    fn answers(&self, command: &mut Command) -> Result<Vec<(String, Value)>, String> {
        let printed = succeed(command)?;
        let found: Value = serde_json::from_str(&printed).map_err(|error| error.to_string())?;
        let found = found.as_object().ok_or("no answers")?;
        if found.len() != self.fmus.len() {
            return Err(format!("{} answers", found.len()));
        }
        let shorter = |name: &String| {
            let path = Path::new(name);
            path.file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned()
        };
        let own = found.iter();
        Ok(own
            .map(|(name, answer)| (shorter(name), answer.clone()))
            .collect())
    }
}
