//! What to record next: signals for an axis within the limits of its travel, speed, acceleration and jerk, or of its effort.
//!
//! ```text
//! limits       what must not be exceeded, and why nothing fits                    excite/limits.rs
//! multisine    sines at all lines of a band, phases of low crest                  excite/multisine.rs, crest.rs
//! chirp        one sine from frequency to frequency                               excite/chirp.rs
//! profile      from rest to rest with bounded jerk                                excite/profile.rs
//! path         moves and dwells; jogs both ways, small reversals                  excite/path.rs, jogs.rs, reversals.rs
//! pulses       an effort there and back                                           excite/pulses.rs
//! written      decimal digits whose differences keep the limits                   excite/written.rs
//! design       one of these, asked for and made                                   excite/design.rs, design/joined.rs
//! set points   what a controller reads                                            excite/set_points.rs
//! ```
//!
//! A design begins and ends at rest, in the middle of its travel. What is checked is what is written: the differences of its
//! decimal digits, before its first sample and after its last one taken to stand.

mod chirp;
mod crest;
mod design;
mod jogs;
mod limits;
mod multisine;
mod path;
mod profile;
mod pulses;
mod reversals;
mod set_points;
mod written;

pub use design::{Design, Lines, Shape, Wish, design};
pub use limits::{Bounds, Impossible, Limits, Peak, Quantity};
pub use path::Leg;
pub use profile::Profile;
pub use set_points::{g_code, twincat};
