//! `event_suite_wrong`: of the hard events with a known answer, how many come out otherwise.

use super::promise::{Figure, Measured, Promise};
use crate::events::CASES;

pub(super) const FIGURE: Figure = Figure {
    name: "event_suite_wrong",
    unit: "cases",
    promise: Promise::Exactly(0.0),
    measure: |_| {
        let wrong = CASES.iter().filter(|case| (case.check)().is_err()).count();
        #[allow(clippy::cast_precision_loss, reason = "a few cases")]
        let wrong = wrong as f64;
        Ok(Measured::Value(wrong))
    },
};
