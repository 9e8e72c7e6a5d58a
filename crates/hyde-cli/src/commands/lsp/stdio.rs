//! The editor on standard input and output. A message that is none is answered, and the session goes on: the transport of
//! `lsp-server` ends there.

use lsp_server::{Connection, Message};
use serde_json::{Value, json};
use std::io::{self, BufRead, Read as _, Write};
use std::thread::JoinHandle;

/// Codes of JSON-RPC.
const PARSE_ERROR: i32 = -32700;
const INVALID_REQUEST: i32 = -32600;

/// The threads that read and write.
pub(super) struct Threads {
    reads: JoinHandle<io::Result<()>>,
    writes: JoinHandle<io::Result<()>>,
}

impl Threads {
    /// Waits until both have ended.
    ///
    /// # Errors
    /// What cannot be read or written.
    pub(super) fn join(self) -> Result<(), String> {
        for thread in [self.reads, self.writes] {
            let ended = thread
                .join()
                .map_err(|_| "a thread ended early".to_owned())?;
            ended.map_err(|error| error.to_string())?;
        }
        Ok(())
    }
}

/// A connection to the editor.
pub(super) fn connection() -> (Connection, Threads) {
    let (server, editor) = Connection::memory();
    let (to_server, to_editor) = (editor.sender, editor.receiver);
    let reads = std::thread::spawn(move || {
        let mut input = io::stdin().lock();
        while let Some(body) = body(&mut input)? {
            let message = match message(&body) {
                Ok(message) => message,
                Err(answer) => {
                    write(&answer)?;
                    continue;
                }
            };
            let exits = matches!(&message, Message::Notification(own) if own.method == "exit");
            if to_server.send(message).is_err() || exits {
                break;
            }
        }
        Ok(())
    });
    let writes = std::thread::spawn(move || {
        to_editor
            .into_iter()
            .try_for_each(|message| message.write(&mut io::stdout().lock()))
    });
    (server, Threads { reads, writes })
}

/// The next body; none at the end of the input.
fn body(input: &mut impl BufRead) -> io::Result<Option<Vec<u8>>> {
    let mut length = None;
    loop {
        let mut line = String::new();
        if input.read_line(&mut line)? == 0 {
            return Ok(None);
        }
        let line = line.trim_end();
        if line.is_empty() {
            break;
        }
        if let Some((name, value)) = line.split_once(':')
            && name.eq_ignore_ascii_case("content-length")
        {
            length = value.trim().parse::<u64>().ok();
        }
    }
    let missing = || {
        io::Error::new(
            io::ErrorKind::InvalidData,
            "a message without Content-Length",
        )
    };
    let length = length.ok_or_else(missing)?;
    let mut body = Vec::new();
    // Room is made for what comes, not for what is announced.
    let read = input.take(length).read_to_end(&mut body)?;
    Ok((read as u64 == length).then_some(body))
}

/// The message of a body, or the answer to one that is none.
fn message(body: &[u8]) -> Result<Message, Value> {
    let refusal = |id: Value, code: i32, reason: &str| json!({ "jsonrpc": "2.0", "id": id, "error": { "code": code, "message": reason } });
    let value: Value = serde_json::from_slice(body)
        .map_err(|error| refusal(Value::Null, PARSE_ERROR, &error.to_string()))?;
    let id = value.get("id").cloned().unwrap_or(Value::Null);
    let reason = match value.is_array() {
        true => "batches of messages are not supported: send one message at a time",
        false => "this is not a request, a notification or a response",
    };
    serde_json::from_value(value).map_err(|_| refusal(id, INVALID_REQUEST, reason))
}

/// Writes an answer that belongs to no request.
fn write(answer: &Value) -> io::Result<()> {
    let body = answer.to_string();
    let mut output = io::stdout().lock();
    write!(output, "Content-Length: {}\r\n\r\n{body}", body.len())?;
    output.flush()
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test may panic")]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_message_is_answered() {
        let code = |body: &[u8]| message(body).unwrap_err()["error"]["code"].clone();
        assert_eq!(code(b"{\"id\": 1, "), PARSE_ERROR);
        assert_eq!(code(b"[]"), INVALID_REQUEST);
        assert_eq!(code(b"{\"jsonrpc\": \"2.0\"}"), INVALID_REQUEST);
        let exit = message(b"{\"jsonrpc\": \"2.0\", \"method\": \"exit\"}").unwrap();
        assert!(matches!(exit, Message::Notification(own) if own.method == "exit"));
    }

    #[test]
    fn a_body_ends_where_its_length_says() {
        let mut input = &b"Content-Length: 2\r\n\r\n{}Content-Length: 99999999999999\r\n\r\n{}"[..];
        assert_eq!(body(&mut input).unwrap().unwrap(), b"{}");
        assert_eq!(body(&mut input).unwrap(), None);
    }
}
