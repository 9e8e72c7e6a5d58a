//! How large the error of a model is on a record, and what it depends on.
//!
//! ```text
//! on record      the three measures, each with its noise floor                          measures/on_record.rs
//! channel error  innovations of a channel                                               measures/channel_error.rs
//! windows        100 ms in open loop                                                    measures/windows.rs
//! free run       the loop closed, driven by the reference                               measures/free_run.rs
//! residual map   what innovations depend on                                             measures/residual_map.rs
//! whiteness      whether they are white                                                 measures/whiteness.rs
//! ```

mod channel_error;
mod free_run;
mod on_record;
mod residual_map;
mod whiteness;
mod windows;

pub use channel_error::ChannelError;
pub use free_run::{FreeChannel, free_run};
pub use on_record::{FreeMeasure, Measures, Model};
pub use residual_map::{ResidualMap, residual_maps};
pub use whiteness::{Whiteness, whiteness};
pub use windows::{WINDOW_S, Windows};
