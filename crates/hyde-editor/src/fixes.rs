//! Repairs of diagnostics whose advice says exactly what to write.

use crate::position::Encoding;
use lsp_types::{CodeAction, CodeActionKind, Diagnostic, TextEdit, Uri, WorkspaceEdit};
use std::ops::Range;

/// The repairs of a diagnostic that the server published for a text.
#[allow(
    clippy::mutable_key_type,
    reason = "the protocol's types have addresses as keys"
)]
pub(crate) fn fixes(
    diagnostic: &Diagnostic,
    text: &str,
    uri: &Uri,
    encoding: Encoding,
) -> Vec<CodeAction> {
    let start = encoding.byte(text, diagnostic.range.start);
    let end = encoding.byte(text, diagnostic.range.end).max(start);
    let help = diagnostic.data.as_ref().and_then(|data| data.as_str());
    let edits = edits(
        &diagnostic.message,
        help.unwrap_or_default(),
        text,
        start..end,
    );
    let only = edits.len() == 1;
    edits
        .into_iter()
        .map(|(title, bytes, new)| {
            let edit = TextEdit::new(encoding.range(text, bytes), new);
            CodeAction {
                title,
                kind: Some(CodeActionKind::QUICKFIX),
                diagnostics: Some(vec![diagnostic.clone()]),
                is_preferred: only.then_some(true),
                edit: Some(WorkspaceEdit {
                    changes: Some([(uri.clone(), vec![edit])].into()),
                    ..WorkspaceEdit::default()
                }),
                ..CodeAction::default()
            }
        })
        .collect()
}

/// Title, place and new text of each repair.
fn edits(
    message: &str,
    help: &str,
    text: &str,
    place: Range<usize>,
) -> Vec<(String, Range<usize>, String)> {
    let here = text.get(place.clone()).unwrap_or_default();
    let is_word =
        |own: &str| !own.is_empty() && own.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
    let quoted = quoted(help);
    // `;` is missing here
    for sign in ["`;` is missing here", "`)` is missing here"] {
        if place.is_empty() && message.contains(sign) {
            let sign = &sign[1..2];
            return vec![(format!("write `{sign}`"), place, sign.to_owned())];
        }
    }
    if help.starts_with("did you mean `")
        && let [near] = quoted.as_slice()
        && is_word(here)
        && is_word(near)
    {
        return vec![(format!("change to `{near}`"), place, (*near).to_owned())];
    }
    if help.starts_with("write `import ") && help.ends_with("at the top of the file") {
        let at = behind_imports(text);
        return quoted
            .iter()
            .map(|import| {
                let line = match at {
                    0 => format!("{import}\n"),
                    _ => format!("\n{import}"),
                };
                (format!("add `{import}`"), at..at, line)
            })
            .collect();
    }
    // `Axis` ends with `end Axs`
    if message.contains("` ends with `end ")
        && let [end] = quoted.as_slice()
        && let Some(name) = end
            .strip_prefix("end ")
            .and_then(|own| own.strip_suffix(';'))
        && is_word(here)
    {
        return vec![(format!("write `{end}`"), place, name.to_owned())];
    }
    // unknown unit `Nm`: write `N.m`
    if let Some((_, advice)) = message.split_once("unknown unit `")
        && let Some((unit, rest)) = advice.split_once("`: write `")
        && let Some((right, _)) = rest.split_once('`')
        && here == unit
    {
        return vec![(format!("change to `{right}`"), place, right.to_owned())];
    }
    Vec::new()
}

/// What stands between back quotes.
fn quoted(text: &str) -> Vec<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// Behind the last import, the package clause, or nothing.
fn behind_imports(text: &str) -> usize {
    let mut at = 0;
    let mut behind = 0;
    for line in text.split_inclusive('\n') {
        let own = line.trim_end();
        if (own.starts_with("import ") || own.starts_with("package ")) && own.ends_with(';') {
            behind = at + own.len();
        }
        at += line.len();
    }
    behind
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn advice_that_is_exact_becomes_an_edit() {
        let text = "package a;\nimport SI.*;\nmodel A\n  Mas m;\nend A;\n";
        let at = text.find("Mas").unwrap();
        let found = edits("there is no type", "did you mean `Mass`?", text, at..at + 3);
        assert_eq!(found[0].2, "Mass");
        let help = "write `import Translational.*;` or `import Planar.*;` at the top of the file";
        let found = edits("`Mas` is in …", help, text, at..at + 3);
        assert_eq!(found.len(), 2);
        assert_eq!(
            found[0].1,
            text.find("\nmodel").unwrap()..text.find("\nmodel").unwrap()
        );
        assert!(edits("something else", "think again", text, at..at + 3).is_empty());
    }
}
