//! Random edits of model files in a language server, with requests in between: after each sequence a server that has been
//! there all the time and one that opens the result say the same.

#[path = "../../crates/hyde-editor/tests/session/pieces.rs"]
mod pieces;

use self::pieces::PIECES;
use crate::numbers::Numbers;
use crate::root;
use hyde_editor::{Ended, Nobody, serve};
use hyde_study::world::{Disk, read_text};
use lsp_server::{Connection, Message, Notification, Request, RequestId};
use serde_json::{Value, json};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

/// The texts that are edited.
const FILES: [&str; 6] = [
    "examples/first/first.hyde",
    "examples/shaft/shaft.hyde",
    "examples/emps/emps.hyde",
    "examples/bldc/rotor.hyde",
    "examples/two_mass/two_mass.hyde",
    "examples/y_axis/axis.hyde",
];
/// Requests about a place, and about a file.
const AT: [&str; 8] = [
    "hover",
    "definition",
    "references",
    "completion",
    "documentHighlight",
    "signatureHelp",
    "rename",
    "selectionRange",
];
const OF: [&str; 7] = [
    "documentSymbol",
    "foldingRange",
    "semanticTokens/full",
    "formatting",
    "inlayHint",
    "codeLens",
    "codeAction",
];
/// Edits of a sequence at most.
const MOST_EDITS: u64 = 6;
/// Sequences after which another server takes over.
const LIFE: u64 = 500;
/// The diagnostics of the full check, which comes after a pause, are compared in one of so many sequences.
const CHECKED: u64 = 250;
/// How long an answer may take.
const PATIENCE: Duration = Duration::from_secs(60);
const PATH: &str = "/nowhere/edited.hyde";

/// What sequences of random edits came to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Edited {
    /// Edits that were made.
    pub edits: u64,
    /// Requests that were answered.
    pub requests: u64,
    /// Answers that fail, or differ from those of a new server, with the text.
    pub findings: Vec<String>,
}

/// Makes sequences of edits, those of these numbers.
///
/// # Errors
/// A model file cannot be read, or a server does not answer.
pub fn edit(numbers: std::ops::Range<u64>) -> Result<Edited, String> {
    let texts = FILES.map(|file| read_text(&Disk, &root().join(file)));
    let texts: Vec<String> = texts.into_iter().collect::<Result<_, _>>()?;
    let mut found = Edited::default();
    let mut old = Editor::new()?;
    old.open(&texts[0])?;
    for number in numbers {
        if number % LIFE == LIFE - 1 {
            std::mem::replace(&mut old, Editor::new()?).end()?;
            old.open(&texts[0])?;
        }
        let mut random = Numbers::of(number);
        let mut text = texts[random.one_of(texts.len() as u64) as usize].clone();
        old.change(json!([{ "text": text }]))?;
        for _ in 0..=random.one_of(MOST_EDITS) {
            old.change(json!([change(&mut random, &mut text)]))?;
            found.edits += 1;
            let (method, params) = request(&mut random, &text);
            let answer = old.ask(&method, params)?;
            found.requests += 1;
            if is_defect(&answer) {
                found
                    .findings
                    .push(format!("{number}: {method}: {answer}\n{text}"));
            }
        }
        let mut fresh = Editor::new()?;
        fresh.open(&text)?;
        for _ in 0..3 {
            let (method, params) = request(&mut random, &text);
            let [was, is] = [&mut old, &mut fresh].map(|own| own.ask(&method, params.clone()));
            let (was, is) = (was?, is?);
            found.requests += 1;
            if was != is || is_defect(&was) {
                let what = format!("{number}: {method} {params}: {was} and, of a new server, {is}");
                found.findings.push(format!("{what}\n{text}"));
            }
        }
        if number % CHECKED == 0 {
            let [was, is] = [&mut old, &mut fresh].map(Editor::full_diagnostics);
            let (was, is) = (was?, is?);
            if was != is {
                let what = format!("{number}: diagnostics {was} and, of a new server, {is}");
                found.findings.push(format!("{what}\n{text}"));
            }
        }
        fresh.end()?;
    }
    old.end()?;
    Ok(found)
}

/// A defect that the server caught.
fn is_defect(answer: &Value) -> bool {
    answer["error"]["code"] == -32603
}

/// A change of the text: some letters go, a piece comes.
fn change(random: &mut Numbers, text: &mut String) -> Value {
    let start = boundary(text, random.one_of(text.len() as u64 + 1) as usize);
    let end = (start + random.one_of(24) as usize).min(text.len());
    let end = boundary(text, end).max(start);
    let kinds = PIECES.len() as u64;
    let new = match random.one_of(kinds + 6) {
        kind if kind < kinds => PIECES[kind as usize].to_owned(),
        _ => {
            let from = boundary(text, random.one_of(text.len() as u64 + 1) as usize);
            let to = (from + random.one_of(80) as usize).min(text.len());
            text[from..boundary(text, to).max(from)].to_owned()
        }
    };
    let range = json!({ "start": place(text, start), "end": place(text, end) });
    text.replace_range(start..end, &new);
    json!({ "range": range, "text": new })
}

