//! Calibration: bounded least squares on innovations and on what is known beforehand, and what the result is worth.
//!
//! ```text
//! varied             a parameter that may change                                        fit/varied.rs
//! least squares      innovations of one program's records                               fit/least_squares.rs
//! joint              those of several experiments at once                               fit/joint.rs
//! linearised         their derivatives, by tangents or by differences of runs           fit/linearised.rs
//! blocks             every other second of a record, to judge what the rest was fitted to   fit/blocks.rs
//! descent            steps of Gauss and Newton, damped                                  fit/descent.rs
//! solution           where they arrived, and how sharply                                fit/solution.rs
//! uncertainty        the covariance of its values                                       fit/uncertainty.rs
//! calibration        the whole: several starts, intervals, correlations, groups         fit/calibration.rs
//! profile            the interval of one parameter, all others fitted again             fit/profile_likelihood.rs
//! identifiability    which parameters records determine, before a fit                   fit/identifiability.rs
//! information        how sharply records would determine them                           fit/information.rs
//! standstill         why a fit taught nothing                                           fit/standstill.rs
//! ```

mod blocks;
mod calibration;
mod descent;
mod goal;
mod identifiability;
mod information;
mod joint;
mod least_squares;
mod linearised;
mod profile_likelihood;
mod solution;
mod standstill;
mod uncertainty;
mod varied;

pub use blocks::Fold;
pub(crate) use blocks::rows_of_a_block;
pub use calibration::{Fit, FittedParameter, fit, fitted_parameters};
pub(crate) use descent::{LAST_STEPS, MAX_STEPS, Objective, sum_of_squares};
pub(crate) use goal::Goal;
pub use identifiability::{Identifiability, Together};
pub use information::{Information, UNKNOWN};
pub use joint::{Joint, Part};
pub use least_squares::Problem;
pub(crate) use linearised::{Linearised, Slopes};
pub use profile_likelihood::{LIMIT, Profile};
pub use solution::Solution;
pub use standstill::{Cause, standstill};
pub(crate) use uncertainty::{covariance, covariance_of_first, inflation, inflation_of};
pub use varied::Varied;
