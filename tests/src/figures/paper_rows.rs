//! `paper_rows`: the rows of the book's table of the paper whose component and test are there and whose test passes.

use super::promise::{Figure, Measured, Promise};
use crate::paper;

#[allow(clippy::cast_precision_loss, reason = "some dozens of rows")]
pub(super) const FIGURE: Figure = Figure {
    name: "paper_rows",
    unit: "rows",
    promise: Promise::Exactly(paper::ROWS as f64),
    measure: |_| {
        let verdicts = paper::verdicts()?;
        let passed = verdicts.iter().filter(|verdict| verdict.outcome.is_ok());
        Ok(Measured::Value(passed.count() as f64))
    },
};
