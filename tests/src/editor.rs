//! `hyde lsp` in a process of its own, and an editor that speaks with it.

use lsp_server::{Message, Notification, Request, RequestId};
use serde_json::{Value, json};
use std::io::BufReader;
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// A session with one open text.
pub struct Editor {
    child: Child,
    input: ChildStdin,
    output: BufReader<ChildStdout>,
    last: i32,
    uri: String,
}

impl Editor {
    /// Starts a command and opens a text under the path of a file.
    ///
    /// # Errors
    /// The command cannot be started or does not answer.
    #[allow(clippy::disallowed_methods, reason = "a server is a process")]
    pub fn open(command: &Path, path: &Path, text: &str) -> Result<Self, String> {
        let mut child = Command::new(command)
            .arg("lsp")
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .map_err(|error| error.to_string())?;
        let (Some(input), Some(output)) = (child.stdin.take(), child.stdout.take()) else {
            return Err("the server has no pipes".to_owned());
        };
        let mut editor = Self {
            child,
            input,
            output: BufReader::new(output),
            last: 0,
            uri: format!("file://{}", path.display()),
        };
        editor.ask("initialize", json!({ "capabilities": {} }))?;
        editor.tell("initialized", json!({}))?;
        let document =
            json!({ "uri": editor.uri, "languageId": "hyde", "version": 1, "text": text });
        editor.tell("textDocument/didOpen", json!({ "textDocument": document }))?;
        Ok(editor)
    }

    /// Gives the text another content.
    ///
    /// # Errors
    /// The server is gone.
    pub fn change(&mut self, changes: Value) -> Result<(), String> {
        self.last += 1;
        let document = json!({ "uri": self.uri, "version": self.last });
        self.tell(
            "textDocument/didChange",
            json!({ "textDocument": document, "contentChanges": changes }),
        )
    }

    /// The answer to a request about a place: line and column.
    ///
    /// # Errors
    /// The server is gone.
    pub fn at(&mut self, method: &str, (line, column): (usize, usize)) -> Result<Value, String> {
        let position = json!({ "line": line, "character": column });
        let document = json!({ "uri": self.uri });
        self.ask(
            method,
            json!({ "textDocument": document, "position": position }),
        )
    }

    /// Waits for the next diagnostics of the text.
    ///
    /// # Errors
    /// The server is gone.
    pub fn diagnostics(&mut self) -> Result<Vec<Value>, String> {
        loop {
            if let Message::Notification(own) = self.read()?
                && own.method == "textDocument/publishDiagnostics"
            {
                let list = own.params["diagnostics"].as_array();
                return Ok(list.cloned().unwrap_or_default());
            }
        }
    }

    /// The memory that the server holds, in kB.
    ///
    /// # Errors
    /// The system does not tell.
    #[allow(clippy::disallowed_methods, reason = "the system tells in a file")]
    pub fn memory_kb(&self) -> Result<f64, String> {
        let path = format!("/proc/{}/status", self.child.id());
        let text = std::fs::read_to_string(path).map_err(|error| error.to_string())?;
        let line = text.lines().find_map(|line| line.strip_prefix("VmRSS:"));
        let number = line.and_then(|line| line.split_whitespace().next()?.parse().ok());
        number.ok_or_else(|| "the system does not tell the memory of a process".to_owned())
    }

    fn tell(&mut self, method: &str, params: Value) -> Result<(), String> {
        let message = Message::from(Notification::new(method.to_owned(), params));
        message
            .write(&mut self.input)
            .map_err(|error| error.to_string())
    }

    fn ask(&mut self, method: &str, params: Value) -> Result<Value, String> {
        self.last += 1;
        let id = RequestId::from(self.last);
        let message = Message::from(Request::new(id.clone(), method.to_owned(), params));
        message
            .write(&mut self.input)
            .map_err(|error| error.to_string())?;
        loop {
            if let Message::Response(own) = self.read()?
                && own.id == id
            {
                return serde_json::to_value(own).map_err(|error| error.to_string());
            }
        }
    }

    fn read(&mut self) -> Result<Message, String> {
        let message = Message::read(&mut self.output).map_err(|error| error.to_string())?;
        message.ok_or_else(|| "the server is gone".to_owned())
    }
}

impl Drop for Editor {
    fn drop(&mut self) {
        drop(self.child.kill());
        drop(self.child.wait());
    }
}
