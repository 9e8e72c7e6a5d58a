//! Public benchmarks of system identification in their own units: the model of `examples/`, fitted on the official record for
//! estimation, beside what others published for the record for test.
//!
//! ```text
//! records below the folder of HYDE_DATA ──fit──> parameters ──run──> errors of the record for test ──> a table
//! ```
//!
//! The records have no licence that lets them be shipped, or are large. Where they are absent the table says where to put them.

mod ced;
mod command;
mod emps;
mod mirror;
mod table;

pub use emps::second_half;
pub use table::words;

use std::path::Path;

/// A benchmark.
#[derive(Clone, Copy)]
pub struct Benchmark {
    /// Its name on the command line, and that of the folder of its records.
    pub name: &'static str,
    /// What is measured, in one line.
    pub about: &'static str,
    /// Fits and tests the model with the records of a folder, by a program that is the command `hyde`.
    pub measure: fn(program: &Path, folder: &Path) -> Result<Vec<Row>, String>,
    /// What others published.
    pub published: &'static [Published],
}

/// All of them.
pub const BENCHMARKS: [Benchmark; 3] = [emps::BENCHMARK, ced::BENCHMARK, mirror::BENCHMARK];

/// A figure of a record for test.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Which record or part of it.
    pub record: &'static str,
    /// The unit of the benchmark.
    pub unit: &'static str,
    /// The root mean square of the error, or what the unit says; or why there is none.
    pub value: Result<f64, Reason>,
    /// How many parameters were fitted.
    pub fitted: usize,
}

/// Why a figure was not measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The official file of this name is not at hand.
    Absent(&'static str),
    /// A run failed: what it says.
    Failed(String),
}

/// Figures that others published, in the order of the records that have one.
#[derive(Clone, Copy, Debug)]
pub struct Published {
    /// The method.
    pub method: &'static str,
    /// Record and figure.
    pub figures: &'static [(&'static str, f64)],
    /// Where it is published.
    pub source: &'static str,
}

/// The table of baselines of several benchmarks, and of the best results known to its authors.
const CHAMPNEYS: &str = "Champneys et al., Baseline Results for Selected Nonlinear System Identification Benchmarks, 2024, \
    arXiv 2405.10779";
