//! What was assumed of records and tables: on the console and on the page.

use crate::lines::wrapped;
use hyde_report::{Block, Section};
use std::fmt::Write as _;

/// One note below the other, for the console.
pub fn text(notes: &[String]) -> String {
    let mut out = String::new();
    for note in notes {
        for (number, line) in wrapped(note, 74).iter().enumerate() {
            let head = if number == 0 { "  note: " } else { "    " };
            let _ = writeln!(out, "{head}{line}");
        }
    }
    out
}

/// The section of a page.
pub fn section(texts: &[String]) -> Option<Section> {
    (!texts.is_empty()).then(|| Section {
        heading: "Assumptions".to_owned(),
        blocks: texts.iter().cloned().map(Block::Text).collect(),
    })
}
