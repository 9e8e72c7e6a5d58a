//! An editor that sends anything: the server answers every request and ends when it is told to.
//!
//! ```text
//! byte 0..=2     open, change or close one of three files; the text is what follows up to a byte 0xff
//! byte 3..=4     a message with a method and parameters of JSON, each up to a byte 0xff
//! other          one of the requests at a line and a column, a byte each
//! ```
#![no_main]

use hyde_editor::{Nobody, serve};
use hyde_study::world::{Buffers, World};
use libfuzzer_sys::fuzz_target;
use lsp_server::{Connection, Message, Notification, Request, RequestId};
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::Duration;

const REQUESTS: [&str; 15] = [
    "textDocument/hover",
    "textDocument/definition",
    "textDocument/references",
    "textDocument/rename",
    "textDocument/prepareRename",
    "textDocument/completion",
    "textDocument/documentHighlight",
    "textDocument/signatureHelp",
    "textDocument/documentSymbol",
    "textDocument/foldingRange",
    "textDocument/semanticTokens/full",
    "textDocument/formatting",
    "textDocument/inlayHint",
    "textDocument/codeAction",
    "textDocument/selectionRange",
];
/// How long an answer may take.
const PATIENCE: Duration = Duration::from_secs(20);
/// Messages of one session.
const MOST: i32 = 24;

fuzz_target!(|data: &[u8]| {
    let (client, own) = Connection::memory();
    let world: Arc<dyn World> = Arc::new(Buffers::default());
    let server = std::thread::spawn(move || serve(&own, world, Box::new(Nobody)));
    let mut editor = Editor { client, last: 0 };
    editor.ask("initialize", json!({ "capabilities": {} }));
    editor.tell("initialized", json!({}));
    let mut rest = data;
    while let Some((&first, behind)) = rest.split_first()
        && editor.last < MOST
    {
        rest = behind;
        let uri = format!("file:///nowhere/{}.hyde", first % 3);
        match first {
            0 => {
                let text = text(&mut rest);
                let document =
                    json!({ "uri": uri, "languageId": "hyde", "version": 1, "text": text });
                editor.tell("textDocument/didOpen", json!({ "textDocument": document }));
            }
            1 => {
                let (from, to) = (place(&mut rest), place(&mut rest));
                let change =
                    json!({ "range": { "start": from, "end": to }, "text": text(&mut rest) });
                let document = json!({ "uri": uri, "version": 2 });
                let params = json!({ "textDocument": document, "contentChanges": [change] });
                editor.tell("textDocument/didChange", params);
            }
            2 => editor.tell(
                "textDocument/didClose",
                json!({ "textDocument": { "uri": uri } }),
            ),
            3 | 4 => {
                let (method, params) = (text(&mut rest), text(&mut rest));
                // These end the session, as below.
                if ["exit", "shutdown", "initialize"].contains(&method.as_str()) {
                    continue;
                }
                let params = serde_json::from_str(&params).unwrap_or(Value::String(params));
                match first {
                    3 => editor.tell(&method, params),
                    _ => editor.ask(&method, params),
                }
            }
            other => {
                let at = place(&mut rest);
                let params = json!({
                    "textDocument": { "uri": uri }, "position": at, "positions": [at], "newName": "other",
                    "range": { "start": at, "end": { "line": 9999, "character": 0 } },
                    "context": { "includeDeclaration": true, "diagnostics": [] },
                    "options": { "tabSize": 2, "insertSpaces": true },
                });
                editor.ask(REQUESTS[usize::from(other) % REQUESTS.len()], params);
            }
        }
    }
    editor.ask("shutdown", Value::Null);
    editor.tell("exit", Value::Null);
    let _ = server.join().expect("the server ends");
});

struct Editor {
    client: Connection,
    last: i32,
}

impl Editor {
    fn tell(&mut self, method: &str, params: Value) {
        self.last += 1;
        let message = Notification::new(method.to_owned(), params);
        let _ = self.client.sender.send(message.into());
    }

    fn ask(&mut self, method: &str, params: Value) {
        self.last += 1;
        let id = RequestId::from(self.last);
        let request = Request::new(id.clone(), method.to_owned(), params);
        self.client
            .sender
            .send(request.into())
            .expect("the server listens");
        loop {
            let message = self.client.receiver.recv_timeout(PATIENCE);
            if let Message::Response(response) = message.expect("an answer to every request")
                && response.id == id
            {
                return;
            }
        }
    }
}

/// The text up to a byte that no text has.
fn text(rest: &mut &[u8]) -> String {
    let end = rest
        .iter()
        .position(|&byte| byte == 0xff)
        .unwrap_or(rest.len());
    let text = String::from_utf8_lossy(&rest[..end]).into_owned();
    *rest = rest.get(end + 1..).unwrap_or_default();
    text
}

/// A line and a column.
fn place(rest: &mut &[u8]) -> Value {
    let (line, column) = (
        rest.first().copied().unwrap_or(0),
        rest.get(1).copied().unwrap_or(0),
    );
    *rest = rest.get(2..).unwrap_or_default();
    json!({ "line": line, "character": column })
}
