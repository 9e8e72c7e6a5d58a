//! Batches: the file part of what [`hyde_experiment::batch`] plans.
//!
//! ```text
//! DIR/batch.json, inputs/       what the batch is, with a copy of every file it reads        order, inputs
//! DIR/journal/*.journal         a record for each finished case: the truth                   store
//! DIR/cases.parquet, …          made of the journals once no case is missing                 merge
//! ```
//! `asked` makes an order of arguments, `prepare` plan and programs of an order, `work` solves what is missing on all cores,
//! `slurm` has it done elsewhere, `tell` says what came of it; `report` makes its page of the files, `over_time` reads
//! trajectories.

pub(crate) mod asked;
pub(crate) mod merge;
pub(crate) mod order;
pub(crate) mod over_time;
pub(crate) mod prepare;
pub(crate) mod progress;
pub(crate) mod report;
pub(crate) mod slurm;
pub(crate) mod store;
pub(crate) mod tell;
pub(crate) mod variants;
pub(crate) mod work;
