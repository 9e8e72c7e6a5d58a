//! A run of an experiment: settings, tolerances and rows from the experiment and the command line, then the solution, then
//! what it is compared with.

use crate::compare::{self, Channel};
use crate::driven_kinds::check_columns;
use crate::measures::{MeasureValue, measures};
use crate::run_error::RunError;
use hyde_program::{Column, Constant, Measured, Parameter, Program, RecordValue, RecordedResponse};
use hyde_signal::Table;
use hyde_sim::{Failure, Reached, Results, Setup};
use hyde_units::Allowed;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// The absolute tolerance as a part of the relative one, where it is not said.
const ATOL: f64 = 1e-2;

/// What the caller sets beside the experiment.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// Values of parameters by name, SI.
    pub set: Vec<(String, f64)>,
    /// End of the run in s.
    pub stop_s: Option<f64>,
    /// Relative tolerance.
    pub rtol: Option<f64>,
    /// Absolute tolerance, SI.
    pub atol: Option<f64>,
    /// Time between rows of the results in s.
    pub every_s: Option<f64>,
    /// From when on the run counts for measures, in s; all of it if not said.
    pub measured_from_s: Option<f64>,
    /// Names of the parameters by which the run is differentiated; without any there is no gradient.
    pub gradient: Vec<String>,
    /// Set from outside to end the run after the step under way.
    pub interrupted: Arc<AtomicBool>,
    /// How far the run is, for another thread to show.
    pub reached: Arc<Reached>,
}

/// A run, finished or not.
#[derive(Clone, Debug)]
pub struct Run {
    /// The parameter vector used.
    pub parameters: Vec<f64>,
    /// Start in s, and the record that begins there; none where the experiment says so or nothing is recorded.
    pub start: (f64, Option<String>),
    /// Stop in s.
    pub stop_s: f64,
    /// Relative and absolute tolerance.
    pub tolerances: (f64, f64),
    /// The solution.
    pub results: Results,
    /// Measured channels against the model.
    pub channels: Vec<Channel>,
    /// Measures and expectations.
    pub measures: Vec<MeasureValue>,
    /// Why the results end before the stop, if they do. Such a run has neither channels nor measures.
    pub incomplete: Option<Incomplete>,
}

/// Why a run ended before its stop.
#[derive(Clone, Debug)]
pub struct Incomplete {
    /// The time in s that it reached.
    pub reached_s: f64,
    /// What happened.
    pub reason: String,
}

/// How long runs last, in s: instants are located to 1e-12 s and 1e-12 of the time, and rounding reaches up to 1e-9.
const LASTS_S: RangeInclusive<f64> = 1e-6..=1e12;
/// Rows of the results at most, and numbers in all of them (3 GB).
const MOST_ROWS: f64 = 2e7;
const MOST_NUMBERS: f64 = 4e8;

/// Runs a program as its experiment says.
///
/// # Errors
/// See [`RunError`]; a failure carries the results up to it.
pub fn run(
    program: &Program,
    records: &BTreeMap<String, Table>,
    options: &Options,
) -> Result<Run, RunError> {
    let setup = setup(program, records, options)?;
    solved(program, records, options, setup)
}

/// The same for values that were set after the model was compiled: they are held against the bounds of their parameters. Only
/// the outputs that `keep` numbers are made, all of them if there is none; channels are compared only then.
///
/// # Errors
/// As for [`run`], and [`RunError::NotAllowed`].
pub fn run_again(
    program: &Program,
    records: &BTreeMap<String, Table>,
    options: &Options,
    keep: Option<Vec<usize>>,
) -> Result<Run, RunError> {
    let mut setup = setup(program, records, options)?;
    within_bounds(program, &setup.parameters)?;
    setup.keep = keep;
    solved(program, records, options, setup)
}

