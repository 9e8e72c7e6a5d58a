//! Runs a program and takes its CPU time, its memory and what it prints.

use crate::problem::{Compared, Problem};
use std::io::Read;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use wait4::Wait4;

/// Where the programs and the models are, and where results go.
pub struct Tools {
    pub hyde: PathBuf,
    pub reference: PathBuf,
    pub diffsol: PathBuf,
    pub models: PathBuf,
    pub out: PathBuf,
}

/// Of one process.
pub struct Ended {
    /// User and system time in s, from start to end.
    pub cpu_s: f64,
    pub bytes: u64,
    pub printed: String,
}

/// How far Hyde goes.
#[derive(Clone, Copy, PartialEq)]
pub enum Extent {
    /// To the end, results not written.
    Whole,
    /// To the end, results in a folder.
    Written,
    /// Until 1 ns: what a run costs before its first steps.
    Start,
}

impl Tools {
    pub fn c(&self, problem: &Problem, rtol: f64) -> Result<Ended, String> {
        let (name, arguments) = problem.call(rtol);
        end(Command::new(self.reference.join(name)).args(arguments))
    }

    /// The program of C and IDA with the arguments of a run that others are compared with.
    pub fn tight(&self, problem: &Problem, rtol: f64) -> Result<Ended, String> {
        let (name, arguments) = problem.call(rtol);
        end(Command::new(self.reference.join(name))
            .args(arguments)
            .args(problem.tight))
    }

    pub fn diffsol(&self, problem: &Problem, rtol: f64) -> Result<Ended, String> {
        let (name, arguments) = problem.call(rtol);
        let mut command = Command::new(&self.diffsol);
        end(command.arg(name).args(arguments).stderr(Stdio::null()))
    }

    /// A sweep has the tolerance of its model, and no start that could be measured apart.
    pub fn hyde(&self, problem: &Problem, rtol: f64, extent: Extent) -> Result<Ended, String> {
        let sweeps = problem.compared == Compared::Cases && extent != Extent::Start;
        let model = self.models.join(problem.model);
        let mut command = Command::new(&self.hyde);
        command.arg(if sweeps { "sweep" } else { "run" }).arg(model);
        command.args([
            match (problem.compared, extent) {
                (Compared::Cases, Extent::Start) => "ends",
                _ => problem.experiment,
            },
            "--quiet",
        ]);
        for set in problem.set {
            command.args(["--set", set]);
        }
        if sweeps {
            command.args(["--jobs", "1", "--format", "csv"]);
        } else {
            command.args([
                "--rtol",
                &format!("{rtol:e}"),
                "--atol",
                &format!("{:e}", 1e-2 * rtol),
            ]);
        }
        match extent {
            Extent::Whole => {}
            Extent::Start => {
                command.args(["--stop", "1e-9"]);
            }
            Extent::Written => {
                let folder = self.folder(problem);
                // What a sweep has already done it does not do again.
                let _ = std::fs::remove_dir_all(&folder);
                command.arg("--out").arg(folder);
            }
        }
        end(&mut command)
    }

    /// Results of the last run that wrote some.
    pub fn folder(&self, problem: &Problem) -> PathBuf {
        self.out.join("runs").join(problem.name)
    }
}

/// Runs to the end; an error if it fails, with what it said.
pub fn end(command: &mut Command) -> Result<Ended, String> {
    let name = format!("{command:?}");
    let failed = |error: std::io::Error| format!("{name}: {error}");
    let mut child = command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .spawn()
        .map_err(failed)?;
    let mut printed = String::new();
    if let Some(mut output) = child.stdout.take() {
        output.read_to_string(&mut printed).map_err(failed)?;
    }
    let ended = child.wait4().map_err(failed)?;
    if !ended.status.success() {
        return Err(format!("{name}: {}", ended.status));
    }
    Ok(Ended {
        cpu_s: (ended.rusage.utime + ended.rusage.stime).as_secs_f64(),
        bytes: ended.rusage.maxrss,
        printed,
    })
}
