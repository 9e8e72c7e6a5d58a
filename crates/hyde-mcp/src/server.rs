//! [`serve`]: JSON-RPC 2.0, one message a line, one after the other.

use crate::components::components;
use crate::tools::{TOOLS, Tool};
use crate::{Host, Ran, digest};
use serde_json::{Map, Value, json};
use std::io::{BufRead, Write};

/// Versions of the protocol with `initialize`, the newest first.
const VERSIONS: [&str; 4] = ["2025-11-25", "2025-06-18", "2025-03-26", "2024-11-05"];

const PARSE: i64 = -32700;
const INVALID_REQUEST: i64 = -32600;
const NO_METHOD: i64 = -32601;
const INVALID_PARAMS: i64 = -32602;

/// What a client is told of the tools as a whole.
const INSTRUCTIONS: &str = "Hyde is an equation language for machine-tool feed drives and its simulator. Write models as files \
NAME.hyde, `check` them, `run` experiments, `look` at traces, `fit` and `diagnose` models on records. Answers are summaries; \
results, figures and complete answers are in files whose paths are given. Do not read result files into the conversation: \
plot or reduce them. `explain` describes a diagnostic code, `components` lists the library.";

/// Longest message that is read, in bytes.
const LONGEST: u64 = 10_000_000;

/// An error of the protocol: code and message.
type Fault = (i64, String);

/// Answers a client until its messages end.
///
/// # Errors
/// A message cannot be read or written.
pub fn serve(
    input: &mut dyn BufRead,
    output: &mut dyn Write,
    host: &dyn Host,
) -> std::io::Result<()> {
    loop {
        let mut line = Vec::new();
        let read = std::io::Read::take(&mut *input, LONGEST).read_until(b'\n', &mut line)?;
        if read == 0 {
            return Ok(());
        }
        if line.iter().all(u8::is_ascii_whitespace) {
            continue;
        }
        let answer = match serde_json::from_slice::<Value>(&line) {
            Ok(message) => answer(&message, host),
            Err(error) => Some(failed(&Value::Null, (PARSE, error.to_string()))),
        };
        if let Some(answer) = answer {
            writeln!(output, "{answer}")?;
            output.flush()?;
        }
    }
}

/// The answer to a message; a notification has none.
fn answer(message: &Value, host: &dyn Host) -> Option<Value> {
    let Some(request) = message.as_object() else {
        let fault = "a message is one JSON object a line".to_owned();
        return Some(failed(&Value::Null, (INVALID_REQUEST, fault)));
    };
    // An answer to a request that this server never makes, or a notification.
    let id = request.get("id")?;
    let Some(method) = request.get("method").and_then(Value::as_str) else {
        let fault = "a request has a `method`".to_owned();
        return Some(failed(id, (INVALID_REQUEST, fault)));
    };
    let empty = Map::new();
    let params = request.get("params").and_then(Value::as_object);
    let params = params.unwrap_or(&empty);
    let result = match method {
        "initialize" => Ok(initialized(params)),
        "ping" => Ok(json!({})),
        "tools/list" => Ok(json!({ "tools": listed() })),
        "tools/call" => called(params, host),
        other => Err((NO_METHOD, format!("no method `{other}`"))),
    };
    Some(match result {
        Ok(result) => json!({ "jsonrpc": "2.0", "id": id, "result": result }),
        Err(fault) => failed(id, fault),
    })
}

fn failed(id: &Value, (code, message): Fault) -> Value {
    json!({ "jsonrpc": "2.0", "id": id, "error": { "code": code, "message": message } })
}

fn initialized(params: &Map<String, Value>) -> Value {
    let asked = params.get("protocolVersion").and_then(Value::as_str);
    let known = VERSIONS.into_iter().find(|version| Some(*version) == asked);
    json!({
        "protocolVersion": known.unwrap_or(VERSIONS[0]),
        "capabilities": { "tools": {} },
        "serverInfo": { "name": "hyde", "title": "Hyde", "version": env!("CARGO_PKG_VERSION") },
        "instructions": INSTRUCTIONS,
    })
}

fn listed() -> Vec<Value> {
    let mut all: Vec<Value> = TOOLS.iter().map(Tool::listed).collect();
    all.push(json!({
        "name": "components",
        "description": "The components and effects of the library: names to use in a model, each with one line.",
        "inputSchema": {
            "type": "object",
            "properties": {
                "containing": { "type": "string", "description": "only those whose name or description contains this word" },
            },
            "additionalProperties": false,
        },
        "annotations": { "readOnlyHint": true, "openWorldHint": false },
    }));
    all
}

fn called(params: &Map<String, Value>, host: &dyn Host) -> Result<Value, Fault> {
    let name = params.get("name").and_then(Value::as_str);
    let name = name.ok_or((INVALID_PARAMS, "a call has the `name` of a tool".to_owned()))?;
    let empty = Map::new();
    let given = params.get("arguments").and_then(Value::as_object);
    let given = given.unwrap_or(&empty);
    if name == "components" {
        let word = given.get("containing").and_then(Value::as_str);
        let all = components(word.unwrap_or_default());
        let found = json!({ "components": all });
        return Ok(told(&found.to_string(), false));
    }
    let tool = TOOLS.iter().find(|tool| tool.name == name);
    let tool = tool.ok_or_else(|| (INVALID_PARAMS, format!("no tool `{name}`")))?;
    let mut given = given.clone();
    if tool.takes("out") && given.get("out").is_none_or(Value::is_null) {
        given.insert("out".to_owned(), json!(host.folder()));
    }
    let out = given.get("out").and_then(Value::as_str).map(str::to_owned);
    let line = match tool.command(&given) {
        Ok(line) => line,
        // The caller can mend it: an answer, not an error of the protocol.
        Err(reason) => return Ok(told(&reason, true)),
    };
    let ran = match host.run(&line) {
        Ok(ran) => ran,
        Err(reason) => return Ok(told(&reason, true)),
    };
    Ok(summary(
        tool,
        &ran,
        out.unwrap_or_else(|| host.folder()),
        host,
    ))
}

/// What a command left, without samples; the whole of it in a file if something is left out.
fn summary(tool: &Tool, ran: &Ran, folder: String, host: &dyn Host) -> Value {
    let Ok(whole) = serde_json::from_str::<Value>(&ran.stdout) else {
        let text = format!("{}{}", ran.stdout, ran.stderr);
        return told(text.trim(), ran.status != 0);
    };
    let (mut short, cut) = digest(&whole);
    if let Value::Object(fields) = &mut short {
        fields.insert("exit_status".to_owned(), json!(ran.status));
        if tool.takes("out") {
            fields.insert("folder".to_owned(), json!(folder));
        }
        if cut {
            let name = format!("{}.json", tool.name);
            match host.write(&folder, &name, &format!("{whole:#}\n")) {
                Ok(path) => fields.insert("complete_answer".to_owned(), json!(path)),
                Err(reason) => fields.insert("complete_answer_lost".to_owned(), json!(reason)),
            };
        }
        let said = ran.stderr.trim();
        if !said.is_empty() {
            fields.insert("said".to_owned(), json!(said));
        }
    }
    // An expectation that does not hold is an answer.
    told(&short.to_string(), ran.status != 0 && ran.status != 4)
}

fn told(text: &str, is_error: bool) -> Value {
    json!({ "content": [{ "type": "text", "text": text }], "isError": is_error })
}