fn solved(
    program: &Program,
    records: &BTreeMap<String, Table>,
    options: &Options,
    setup: Setup<'_>,
) -> Result<Run, RunError> {
    let places = places(program, &options.gradient)?;
    let mut setup: Setup<'_> = setup;
    let start = start(program, records, &setup.parameters);
    setup.sensitivities = (!places.is_empty()).then_some(places.as_slice());
    let results = hyde_sim::simulate(program, &setup).map_err(RunError::Failed)?;
    let skip_s = program
        .kernels
        .constant(Constant::Skip, &setup.parameters)
        .unwrap_or(0.0);
    let from_s = setup.start_s + skip_s;
    let channels = match setup.keep {
        Some(_) => Vec::new(),
        None => compare::channels(program, records, &setup.parameters, &results, from_s)
            .map_err(RunError::Compare)?,
    };
    let measures = measures(program, &results.parameters, &results);
    Ok(Run {
        start,
        stop_s: setup.stop_s,
        tolerances: (setup.rtol, setup.atol),
        parameters: results.parameters.clone(),
        results,
        channels,
        measures,
        incomplete: None,
    })
}

/// What there is of a run that failed or was interrupted.
///
/// # Errors
/// As for [`run`].
pub fn incomplete(
    program: &Program,
    records: &BTreeMap<String, Table>,
    options: &Options,
    failure: &Failure,
    reason: String,
) -> Result<Run, RunError> {
    let setup = setup(program, records, options)?;
    Ok(Run {
        start: start(program, records, &setup.parameters),
        stop_s: setup.stop_s,
        tolerances: (setup.rtol, setup.atol),
        parameters: setup.parameters,
        results: failure.results.clone(),
        channels: Vec::new(),
        measures: Vec::new(),
        incomplete: Some(Incomplete {
            reached_s: failure.t,
            reason,
        }),
    })
}

/// Whether every parameter is within its bounds, also those that are computed from others.
///
/// # Errors
/// [`RunError::NotAllowed`] of the first that is not.
pub fn within_bounds(program: &Program, parameters: &[f64]) -> Result<(), RunError> {
    for parameter in &program.parameters {
        let Allowed { min, max, .. } = parameter.allowed;
        let bounds = Allowed {
            min,
            max,
            ..Allowed::default()
        };
        for &value in &parameters[parameter.place..parameter.place + parameter.len] {
            if let Some(refusal) = bounds.refusal(value, &parameter.unit) {
                return Err(RunError::NotAllowed(parameter.name.clone(), refusal));
            }
        }
    }
    Ok(())
}

/// What a run is told: parameters, times and tolerances of the experiment, or of the caller where those are given.
///
/// # Errors
/// As for [`run`], before it starts.
pub fn setup<'r>(
    program: &Program,
    records: &'r BTreeMap<String, Table>,
    options: &Options,
) -> Result<Setup<'r>, RunError> {
    let parameters = parameters(program, records, &options.set)?;
    let constant = |which| program.kernels.constant(which, &parameters);
    let stop = options.stop_s.or_else(|| constant(Constant::Stop));
    let stop_s = stop.ok_or(RunError::NoStop)?;
    let (start_s, record) = start(program, records, &parameters);
    if start_s.is_nan() || stop_s.is_nan() || stop_s <= start_s {
        return Err(RunError::EndsBeforeStart {
            start_s,
            stop_s,
            record,
        });
    }
    if stop_s.is_infinite() {
        return Err(RunError::NotPositive("stop", stop_s));
    }
    if !LASTS_S.contains(&(stop_s - start_s)) {
        return Err(RunError::Lasts(stop_s - start_s));
    }
    let every = options
        .every_s
        .or_else(|| constant(Constant::Every))
        .unwrap_or((stop_s - start_s) / 1000.0);
    let atol = constant(Constant::Atol);
    let mut setup = setup_with(program, records, parameters);
    setup.stop_s = stop_s;
    setup.interrupted = Arc::clone(&options.interrupted);
    setup.reached = Arc::clone(&options.reached);
    if let Some(rtol) = options.rtol {
        (setup.rtol, setup.atol) = (rtol, atol.unwrap_or(ATOL * rtol));
    }
    if let Some(atol) = options.atol {
        setup.atol = atol;
    }
    for (what, value) in [
        ("rtol", setup.rtol),
        ("atol", setup.atol),
        ("the time between rows", every),
        ("max_step", setup.max_step_s),
    ] {
        let endless = value.is_infinite() && what != "max_step";
        if value.is_nan() || value <= 0.0 || endless {
            return Err(RunError::NotPositive(what, value));
        }
    }
    let (count, columns) = ((stop_s - start_s) / every, program.outputs.len() + 1);
    let most = MOST_ROWS.min(MOST_NUMBERS / columns as f64);
    if count > most {
        return Err(RunError::TooManyRows {
            rows: count,
            columns,
            least_s: (stop_s - start_s) / most,
        });
    }
    setup.rows_s = rows(program, records, (start_s, stop_s), every);
    setup.reductions.clone_from(&program.experiment.reductions);
    setup.reduced_from_s = options.measured_from_s.unwrap_or(f64::NEG_INFINITY);
    Ok(setup)
}

