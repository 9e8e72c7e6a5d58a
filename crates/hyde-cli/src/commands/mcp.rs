//! `hyde mcp`: a server of the Model Context Protocol, on standard input and output. A tool runs this command again.

use crate::exit::Exit;
use crate::files;
use crate::output::print_error;
use hyde_mcp::{Host, Ran};
use std::io::BufReader;
use std::path::Path;
use std::process::{Command, Stdio};

/// Serves one client until its messages end.
pub(crate) fn mcp() -> Exit {
    let mut input = BufReader::new(std::io::stdin());
    let mut output = std::io::stdout();
    match hyde_mcp::serve(&mut input, &mut output, &Machine) {
        Ok(()) => Exit::Done,
        Err(error) => {
            print_error(&format!("error: {}", files::reason(&error)));
            Exit::CommandLine
        }
    }
}

/// What the server needs of the machine.
struct Machine;

impl Host for Machine {
    fn run(&self, arguments: &[String]) -> Result<Ran, String> {
        let own = std::env::current_exe().map_err(|error| files::reason(&error))?;
        let mut command = Command::new(own);
        // The messages on standard input are not for it.
        command.args(arguments).stdin(Stdio::null());
        let left = command.output().map_err(|error| files::reason(&error))?;
        Ok(Ran {
            stdout: String::from_utf8_lossy(&left.stdout).into_owned(),
            stderr: String::from_utf8_lossy(&left.stderr).into_owned(),
            status: left.status.code().unwrap_or(-1),
        })
    }

    fn write(&self, folder: &str, name: &str, text: &str) -> Result<String, String> {
        let folder = Path::new(folder);
        files::make_folder(folder)?;
        let path = folder.join(name);
        files::write(&path, text.as_bytes())?;
        Ok(path.display().to_string())
    }

    fn folder(&self) -> String {
        let name = format!("hyde-mcp-{}", std::process::id());
        std::env::temp_dir().join(name).display().to_string()
    }
}
