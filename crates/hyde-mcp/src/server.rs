//! [`serve`]: JSON-RPC 2.0, one message a line: one thread reads and answers, another runs the tools one after the other.

use crate::batch::{Batch, WITH_BATCHES};
use crate::components::components;
use crate::tools::{TOOLS, Tool};
use crate::{Host, Ran, digest};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::io::{BufRead, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};

/// Versions of the protocol with `initialize`, the newest first.
const VERSIONS: [&str; 4] = ["2025-11-25", "2025-06-18", WITH_BATCHES, "2024-11-05"];

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

/// Answers a client until its messages end, and works off the calls that are left then.
///
/// Calls of tools run one after the other; everything else is answered at once, so that a call can be cancelled.
///
/// # Errors
/// A message cannot be read or written.
pub fn serve(
    input: &mut dyn BufRead,
    output: &mut (dyn Write + Send),
    host: &(dyn Host + Sync),
) -> std::io::Result<()> {
    let output = Mutex::new(output);
    let asked = Asked::default();
    let (calls, waiting) = mpsc::channel::<Call>();
    std::thread::scope(|scope| {
        let (asked, output) = (&asked, &output);
        let worker = scope.spawn(move || work(waiting, asked, output, host));
        let read = read(input, &calls, asked, output);
        drop(calls);
        let worked = worker.join();
        read.and(worked.unwrap_or(Ok(())))
    })
}

/// A stream of answers that both threads write to.
type Output<'a> = Mutex<&'a mut (dyn Write + Send)>;

/// A tool that was called.
struct Call {
    id: Value,
    params: Map<String, Value>,
    cancelled: Arc<AtomicBool>,
    /// The line of several messages that it is of.
    batch: Option<Arc<Batch>>,
}

/// The calls without an answer yet, by the text of their id.
#[derive(Default)]
struct Asked(Mutex<BTreeMap<String, Arc<AtomicBool>>>);

impl Asked {
    fn with<T>(&self, work: impl FnOnce(&mut BTreeMap<String, Arc<AtomicBool>>) -> T) -> T {
        work(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner))
    }
}

fn write(output: &Output<'_>, answer: &Value) -> std::io::Result<()> {
    let mut output = output.lock().unwrap_or_else(PoisonError::into_inner);
    writeln!(output, "{answer}")?;
    output.flush()
}

/// Reads messages: puts calls of tools into the queue, and answers the others.
fn read(
    input: &mut dyn BufRead,
    calls: &mpsc::Sender<Call>,
    asked: &Asked,
    output: &Output<'_>,
) -> std::io::Result<()> {
    let mut batches = false;
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
            Ok(Value::Array(messages)) if batches && !messages.is_empty() => {
                answers(&messages, asked, calls)
            }
            Ok(message) => {
                let reply = reply(&message, asked, calls, None);
                if let Reply::Now(Some(answer)) = &reply
                    && let Some(version) = answer["result"]["protocolVersion"].as_str()
                {
                    batches = version == WITH_BATCHES;
                }
                reply.now()
            }
            Err(error) => Some(failed(&Value::Null, (PARSE, error.to_string()))),
        };
        if let Some(answer) = answer {
            write(output, &answer)?;
        }
    }
}

/// The answers to the messages of a line, unless tools must be waited for.
fn answers(messages: &[Value], asked: &Asked, calls: &mpsc::Sender<Call>) -> Option<Value> {
    let batch = Arc::new(Batch::of(messages.len()));
    let each =
        messages
            .iter()
            .filter_map(|message| match reply(message, asked, calls, Some(&batch)) {
                Reply::Now(answer) => batch.take(answer),
                Reply::Later => None,
            });
    each.last()
}

