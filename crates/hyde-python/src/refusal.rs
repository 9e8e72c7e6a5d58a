//! Errors of Python that carry the diagnostics of Hyde.

use hyde_diag::{Diagnostics, Sources};
use hyde_study::render;
use hyde_study::{Fault, Refused};
use pyo3::exceptions::{PyException, PyKeyboardInterrupt};
use pyo3::prelude::*;

pyo3::create_exception!(
    hyde,
    Error,
    PyException,
    "What was asked cannot be done. `diagnostics` is a list of dictionaries as `--json` prints them; empty where there is no place."
);
pyo3::create_exception!(
    hyde,
    ModelError,
    Error,
    "The model or its data are at fault."
);
pyo3::create_exception!(hyde, SolverError, Error, "The solver could not go on.");

/// What was asked cannot be: one sentence.
pub(crate) fn asked(reason: &str) -> PyErr {
    with(Error::new_err(reason.to_owned()), "[]".to_owned())
}

/// The error of a study.
pub(crate) fn refused(refused: &Refused) -> PyErr {
    match refused {
        Refused::Asked(reason) | Refused::Because(reason, _) => asked(reason),
        Refused::Model {
            sources,
            diagnostics,
            fault,
        } => of(diagnostics, sources, *fault),
    }
}

/// Diagnostics as an error of their kind.
pub(crate) fn of(diagnostics: &Diagnostics, sources: &Sources, fault: Fault) -> PyErr {
    if fault == Fault::Interrupted {
        return PyKeyboardInterrupt::new_err("the run was interrupted");
    }
    let text = render::render(diagnostics, sources, false);
    let text = text.trim_end().to_owned();
    let error = match fault {
        Fault::Asked => Error::new_err(text),
        Fault::Solver => SolverError::new_err(text),
        Fault::Model | Fault::Expectation | Fault::Interrupted => ModelError::new_err(text),
    };
    with(error, render::to_json(diagnostics, sources).to_string())
}

/// The error with its diagnostics, given as JSON.
fn with(error: PyErr, json: String) -> PyErr {
    Python::attach(|py| {
        let parsed = py
            .import("json")
            .and_then(|module| module.call_method1("loads", (json,)));
        match parsed.and_then(|list| error.value(py).setattr("diagnostics", list)) {
            Ok(()) => error,
            Err(other) => other,
        }
    })
}
