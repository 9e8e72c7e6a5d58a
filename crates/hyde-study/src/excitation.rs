//! What to record next for a calibration: its model, records that are designed, and what each would tell.
//!
//! ```text
//! bench        the model of a calibration without records              excitation/bench.rs
//! columns      what an experiment reads of its records                 excitation/columns.rs
//! held         an effort within the travel of the model              excitation/held.rs
//! candidates   signals within the limits                               excitation/candidates.rs
//! ```
//! A designed record is simulated with the loop closed and with the noise of the declared sensors; it is observed as
//! `hyde fit` observes it.

mod bench;
mod candidates;
mod columns;
mod held;

pub use bench::{Bench, Failed, Told, bench};
pub use candidates::{Candidate, Unmade, candidates};
pub use held::Room;
