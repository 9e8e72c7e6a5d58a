//! Observers of machines on records: how large the error of a model is, which parameters reduce it, and which effect the model
//! lacks.
//!
//! The folders in the way through; each uses only those above it:
//!
//! ```text
//! refusals   what is said of a `calibrate` block that is wrong
//! plan       what a `calibrate` block asks for
//! linear     linear systems: what one does in a step, and products of small matrices
//! records    a record at even rows: what drives the model, what was measured
//! plant      a program in fixed steps along a record, exact where it is linear
//! observer   a fixed Kalman gain round the plant: innovations, and how they change with parameters
//! fit        least squares on innovations, and what the result is worth
//! measures   the error of a model in three measures, and what it depends on
//! diagnosis  which effect is missing
//! selftest   what a diagnosis finds in simulated records with a known effect
//! ```
//!
//! A calibration is `Recording::new` for each record, `Observer::new`, and `fit` of a `Joint`. A diagnosis is `diagnose` of an
//! `Inquiry`. The file of a folder lists what is in it.

mod diagnosis;
mod fit;
mod linear;
mod measures;
mod observer;
mod plan;
mod plant;
mod records;
mod refusals;
mod selftest;

pub use diagnosis::{
    Alternative, Author, Built, CommandTiming, Commands, CurvePoint, Diagnosis, Experiment, Factor,
    Finding, FoundCurve, FoundLaw, FoundModel, Gates, Hypothesis, Inquiry, Kind, Knob, LatentForce,
    Law, LawVariable, Map, Over, Panel, Quantity, Rejection, Relation, Round, Scales, Score, Seen,
    Site, Summand, TABLE, Threshold, Thresholds, Trial, Uncompared, Unknown, Variable, Verdict,
    Why, Written, diagnose, moved_columns,
};
pub use fit::{
    Cause, Fit, FittedParameter, Fold, Identifiability, Information, Joint, LIMIT, Part, Problem,
    Profile, Solution, Together, UNKNOWN, Varied, fit, fitted_parameters, standstill,
};
pub use measures::{
    ChannelError, FreeChannel, FreeMeasure, Measures, Model, ResidualMap, WINDOW_S, Whiteness,
    Windows, free_run, residual_maps, whiteness,
};
pub use observer::{Innovations, Observer, Taken, UNDECLARED_NOISE};
pub use plan::{CalibrationPlan, Label, LabelValue, Per, Source, Vary};
pub use plant::Unsupported;
pub use records::{Frozen, RecordError, Recording, Uneven, frozen};
pub use selftest::{
    Asked, Axis, Case, Claim, Designed, Designer, Fault, Faulty, Found, Linearised, Outcome,
    Planting, Point, Row, SelftestError, Separation, Signal, Simulated, Size, Tally, cases,
    simulated, tables_of, tally, try_case,
};
