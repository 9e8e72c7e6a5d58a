//! `--sandbox`: each instance of an FMU in a process of its own. What its library does to that process ends the run with a
//! diagnostic and nothing else.

use crate::exit::Exit;
use crate::files;
use crate::output::print_error;
use hyde_fmu_import::{Fmu, host};
use hyde_program::{Foreign, ForeignInstance, Stopped};
use hyde_study::FmuHost;
use std::io::{BufRead as _, BufReader, Write as _};
use std::net::Shutdown;
use std::os::fd::{AsFd as _, OwnedFd};
use std::os::unix::net::UnixStream;
use std::process::{Child, Command, Stdio};
use std::sync::Arc;

/// Who runs FMUs; none for this process, if the command line does not ask for others.
pub(crate) fn host(asked: bool) -> Option<Arc<dyn FmuHost>> {
    asked.then(|| Arc::new(Sandbox) as Arc<dyn FmuHost>)
}

/// `hyde fmu-host`: the process itself. Standard input is a socket to the process that started it; standard output is left to
/// what the library prints.
pub(crate) fn serve() -> Exit {
    let served = std::io::stdin()
        .as_fd()
        .try_clone_to_owned()
        .map(UnixStream::from)
        .and_then(|answers| Ok((answers.try_clone()?, answers)))
        .map_err(|error| files::reason(&error))
        .and_then(|(asked, answers)| host::serve(BufReader::new(asked), answers));
    match served {
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

/// A process with the socket to it.
struct Process {
    child: Child,
    answers: BufReader<UnixStream>,
}

impl Process {
    fn new() -> Result<Self, String> {
        Self::started()
            .map_err(|error| format!("its process cannot be started: {}", files::reason(&error)))
    }

    fn started() -> std::io::Result<Self> {
        let (own, other) = UnixStream::pair()?;
        let printed = std::io::stderr().as_fd().try_clone_to_owned()?;
        let child = Command::new(std::env::current_exe()?)
            .arg("fmu-host")
            .stdin(Stdio::from(OwnedFd::from(other)))
            .stdout(Stdio::from(printed))
            .spawn()?;
        let answers = BufReader::new(own);
        Ok(Self { child, answers })
    }

    /// How the process ended.
    fn ended(&mut self) -> String {
        self.close();
        match self.child.wait() {
            Ok(status) => format!("its process ended: {status}"),
            Err(error) => format!("its process ended: {}", files::reason(&error)),
        }
    }

    /// Without more to read it ends by itself, after it has ended the instance.
    fn close(&self) {
        drop(self.answers.get_ref().shutdown(Shutdown::Both));
    }
}

impl host::Process for Process {
    fn tell(&mut self, bytes: &[u8]) -> Result<(), String> {
        match self.answers.get_mut().write_all(bytes) {
            Ok(()) => Ok(()),
            Err(_) => Err(self.ended()),
        }
    }

    fn ask(&mut self, line: &str) -> Result<String, String> {
        self.tell(format!("{line}\n").as_bytes())?;
        let mut answer = String::new();
        match self.answers.read_line(&mut answer) {
            Ok(length) if length > 0 => Ok(answer),
            Ok(_) | Err(_) => Err(self.ended()),
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        self.close();
        drop(self.child.wait());
    }
}
