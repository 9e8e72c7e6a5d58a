//! Records as an observer reads them: at even rows, what drives the model beside what was measured.
//!
//! ```text
//! read           a measured channel with the times of its own readings                 records/read.rs
//! begins again   a channel that counts from zero again, beside a model that goes on    records/begins_again.rs
//! even rows      even rows where those of the record are not                           records/even_rows.rs
//! readings       the readings of each channel at these rows                            records/readings.rs
//! recording      the whole                                                             records/recording.rs
//! frozen         spells in which a channel stands still and then jumps                 records/frozen.rs
//! ```

mod begins_again;
mod even_rows;
mod frozen;
mod read;
mod readings;
mod recording;

pub use even_rows::Uneven;
pub use frozen::{Frozen, frozen};
pub(crate) use readings::{Rates, Readings, filled};
pub use recording::{RecordError, Recording};
