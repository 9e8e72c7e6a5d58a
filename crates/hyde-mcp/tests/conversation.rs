//! A scripted client: the handshake, the list of tools, calls, mistakes.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]

use hyde_mcp::{Host, Ran, serve};
use serde_json::{Value, json};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// A machine that remembers what it was asked.
#[derive(Default)]
struct Recording {
    ran: Mutex<Vec<Vec<String>>>,
    written: Mutex<Vec<String>>,
    answer: Ran,
}

impl Host for Recording {
    fn run(&self, arguments: &[String], _: &AtomicBool) -> Result<Ran, String> {
        self.ran.lock().unwrap().push(arguments.to_vec());
        Ok(self.answer.clone())
    }

    fn write(&self, folder: &str, name: &str, text: &str) -> Result<String, String> {
        self.written.lock().unwrap().push(text.to_owned());
        Ok(format!("{folder}/{name}"))
    }

    fn folder(&self, call: usize) -> String {
        match call {
            1 => "somewhere".to_owned(),
            _ => format!("somewhere_{call}"),
        }
    }
}

/// The answers in the order of their ids, those without one first: calls of tools are answered later than others.
fn talk(host: &(dyn Host + Sync), lines: &[&str]) -> Vec<Value> {
    let mut output = Vec::new();
    serve(&mut lines.join("\n").as_bytes(), &mut output, host).unwrap();
    let text = String::from_utf8(output).unwrap();
    let answers = text.lines();
    let mut answers: Vec<Value> = answers
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    answers.sort_by_key(|answer| answer["id"].as_i64());
    answers
}

/// A machine whose commands run until they are cancelled.
struct Endless(Mutex<Vec<String>>);

impl Host for Endless {
    fn run(&self, arguments: &[String], cancelled: &AtomicBool) -> Result<Ran, String> {
        self.0.lock().unwrap().extend(arguments.last().cloned());
        while !cancelled.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(1));
        }
        Ok(Ran::default())
    }

    fn write(&self, _: &str, _: &str, _: &str) -> Result<String, String> {
        Err("nothing is written".to_owned())
    }

    fn folder(&self, _: usize) -> String {
        "somewhere".to_owned()
    }
}

#[test]
fn a_call_that_is_cancelled_ends_and_has_no_answer() {
    let host = Endless(Mutex::default());
    let call = |id: &str, file: &str| {
        format!(
            r#"{{"jsonrpc":"2.0","id":{id},"method":"tools/call","params":{{"name":"run","arguments":{{"file":"{file}"}}}}}}"#
        )
    };
    let cancel = |id: &str| {
        format!(
            r#"{{"jsonrpc":"2.0","method":"notifications/cancelled","params":{{"requestId":{id}}}}}"#
        )
    };
    let answers = talk(
        &host,
        &[
            &call("1", "first.hyde"),
            &call("\"two\"", "second.hyde"),
            r#"{"jsonrpc":"2.0","id":3,"method":"ping"}"#,
            &cancel("9"),
            &cancel("\"two\""),
            &cancel("1"),
        ],
    );
    assert_eq!(answers.len(), 1, "{answers:?}");
    assert_eq!(answers[0]["id"], 3);
    // The one that waited was not begun; the other may have been cancelled before it was.
    let ran = host.0.lock().unwrap();
    assert!(ran.iter().all(|file| file == "first.hyde"), "{ran:?}");
}

#[test]
fn a_client_and_the_server_agree_on_a_version() {
    let asked = |version: &str| {
        let message = json!({
            "jsonrpc": "2.0", "id": 1, "method": "initialize",
            "params": { "protocolVersion": version, "capabilities": {}, "clientInfo": { "name": "test", "version": "1" } },
        });
        let done = r#"{"jsonrpc":"2.0","method":"notifications/initialized"}"#;
        let answers = talk(&Recording::default(), &[&message.to_string(), done]);
        assert_eq!(answers.len(), 1, "a notification has no answer");
        answers[0]["result"].clone()
    };
    assert_eq!(asked("2025-06-18")["protocolVersion"], "2025-06-18");
    assert_eq!(asked("1999-01-01")["protocolVersion"], "2025-11-25");
    assert!(asked("2025-11-25")["capabilities"]["tools"].is_object());
    assert_eq!(asked("2025-11-25")["serverInfo"]["name"], "hyde");
}