/// A request about a random place.
fn request(random: &mut Numbers, text: &str) -> (String, Value) {
    let at = place(
        text,
        boundary(text, random.one_of(text.len() as u64 + 1) as usize),
    );
    let kinds = (AT.len() + OF.len()) as u64;
    let kind = random.one_of(kinds) as usize;
    let method = AT.iter().chain(&OF).nth(kind).unwrap_or(&AT[0]);
    let all = json!({ "start": { "line": 0, "character": 0 }, "end": { "line": 99_999, "character": 0 } });
    let params = json!({
        "textDocument": { "uri": uri() }, "position": at, "positions": [at], "newName": "other",
        "range": all, "options": { "tabSize": 2, "insertSpaces": true },
        "context": { "includeDeclaration": true, "diagnostics": [] },
    });
    (format!("textDocument/{method}"), params)
}

/// The letter that a byte is in begins here.
fn boundary(text: &str, byte: usize) -> usize {
    let mut byte = byte.min(text.len());
    while !text.is_char_boundary(byte) {
        byte -= 1;
    }
    byte
}

/// Line and column of a byte, the column in UTF-16.
fn place(text: &str, byte: usize) -> Value {
    let line = text[..byte].matches('\n').count();
    let start = text[..byte].rfind('\n').map_or(0, |at| at + 1);
    json!({ "line": line, "character": text[start..byte].encode_utf16().count() })
}

fn uri() -> String {
    format!("file://{PATH}")
}

/// An editor with a server of its own.
struct Editor {
    connection: Connection,
    server: JoinHandle<Result<Ended, String>>,
    last: i32,
}

impl Editor {
    fn new() -> Result<Self, String> {
        let (connection, own) = Connection::memory();
        let server = std::thread::spawn(move || serve(&own, Arc::new(Disk), Box::new(Nobody)));
        let mut editor = Self {
            connection,
            server,
            last: 0,
        };
        editor.ask("initialize", json!({ "capabilities": {} }))?;
        editor.tell("initialized", json!({}))?;
        Ok(editor)
    }

    fn open(&mut self, text: &str) -> Result<(), String> {
        let document = json!({ "uri": uri(), "languageId": "hyde", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }))
    }

    fn change(&mut self, changes: Value) -> Result<(), String> {
        let document = json!({ "uri": uri(), "version": self.last + 1 });
        let params = json!({ "textDocument": document, "contentChanges": changes });
        self.tell("textDocument/didChange", params)
    }

    fn tell(&mut self, method: &str, params: Value) -> Result<(), String> {
        self.last += 1;
        let message = Notification::new(method.to_owned(), params);
        let sent = self.connection.sender.send(message.into());
        sent.map_err(|error| error.to_string())
    }

    fn ask(&mut self, method: &str, params: Value) -> Result<Value, String> {
        self.last += 1;
        let id = RequestId::from(self.last);
        let request = Request::new(id.clone(), method.to_owned(), params);
        let sent = self.connection.sender.send(request.into());
        sent.map_err(|error| error.to_string())?;
        loop {
            if let Message::Response(own) = self.heard(PATIENCE)?
                && own.id == id
            {
                let value = serde_json::to_value(own).map_err(|error| error.to_string())?;
                let part = |key: &str| value.get(key).cloned().unwrap_or_default();
                return Ok(json!({ "result": part("result"), "error": part("error") }));
            }
        }
    }

    /// What the server says of the text when it has said nothing new for longer than its pause.
    fn full_diagnostics(&mut self) -> Result<Value, String> {
        // An answer comes after all that was published before.
        self.change(json!([]))?;
        let mut last = Value::Null;
        while let Ok(message) = self.heard(4 * hyde_editor::PAUSE) {
            if let Message::Notification(own) = message
                && own.method == "textDocument/publishDiagnostics"
            {
                last = own.params["diagnostics"].clone();
            }
        }
        Ok(last)
    }

    fn heard(&self, patience: Duration) -> Result<Message, String> {
        let heard = self.connection.receiver.recv_timeout(patience);
        heard.map_err(|_| "the server does not answer".to_owned())
    }

    fn end(mut self) -> Result<(), String> {
        self.ask("shutdown", Value::Null)?;
        self.tell("exit", Value::Null)?;
        let ended = self.server.join();
        let ended = ended.map_err(|_| "the server ended in a panic".to_owned())??;
        match ended {
            Ended::ShutDown => Ok(()),
            Ended::Exit | Ended::Gone => Err(format!("the server ended otherwise: {ended:?}")),
        }
    }
}
