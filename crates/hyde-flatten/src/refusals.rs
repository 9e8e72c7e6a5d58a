//! Every diagnostic of flatten, as data: a file for each group of passes. A pass reports what a function of its file makes.

pub(crate) mod allowed;
pub(crate) mod calls;
pub(crate) mod connect;
pub(crate) mod dimensions;
pub(crate) mod effects;
pub(crate) mod equations;
pub(crate) mod experiment;
pub(crate) mod fields;
pub(crate) mod instantiate;
pub(crate) mod laws;
pub(crate) mod names;
pub(crate) mod records;
pub(crate) mod values;