/// Runs the tools that were called. A call that the client has cancelled has no answer.
fn work(
    waiting: mpsc::Receiver<Call>,
    asked: &Asked,
    output: &Output<'_>,
    host: &(dyn Host + Sync),
) -> std::io::Result<()> {
    for (number, call) in (1..).zip(waiting) {
        let Call {
            id,
            params,
            cancelled,
            batch,
        } = call;
        let is_cancelled = || cancelled.load(Ordering::Relaxed);
        let result = match is_cancelled() {
            true => None,
            false => Some(called(&params, host, number, &cancelled)),
        };
        asked.with(|known| known.remove(&id.to_string()));
        let result = result.filter(|_| !is_cancelled());
        let answer = result.map(|result| answered(&id, result));
        let answer = match batch {
            Some(batch) => batch.take(answer),
            None => answer,
        };
        if let Some(answer) = answer {
            write(output, &answer)?;
        }
    }
    Ok(())
}

/// The answer to a message.
enum Reply {
    /// An answer; a notification has none.
    Now(Option<Value>),
    /// A tool was called: its answer follows.
    Later,
}

impl Reply {
    /// What is written at once.
    fn now(self) -> Option<Value> {
        match self {
            Self::Now(answer) => answer,
            Self::Later => None,
        }
    }
}

/// The answer to a message, which may be one of several in its line.
fn reply(
    message: &Value,
    asked: &Asked,
    calls: &mpsc::Sender<Call>,
    batch: Option<&Arc<Batch>>,
) -> Reply {
    let Some(request) = message.as_object() else {
        let fault = format!(
            "a message is one JSON object a line; only version {WITH_BATCHES} of the protocol has several in a line"
        );
        return Reply::Now(Some(failed(&Value::Null, (INVALID_REQUEST, fault))));
    };
    let empty = Map::new();
    let params = request.get("params").and_then(Value::as_object);
    let params = params.unwrap_or(&empty);
    let Some(id) = request.get("id") else {
        // An answer to a request that this server never makes, or a notification.
        if request.get("method").and_then(Value::as_str) == Some("notifications/cancelled")
            && let Some(id) = params.get("requestId")
        {
            asked.with(|known| {
                let call = known.get(&id.to_string());
                call.inspect(|call| call.store(true, Ordering::Relaxed));
            });
        }
        return Reply::Now(None);
    };
    let Some(method) = request.get("method").and_then(Value::as_str) else {
        let fault = "a request has a `method`".to_owned();
        return Reply::Now(Some(failed(id, (INVALID_REQUEST, fault))));
    };
    let result = match method {
        "initialize" => Ok(initialized(params)),
        "ping" => Ok(json!({})),
        "tools/list" => Ok(json!({ "tools": listed() })),
        "tools/call" => {
            let cancelled = Arc::<AtomicBool>::default();
            asked.with(|known| known.insert(id.to_string(), Arc::clone(&cancelled)));
            let call = Call {
                id: id.clone(),
                params: params.clone(),
                cancelled,
                batch: batch.cloned(),
            };
            // There is a worker as long as answers can be written.
            let _sent = calls.send(call);
            return Reply::Later;
        }
        other => Err((NO_METHOD, format!("no method `{other}`"))),
    };
    Reply::Now(Some(answered(id, result)))
}

fn answered(id: &Value, result: Result<Value, Fault>) -> Value {
    match result {
        Ok(result) => json!({ "jsonrpc": "2.0", "id": id, "result": result }),
        Err(fault) => failed(id, fault),
    }
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

fn called(
    params: &Map<String, Value>,
    host: &dyn Host,
    number: usize,
    cancelled: &AtomicBool,
) -> Result<Value, Fault> {
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
        given.insert("out".to_owned(), json!(host.folder(number)));
    }
    let out = given.get("out").and_then(Value::as_str).map(str::to_owned);
    let line = match tool.command(&given) {
        Ok(line) => line,
        // The caller can mend it: an answer, not an error of the protocol.
        Err(reason) => return Ok(told(&reason, true)),
    };
    let ran = match host.run(&line, cancelled) {
        Ok(ran) => ran,
        Err(reason) => return Ok(told(&reason, true)),
    };
    Ok(summary(
        tool,
        &ran,
        out.unwrap_or_else(|| host.folder(number)),
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
