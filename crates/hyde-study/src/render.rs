//! Diagnostics as text, with the source underlined, or as JSON.

use annotate_snippets::{AnnotationKind, Group, Level, Renderer, Snippet};
use hyde_diag::{Diagnostic, Diagnostics, Severity, Sources};
use serde_json::{Value, json};

/// Width of rendered diagnostics.
const WIDTH: usize = 100;

/// Every diagnostic as text, errors and warnings in the order found, then how many there were.
#[must_use]
pub fn render(diagnostics: &Diagnostics, sources: &Sources, styled: bool) -> String {
    let renderer = if styled {
        Renderer::styled()
    } else {
        Renderer::plain()
    }
    .term_width(WIDTH);
    let mut text = String::new();
    for diagnostic in diagnostics.iter() {
        let groups = groups(diagnostic, sources);
        text.push_str(&renderer.render(&groups));
        text.push_str("\n\n");
    }
    text
}

/// Every diagnostic as a JSON array.
#[must_use]
pub fn to_json(diagnostics: &Diagnostics, sources: &Sources) -> Value {
    diagnostics
        .iter()
        .map(|diagnostic| {
            let labels: Vec<Value> = diagnostic
                .labels
                .iter()
                .map(|label| {
                    let source = sources.get(label.span.file);
                    let (line, column) = source.line_column(label.span.start);
                    let (end_line, end_column) = source.line_column(label.span.end);
                    json!({
                        "file": source.name, "line": line, "column": column,
                        "end_line": end_line, "end_column": end_column, "text": label.text,
                    })
                })
                .collect();
            json!({
                "code": diagnostic.code.as_str(),
                "severity": if diagnostic.severity == Severity::Error { "error" } else { "warning" },
                "message": diagnostic.message,
                "labels": labels,
                "notes": diagnostic.notes,
                "help": diagnostic.help,
            })
        })
        .collect()
}

fn groups<'a>(diagnostic: &'a Diagnostic, sources: &'a Sources) -> Vec<Group<'a>> {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let title = level
        .primary_title(diagnostic.message.as_str())
        .id(diagnostic.code.as_str());
    let mut group = Group::with_title(title);
    let mut files: Vec<hyde_diag::FileId> = Vec::new();
    for label in &diagnostic.labels {
        if !files.contains(&label.span.file) {
            files.push(label.span.file);
        }
    }
    for file in files {
        let source = sources.get(file);
        let mut snippet = Snippet::source(source.text.as_str()).path(source.name.as_str());
        for (number, label) in diagnostic.labels.iter().enumerate() {
            if label.span.file != file {
                continue;
            }
            let kind = if number == 0 {
                AnnotationKind::Primary
            } else {
                AnnotationKind::Context
            };
            let end = (label.span.end as usize).min(source.text.len());
            let start = (label.span.start as usize).min(end);
            snippet = snippet.annotation(kind.span(start..end).label(label.text.as_str()));
        }
        group = group.element(snippet);
    }
    for note in &diagnostic.notes {
        group = group.element(Level::NOTE.message(note.as_str()));
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    vec![group]
}
