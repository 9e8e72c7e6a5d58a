//! `thresholds_without_reason`: numbers that decide an answer of a diagnosis and are not in the table of the book with their
//! reason and with what their removal does.

use super::promise::{Figure, Measured, Promise};
use crate::ablation::{Results, outside_the_table, unreasoned};

pub(super) const FIGURE: Figure = Figure {
    name: "thresholds_without_reason",
    unit: "thresholds",
    promise: Promise::Exactly(0.0),
    measure: |_| {
        let outside = outside_the_table()?.len();
        let unreasoned = unreasoned(&Results::read()?).len();
        Ok(Measured::Value((outside + unreasoned) as f64))
    },
};
