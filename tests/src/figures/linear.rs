//! `linear_against_run_wrong`, `sampled_poles_wrong`: do linearised models do what their runs do?

use super::promise::{Figure, Promise, Session, count};
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
