//! `gradient_vs_difference_max`: do derivatives of runs through events agree with differences of runs?

use super::promise::{Figure, Measured, Promise, Session};
use crate::gradient::{BENCH, CASES, compare_bench};

pub(super) const FIGURE: Figure = Figure {
    name: "gradient_vs_difference_max",
    unit: "",
    promise: Promise::AtMost(1e-4),
    measure,
};

/// The largest relative difference over every model, output and parameter, the bench axis without its quantiser too.
fn measure(_: &Session) -> Result<Measured, String> {
    let mut worst = 0.0_f64;
    let lists = CASES.iter().map(crate::gradient::Case::compare);
    for list in lists.chain([compare_bench(&BENCH)]) {
        for compared in list? {
            worst = worst.max(compared.error);
        }
    }
    Ok(Measured::Value(worst))
}
