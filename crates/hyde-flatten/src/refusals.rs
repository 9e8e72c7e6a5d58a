//! Every diagnostic of flatten, as data: a file for each group of passes. A pass reports what a function of its file makes.

pub(crate) mod allowed;
pub(crate) mod connect;
