//! `differential_disagreements`: random drive models, each computed in two ways: how often do they disagree without a word?

use super::promise::{Figure, Measured, Promise, Session};
use crate::differential::{Way, compare};

pub(super) const FIGURE: Figure = Figure {
    name: "differential_disagreements",
    unit: "",
    promise: Promise::Exactly(0.0),
    measure,
};

/// The disagreements of all models in all ways: 10 000 models in full, otherwise 500.
#[allow(clippy::print_stderr, reason = "a figure that falls short says where")]
fn measure(session: &Session) -> Result<Measured, String> {
    let models = if session.whole { 10_000 } else { 500 };
    let first = (session.seed - 1) * models;
    let summary = compare(first..first + models, |_| Way::ALL.to_vec());
    for told in summary.disagreements.iter().chain(&summary.refusals) {
        eprintln!("{told}");
    }
    if summary.refused() > 0.1 {
        return Err(format!(
            "{} of the comparisons are refused",
            summary.refused()
        ));
    }
    Ok(Measured::Value(summary.disagreements.len() as f64))
}
