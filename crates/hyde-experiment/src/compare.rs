//! Measured channels against the model: the record prepared as the experiment says, the model at the record's rows.
//!
//! A continuous quantity is compared as it is before a tick at that instant, a clocked one as it is after (C4). One that begins
//! again, as an angle after a turn, is compared modulo that.

use hyde_program::{Constant, Measured, Preparation, Program};
use hyde_signal::filter::{LowPass, central_difference};
use hyde_signal::{Table, statistics, wrap};
use hyde_sim::Results;
use hyde_units::{NamedUnit, engineering_difference};
use std::collections::BTreeMap;

/// A measured channel with its error.
#[derive(Clone, Debug)]
pub struct Channel {
    /// Its name.
    pub name: String,
    /// Unit for printing; everything here is SI.
    pub unit: NamedUnit,
    /// Times of the rows compared in s.
    pub time: Vec<f64>,
    /// What was measured, prepared.
    pub measured: Vec<f64>,
    /// What the model has.
    pub simulated: Vec<f64>,
    /// Its derivatives by each parameter of the run's gradient.
    pub slopes: Vec<Vec<f64>>,
    /// Root mean square of the difference.
    pub rms: f64,
    /// 100 times the norm of the difference over that of the measured signal.
    pub relative_percent: f64,
    /// Standard deviation of the channel's noise, if it is declared.
    pub noise: Option<f64>,
}

/// Why a channel cannot be compared.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CompareError {
    /// The channel.
    pub channel: String,
    /// What is wrong.
    pub cause: String,
}

/// Compares every measured channel, rows before `from_s` apart.
pub(crate) fn channels(
    program: &Program,
    records: &BTreeMap<String, Table>,
    parameters: &[f64],
    results: &Results,
    from_s: f64,
) -> Result<Vec<Channel>, CompareError> {
    let mut found = Vec::new();
    for (number, measured) in program.experiment.measured.iter().enumerate() {
        let error = |cause: &str| CompareError {
            channel: measured.name.clone(),
            cause: cause.to_owned(),
        };
        let noise = program
            .kernels
            .constant(Constant::Noise(number), parameters);
        if let Some(negative) = noise.filter(|noise| *noise < 0.0) {
            return Err(error(&format!(
                "its noise is {}, and a standard deviation is not negative: write it without the sign",
                engineering_difference(negative, &measured.unit)
            )));
        }
        let (record, column) = &measured.source;
        let table = records
            .get(record)
            .ok_or_else(|| error("its record is missing"))?
            .reading(column);
        let column = table
            .column(column)
            .ok_or_else(|| error("its record has no such column"))?;
        let period = program.kernels.constant(Constant::Wrap(number), parameters);
        let values = unwrapped(measured, column.values(), period);
        let signal = prepared(measured, table, &values).map_err(|cause| error(&cause))?;
        let simulated = results
            .column(measured.output)
            .ok_or_else(|| error("the run did not keep it"))?;
        let (mut time, mut of_record, mut of_model) = (Vec::new(), Vec::new(), Vec::new());
        let by_parameter = slopes(results, measured.output);
        let mut slopes = vec![Vec::new(); by_parameter.len()];
        for (&t, &value) in table.time().iter().zip(&signal) {
            if t < from_s - 1e-12 {
                continue;
            }
            let Some((left, right)) = results.rows_at(t) else {
                continue;
            };
            time.push(t);
            let row = if measured.clocked { right } else { left };
            of_model.push(simulated[row]);
            of_record.push(match period {
                Some(period) => simulated[row] + wrap::nearest(value - simulated[row], period),
                None => value,
            });
            for (slopes, column) in slopes.iter_mut().zip(&by_parameter) {
                slopes.push(column[row]);
            }
        }
        if time.is_empty() {
            return Err(error("no sample of the record lies within the run"));
        }
        let difference: Vec<f64> = of_record
            .iter()
            .zip(&of_model)
            .map(|(a, b)| a - b)
            .collect();
        found.push(Channel {
            name: measured.name.clone(),
            unit: measured.unit.clone(),
            rms: statistics::rms(&difference),
            relative_percent: statistics::relative_error_percent(&of_record, &of_model),
            noise,
            time,
            measured: of_record,
            simulated: of_model,
            slopes,
        });
    }
    Ok(found)
}

/// The derivatives of an output's rows, one column a parameter of the gradient.
fn slopes(results: &Results, output: usize) -> Vec<&[f64]> {
    match (&results.gradient, results.outputs.binary_search(&output)) {
        (Some(gradient), Ok(kept)) => {
            let columns = gradient.columns.iter();
            columns.map(|columns| columns[kept].as_slice()).collect()
        }
        (Some(_), Err(_)) | (None, _) => Vec::new(),
    }
}

/// A column that begins again after a period (of what is made of it) made to go on.
#[must_use]
pub fn unwrapped(measured: &Measured, values: &[f64], period: Option<f64>) -> Vec<f64> {
    let mut values = values.to_vec();
    let scales = measured.preparation.iter().map(|step| match step {
        Preparation::Scale(factor) => *factor,
        Preparation::Lowpass(_) | Preparation::Slope => 1.0,
    });
    if let Some(period) = period {
        wrap::unwrap(&mut values, period / scales.product::<f64>());
    }
    values
}

pub(crate) fn uneven(table: &Table, what: &str) -> String {
    let steps = table.time().windows(2).map(|pair| pair[1] - pair[0]);
    let (least, most) = steps.fold((f64::INFINITY, 0.0_f64), |(least, most), step| {
        (least.min(step), most.max(step))
    });
    let shown = |step| hyde_units::significant(step, 3);
    format!(
        "its rows are {} to {} s apart, and {what} even ones: resample the record. Declare `every` only if the samples are even and \
         their times are wrong: it puts each row one period after the row before it",
        shown(least),
        shown(most)
    )
}

/// A column low-passed, differentiated and scaled as the experiment says.
///
/// # Errors
/// What the column lacks for it.
pub fn prepared(measured: &Measured, table: &Table, values: &[f64]) -> Result<Vec<f64>, String> {
    let mut signal = values.to_vec();
    for step in &measured.preparation {
        let step_s = table
            .period()
            .or_else(|| table.mean_step())
            .ok_or("its record has only one sample")?;
        // A drifting clock is no harm, a gap is.
        let even = table
            .time()
            .windows(2)
            .all(|pair| (pair[1] - pair[0] - step_s).abs() <= 0.1 * step_s);
        match *step {
            Preparation::Lowpass(_) if !even => {
                return Err(uneven(table, "`lowpass` and `slope` need"));
            }
            Preparation::Lowpass(corner) => {
                let filter = LowPass::butterworth(4, corner, 1.0 / step_s)
                    .map_err(|error| error.to_string())?;
                signal = filter
                    .zero_phase(&signal)
                    .map_err(|error| error.to_string())?;
            }
            Preparation::Slope if !even => return Err(uneven(table, "`lowpass` and `slope` need")),
            Preparation::Slope => signal = central_difference(&signal, step_s),
            Preparation::Scale(factor) => signal.iter_mut().for_each(|value| *value *= factor),
        }
    }
    Ok(signal)
}
