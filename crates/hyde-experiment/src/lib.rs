//! What is asked of a program beside one solution: a run with its record ([`read_record`]), measures and expectations ([`run`]); the
//! system linearised about an operating point ([`linearize`]), as a [`state_space`], its frequency response with the sampled loop closed
//! ([`frequency_response`]), the margins of a loop cut at a signal ([`margins`]) and its modes ([`modes`]); the response on the full hybrid model, swept ([`swept_response`]) and
//! stepped ([`stepped_response`]), and measured ones ([`measured_curve`]); parameters from measured modes
//! ([`fit_modes`]); the forces between components ([`flows`]) and the error budget ([`BudgetOf`]); the limit
//! test of an effect ([`limit`]); many runs planned and kept as one ([`batch`]).

pub mod batch;

mod assumptions;
mod bode;
mod budget;
mod common_period;
mod compare;
mod driven_kinds;
mod flows;
mod ledger;
mod limit;
mod linearize;
mod margins;
mod measured_response;
mod measures;
mod mode_fit;
mod mode_shape;
mod modes;
mod pencil;
mod poles;
mod record;
mod refusals;
mod rows;
mod run;
mod run_error;
mod sampled;
mod state_space;
mod stepped;
mod swept;

pub use assumptions::Assumption;
pub use bode::{BodeError, frequency_response, frequency_response_watched};
pub use budget::{BudgetOf, Estimate, Share};
pub use compare::{Channel, CompareError, prepared, unwrapped};
pub use driven_kinds::{RowFault, check_columns};
pub use flows::{FlowLine, flows};
pub use ledger::{EnergyLedger, LedgerEntry};
pub use limit::{Answer, LIMIT_LEFT, LIMIT_PART, limit};
pub use linearize::{About, Linear, LinearizeError, linearize, linearize_about};
pub use margins::{CutError, DelayMargin, GainCrossover, Margins, PhaseCrossover, margins};
pub use measured_response::{MeasuredCurve, curve_of_run, measured_curve};
pub use measures::{MeasureValue, Missing};
pub use mode_fit::{
    Combination, FoundParameter, MeasuredMode, ModeFit, ModeFitError, ModeFitRequest, PairedMode,
    fit_modes,
};
pub use mode_shape::{ModeShape, mode_shape};
pub use modes::{NaturalMode, modes};
pub use poles::{Pole, Poles, poles};
pub use record::read_record;
pub use run::{
    Incomplete, Options, Run, extent, incomplete, is_over_frequency, parameters, places,
    record_value, rtol_of, run, run_again, setup, within_bounds,
};
pub use run_error::RunError;
pub use sampled::{Clocked, Sampled};
pub use state_space::{SampleTimes, StateSpace, StateSpaceSignal, state_space};
pub use stepped::{Level, SteppedOutput, SteppedPoint, Steps, stepped_response};
pub use swept::{Swept, swept_response};
