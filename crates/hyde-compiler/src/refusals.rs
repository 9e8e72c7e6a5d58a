//! Every diagnostic of packages and of diagnoses, as data.

pub(crate) mod diagnoses;
pub(crate) mod packages;
