//! Every diagnostic of studies, as data.

pub(crate) mod calibrations;
pub(crate) mod files;
pub(crate) mod packages;
pub(crate) mod responses;
pub(crate) mod runs;
