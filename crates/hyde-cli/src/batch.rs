//! Sweeps on this machine and on clusters; what is computed is [`hyde_study::sweep`].
//!
//! ```text
//! DIR/batch.json, inputs/       what the batch is, with a copy of every file it reads
//! DIR/journal/*.journal         a record for each finished case: the truth          store
//! DIR/cases.parquet, …          made of the journals once no case is missing
//! ```
//! `asked` makes an order of arguments, `prepared` a batch of an order, `folder` keeps it and makes the data set, `shard` says
//! which cases are one shard's, `progress` shows how far a batch is, `slurm` has it solved elsewhere.

pub(crate) mod asked;
pub(crate) mod folder;
pub(crate) mod prepared;
pub(crate) mod progress;
pub(crate) mod shard;
pub(crate) mod slurm;
pub(crate) mod store;
