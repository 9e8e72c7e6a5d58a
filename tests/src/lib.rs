//! What the tests across crates and the figures share: the examples, compiled as the command line compiles them.

mod data;
pub mod events;
mod example;
pub mod figures;
pub mod ivp;
pub mod msl;
pub mod paper;
pub mod stored_energy;

pub use data::data;
pub use example::{Example, Loaded, root};
