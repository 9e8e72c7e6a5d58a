//! Every diagnostic of experiments, as data.

pub(crate) mod records;
pub(crate) mod sweeps;
