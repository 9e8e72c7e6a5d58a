//! Diagnostics as the protocol shows them.

use crate::position::Encoding;
use crate::uri;
use hyde_diag::{Diagnostic, FileId, Severity, Sources};
use lsp_types::{DiagnosticRelatedInformation, DiagnosticSeverity, Location, NumberOrString};
use std::path::Path;

/// A diagnostic of a file among the sources. One whose place is in another file is shown where this file takes part in it, or
/// at its beginning.
pub(crate) fn published(
    diagnostic: &Diagnostic,
    sources: &Sources,
    own: Option<FileId>,
    encoding: Encoding,
) -> lsp_types::Diagnostic {
    let text = own.map_or("", |own| sources.get(own).text.as_str());
    let shown = diagnostic
        .labels
        .iter()
        .position(|label| Some(label.span.file) == own);
    let range = shown.and_then(|at| diagnostic.labels.get(at));
    let range = range.map_or_else(
        || encoding.range(text, 0..0),
        |label| encoding.range(text, label.span.start as usize..label.span.end as usize),
    );
    let mut message = diagnostic.message.clone();
    if let Some(label) = shown.and_then(|at| diagnostic.labels.get(at))
        && !label.text.is_empty()
    {
        message.push_str(&format!("\n{}", label.text));
    }
    for note in &diagnostic.notes {
        message.push_str(&format!("\nnote: {note}"));
    }
    if let Some(help) = &diagnostic.help {
        message.push_str(&format!("\nhelp: {help}"));
    }
    let others = diagnostic.labels.iter().enumerate();
    let others = others.filter(|(at, _)| Some(*at) != shown);
    let related: Vec<DiagnosticRelatedInformation> = others
        .filter_map(|(_, label)| {
            let source = sources.get(label.span.file);
            let bytes = label.span.start as usize..label.span.end as usize;
            let location = Location::new(
                uri::of(Path::new(&source.name))?,
                encoding.range(&source.text, bytes),
            );
            let message = label.text.clone();
            Some(DiagnosticRelatedInformation { location, message })
        })
        .collect();
    lsp_types::Diagnostic {
        range,
        severity: Some(match diagnostic.severity {
            Severity::Error => DiagnosticSeverity::ERROR,
            Severity::Warning => DiagnosticSeverity::WARNING,
        }),
        code: Some(NumberOrString::String(diagnostic.code.as_str().to_owned())),
        source: Some("hyde".to_owned()),
        message,
        related_information: (!related.is_empty()).then_some(related),
        data: diagnostic.help.clone().map(serde_json::Value::String),
        ..lsp_types::Diagnostic::default()
    }
}
