//! Records as CSV: a header of `name [unit]` columns, then a row an instant.
//!
//! ```text
//! t [s],x [mm],phi [rad]
//! 0,0,0
//! 0.001,0.35,0.02
//! ```
//!
//! What separates the cells (comma, semicolon, tab, bar or blanks), the decimal sign, the encoding, a row of units below the
//! names and a header behind `#` are found out by the file itself; what is not as above is told in a [`Note`](crate::Note).
//! Names may be quoted. Blank lines and lines that start with `#` or `%` are skipped.

mod columns;
mod error;
mod facts;
mod frame;
mod grid;
mod groups;
mod head;
mod labview;
mod number;
mod pairs;
mod plain_rows;
mod read;
mod rows;
mod runs;
mod separator;
mod text;
mod write;

pub use error::ReadError;
pub use frame::read_frame;
pub(crate) use number::number_with;
pub use read::read;
pub(crate) use read::read_sheet;
pub use write::{write, write_to};
