//! `hyde lsp` with Neovim as the editor. `./dev setup` installs it; without it the test says so and looks at nothing.

use crate::command::{Folder, command, errors, status, text};
use serde_json::Value;
use std::io::Write as _;
use std::process::{Command, Stdio};

/// Opens a file, waits for its diagnostics, asks for a hover, a definition, completions and the layout, and prints all as
/// JSON.
const SCRIPT: &str = r#"
local file, server = vim.env.HYDE_FILE, vim.env.HYDE_COMMAND
vim.cmd("edit " .. vim.fn.fnameescape(file))
local client = vim.lsp.start_client({ name = "hyde", cmd = { server, "lsp" }, root_dir = vim.fn.fnamemodify(file, ":h") })
vim.lsp.buf_attach_client(0, client)
local out = {}
vim.wait(60000, function() return #vim.diagnostic.get(0) > 0 end, 20)
for _, own in ipairs(vim.diagnostic.get(0)) do
  table.insert(out, { code = own.code, line = own.lnum, message = own.message })
end
local function ask(method, line, column)
  vim.api.nvim_win_set_cursor(0, { line, column })
  local params = vim.lsp.util.make_position_params(0, "utf-16")
  params.options = { tabSize = 2, insertSpaces = true }
  local found = vim.lsp.buf_request_sync(0, method, params, 60000)
  return found and found[client] and found[client].result or vim.NIL
end
local result = {
  diagnostics = out,
  hover = ask("textDocument/hover", 5, 22),
  definition = ask("textDocument/definition", 5, 22),
  completion = ask("textDocument/completion", 5, 22),
  formatting = ask("textDocument/formatting", 1, 0),
  signature = ask("textDocument/signatureHelp", 5, 21),
}
-- The lens over an experiment: its page is named, as this editor shows no documents.
local shown = nil
vim.lsp.handlers["window/showMessage"] = function(_, params) shown = params.message end
vim.lsp.handlers["window/showDocument"] = function(_, params)
  shown = params.uri
  return { success = true }
end
vim.cmd("edit " .. vim.fn.fnameescape(vim.env.HYDE_EXPERIMENT))
vim.lsp.buf_attach_client(0, client)
local lenses = ask("textDocument/codeLens", 1, 0)
result.lenses = lenses
result.hints = vim.lsp.buf_request_sync(0, "textDocument/inlayHint", {
  textDocument = vim.lsp.util.make_text_document_params(0),
  range = { start = { line = 0, character = 0 }, ["end"] = { line = 99, character = 0 } },
}, 60000)[client].result
local command = lenses[1].command
vim.lsp.buf_request_sync(0, "workspace/executeCommand", { command = command.command, arguments = command.arguments }, 60000)
vim.wait(60000, function() return shown ~= nil end, 20)
result.shown = shown
result.value = ask("textDocument/hover", 5, 7)
result.lensesAfter = ask("textDocument/codeLens", 1, 0)
-- A run that fails marks the equation.
vim.cmd("edit " .. vim.fn.fnameescape(vim.env.HYDE_FAILING))
vim.lsp.buf_attach_client(0, client)
shown = nil
command = ask("textDocument/codeLens", 1, 0)[1].command
vim.lsp.buf_request_sync(0, "workspace/executeCommand", { command = command.command, arguments = command.arguments }, 60000)
vim.wait(60000, function() return shown ~= nil and #vim.diagnostic.get(0) > 0 end, 20)
result.failure = vim.diagnostic.get(0)[1]
io.stdout:write(vim.json and vim.json.encode(result) or vim.fn.json_encode(result))
io.stdout:flush()
vim.cmd("qa!")
"#;

const MODEL: &str = "package pushed;\nimport SI.*;\nmodel Pushed\n  parameter Force F0 = 3 [N] \"that pushes\";\n  Real twice = abs(2*F0);\n  Length s = 1 [kg];\nend Pushed;\n";

const EXPERIMENT: &str = "package coasting;\nimport SI.*;\nmodel Coasting\n  parameter Real k = 2*3 [1/s];\n  Real x(start = 1);\nequation\n  der(x) = -k*x;\nend Coasting;\nexperiment rest of Coasting\n  solve ida(rtol = 1e-6) stop 1 [s] every 10 [ms];\nend rest;\n";

/// It falls, and is not to: its speed is the square root of what is left.
const FAILING: &str = "package falling;\nimport SI.*;\nmodel Falling\n  Real x(start = 1, fixed = true);\nequation\n  der(x) = -2 [1/s]*sqrt(x - 0.5);\n  assert(x > 0.8, \"it fell too far\");\nend Falling;\nexperiment fall of Falling\n  solve ida(rtol = 1e-6) stop 1 [s] every 10 [ms];\nend fall;\n";

/// The status of the server, and what it says to some messages.
fn session(messages: &[&str]) -> (i32, String) {
    let mut child = command(&["lsp"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = child.stdin.take().unwrap();
    for message in messages {
        write!(input, "Content-Length: {}\r\n\r\n{message}", message.len()).unwrap();
    }
    drop(input);
    let output = child.wait_with_output().unwrap();
    (status(&output), text(&output))
}

#[test]
fn what_is_no_message_is_answered_and_an_exit_alone_is_an_error() {
    let begin = r#"{"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}}"#;
    let begun = r#"{"jsonrpc":"2.0","method":"initialized","params":{}}"#;
    let shutdown = r#"{"jsonrpc":"2.0","id":2,"method":"shutdown"}"#;
    let late = r#"{"jsonrpc":"2.0","id":3,"method":"textDocument/hover"}"#;
    let exit = r#"{"jsonrpc":"2.0","method":"exit"}"#;
    let (ended, said) = session(&[begin, begun, "{\"id\": ", "[]", shutdown, late, exit]);
    assert_eq!(ended, 0, "{said}");
    assert!(said.contains("-32700"), "{said}");
    assert_eq!(said.matches("-32600").count(), 2, "{said}");
    assert_eq!(session(&[begin, begun, exit]).0, 1);
}

#[test]
fn neovim_shows_what_the_server_says() {
    if Command::new("nvim").arg("--version").output().is_err() {
        let mut log = std::io::stderr();
        writeln!(
            log,
            "skipped: Neovim is not installed; `./dev setup` does it"
        )
        .unwrap();
        return;
    }
    let folder = Folder::new();
    let file = folder.file("pushed.hyde", MODEL);
    let script = folder.file("ask.lua", SCRIPT);
    let server = command(&[]).get_program().to_owned();
    let output = Command::new("nvim")
        .args(["--clean", "--headless", "-i", "NONE", "-n", "-c"])
        .arg(format!("luafile {script}"))
        .env("HYDE_FILE", &file)
        .env("HYDE_EXPERIMENT", folder.file("coasting.hyde", EXPERIMENT))
        .env("HYDE_FAILING", folder.file("falling.hyde", FAILING))
        .env("HYDE_COMMAND", server)
        .env("XDG_STATE_HOME", folder.path("state"))
        .env("XDG_CACHE_HOME", folder.path("cache"))
        .stdin(Stdio::null())
        .output()
        .unwrap();
    let said = text(&output);
    let answer: Value = serde_json::from_str(&said)
        .unwrap_or_else(|error| panic!("{error}:\n{said}\n{}", errors(&output)));
    let codes: Vec<&str> = answer["diagnostics"]
        .as_array()
        .unwrap()
        .iter()
        .filter_map(|own| own["code"].as_str())
        .collect();
    assert!(codes.contains(&"E0301"), "{answer}");
    let hover = answer["hover"]["contents"]["value"].as_str().unwrap();
    assert!(
        hover.contains("parameter Force F0 = 3 [N]") && hover.contains("that pushes"),
        "{hover}"
    );
    assert_eq!(answer["definition"]["range"]["start"]["line"], 3);
    let labels = answer["completion"].as_array().unwrap();
    assert!(labels.iter().any(|own| own["label"] == "F0"), "{labels:?}");
    assert_eq!(answer["formatting"].as_array().map(Vec::len), Some(0));
    assert_eq!(answer["signature"]["signatures"][0]["label"], "abs(x)");
    assert_eq!(answer["lenses"][0]["command"]["title"], "Run");
    assert_eq!(answer["hints"][0]["label"], "[1/s]");
    let page = answer["shown"].as_str().unwrap();
    let at = page.find('/').unwrap();
    let html = std::fs::read_to_string(page[at..].trim_start_matches("//")).unwrap();
    assert!(html.contains("rest"), "{page}");
    // x = exp(-6 t): 0.00248 at 1 s.
    let value = answer["value"]["contents"]["value"].as_str().unwrap();
    assert!(
        value.contains("run `rest` at 1 s, its end:") && value.contains("`x` = 0.002479"),
        "{value}"
    );
    assert!(
        value.contains("from 0.002479") && value.contains("to 1  \n`█"),
        "{value}"
    );
    let lenses = answer["lensesAfter"].to_string();
    assert!(lenses.contains("Values at 1 s"), "{lenses}");
    let failure = &answer["failure"];
    assert_eq!(
        (&failure["code"], &failure["lnum"]),
        (&"E0704".into(), &6.into()),
        "{failure}"
    );
    assert!(
        failure["message"].as_str().unwrap().contains("`x` is 0.8"),
        "{failure}"
    );
}

#[test]
fn a_session_ends_with_success_and_an_editor_that_is_gone_ends_it_too() {
    let message = |body: &str| format!("Content-Length: {}\r\n\r\n{body}", body.len());
    let begin =
        message(r#"{"jsonrpc":"2.0","id":1,"method":"initialize","params":{"capabilities":{}}}"#)
            + &message(r#"{"jsonrpc":"2.0","method":"initialized","params":{}}"#);
    let end = message(r#"{"jsonrpc":"2.0","id":2,"method":"shutdown"}"#)
        + &message(r#"{"jsonrpc":"2.0","method":"exit"}"#);
    for (input, success) in [(format!("{begin}{end}"), true), (begin, false)] {
        let mut child = command(&["lsp", "--stdio"])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        child
            .stdin
            .take()
            .unwrap()
            .write_all(input.as_bytes())
            .unwrap();
        let output = child.wait_with_output().unwrap();
        assert!(output.status.code().is_some(), "it ends");
        assert!(
            text(&output).contains("\"hoverProvider\":true"),
            "{}",
            text(&output)
        );
        if success {
            assert_eq!(output.status.code(), Some(0), "{}", errors(&output));
        }
    }
}
