//! Studies of a model as functions from data to data. Nothing here prints, exits or reads arguments: the command line does,
//! and an editor or another program stands on the same functions.
//!
//! ```text
//! world             where files are: the disk, memory, unsaved buffers  world.rs
//! aim               what a program is made for                        aim.rs
//! asked             which model, with what set from outside             asked.rs
//! inputs            every file a model is made from, as it was read     inputs.rs
//! package           packages beyond the library, and their manifests    package.rs
//! settings          a parameter set from outside                        settings.rs
//! tables            the files of lookup tables                          tables.rs
//! fmus              FMUs that stand for models                          fmus.rs
//! record_settings   how a record is to be read                          record_settings.rs
//! records           the records of an experiment                        records.rs
//! ports             inputs and outputs of a program for another tool    ports.rs
//! project           a file parsed once; its model, experiment, program  project.rs
//! known             which effects fit where, and where a law may act    known.rs
//! operating_point   about which point a model is linearised             operating_point.rs
//! check             everything in a file compiled, and nothing run      check.rs
//! assumptions       what was assumed of records, tables and FMUs        assumptions.rs
//! not_numbers       columns of a run without a number                   not_numbers.rs
//! responses         frequency responses and stability margins           responses.rs
//! modes             natural frequencies, and parameters from them       modes.rs
//! state_space       the linearised model as matrices                    state_space.rs
//! budget            which imperfection contributes how much             budget.rs
//! selftest          what the verdicts of a diagnosis are worth          selftest.rs
//! trend             how sizes went from one diagnosis to the next       trend.rs
//! traces            what is in a trace, before any model reads it       traces.rs
//! runs              the runs that other studies need                    runs.rs
//! experiment_tests  what experiments expect, whether effects vanish     experiment_tests.rs
//! sweep             the cases of a sweep, solved and gathered           sweep.rs
//! store             where finished tasks of a long study are kept       store.rs
//! progress          how far a long study is                             progress.rs
//! calibration       a calibration with its records and its observers    calibration.rs
//! comparison        errors before and after, over the noise floor       comparison.rs
//! fitted            what a calibration found, and its models            fitted.rs
//! diagnosis         its block and calibration, what it found, its model   diagnosis.rs
//! unknown           an effect that no library has                       unknown.rs
//! left_model        what stands before a model in a file                left_model.rs
//! excitation        what to record next for a calibration               excitation.rs
//! first_model       a first model of an axis, from a trace              first_model.rs
//! render            diagnostics as text or JSON                         render.rs
//! run_failure       a run that could not go on, as a diagnostic         run_failure.rs
//! unobservable      a study that cannot be, as a diagnostic             unobservable.rs
//! refused           why a study has no answer                           refused.rs
//! ```
//! Start reading at [`load`] in `project.rs`.

mod aim;
mod asked;
pub mod assumptions;
pub mod budget;
mod calibration;
mod check;
pub mod comparison;
pub mod diagnosis;
pub mod excitation;
pub mod experiment_tests;
pub mod first_model;
pub mod fitted;
mod fmus;
mod inputs;
mod known;
pub mod left_model;
pub mod modes;
mod near;
mod not_numbers;
pub mod operating_point;
mod package;
pub mod ports;
mod progress;
mod project;
pub mod record_files;
pub mod record_settings;
mod records;
mod refusals;
mod refused;
pub mod render;
pub mod responses;
pub mod run_failure;
pub mod runs;
pub mod selftest;
pub mod settings;
pub mod state_space;
mod store;
pub mod sweep;
mod tables;
pub mod topology;
pub mod traces;
pub mod trend;
pub mod unknown;
pub mod unobservable;
pub mod world;

pub use aim::Aim;
pub use asked::Asked;
pub use calibration::{
    Calibration, JointCalibration, JointPart, Local, Number, calibration, chosen, joint_calibration,
};
pub use check::{Checked, check};
pub use fmus::{FmuHost, NamedFmu};
pub use inputs::{Content, Inputs, Key, Kind};
pub use package::{MANIFEST, Manifest, Root, Roots, is_inside, links_out};
pub use progress::Progress;
pub use project::{Loaded, Project, files_of, load};
pub use records::{Record, Records, headers, read as read_records, tables};
pub use refused::{Fault, Refused};
pub use store::Store;
pub use tables::Table;
