//! [`simulated`]: the records that an axis would leave: the exact run of its experiment with the loop closed, and what the
//! declared sensors make of it.
//!
//! Each measured channel gets white noise of its declared deviation, then its rounding. What a clock has counted, and what
//! is replayed, the axis knows exactly. A column that is prepared (`lowpass`, a factor) is recorded before that.

use super::case::Fault;
use super::random::Random;
use hyde_experiment::{Options, RunError};
use hyde_program::{Constant, Measured, Preparation, Program};
use hyde_signal::{Column, Table};
use hyde_sim::Results;
use std::collections::BTreeMap;

/// A fault: far off is so many deviations, extra noise that much.
const FAR: f64 = 50.0;
const NOISY: f64 = 3.0;
/// One row in so many is far off.
const SPIKES: f64 = 1.0 / 200.0;
/// How long a value stands still, in s, and where in the record.
const FROZEN_S: f64 = 0.1;
const FROZEN_AT: [f64; 2] = [0.3, 0.6];

/// Why there are no such records.
#[derive(Clone, Debug)]
pub enum Simulated {
    /// The run failed or could not begin.
    Run(Box<RunError>),
    /// No channel tells what the column holds: record and column.
    Column(String, String),
}

/// A channel that does what none should.
#[derive(Clone, Copy, Debug)]
pub struct Faulty {
    /// Its number.
    pub channel: usize,
    /// What it does.
    pub fault: Fault,
    /// The deviation of its noise and rounding where all is well, SI. The recorded form does not tell that of a count,
    /// which is rounded before it is measured.
    pub deviation: f64,
}

/// Replaces every measured and replayed column of the records by what the axis would leave there. `program` is in the
/// recorded form; stimuli are read from `tables`.
///
/// # Errors
/// See [`Simulated`].
pub fn simulated(
    program: &Program,
    tables: &BTreeMap<String, Table>,
    options: &Options,
    faulty: Option<Faulty>,
    seed: u64,
    purpose: &str,
) -> Result<BTreeMap<String, Table>, Simulated> {
    let run =
        hyde_experiment::run(program, tables, options).map_err(|e| Simulated::Run(Box::new(e)))?;
    let mut made: BTreeMap<&(String, String), Vec<f64>> = BTreeMap::new();
    let measured = &program.experiment.measured;
    for (number, channel) in measured.iter().enumerate() {
        let Some(table) = tables.get(&channel.source.0) else {
            continue;
        };
        let table = table.reading(&channel.source.1);
        let (Some(factor), false) = (factor(channel), made.contains_key(&channel.source)) else {
            continue;
        };
        let mut random = Random::new(seed, &format!("{purpose} / channel {number}"));
        let constant = |which| {
            program
                .kernels
                .constant(which, &run.parameters)
                .unwrap_or(0.0)
        };
        let (noise, width) = (
            constant(Constant::Noise(number)),
            constant(Constant::Rounding(number)),
        );
        let faulty = faulty.filter(|faulty| faulty.channel == number);
        let mut values = rows(&run.results, channel, table);
        for value in &mut values {
            *value += noise * random.normal();
            if let Some(faulty) = faulty {
                *value += faulty.deviation * error(faulty.fault, &mut random);
            }
            if width > 0.0 {
                // No -0: it would be written as something else.
                *value = (*value / width).round() * width + 0.0;
            }
        }
        if faulty.is_some_and(|faulty| faulty.fault == Fault::Frozen) {
            freeze(&mut values, table);
        }
        values.iter_mut().for_each(|value| *value /= factor);
        made.insert(&channel.source, values);
    }
    if let Some(channel) = measured.iter().find(|m| !made.contains_key(&m.source)) {
        let (record, column) = channel.source.clone();
        return Err(Simulated::Column(record, column));
    }
    let replaced = |(name, table): (&String, &Table)| {
        let table = table.mapped(|_, column| {
            let values = made.remove(&(name.clone(), column.name().to_owned()));
            match (values, column.unit()) {
                (None, _) => column.clone(),
                (Some(values), Some(unit)) => Column::new(column.name(), unit.clone(), values),
                (Some(values), None) => Column::raw(column.name(), values),
            }
        });
        // Columns as long as before over the same time.
        table.ok().map(|table| (name.clone(), table))
    };
    Ok(tables.iter().filter_map(replaced).collect())
}

/// What a column was multiplied by to become the channel; `None` where it was differentiated.
fn factor(channel: &Measured) -> Option<f64> {
    channel
        .preparation
        .iter()
        .try_fold(1.0, |factor, step| match step {
            Preparation::Lowpass(_) => Some(factor),
            Preparation::Scale(own) => Some(factor * own),
            Preparation::Slope => None,
        })
}

/// A channel at the rows of a record: before a tick at that instant, clocked ones after it.
fn rows(results: &Results, channel: &Measured, table: &Table) -> Vec<f64> {
    let Some(column) = results.column(channel.output) else {
        return vec![f64::NAN; table.rows()];
    };
    let at = |&time: &f64| {
        results.rows_at(time).map_or(f64::NAN, |(left, right)| {
            column[if channel.clocked { right } else { left }]
        })
    };
    table.time().iter().map(at).collect()
}

/// What a fault adds to a row, in deviations.
fn error(fault: Fault, random: &mut Random) -> f64 {
    match fault {
        Fault::Noise => NOISY * random.normal(),
        Fault::Spikes if random.uniform() < SPIKES => FAR * random.sign(),
        Fault::Spikes | Fault::Frozen => 0.0,
    }
}

fn freeze(values: &mut [f64], table: &Table) {
    let step_s = table.mean_step().unwrap_or(FROZEN_S);
    let long = (FROZEN_S / step_s).round() as usize;
    for part in FROZEN_AT {
        let from = (part * values.len() as f64) as usize;
        let to = (from + long).min(values.len());
        let stands = values[from];
        values[from..to].fill(stands);
    }
}
