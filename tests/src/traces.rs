//! Traces as drives, scopes and controllers write them: whether they are read as what they are.
//!
//! [`layouts`] compares real and retyped layouts with their truth; [`Mutated`] writes a known motion in a layout drawn by a
//! seed, with whatever may be odd about it, and tells whether a reader took something of it for something else without a word.

mod layouts;
mod mutated;
mod written;

pub use layouts::layouts;
pub use mutated::{Mutated, Outcome};
