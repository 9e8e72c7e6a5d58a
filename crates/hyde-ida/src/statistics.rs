//! What a solver has done so far.

/// Counts since the solver was made, across all restarts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Statistics {
    /// Accepted internal steps.
    pub steps: u64,
    /// Calls of the residual, consistent initial conditions included.
    pub residual_evaluations: u64,
    /// Calls of the Jacobian.
    pub jacobian_evaluations: u64,
    /// Calls of the root functions.
    pub root_evaluations: u64,
    /// Factorizations that chose their pivots anew (every dense one does).
    pub factorizations: u64,
    /// Sparse factorizations with the pivots of an earlier one.
    pub refactorizations: u64,
    /// Newton iterations.
    pub nonlinear_iterations: u64,
    /// Newton solves that did not converge; with an old Jacobian IDA first tries again with a new one.
    pub nonlinear_failures: u64,
    /// Steps made smaller because Newton's method failed.
    pub step_solve_failures: u64,
    /// Steps made smaller because the estimated error was too large.
    pub error_test_failures: u64,
    /// Calls of `reinit`.
    pub restarts: u64,
    /// First steps tried again from the start with a thousandth of the step size.
    pub first_step_retries: u64,
}
