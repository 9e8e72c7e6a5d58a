//! `hyde mcp`: a server of the Model Context Protocol, on standard input and output. A tool runs this command again.

use crate::exit::Exit;
use crate::files;
use crate::output::print_error;
use hyde_mcp::{Host, Ran};
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::time::Duration;

/// Serves one client until its messages end.
pub(crate) fn mcp() -> Exit {
    let mut input = BufReader::new(std::io::stdin());
    let mut output = std::io::stdout();
    match hyde_mcp::serve(&mut input, &mut output, &Machine::new()) {
        Ok(()) => Exit::Done,
        Err(error) => {
            print_error(&format!("error: {}", files::reason(&error)));
            Exit::CommandLine
        }
    }
}

/// How often a command that runs is looked at whether it is cancelled.
const LOOKS: Duration = Duration::from_millis(20);

/// Everything that a stream gives. The sender is held until then.
fn text(stream: Option<impl Read>, _ended: mpsc::Sender<()>) -> String {
    let mut bytes = Vec::new();
    // What a process that ended left is read to its end.
    let _read = stream.map(|mut stream| stream.read_to_end(&mut bytes));
    String::from_utf8_lossy(&bytes).into_owned()
}

/// What the server needs of the machine.
struct Machine {
    /// The folder with those of the calls. Another server of this process number may have left one.
    folder: PathBuf,
}

impl Machine {
    fn new() -> Self {
        let own = format!("hyde-mcp-{}", std::process::id());
        let further = (2_u64..).map(|number| format!("{own}-{number}"));
        let names = std::iter::once(own.clone()).chain(further);
        let mut folders = names.map(|name| std::env::temp_dir().join(name));
        let free = folders.find(|folder| !folder.exists());
        Self {
            folder: free.unwrap_or_else(std::env::temp_dir),
        }
    }
}

impl Host for Machine {
    fn run(&self, arguments: &[String], cancelled: &AtomicBool) -> Result<Ran, String> {
        let own = std::env::current_exe().map_err(|error| files::reason(&error))?;
        let mut command = Command::new(own);
        // The messages on standard input are not for it.
        command.args(arguments).stdin(Stdio::null());
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut running = command.spawn().map_err(|error| files::reason(&error))?;
        let (stdout, stderr) = (running.stdout.take(), running.stderr.take());
        // Both readers hold a sender until they are at the end.
        let (sender, ended) = mpsc::channel::<()>();
        std::thread::scope(|scope| {
            let other = sender.clone();
            let stdout = scope.spawn(move || text(stdout, sender));
            let stderr = scope.spawn(move || text(stderr, other));
            while ended.recv_timeout(LOOKS) == Err(RecvTimeoutError::Timeout) {
                if cancelled.load(Ordering::Relaxed) {
                    running.kill().map_err(|error| files::reason(&error))?;
                    break;
                }
            }
            let status = running.wait().map_err(|error| files::reason(&error))?;
            Ok(Ran {
                stdout: stdout.join().unwrap_or_default(),
                stderr: stderr.join().unwrap_or_default(),
                status: status.code().unwrap_or(-1),
            })
        })
    }

    fn write(&self, folder: &str, name: &str, text: &str) -> Result<String, String> {
        let folder = Path::new(folder);
        files::make_folder(folder)?;
        let path = folder.join(name);
        files::write(&path, text.as_bytes())?;
        Ok(path.display().to_string())
    }

    fn folder(&self, call: usize) -> String {
        self.folder.join(call.to_string()).display().to_string()
    }
}
