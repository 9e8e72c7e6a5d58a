//! Safe wrapper of SUNDIALS IDA, a solver of differential-algebraic systems `0 = F(t, y, y')`.
//!
//! A model implements [`System`]; [`Ida`] integrates it by backward differentiation formulas of variable order and
//! step, stops exactly at a given time and at zeros of root functions, and interpolates over the last step. The
//! Jacobian comes from the model, as the values of a sparse [`Pattern`]; a few unknowns are solved densely, more by
//! KLU, and the same [`SparseSolver`] stands alone for other linear systems of that pattern. Failures are typed, say
//! where, and name the unknown or the equation to look at. Nothing is printed.
//!
//! Building takes cmake, libclang (for the bindings) and KLU; on Debian `cmake libclang-dev libsuitesparse-dev`.
//!
//! A. C. Hindmarsh and others, SUNDIALS, ACM Trans. Math. Softw. 31 (2005) 363; the user documentation of IDA 7.1.
//!
//! ```
//! use hyde_ida::{Ida, Options, Pattern, Recoverable, Stopped, System};
//!
//! /// `y' = -y`.
//! struct Decay;
//!
//! impl System for Decay {
//!     fn residual(&mut self, _t: f64, y: &[f64], yp: &[f64], out: &mut [f64]) -> Result<(), Recoverable> {
//!         out[0] = yp[0] + y[0];
//!         Ok(())
//!     }
//!
//!     fn jacobian(&mut self, _t: f64, cj: f64, _y: &[f64], _yp: &[f64], values: &mut [f64]) -> Result<(), Recoverable> {
//!         values[0] = 1.0 + cj;
//!         Ok(())
//!     }
//! }
//!
//! let options = Options::new(1e-8, vec![1e-10], vec![true]);
//! let mut solver = Ida::new(Decay, Pattern::dense(1)?, options, 0.0, &[1.0], &[-1.0])?;
//! while solver.step(2.0)? != Stopped::Stop {}
//! assert!((solver.y()[0] - (-2.0_f64).exp()).abs() < 1e-7);
//! # Ok::<(), hyde_ida::Error>(())
//! ```
//!
//! # Left open
//! On a torsional shaft half of the time and more goes to KLU's triangular solves. A nonlinear solver of our own, with
//! the model's own elimination, would be handed to IDA through `IDASetNonlinearSolver` in `memory.rs`. Guards evaluated on the converged iterate, with a test for an extremum inside the step, could take
//! the place of IDA's root functions, which miss two crossings in one step. An input that jumps at a known time could
//! be added to IDA's history instead of restarting it.
#![allow(
    unsafe_code,
    reason = "the crate's business is to call C and to be called by it"
)]

mod callback;
mod context;
mod convergence;
mod dense;
mod error;
mod failure;
mod few;
mod fixed_pivots;
mod interleave;
mod klu;
mod linear;
mod memory;
mod operations;
mod options;
mod pattern;
mod reading;
mod settings;
mod solver;
mod start;
mod statistics;
mod steep;
mod system;
mod vector;

pub use convergence::to_come;
pub use error::{Error, Failure, FailureKind};
pub use linear::{LinearMethod, SetAside, Singular, SparseSolver};
pub use options::Options;
pub use pattern::{Pattern, PatternError};
pub use reading::Crossing;
pub use solver::{Ida, Stopped};
pub use start::Given;
pub use statistics::Statistics;
pub use system::{Recoverable, System};

/// The version of SUNDIALS underneath, as in 7.1.1.
#[must_use]
pub fn sundials_version() -> String {
    use sundials_sys::{SUNDIALS_VERSION_MAJOR, SUNDIALS_VERSION_MINOR, SUNDIALS_VERSION_PATCH};
    format!("{SUNDIALS_VERSION_MAJOR}.{SUNDIALS_VERSION_MINOR}.{SUNDIALS_VERSION_PATCH}")
}
