//! The promises of the project as numbers that can be measured: one small file a promise.

mod backends;
mod batches;
mod bench;
mod c_step;
mod cases;
mod clif_growth;
mod clock;
mod command_line;
mod command_start;
mod compile;
mod csv_reading;
mod demo;
mod designed_record;
mod diagnosis;
mod differential;
mod emps;
mod emps_diagnosis;
mod energy;
mod event_suite;
mod events;
mod fixtures;
mod fmu;
mod gradient;
mod ivp;
mod ledger;
mod linear;
mod live;
mod long_run;
mod lsp;
mod lsp_fuzz;
mod mode_error;
mod msl;
mod paper_rows;
mod process;
mod promise;
mod python;
mod random_fmus;
mod realtime;
mod residual_cost;
mod selftest;
mod start;
mod stick;
mod three_effects;
mod thresholds;
mod traces;
mod travelling_nut;
mod two_mass;

pub use csv_reading::read_record;
pub(crate) use diagnosis::is_right;
pub(crate) use process::cpu_s;
pub use promise::{Figure, Measured, Promise, Session};
pub use selftest::record;
pub use start::{START, first_step};

/// Every figure, in the order printed.
pub const FIGURES: &[Figure] = &[
    clif_growth::FIGURE,
    residual_cost::FIGURE,
    c_step::FIGURE,
    start::FIGURE,
    command_start::FIGURE,
    command_line::LINES,
    command_line::PARSES,
    stick::FIGURE,
    emps::FORCE,
    emps::VELOCITY,
    emps::POSITION,
    emps_diagnosis::BEFORE,
    emps_diagnosis::DIAGNOSED,
    emps_diagnosis::AFTER,
    bench::TABLE,
    bench::TACHO,
    bench::ANGLE,
    two_mass::MOTOR,
    two_mass::LOAD,
    two_mass::MOTOR_WITHOUT_DELAY,
    two_mass::LOAD_WITHOUT_DELAY,
    energy::FIGURE,
    backends::FIGURE,
    differential::FIGURE,
    msl::FIGURE,
    paper_rows::FIGURE,
    mode_error::FIGURE,
    linear::AGAINST_RUN,
    linear::POLES,
    realtime::FIGURE,
    ivp::PROBLEMS,
    ivp::MIN_DIGITS,
    compile::Y_AXIS,
    compile::GROWTH,
    compile::CHAIN,
    compile::CARS,
    fixtures::FIGURE,
    cases::FIGURE,
    demo::FIGURE,
    traces::LAYOUTS,
    traces::MUTATED,
    csv_reading::RATE,
    csv_reading::MEMORY,
    csv_reading::OVER_POLARS,
    event_suite::FIGURE,
    events::P2,
    events::P3,
    travelling_nut::DRIFT,
    travelling_nut::RIPPLE,
    travelling_nut::OVER_FIXED,
    ledger::FIGURE,
    ledger::OPEN,
    batches::OVERHEAD,
    batches::TWO_CORES,
    batches::KILLS,
    batches::SLURM,
    batches::MEMORY,
    long_run::MEMORY,
    long_run::CSV,
    gradient::FIGURE,
    fmu::DEVIATION,
    fmu::EVENTS,
    fmu::EXPORT,
    random_fmus::FAILED,
    random_fmus::LEAKS,
    live::SLIDER,
    python::SWEEP,
    python::RUN,
    lsp::SYNTAX,
    lsp::FULL,
    lsp::COMPLETION,
    lsp::HOVER,
    lsp::MEMORY,
    lsp_fuzz::FINDINGS,
    selftest::FALSE_ALARMS,
    selftest::TOP1,
    selftest::FALSE_ALARMS_RACK,
    selftest::TOP1_RACK,
    selftest::FALSE_ALARMS_LINEAR,
    selftest::TOP1_LINEAR,
    selftest::WITHHELD,
    selftest::HOLDS_ZERO,
    selftest::COVERAGE,
    designed_record::FIGURE,
    diagnosis::RIGHT,
    diagnosis::CHI,
    diagnosis::WINDOWS,
    diagnosis::FREE_RUN,
    diagnosis::MINUTES,
    three_effects::FIGURE,
    thresholds::FIGURE,
];
