//! An editor that speaks the protocol with a server in the same process.

use hyde_diag::Code;
use hyde_editor::{Action, Course, Courses, Ended, Failure, Host, Label, Order, Outcome};
use hyde_study::world::Disk;
use hyde_units::{Dimension, NamedUnit};
use lsp_server::{Connection, Message, Notification, Request, RequestId};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

/// How long an answer may take in a debug build on a busy machine.
const LONGEST: Duration = Duration::from_secs(60);

pub(crate) struct Client {
    connection: Connection,
    server: Option<JoinHandle<Result<Ended, String>>>,
    last: i32,
    pub(crate) told: Vec<Notification>,
    /// What the server asked of the editor.
    pub(crate) asked: Vec<Request>,
}

struct Machine;

impl Host for Machine {
    fn library_file(&self, name: &str, _: &str) -> Option<PathBuf> {
        Some(Path::new("/library").join(name))
    }

    fn explanation(&self, code: Code) -> String {
        format!("{code}: {}", code.title())
    }

    /// A run of `fade` has values, one of `break` fails at half its way.
    fn start(&self, order: Order, done: Box<dyn FnOnce(Outcome) + Send>) {
        let page = format!("/pages/{}-{}.html", order.action.title(), order.name);
        let outcome = Outcome::from(Ok(PathBuf::from(page)));
        done(match (order.action, order.name.as_str()) {
            (Action::Run, "fade") => Outcome {
                courses: Some(courses(100)),
                ..outcome
            },
            (Action::Run, "break") => Outcome {
                courses: Some(courses(50)),
                failures: vec![failure(&order.file.to_string_lossy())],
                ..outcome
            },
            _ => outcome,
        });
    }
}

/// Two lags that fade, `one.x` from 1 and `two.x` from -2, and a body that stays, in so many hundredths of a second.
fn courses(rows: u32) -> Courses {
    let time: Vec<f64> = (0..=rows).map(|k| f64::from(k) / 100.0).collect();
    let course = |name: &str, start: f64, fall: f64| Course {
        name: name.to_owned(),
        unit: NamedUnit::usual(Dimension::LENGTH),
        values: time.iter().map(|t| start * (1.0 - fall * t)).collect(),
    };
    Courses {
        list: vec![
            course("one.x", 1.0, 0.5),
            course("two.x", -2.0, 0.25),
            course("body.s", 3.0, 0.0),
        ],
        time: time.clone(),
    }
}

/// A failure at the equation in line 8, `  T*der(x) = -x;`.
fn failure(file: &str) -> Failure {
    Failure {
        code: "E0701".to_owned(),
        message: "the solver failed at 0.5 s".to_owned(),
        notes: vec!["`one.x` is 0.75 m there".to_owned()],
        help: Some("look there".to_owned()),
        labels: vec![Label {
            file: file.to_owned(),
            from: (8, 3),
            to: (8, 16),
            text: "this equation, in `one`".to_owned(),
        }],
    }
}

impl Client {
    /// A session that has begun. `encodings` are those that the editor knows.
    pub(crate) fn new(encodings: &[&str]) -> Self {
        let (connection, own) = Connection::memory();
        let server =
            std::thread::spawn(move || hyde_editor::serve(&own, Arc::new(Disk), Box::new(Machine)));
        let mut client = Self {
            connection,
            server: Some(server),
            last: 0,
            told: Vec::new(),
            asked: Vec::new(),
        };
        let general = json!({ "general": { "positionEncodings": encodings },
            "window": { "showDocument": { "support": true } } });
        let answer = client.ask("initialize", json!({ "capabilities": general }));
        assert!(
            answer["capabilities"]["hoverProvider"].is_boolean(),
            "{answer}"
        );
        client.tell("initialized", json!({}));
        client
    }

    /// A session in which a file is open.
    pub(crate) fn with(path: &str, text: &str) -> Self {
        let client = Self::new(&["utf-16"]);
        client.open(path, text);
        client
    }

    /// What a hover over a word says: the first `what` behind the first `after`.
    pub(crate) fn hover(&mut self, (path, text): (&str, &str), after: &str, what: &str) -> String {
        let found = self.at("textDocument/hover", path, find(text, after, what));
        found["contents"]["value"]
            .as_str()
            .unwrap_or_default()
            .to_owned()
    }

    pub(crate) fn tell(&self, method: &str, params: Value) {
        let message = Notification::new(method.to_owned(), params);
        self.connection.sender.send(message.into()).unwrap();
    }

    /// The result of a request; one that fails gives its message in `error`.
    pub(crate) fn ask(&mut self, method: &str, params: Value) -> Value {
        self.last += 1;
        let id = RequestId::from(self.last);
        let request = Request::new(id.clone(), method.to_owned(), params);
        self.connection.sender.send(request.into()).unwrap();
        loop {
            match self.connection.receiver.recv_timeout(LONGEST).unwrap() {
                Message::Response(response) if response.id == id => {
                    let value = serde_json::to_value(response).unwrap();
                    return match value.get("error") {
                        Some(error) => json!({ "error": error }),
                        None => value["result"].clone(),
                    };
                }
                Message::Notification(own) => self.told.push(own),
                Message::Request(own) => self.asked.push(own),
                other @ Message::Response(_) => panic!("{other:?}"),
            }
        }
    }

