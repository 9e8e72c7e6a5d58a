//! How to solve: tolerances, orders, step limits, linear solver.

use crate::{Error, LinearMethod};

/// The options of a solver, checked when it is made.
///
/// The weighted error of unknown `i` is measured in units of `rtol |y_i| + atol_i`; a step is accepted when the root
/// mean square over the unknowns is below 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// Relative tolerance, 0 or more.
    pub rtol: f64,
    /// Absolute tolerance of each unknown, in its own unit, more than 0.
    pub atol: Vec<f64>,
    /// For each unknown whether its derivative occurs: a state, else an algebraic variable.
    pub differential: Vec<bool>,
    /// Leaves the algebraic variables out of the error test. Needed for most systems of index 1 started from rest:
    /// else the first step fails at tight tolerances. They are then as exact as Newton's method leaves them.
    pub suppress_algebraic: bool,
    /// Largest order of the backward differentiation formula, 1 to 5.
    pub max_order: u8,
    /// Largest internal step in s; infinity for none.
    pub max_step_s: f64,
    /// Size of the very first step in s; `None` leaves it to IDA.
    pub first_step_s: Option<f64>,
    /// Largest number of internal steps of one call of `solve`; `None` for no limit.
    pub max_steps_per_solve: Option<u32>,
    /// How linear systems are solved.
    pub linear_method: LinearMethod,
    /// Looks at the rate of Newton's method again after some steps, where IDA believes the last one that it saw as long as
    /// steps have one size. Without it an algebraic variable may drift off unseen.
    pub watch_convergence: bool,
    /// For equations with exponentials that grow: compares an old Jacobian with that of each step, by one evaluation, and
    /// estimates the error of each unknown by the rate of its own corrections.
    pub steep: bool,
}

impl Options {
    /// Options with these tolerances and kinds of unknowns and otherwise the usual values: algebraic variables left
    /// out of the error test, order up to 5, no limits on steps, dense or sparse by size, convergence watched.
    #[must_use]
    pub fn new(rtol: f64, atol: Vec<f64>, differential: Vec<bool>) -> Self {
        Self {
            rtol,
            atol,
            differential,
            suppress_algebraic: true,
            max_order: 5,
            max_step_s: f64::INFINITY,
            first_step_s: None,
            max_steps_per_solve: None,
            linear_method: LinearMethod::Auto,
            watch_convergence: true,
            steep: false,
        }
    }

    pub(crate) fn check(&self, n: usize) -> Result<(), Error> {
        check_tolerances(self.rtol, &self.atol, n)?;
        check_length("differential", self.differential.len(), n)?;
        check_max_step(self.max_step_s)?;
        check_first_step(self.first_step_s)?;
        require(
            (1..=5).contains(&self.max_order),
            "max_order",
            "must be 1 to 5",
        )
    }
}

pub(crate) fn check_tolerances(rtol: f64, atol: &[f64], n: usize) -> Result<(), Error> {
    check_length("atol", atol.len(), n)?;
    require(
        rtol >= 0.0 && rtol.is_finite(),
        "rtol",
        "must be finite and not negative",
    )?;
    require(
        atol.iter().all(|&atol| atol > 0.0 && atol.is_finite()),
        "atol",
        "must be finite and positive everywhere",
    )
}

pub(crate) fn check_max_step(max_step_s: f64) -> Result<(), Error> {
    require(max_step_s > 0.0, "max_step_s", "must be positive")
}

pub(crate) fn check_first_step(first_step_s: Option<f64>) -> Result<(), Error> {
    let usable = first_step_s.is_none_or(|step| step > 0.0 && step.is_finite());
    require(usable, "first_step_s", "must be finite and positive")
}

pub(crate) fn check_length(what: &'static str, found: usize, expected: usize) -> Result<(), Error> {
    if found == expected {
        Ok(())
    } else {
        Err(Error::Length {
            what,
            expected,
            found,
        })
    }
}

pub(crate) fn check_finite(what: &'static str, values: &[f64]) -> Result<(), Error> {
    match values.iter().position(|value| !value.is_finite()) {
        None => Ok(()),
        Some(index) => Err(Error::NotFinite { what, index }),
    }
}

fn require(holds: bool, what: &'static str, requirement: &'static str) -> Result<(), Error> {
    if holds {
        Ok(())
    } else {
        Err(Error::Option { what, requirement })
    }
}
