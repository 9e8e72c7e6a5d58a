//! Sweeps: the cases that [`hyde_experiment::batch`] plans, over models and records, kept as they are solved.
//!
//! ```text
//! order      what a batch is asked to be, with the files it reads; its identity   sweep/order.rs
//! prepare    plan and programs of an order                                        sweep/prepare.rs
//! variants   the compiled models of the cases                                     sweep/variants.rs
//! work       the missing cases solved on all cores, into a store                  sweep/work.rs
//! merge      a store with every case made one data set                            sweep/merge.rs
//! finished   what the folder of a finished batch holds                           sweep/finished.rs
//! ```

mod finished;
mod merge;
mod order;
mod prepare;
mod variants;
mod work;

pub use finished::{Finished, Unfinished, table_in};
pub use merge::{TableForm, cases, trajectories};
pub use order::{ORDER, Order, Parts};
pub use prepare::Prepared;
pub use variants::{Ready, Source, Variants};
pub use work::{Ended, How, Took, solve_missing};
