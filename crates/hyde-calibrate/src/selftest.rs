//! What the verdicts of a diagnosis are worth on an axis: effects planted in simulated records of it, and what was found.
//!
//! ```text
//! numbers        random numbers by seed and purpose, the same everywhere            selftest/random.rs
//! case           what is planted: an effect, a wrong parameter, a faulty sensor     selftest/case.rs
//! simulated      the records that the axis would leave: noise, rounding             selftest/simulated.rs
//! expected       what a planted effect gains at best, and where it begins to show   selftest/expected.rs
//! separation     what effects gain over each other on records                   selftest/separation.rs
//! designed       a record that is to distinguish what a case cannot             selftest/designed.rs
//! trial          a case simulated, diagnosed, judged                                selftest/trial.rs
//! table          the outcomes of all cases, counted                                 selftest/table.rs
//! ```

mod case;
mod designed;
mod expected;
mod random;
mod separation;
mod simulated;
mod table;
mod trial;

pub use case::{Asked, Case, Fault, Planting, Size, cases};
pub use designed::{Designed, Designer, Signal};
pub use separation::{Linearised, Point, Separation};
pub use simulated::{Faulty, Simulated, simulated};
pub use table::{Found, Row, Table as Tally, tally};
pub use trial::{Axis, Claim, Outcome, SelftestError, tables_of, try_case};