    pub(crate) fn open(&self, path: &str, text: &str) {
        let document =
            json!({ "uri": uri(path), "languageId": "hyde", "version": 1, "text": text });
        self.tell("textDocument/didOpen", json!({ "textDocument": document }));
    }

    pub(crate) fn change(&self, path: &str, version: i32, changes: Value) {
        let document = json!({ "uri": uri(path), "version": version });
        self.tell(
            "textDocument/didChange",
            json!({ "textDocument": document, "contentChanges": changes }),
        );
    }

    /// A request about a place.
    pub(crate) fn at(&mut self, method: &str, path: &str, (line, column): (usize, usize)) -> Value {
        let position = json!({ "line": line, "character": column });
        let mut params = json!({ "textDocument": { "uri": uri(path) }, "position": position });
        if method == "textDocument/references" {
            params["context"] = json!({ "includeDeclaration": true });
        }
        self.ask(method, params)
    }

    /// A request about a file.
    pub(crate) fn of(&mut self, method: &str, path: &str) -> Value {
        let options = json!({ "tabSize": 2, "insertSpaces": true });
        let document = json!({ "uri": uri(path) });
        // The whole file.
        let range = json!({ "start": { "line": 0, "character": 0 },
            "end": { "line": 100_000, "character": 0 } });
        self.ask(
            method,
            json!({ "textDocument": document, "options": options, "range": range }),
        )
    }

    /// The next diagnostics of a file that `wanted` accepts.
    pub(crate) fn diagnostics(
        &mut self,
        path: &str,
        wanted: impl Fn(&[Value]) -> bool,
    ) -> Vec<Value> {
        loop {
            while !self.told.is_empty() {
                let own = self.told.remove(0);
                let list = own.params["diagnostics"].as_array().cloned();
                let here = own.params["uri"] == uri(path);
                if let Some(list) = list.filter(|list| here && wanted(list)) {
                    return list;
                }
            }
            match self.connection.receiver.recv_timeout(LONGEST).unwrap() {
                Message::Notification(own) => self.told.push(own),
                Message::Request(own) => self.asked.push(own),
                other @ Message::Response(_) => panic!("{other:?}"),
            }
        }
    }

    /// The next request of the server.
    pub(crate) fn request(&mut self) -> Request {
        while self.asked.is_empty() {
            match self.connection.receiver.recv_timeout(LONGEST).unwrap() {
                Message::Notification(own) => self.told.push(own),
                Message::Request(own) => self.asked.push(own),
                other @ Message::Response(_) => panic!("{other:?}"),
            }
        }
        self.asked.remove(0)
    }

    /// Ends the session as an editor does.
    pub(crate) fn end(mut self) {
        self.ask("shutdown", Value::Null);
        let late = self.ask("textDocument/hover", Value::Null);
        assert_eq!(late["error"]["code"], -32600, "{late}");
        self.tell("exit", Value::Null);
        let ended = self.server.take().unwrap().join().unwrap();
        assert_eq!(ended, Ok(Ended::ShutDown));
    }
}

pub(crate) fn uri(path: &str) -> String {
    format!("file://{path}")
}

/// Line and column of a byte, the column in UTF-16.
pub(crate) fn place(text: &str, byte: usize) -> (usize, usize) {
    let line = text[..byte].matches('\n').count();
    let start = text[..byte].rfind('\n').map_or(0, |at| at + 1);
    (line, text[start..byte].encode_utf16().count())
}

/// The place of the first `what` behind `after`.
pub(crate) fn find(text: &str, after: &str, what: &str) -> (usize, usize) {
    let from = text.find(after).unwrap() + after.len();
    place(text, from + text[from..].find(what).unwrap())
}

/// A text with the edits of an answer applied.
pub(crate) fn edited(text: &str, edits: &Value) -> String {
    let byte = |position: &Value| {
        let line = position["line"].as_u64().unwrap() as usize;
        let column = position["character"].as_u64().unwrap() as usize;
        let start: usize = text.split_inclusive('\n').take(line).map(str::len).sum();
        let mut units = 0;
        let rest = &text[start..];
        let at = rest.char_indices().find(|(_, sign)| {
            let found = units >= column;
            units += sign.len_utf16();
            found
        });
        start + at.map_or(rest.len(), |(at, _)| at)
    };
    let mut list: Vec<(usize, usize, String)> = edits
        .as_array()
        .unwrap()
        .iter()
        .map(|edit| {
            let range = &edit["range"];
            let new = edit["newText"].as_str().unwrap().to_owned();
            (byte(&range["start"]), byte(&range["end"]), new)
        })
        .collect();
    list.sort();
    let mut text = text.to_owned();
    for (start, end, new) in list.into_iter().rev() {
        text.replace_range(start..end, &new);
    }
    text
}

/// Whether `./dev long` asks for everything.
pub(crate) fn is_long() -> bool {
    std::env::var_os("HYDE_LONG").is_some()
}