#[test]
fn tools_are_listed_with_schemas() {
    let answers = talk(
        &Recording::default(),
        &[r#"{"jsonrpc":"2.0","id":"a","method":"tools/list"}"#],
    );
    assert_eq!(answers[0]["id"], "a");
    let tools = answers[0]["result"]["tools"].as_array().unwrap();
    let names: Vec<&str> = tools
        .iter()
        .map(|tool| tool["name"].as_str().unwrap())
        .collect();
    for name in [
        "check",
        "run",
        "modes",
        "bode",
        "fit",
        "diagnose",
        "look",
        "explain",
        "components",
    ] {
        assert!(names.contains(&name), "{name}");
    }
    for tool in tools {
        assert_eq!(tool["inputSchema"]["type"], "object");
        assert!(tool["description"].as_str().unwrap().len() > 20);
    }
    assert_eq!(tools[1]["inputSchema"]["required"], json!(["file"]));
}

/// A host whose commands answer with 500 samples.
fn with_samples() -> Recording {
    let samples: Vec<f64> = (0..500).map(f64::from).collect();
    Recording {
        answer: Ran {
            stdout: json!({ "ok": true, "x": samples }).to_string(),
            ..Ran::default()
        },
        ..Recording::default()
    }
}

#[test]
fn samples_stay_on_the_disk() {
    let host = with_samples();
    let call = json!({
        "jsonrpc": "2.0", "id": 7, "method": "tools/call",
        "params": { "name": "run", "arguments": { "file": "a.hyde" } },
    });
    let answers = talk(&host, &[&call.to_string()]);
    let result = &answers[0]["result"];
    assert_eq!(result["isError"], false);
    let text = result["content"][0]["text"].as_str().unwrap();
    let told: Value = serde_json::from_str(text).unwrap();
    assert_eq!(
        told["x"],
        json!({ "numbers": 500, "least": 0.0, "most": 499.0 })
    );
    assert_eq!(told["complete_answer"], "somewhere/run.json");
    assert!(host.written.lock().unwrap()[0].contains("499.0"));
    let line = ["run", "--out=somewhere", "--json", "--", "a.hyde"];
    assert_eq!(host.ran.lock().unwrap()[0], line);
}

#[test]
fn a_second_call_leaves_the_files_of_the_first() {
    let host = with_samples();
    let call = |id: u8, tool: &str| {
        json!({
            "jsonrpc": "2.0", "id": id, "method": "tools/call",
            "params": { "name": tool, "arguments": { "file": "a.hyde" } },
        })
        .to_string()
    };
    let answers = talk(
        &host,
        &[&call(1, "run"), &call(2, "run"), &call(3, "modes")],
    );
    let paths: Vec<Value> = answers
        .iter()
        .map(|own| {
            let text = own["result"]["content"][0]["text"].as_str().unwrap();
            serde_json::from_str::<Value>(text).unwrap()["complete_answer"].clone()
        })
        .collect();
    let expected = [
        "somewhere/run.json",
        "somewhere_2/run.json",
        "somewhere_3/modes.json",
    ];
    assert_eq!(paths, expected);
    assert_eq!(host.ran.lock().unwrap()[1][1], "--out=somewhere_2");
}

#[test]
fn several_messages_in_a_line_have_one_list_of_answers() {
    let line = json!([
        { "jsonrpc": "2.0", "id": 1, "method": "tools/call", "params": { "name": "explain", "arguments": {} } },
        { "jsonrpc": "2.0", "method": "notifications/initialized" },
        { "jsonrpc": "2.0", "id": 2, "method": "ping" },
        1,
    ])
    .to_string();
    let begin = |version: &str| {
        json!({ "jsonrpc": "2.0", "id": 0, "method": "initialize", "params": { "protocolVersion": version } })
            .to_string()
    };
    let host = Recording::default();
    let answers = talk(&host, &[&begin("2025-03-26"), &line, "[]"]);
    let list = answers.iter().find_map(Value::as_array).unwrap();
    let mut ids: Vec<Option<u64>> = list.iter().map(|own| own["id"].as_u64()).collect();
    ids.sort_unstable();
    assert_eq!(ids, [None, Some(1), Some(2)]);
    assert!(
        answers.iter().any(|own| own["error"]["code"] == -32600),
        "{answers:?}"
    );
    assert_eq!(answers.len(), 3);
    // Later versions have none.
    let answers = talk(&host, &[&begin("2025-06-18"), &line]);
    assert!(answers.iter().all(Value::is_object), "{answers:?}");
    let fault = answers.iter().find(|own| own["error"]["code"] == -32600);
    let said = fault.unwrap()["error"]["message"].as_str().unwrap();
    assert!(said.contains("2025-03-26"), "{said}");
}

#[test]
fn mistakes_are_answered() {
    let answers = talk(
        &Recording::default(),
        &[
            "no json",
            "[1]",
            "",
            r#"{"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":"format_disk"}}"#,
            r#"{"jsonrpc":"2.0","id":2,"method":"tools/call","params":{"name":"run","arguments":{}}}"#,
            r#"{"jsonrpc":"2.0","id":3,"method":"resources/list"}"#,
            r#"{"jsonrpc":"2.0","id":4,"method":"ping"}"#,
        ],
    );
    let codes: Vec<&Value> = answers.iter().map(|own| &own["error"]["code"]).collect();
    assert_eq!(
        codes,
        [
            &json!(-32700),
            &json!(-32600),
            &json!(-32602),
            &Value::Null,
            &json!(-32601),
            &Value::Null
        ]
    );
    // The caller can mend its arguments: that is an answer of the tool.
    assert_eq!(answers[3]["result"]["isError"], true);
    assert_eq!(answers[5]["result"], json!({}));
}

#[test]
fn the_library_is_listed() {
    let call = r#"{"jsonrpc":"2.0","id":1,"method":"tools/call","params":{"name":"components","arguments":{"containing":"backlash"}}}"#;
    let answers = talk(&Recording::default(), &[call]);
    let text = answers[0]["result"]["content"][0]["text"].as_str().unwrap();
    let told: Value = serde_json::from_str(text).unwrap();
    let found = told["components"].as_array().unwrap();
    assert!(
        found
            .iter()
            .any(|own| own["name"].as_str().unwrap().contains("Backlash")),
        "{text}"
    );
    assert!(found.len() < 40, "{}", found.len());
}
