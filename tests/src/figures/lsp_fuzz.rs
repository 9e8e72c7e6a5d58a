//! `lsp_fuzz_findings`: sequences of random edits with requests in between after which the language server fails, or answers
//! otherwise than a new one.

use super::promise::{Figure, Measured, Promise, Session};
use crate::edits::edit;

/// Sequences of the promise, and of a quick look.
const ALL: u64 = 100_000;
const FEW: u64 = 1_000;

pub(super) const FINDINGS: Figure = Figure {
    name: "lsp_fuzz_findings",
    unit: "",
    promise: Promise::Exactly(0.0),
    measure: findings,
};

fn findings(session: &Session) -> Result<Measured, String> {
    let count = if session.whole { ALL } else { FEW };
    let first = (session.seed - 1) * ALL;
    let found = edit(first..first + count)?;
    match (found.findings.first(), session.whole) {
        (Some(finding), _) => Err(format!("{} findings: {finding}", found.findings.len())),
        (None, true) => Ok(Measured::Value(0.0)),
        (None, false) => Ok(Measured::Partly(0.0, "1 000 of 100 000 sequences")),
    }
}
