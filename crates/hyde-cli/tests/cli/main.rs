//! The command line as its users meet it.
#![allow(
    clippy::disallowed_methods,
    clippy::float_cmp,
    clippy::unwrap_used,
    reason = "tests open files, compare what is exact, and unwrap what must be there"
)]

mod analyses;
mod command;
mod diagnose;
mod documented;
mod effects;
mod excite;
mod excite_model;
mod files;
mod fit;
mod fmt;
mod live;
mod long_runs;
mod lsp;
mod modelica;

mod parquet;
mod plot;
mod printed;
mod readable_pages;
mod report;
mod selftest;
mod settings;
mod status;
mod sweep;
mod sweep_lasts;
