//! The module `hyde._hyde`, below the Python package `hyde`: loads a model, compiles it once, and runs it in the process.
//!
//! ```text
//! model     a model with its experiment, compiled       model.rs
//! outcome   what a run leaves, as arrays                outcome.rs
//! shown     the page and the figures of a run           shown.rs
//! refusal   errors, with their diagnostics              refusal.rs
//! ```
//! Columns become NumPy arrays without a copy. The interpreter's lock is released while a run goes on.

mod model;
mod outcome;
mod refusal;
mod shown;

use mimalloc::MiMalloc;
use pyo3::prelude::*;

/// As in the command: a run that two threads compute at once allocates in both.
#[global_allocator]
static ALLOCATOR: MiMalloc = MiMalloc;

/// The module as Python sees it.
#[pymodule]
fn _hyde(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<model::Model>()?;
    module.add_class::<outcome::Outcome>()?;
    module.add_function(wrap_pyfunction!(shown::page, module)?)?;
    module.add_function(wrap_pyfunction!(shown::figures_of, module)?)?;
    module.add("Error", module.py().get_type::<refusal::Error>())?;
    module.add("ModelError", module.py().get_type::<refusal::ModelError>())?;
    module.add(
        "SolverError",
        module.py().get_type::<refusal::SolverError>(),
    )?;
    module.add("VERSION", env!("CARGO_PKG_VERSION"))?;
    Ok(())
}
