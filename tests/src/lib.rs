//! What the tests across crates and the figures share: the examples, compiled as the command line compiles them.

pub mod ablation;
pub mod batches;
pub mod bench_axis;
pub mod benchmarks;
pub mod cases;
mod closed_form;
mod cluster;
mod data;
pub mod differential;
pub mod editor;
pub mod edits;
pub mod events;
mod example;
pub mod figures;
pub mod fixed_step;
pub mod fmu;
mod folder;
pub mod gradient;
pub mod imported;
pub mod ivp;
mod last_bit;
pub mod library;
pub mod linear;
pub mod msl;
mod numbers;
pub mod paper;
pub mod random_fmus;
pub mod random_ledger;
pub mod stored_energy;
pub mod traces;
pub mod wording;

pub use closed_form::ContinuousAxis;
pub use data::data;
pub use example::{Example, Loaded, root};