/// A run with complete parameters from its start on, with the method and the tolerances that its experiment says.
pub(crate) fn setup_with<'r>(
    program: &Program,
    records: &'r BTreeMap<String, Table>,
    parameters: Vec<f64>,
) -> Setup<'r> {
    let constant = |which| program.kernels.constant(which, &parameters);
    let rtol = rtol_of(program, &parameters);
    let atol = constant(Constant::Atol).unwrap_or(ATOL * rtol);
    let max_step_s = constant(Constant::MaxStep).unwrap_or(f64::INFINITY);
    let ((start_s, _), stop_s) = extent(program, records, &parameters);
    let mut setup = Setup::new(parameters, records, stop_s);
    setup.start_s = start_s;
    setup.method = program.experiment.method;
    setup.conserve = program.experiment.conserve;
    (setup.rtol, setup.atol) = (rtol, atol);
    setup.max_step_s = max_step_s;
    setup
}

/// The relative tolerance of runs of a program with complete parameters, if no option says another one.
#[must_use]
pub fn rtol_of(program: &Program, parameters: &[f64]) -> f64 {
    let own = program.kernels.constant(Constant::Rtol, parameters);
    own.unwrap_or(1e-6)
}

/// When a run starts, with the record that begins there if that is why, and when it ends; in s.
#[must_use]
pub fn extent(
    program: &Program,
    records: &BTreeMap<String, Table>,
    parameters: &[f64],
) -> ((f64, Option<String>), f64) {
    let start = start(program, records, parameters);
    let stop_s = program.kernels.constant(Constant::Stop, parameters);
    let stop_s = stop_s.filter(|stop| *stop > start.0);
    let stop_s = stop_s.unwrap_or(start.0 + 1.0);
    (start, stop_s)
}

/// Whether a record is a measured frequency response: its first column is the frequency, not the time.
#[must_use]
pub fn is_over_frequency(program: &Program, record: &str) -> bool {
    let mut responses = program.experiment.measured_responses.iter();
    responses.any(|response| match &response.source {
        RecordedResponse::Complex(of, _) | RecordedResponse::Polar(of, _) => of.record == record,
        RecordedResponse::Periodic(..) => false,
    })
}

/// When a run starts in s: as the experiment says, else where the last of the records begins that drive the model, else where
/// the first begins that it is compared with, else at 0. With it the record that begins there.
fn start(
    program: &Program,
    records: &BTreeMap<String, Table>,
    parameters: &[f64],
) -> (f64, Option<String>) {
    if let Some(start_s) = program.kernels.constant(Constant::Start, parameters) {
        return (start_s, None);
    }
    let measured = &program.experiment.measured;
    let is_measured = |column: &Column| {
        let own = |m: &Measured| m.source.0 == column.record && m.source.1 == column.column;
        measured.iter().any(own)
    };
    let begin = |record: &String| {
        let table = records
            .get(record)
            .filter(|_| !is_over_frequency(program, record))?;
        Some((*table.time().first()?, record.clone()))
    };
    let driving = program.columns.iter();
    let driving = driving.filter(|column| column.continuous || !is_measured(column));
    let driving = driving.filter_map(|column| begin(&column.record));
    let compared = || measured.iter().filter_map(|m| begin(&m.source.0));
    let later = |a: (f64, String), b: (f64, String)| if b.0 > a.0 { b } else { a };
    let earlier = |a: (f64, String), b: (f64, String)| if b.0 < a.0 { b } else { a };
    let found = driving.reduce(later).or_else(|| compared().reduce(earlier));
    found.map_or((0.0, None), |(start_s, record)| (start_s, Some(record)))
}

