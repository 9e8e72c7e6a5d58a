//! The tests of the solver as its users see it: one module for each thing promised.
#![allow(
    clippy::float_cmp,
    clippy::unwrap_used,
    clippy::wildcard_enum_match_arm,
    reason = "tests compare what is exact, unwrap what must be there, and match what they made"
)]

mod chain;
mod convergence;
mod events;
mod failures;
mod initial_conditions;
mod linear;
mod panics;
mod refusals;
mod rest;
mod robertson;
mod silence;
mod stepping;
mod threads;
