//! `lsp_syntax_ms`, `lsp_full_ms`, `lsp_completion_ms`, `lsp_hover_ms`, `lsp_memory_ratio`: what an editor waits for, on the Y
//! axis with every package of the library loaded.

use super::clock::now;
use super::promise::{Figure, Measured, Promise, Session};
use crate::editor::Editor;
use crate::root;
use hyde_editor::PAUSE;
use hyde_syntax::ast::Item;
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Instant;

pub(super) const SYNTAX: Figure = Figure {
    name: "lsp_syntax_ms",
    unit: "ms",
    promise: Promise::AtMost(5.0),
    measure: |session| measured(session, |all| all.syntax),
};

/// From the end of the pause after the last key.
pub(super) const FULL: Figure = Figure {
    name: "lsp_full_ms",
    unit: "ms",
    promise: Promise::AtMost(60.0),
    measure: |session| measured(session, |all| all.full),
};

pub(super) const COMPLETION: Figure = Figure {
    name: "lsp_completion_ms",
    unit: "ms",
    promise: Promise::AtMost(10.0),
    measure: |session| measured(session, |all| all.completion),
};

pub(super) const HOVER: Figure = Figure {
    name: "lsp_hover_ms",
    unit: "ms",
    promise: Promise::AtMost(10.0),
    measure: |session| measured(session, |all| all.hover),
};

/// The memory after 10 000 keys over that after 100.
pub(super) const MEMORY: Figure = Figure {
    name: "lsp_memory_ratio",
    unit: "ratio",
    promise: Promise::AtMost(1.5),
    measure: |_| memory(),
};

/// Medians in ms.
#[derive(Clone, Debug)]
pub(crate) struct Waits {
    syntax: f64,
    full: f64,
    completion: f64,
    hover: f64,
}

/// How often each is measured.
const ROUNDS: usize = 21;

fn measured(session: &Session, of: fn(&Waits) -> f64) -> Result<Measured, String> {
    let all = session.waits.get_or_init(waits).as_ref();
    Ok(Measured::Value(of(all.map_err(Clone::clone)?)))
}

/// Y axis, with every package of the library imported by an item whose name it does not use.
fn text() -> Result<(PathBuf, String), String> {
    let path = root().join("examples/y_axis/axis.hyde");
    let text = hyde_study::world::read_text(&hyde_study::world::Disk, &path)?;
    let mut imports = String::new();
    for package in hyde_library::PACKAGES {
        let mut sources = hyde_diag::Sources::new();
        let id = sources.add(package.name, package.text);
        let tree = hyde_syntax::parse(&sources, id, &mut hyde_diag::Diagnostics::new());
        let names = tree.items.iter().filter_map(|item| match item {
            Item::Class(class) => Some(&class.name.text),
            Item::Type(_) | Item::Experiment(_) | Item::Study(_) => None,
        });
        let mut names = names.rev();
        let unused = names.find(|name| !text.contains(name.as_str()));
        if let Some(name) = unused {
            imports.push_str(&format!("import {}.{name};\n", package.name));
        }
    }
    let text = text.replacen("import SI.*;\n", &format!("import SI.*;\n{imports}"), 1);
    Ok((path, text))
}

/// The server is this program.
fn editor() -> Result<(Editor, String), String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let (path, text) = text()?;
    let mut editor = Editor::open(&own, &path, &text)?;
    editor.diagnostics()?;
    let wrong = editor.diagnostics()?;
    match wrong.as_slice() {
        [] => Ok((editor, text)),
        [first, ..] => Err(format!("the Y axis is not in order: {first}")),
    }
}

/// Line and column of the end of a word of the text.
fn behind(text: &str, word: &str) -> Result<(usize, usize), String> {
    let at = text.find(word).ok_or_else(|| format!("no `{word}`"))? + word.len();
    let line = text[..at].matches('\n').count();
    let start = text[..at].rfind('\n').map_or(0, |at| at + 1);
    Ok((line, at - start))
}

/// A key: a digit behind a number, or that digit taken away again.
fn key(text: &str, round: usize) -> Result<Value, String> {
    let (line, column) = behind(text, "J = 0.0100")?;
    let from = json!({ "line": line, "character": column });
    let to = json!({ "line": line, "character": column + round % 2 });
    let new = if round.is_multiple_of(2) { "1" } else { "" };
    Ok(json!([{ "range": { "start": from, "end": to }, "text": new }]))
}

fn waits() -> Result<Waits, String> {
    let (mut editor, text) = editor()?;
    let (mut syntax, mut full, mut completion, mut hover) = (vec![], vec![], vec![], vec![]);
    let member = behind(&text, "r = r, V7 = saddle.")?;
    let operator = behind(&text, "tacho.K_ta*belt.zb")?;
    for round in 0..ROUNDS {
        let start = now();
        editor.change(key(&text, round)?)?;
        editor.diagnostics()?;
        syntax.push(milliseconds(start));
        editor.diagnostics()?;
        full.push(milliseconds(start) - PAUSE.as_secs_f64() * 1e3);
    }
    for round in 0..2 * ROUNDS {
        editor.change(key(&text, round + ROUNDS)?)?;
        editor.diagnostics()?;
        // Nothing of the text before the key is of use.
        let start = now();
        let (method, at) = match round < ROUNDS {
            true => ("textDocument/completion", member),
            false => ("textDocument/hover", operator),
        };
        let answer = editor.at(method, at)?;
        let list = if round < ROUNDS {
            &mut completion
        } else {
            &mut hover
        };
        list.push(milliseconds(start));
        if answer["result"].is_null() {
            return Err(format!("no answer to {method}: {answer}"));
        }
        editor.diagnostics()?;
    }
    Ok(Waits {
        syntax: median(syntax),
        full: median(full),
        completion: median(completion),
        hover: median(hover),
    })
}

fn memory() -> Result<Measured, String> {
    let (mut editor, text) = editor()?;
    let operator = behind(&text, "tacho.K_ta*belt.zb")?;
    let mut early = f64::NAN;
    for round in 0..10_000 {
        editor.change(key(&text, round)?)?;
        // Now and then somebody looks.
        if round.is_multiple_of(50) {
            editor.at("textDocument/hover", operator)?;
        }
        if round == 99 {
            early = editor.memory_kb()?;
        }
    }
    editor.at("textDocument/hover", operator)?;
    Ok(Measured::Value(editor.memory_kb()? / early))
}

fn median(mut list: Vec<f64>) -> f64 {
    list.sort_by(f64::total_cmp);
    list[list.len() / 2]
}

fn milliseconds(start: Instant) -> f64 {
    start.elapsed().as_secs_f64() * 1e3
}