/// Positions in the parameter vector of the parameters that a run is to be differentiated by.
///
/// # Errors
/// A name that is no parameter, or one of which there is no gradient.
pub fn places(program: &Program, names: &[String]) -> Result<Vec<usize>, RunError> {
    let place = |name: &String| {
        let Some((parameter, element)) = program.parameter(name) else {
            return Err(RunError::NoParameter(name.clone()));
        };
        if parameter.structural {
            let why = "the equations are compiled with its value";
            return Err(RunError::NoGradientBy(name.clone(), why));
        }
        if parameter.is_whole(name) {
            let why = "it is an array: name one of its elements";
            return Err(RunError::NoGradientBy(name.clone(), why));
        }
        Ok(parameter.place + element)
    };
    names.iter().map(place).collect()
}

/// The parameter vector with some values set and those that a record gives.
///
/// # Errors
/// A name that is no parameter, or one that may not be set here.
pub fn parameters(
    program: &Program,
    records: &BTreeMap<String, Table>,
    set: &[(String, f64)],
) -> Result<Vec<f64>, RunError> {
    let mut values = Vec::new();
    for known in &program.record_values {
        let table = records.get(&known.record);
        if let Some(value) = table.and_then(|table| record_value(known, table)) {
            values.push((known.place, value));
        }
    }
    for (name, value) in set {
        let Some((parameter, element)) = program.parameter(name) else {
            return Err(RunError::NoParameter(name.clone()));
        };
        if parameter.is_whole(name) {
            let why = "it is an array: set its elements, `name[1]` and so on";
            return Err(RunError::CannotSet(name.clone(), why));
        }
        let Parameter {
            is_final,
            found,
            structural,
            place,
            ..
        } = *parameter;
        if found {
            let why = "an initial equation determines it: `fixed = false`";
            return Err(RunError::CannotSet(name.clone(), why));
        }
        if is_final {
            return Err(RunError::CannotSet(name.clone(), "it is final"));
        }
        // Structural values are in the equations already: setting them here would change one half of the model.
        if !structural {
            values.push((place + element, *value));
        }
    }
    check_columns(program, records).map_err(RunError::Row)?;
    let mut parameters = vec![0.0; program.n_parameters];
    program.kernels.parameters(&values, &mut parameters);
    Ok(parameters)
}

/// The number that a parameter takes from its record, unless the record has no such column.
#[must_use]
pub fn record_value(known: &RecordValue, record: &Table) -> Option<f64> {
    let rows = match &known.column {
        Some(column) => record.column(column)?.values(),
        None => record.time(),
    };
    Some(known.kind.of(rows))
}

/// Rows every so often, and at every row of a record that something is measured in.
fn rows(
    program: &Program,
    records: &BTreeMap<String, Table>,
    (start_s, stop_s): (f64, f64),
    every_s: f64,
) -> Vec<f64> {
    let mut rows = Setup::rows_every(start_s, stop_s, every_s);
    let experiment = &program.experiment;
    let compared = experiment
        .measured
        .iter()
        .map(|m| (&m.source.0, &m.source.1));
    let responses = experiment.measured_responses.iter();
    let periodic = responses.filter_map(|m| match &m.source {
        RecordedResponse::Periodic(input, ..) => Some((&input.record, &input.column)),
        RecordedResponse::Complex(..) | RecordedResponse::Polar(..) => None,
    });
    for (record, column) in compared.chain(periodic) {
        if let Some(table) = records.get(record) {
            rows.extend(
                table
                    .reading(column)
                    .time()
                    .iter()
                    .copied()
                    .filter(|t| (start_s..=stop_s).contains(t)),
            );
        }
    }
    rows.sort_by(f64::total_cmp);
    rows.dedup_by(|later, earlier| (*later - *earlier).abs() <= 1e-12 + 1e-13 * later.abs());
    rows
}
