//! An observer over a record: innovations, and how they change with small changes of parameters.
//!
//! ```text
//! beginning      the states that the first rows of a record show                        observer/beginning.rs
//! gain           a fixed Kalman gain                                                    observer/gain.rs
//! input noise    what driving columns are not known to, as noise of the states          observer/input_noise.rs
//! held           another gain for modes in which errors grow by the fixed one           observer/held.rs
//! over record    predict a row, compare, correct, on                                    observer/over_record.rs
//! innovations    what the model did not predict, whitened                               observer/innovations.rs
//! track          where the plant has been along a record, row by row                    observer/track.rs, observer/track/
//! tangent        how innovations change with parameters along a track                   observer/tangent.rs, observer/tangent/
//! lateness       how they change if what drives the axis comes a little later           observer/lateness.rs
//! ```

mod beginning;
mod gain;
mod held;
mod innovations;
mod input_noise;
mod lateness;
mod over_record;
mod tangent;
mod track;

pub(crate) use gain::state_names;
pub use gain::{Observer, Taken, UNDECLARED_NOISE};
pub use innovations::Innovations;
pub(crate) use input_noise::MATERIAL;
pub(crate) use lateness::{KNOWN_TO, changes_if_late};
pub(crate) use over_record::{When, forget_missing, run, run_while};
pub(crate) use tangent::{Direction, Forces, Known, Modes, Own, Shape, Slopes, along, changes};
pub(crate) use track::{Place, Track, Vectors};
