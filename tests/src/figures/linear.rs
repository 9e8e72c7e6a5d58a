//! `linear_against_run_wrong`, `sampled_poles_wrong`: do linearised models do what their runs do?

use super::promise::{Figure, Measured, Promise, Session};
use crate::linear::{Verdict, compare, wrong_poles};

pub(super) const AGAINST_RUN: Figure = Figure {
    name: "linear_against_run_wrong",
    unit: "",
    promise: Promise::Exactly(0.0),
    measure: |_: &Session| {
        count(200, |seed| match compare(seed)? {
            Verdict::Wrong(reason) => Ok(Some(reason)),
            Verdict::Agrees | Verdict::Told | Verdict::Nothing => Ok(None),
        })
    },
};

pub(super) const POLES: Figure = Figure {
    name: "sampled_poles_wrong",
    unit: "",
    promise: Promise::Exactly(0.0),
    measure: |_: &Session| count(50, wrong_poles),
};

/// How many of the first seeds have something wrong.
fn count(
    seeds: u64,
    wrong: impl Fn(u64) -> Result<Option<String>, String>,
) -> Result<Measured, String> {
    let mut sum = 0_u32;
    for seed in 0..seeds {
        if let Some(reason) = wrong(seed)? {
            tell(seed, &reason);
            sum += 1;
        }
    }
    Ok(Measured::Value(f64::from(sum)))
}

#[allow(clippy::print_stderr, reason = "a figure that falls short says where")]
fn tell(seed: u64, reason: &str) {
    eprintln!("seed {seed}: {reason}");
}
