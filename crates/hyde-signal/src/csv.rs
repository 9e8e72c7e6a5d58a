//! Records as CSV: a header of `name [unit]` columns, then a row an instant.
//!
//! ```text
//! t [s],x [mm],phi [rad]
//! 0,0,0
//! 0.001,0.35,0.02
//! ```
//!
//! The separator is a comma, a semicolon or a tab, whichever the header has most of. Names may be quoted. Blank lines
//! and lines that start with `#` are skipped. The decimal sign is the point.

mod error;
mod frame;
mod header;
mod read;
mod rows;
mod write;

pub use error::ReadError;
pub use frame::read_frame;
pub(crate) use header::name_and_unit;
pub use read::read;
pub use write::write;
