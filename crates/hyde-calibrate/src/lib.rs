//! Observers round a program: how far it is from records, and which parameters bring it nearer.
//!
//! ```text
//! recording      a record, evenly sampled                                         recording.rs, even_rows.rs
//! beginning      the states that its first rows show                              beginning.rs
//! frozen         readings that were held                                          frozen.rs
//! fixed steps    the program in dyadic steps, exact where it is linear            plant.rs, inputs.rs, stepping.rs, leg.rs, model.rs, configuration.rs, events.rs, past.rs
//! observer       a fixed Kalman gain; whitened innovations                        gain.rs, held.rs, observer.rs
//! track          where an observer takes the plant along a record                 track.rs, track/
//! tangent        how innovations change with parameters, along one track              tangent.rs
//! plan           what a `calibrate` block asks for                                 plan.rs
//! calibration    bounded least squares on innovations and priors                  descent.rs, least_squares.rs, solution.rs, blocks.rs, varied.rs
//!                of several experiments at once                                    joint.rs
//! its worth      intervals, correlations, groups                                   fit.rs
//!                the interval of one parameter, others fitted again                profile_likelihood.rs
//!                what records determine beforehand                                 identifiability.rs
//!                what records would tell beforehand                               information.rs
//!                why it taught nothing, where it did not                           standstill.rs
//! measures       the error in three measures, before and after, over its floor                  measures.rs, windows.rs, free_run.rs
//! what is left   what innovations depend on, and whether they are white                        residual_map.rs, whiteness.rs
//! diagnosis      which effect is missing                                          diagnosis.rs
//! self-test      what a diagnosis finds in records with a known effect              selftest.rs
//! ```

mod beginning;
mod begins_again;
mod blocks;
mod channel_error;
mod configuration;
mod dense;
mod descent;
mod diagnosis;
mod even_rows;
mod events;
mod exponential;
mod fit;
mod free_run;
mod frozen;
mod gain;
mod gains;
mod held;
mod identifiability;
mod information;
mod input_noise;
mod inputs;
mod joint;
mod label;
mod lateness;
mod least_squares;
mod leg;
mod linearised;
mod measures;
mod model;
mod observer;
mod outputs;
mod past;
mod plan;
mod plant;
mod profile_likelihood;
mod read;
mod readings;
mod recording;
mod residual_map;
mod selftest;
mod snapshot;
mod solution;
mod standstill;
mod stepping;
mod tangent;
mod track;
mod uncertainty;
mod varied;
mod whiteness;
mod windows;

pub use blocks::Fold;
pub use channel_error::ChannelError;
pub use diagnosis::{
    Alternative, Author, Built, CurvePoint, Diagnosis, Experiment, Factor, Finding, FoundCurve,
    FoundLaw, FoundModel, Gates, Hypothesis, Inquiry, Kind, Knob, LatentForce, Law, LawVariable,
    Map, Over, Panel, Quantity, Rejection, Round, Scales, Score, Seen, Site, Summand, Trial,
    Unknown, Variable, Verdict, Written, diagnose,
};
pub use even_rows::Uneven;
pub use fit::{Fit, FittedParameter, fit, fitted_parameters};
pub use free_run::{FreeChannel, free_run};
pub use frozen::{Frozen, frozen};
pub use gain::{Observer, Taken, UNDECLARED_NOISE};
pub use identifiability::{Identifiability, Together};
pub use information::{Information, UNKNOWN};
pub use joint::{Joint, Part};
pub use label::{Label, LabelValue};
pub use least_squares::Problem;
pub use measures::{FreeMeasure, Measures, Model};
pub use observer::Innovations;
pub use plan::{CalibrationPlan, Per, Source, Vary};
pub use plant::Unsupported;
pub use profile_likelihood::{LIMIT, Profile};
pub use recording::{RecordError, Recording};
pub use residual_map::{ResidualMap, residual_maps};
pub use selftest::{
    Asked, Axis, Case, Claim, Fault, Faulty, Found, Outcome, Planting, Row, SelftestError,
    Separation, Simulated, Size, Tally, cases, separation, simulated, tables_of, tally, try_case,
};
pub use solution::Solution;
pub use standstill::{Cause, standstill};
pub use varied::Varied;
pub use whiteness::{Whiteness, whiteness};
pub use windows::{WINDOW_S, Windows};
