//! What each threshold of a diagnosis is worth: it is set to the value with which it decides nothing, and right answers, false
//! alarms and seconds are counted on records with known answers.
//!
//! ```text
//! change       one or several thresholds with other values       ablation/change.rs
//! measured     a suite of records diagnosed with a change         ablation/measured.rs
//! results      the rows of `tests/ablation.csv`                   ablation/results.rs
//! table        the table of the book, made of both                ablation/table.rs
//! numbers      numbers of the sources that are in no table        ablation/numbers.rs
//! ```

mod change;
mod measured;
mod numbers;
mod results;
mod table;

pub use change::Change;
pub use measured::{Suite, measured};
pub use numbers::outside_the_table;
pub use results::{Result as Row, Results};
pub use table::{BEGIN, END, in_book, unreasoned};
