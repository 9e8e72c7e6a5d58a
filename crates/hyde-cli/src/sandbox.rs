//! `--sandbox`: each instance of an FMU in a process of its own. What its library does to that process ends the run with a
//! diagnostic and nothing else.

use crate::exit::Exit;
use crate::files;
use crate::output::print_error;
use hyde_fmu_import::{Fmu, host};
use hyde_program::{Foreign, ForeignInstance, Stopped};
use hyde_study::FmuHost;
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether the command line asked for it.
static ASKED: AtomicBool = AtomicBool::new(false);

/// Notes what the command line asks.
pub(crate) fn ask(sandbox: bool) {
    ASKED.store(sandbox, Ordering::Relaxed);
}

/// Whether FMUs run in processes of their own.
pub(crate) fn is_asked() -> bool {
    ASKED.load(Ordering::Relaxed)
}

/// Who runs FMUs; none for this process.
pub(crate) fn host() -> Option<Arc<dyn FmuHost>> {
    is_asked().then(|| Arc::new(Sandbox) as Arc<dyn FmuHost>)
}

/// `hyde fmu-host`: the process itself.
pub(crate) fn serve() -> Exit {
    match host::serve(std::io::stdin().lock(), std::io::stdout()) {
        Ok(()) => Exit::Done,
        Err(reason) => {
            print_error(&format!("error: {reason}"));
            Exit::CommandLine
        }
    }
}

#[derive(Debug)]
struct Sandbox;

impl FmuHost for Sandbox {
    fn host(&self, fmu: &Arc<Fmu>) -> Arc<dyn Foreign> {
        Arc::new(Hosted { fmu: fmu.clone() })
    }
}

/// An FMU that runs in other processes.
#[derive(Debug)]
struct Hosted {
    fmu: Arc<Fmu>,
}

impl Foreign for Hosted {
    fn instance(&self, component: &str) -> Result<Box<dyn ForeignInstance>, Stopped> {
        match Process::new() {
            Ok(process) => Ok(Box::new(host::Remote::new(
                process,
                self.fmu.clone(),
                component,
            ))),
            Err(what) => Err(Stopped {
                what,
                log: Vec::new(),
            }),
        }
    }
}

/// A process with its pipes.
struct Process {
    child: Child,
    /// Taken to end the process.
    input: Option<ChildStdin>,
    output: BufReader<ChildStdout>,
}

impl Process {
    fn new() -> Result<Self, String> {
        let failed = |error: std::io::Error| {
            format!("its process cannot be started: {}", files::reason(&error))
        };
        let own = std::env::current_exe().map_err(failed)?;
        let mut child = Command::new(own)
            .arg("fmu-host")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(failed)?;
        match (child.stdin.take(), child.stdout.take()) {
            (Some(input), Some(output)) => Ok(Self {
                child,
                input: Some(input),
                output: BufReader::new(output),
            }),
            _ => Err("its process has no pipes".to_owned()),
        }
    }

    /// How the process ended.
    fn ended(&mut self) -> String {
        self.input = None;
        match self.child.wait() {
            Ok(status) => format!("its process ended: {status}"),
            Err(error) => format!("its process ended: {}", files::reason(&error)),
        }
    }
}

impl host::Process for Process {
    fn tell(&mut self, bytes: &[u8]) -> Result<(), String> {
        let written = match &mut self.input {
            Some(input) => input.write_all(bytes).and_then(|()| input.flush()).is_ok(),
            None => false,
        };
        match written {
            true => Ok(()),
            false => Err(self.ended()),
        }
    }

    fn ask(&mut self, line: &str) -> Result<String, String> {
        self.tell(format!("{line}\n").as_bytes())?;
        let mut answer = String::new();
        match self.output.read_line(&mut answer) {
            Ok(length) if length > 0 => Ok(answer),
            Ok(_) | Err(_) => Err(self.ended()),
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // Without input it ends by itself, after it has ended the instance.
        self.input = None;
        drop(self.child.wait());
    }
}
