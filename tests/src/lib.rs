//! What the tests across crates and the figures share: the examples, compiled as the command line compiles them.

mod example;
pub mod figures;

pub use example::{Example, Loaded, root};
