//! Sampled signals with names and units: CSV and Parquet, interpolation, filters, spectra, signals to record.
//!
//! A record is a [`Table`]: columns of equal length over one time, read by [`csv::read`] and written by
//! [`csv::write`] in the same form, or by [`parquet`] with the same numbers, so that a result can stand in for a measurement
//! ([`mat`] writes for other tools). Columns whose unit is known hold
//! SI values. A [`Signal`] is one column over the time; it reads between the rows. [`filter`], [`spectrum`] and
//! [`statistics`] work on plain slices of equally spaced samples, unless they say otherwise.
//!
//! ```
//! use hyde_signal::{Cursor, Layout, csv};
//!
//! let table = csv::read(b"t [ms],x [mm]\n0,0\n1,350\n", &Layout::default())?;
//! let x = table.signal("x").expect("the header has x");
//! let mut cursor = Cursor::default();
//! assert_eq!(x.linear(0.0005, &mut cursor), 0.175);
//! assert_eq!(x.held(0.0005, &mut cursor), 0.0);
//! assert_eq!(x.next(0.0005, &mut cursor), 0.35);
//! # Ok::<(), csv::ReadError>(())
//! ```

pub mod arrays;
pub mod csv;
pub mod excite;
pub mod filter;
pub mod look;
pub mod mat;
pub mod parquet;
pub mod sinumerik;
pub mod spectrum;
pub mod statistics;
pub mod workbook;
pub mod wrap;

mod align;
mod assemble;
mod calendar;
mod column;
mod contradicted;
mod decimal;
mod declared;
mod foreign;
mod frame;
mod gaps;
mod heading;
mod instants;
mod join;
mod layout;
mod note;
mod record;
mod series;
mod signal;
mod table;
mod texts;
mod time_error;
mod unpack;

pub use align::align;
pub use assemble::{Fault, Unusable};
pub use calendar::{Origin, Since, Zone};
pub use column::{Column, UnitConflict, Values as WrittenValues, Written, in_unit};
pub use foreign::Foreign;
pub use frame::{Field, Frame, Kind, Values};
pub use join::{JoinError, join};
pub use layout::{CountUnit, DeclaredColumn, Kind as LayoutKind, Layout};
pub use note::Note;
pub use record::{RecordError, read, read_frame, read_whole};
pub use series::Series;
pub use signal::{Cursor, Signal};
pub use table::{Table, TableError};
pub use time_error::{Candidate, TimeError};
