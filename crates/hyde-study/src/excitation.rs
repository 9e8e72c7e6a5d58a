//! What to record next for a calibration: its model, records that are designed, and what each would tell.
//!
//! ```text
//! bench        the model of a calibration without records              excitation/bench.rs
//! columns      what an experiment reads of its records                 excitation/columns.rs
//! held         an effort within the travel of the model              excitation/held.rs
//! candidates   signals within the limits                               excitation/candidates.rs
//! options      what a user asks for                                    excitation/options.rs
//! quantity     a number with a unit, as an option has it               excitation/quantity.rs
//! wish         the signal that options ask for, and what is assumed    excitation/wish.rs
//! refused      why there is no such signal, and what to write          excitation/refused.rs
//! compared     signals compared on a model                             excitation/compared.rs
//! between      effects that a record is to distinguish                 excitation/between.rs
//! ```
//! A designed record is simulated with the loop closed and with the noise of the declared sensors; it is observed as
//! `hyde fit` observes it.

mod bench;
mod between;
mod candidates;
mod columns;
mod compared;
mod held;
mod options;
mod quantity;
pub mod refused;
mod wish;

pub use bench::{Bench, Failed, Told, bench};
pub use between::Apart;
pub(crate) use between::{Effects, apart};
pub use candidates::{Candidate, Unmade, candidates};
pub(crate) use columns::driven;
pub use compared::{Compared, Comparison, compared};
pub(crate) use compared::{Signals, none, signals};
pub use held::Room;
pub use options::{Criterion, Options, PLACES, SIZE, SPEEDS};
pub use wish::{Wished, of as wished};
