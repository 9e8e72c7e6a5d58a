//! Measured frequency responses: read from a record over frequency, or estimated from a periodic record over time; and how
//! far a model is from them.

use crate::compare::{CompareError, uneven};
use hyde_program::{MeasuredResponse, Program, RecordedResponse, ScaledColumn};
use hyde_signal::Table;
use hyde_signal::spectrum::{Complex, PeriodicResponse, period, periodic_response};
use hyde_sim::Results;
use std::collections::BTreeMap;

/// A measured frequency response; what is known of its noise has the length of the frequencies or none.
#[derive(Clone, Debug)]
pub struct MeasuredCurve {
    /// Frequencies in Hz, rising.
    pub frequency_hz: Vec<f64>,
    /// Output over input, SI.
    pub response: Vec<Complex<f64>>,
    /// Standard deviation of the response.
    pub deviation: Vec<f64>,
    /// Coherence of the spectra of the periods, 0 to 1.
    pub coherence: Vec<f64>,
    /// Amplitude of the input at each line.
    pub input: Vec<f64>,
    /// Periods averaged, and the time of one in s; none of a record over frequency.
    pub periods: Option<(usize, f64)>,
}

impl MeasuredCurve {
    /// 100 times the root mean square over the lines of `|model - measured|/|measured|`.
    #[must_use]
    pub fn error_percent(&self, model: &[Complex<f64>]) -> f64 {
        let pairs = model.iter().zip(&self.response);
        percent(pairs.map(|(model, measured)| (model - measured).norm() / measured.norm()))
    }

    /// The same of the noise: the root mean square of standard deviation over magnitude; `None` if it is not known.
    #[must_use]
    pub fn noise_percent(&self) -> Option<f64> {
        let pairs = self.deviation.iter().zip(&self.response);
        let noise = percent(pairs.map(|(deviation, measured)| deviation / measured.norm()));
        noise.is_finite().then_some(noise)
    }

    /// 100 times the norm of model minus measured over that of measured, over a period in time with these lines alone; `None`
    /// for a record over frequency, which does not tell the input.
    #[must_use]
    pub fn time_error_percent(&self, model: &[Complex<f64>]) -> Option<f64> {
        let lines = model.iter().zip(&self.response).zip(&self.input);
        // By Parseval: each line weighs with the square of its amplitude.
        let squares = lines.map(|((model, measured), input)| {
            let power = input * input;
            (
                (model - measured).norm_sqr() * power,
                measured.norm_sqr() * power,
            )
        });
        let (rest, whole) = squares.fold((0.0, 0.0), |sum, next| (sum.0 + next.0, sum.1 + next.1));
        (!self.input.is_empty()).then(|| 100.0 * (rest / whole).sqrt())
    }

    /// The lines from one frequency in Hz to another, both included.
    #[must_use]
    pub fn between(mut self, low_hz: f64, high_hz: f64) -> Self {
        let first = self.frequency_hz.partition_point(|&f| f < low_hz);
        let end = self.frequency_hz.partition_point(|&f| f <= high_hz);
        let range = first..end.max(first);
        self.frequency_hz = self.frequency_hz[range.clone()].to_vec();
        self.response = self.response[range.clone()].to_vec();
        for list in [&mut self.deviation, &mut self.coherence, &mut self.input] {
            *list = list.get(range.clone()).unwrap_or_default().to_vec();
        }
        self
    }
}

fn percent(errors: impl Iterator<Item = f64>) -> f64 {
    100.0 * hyde_signal::statistics::rms(&errors.collect::<Vec<f64>>())
}

/// The measured response. Of a record over time the rows `skip_s` behind the first one count, as many whole periods as there are.
///
/// # Errors
/// A column is missing, frequencies are not rising and positive, rows are uneven, or nothing repeats.
pub fn measured_curve(
    measured: &MeasuredResponse,
    records: &BTreeMap<String, Table>,
    skip_s: f64,
) -> Result<MeasuredCurve, CompareError> {
    let error = |cause: String| CompareError {
        channel: measured.name.clone(),
        cause,
    };
    let mut curve = match &measured.source {
        RecordedResponse::Complex(re, im) => over_frequency(re, im, records, Complex::new),
        RecordedResponse::Polar(gain, phase) => {
            over_frequency(gain, phase, records, Complex::from_polar)
        }
        RecordedResponse::Periodic(input, output, declared) => {
            over_time(input, output, *declared, records, skip_s)
        }
    }
    .map_err(error)?;
    if let Some(deviation) = &measured.deviation {
        let values = column(deviation, records).map_err(error)?;
        if values.len() != curve.frequency_hz.len() {
            return Err(error("its noise is in another record".to_owned()));
        }
        curve.deviation = values;
    }
    Ok(curve)
}

fn column(scaled: &ScaledColumn, records: &BTreeMap<String, Table>) -> Result<Vec<f64>, String> {
    let values = table(scaled, records)?
        .column(&scaled.column)
        .ok_or("its record has no such column")?
        .values();
    Ok(values.iter().map(|value| value * scaled.scale).collect())
}

fn table<'a>(
    scaled: &ScaledColumn,
    records: &'a BTreeMap<String, Table>,
) -> Result<&'a Table, String> {
    let table = records.get(&scaled.record);
    Ok(table
        .ok_or("its record is missing")?
        .holding(&scaled.column))
}

fn over_frequency(
    a: &ScaledColumn,
    b: &ScaledColumn,
    records: &BTreeMap<String, Table>,
    number: fn(f64, f64) -> Complex<f64>,
) -> Result<MeasuredCurve, String> {
    let frequency_hz = table(a, records)?.time().to_vec();
    let rising = frequency_hz.windows(2).all(|pair| pair[0] < pair[1]);
    if !rising || frequency_hz.first().is_none_or(|first| *first <= 0.0) {
        return Err("the first column of its record is not an increasing frequency".to_owned());
    }
    let (a, b) = (column(a, records)?, column(b, records)?);
    let pairs = a.into_iter().zip(b);
    Ok(MeasuredCurve {
        frequency_hz,
        response: pairs.map(|(a, b)| number(a, b)).collect(),
        deviation: vec![],
        coherence: vec![],
        input: vec![],
        periods: None,
    })
}

fn over_time(
    input: &ScaledColumn,
    output: &ScaledColumn,
    declared: Option<f64>,
    records: &BTreeMap<String, Table>,
    skip_s: f64,
) -> Result<MeasuredCurve, String> {
    let table = table(input, records)?;
    let rows = Rows::of(table, skip_s)?;
    let (u, y) = (column(input, records)?, column(output, records)?);
    let (u, y) = (&u[rows.first..], &y[rows.first..]);
    let samples = rows.period(u, declared)?;
    let found = periodic_response(u, y, rows.rate_hz, samples).map_err(|e| e.to_string())?;
    let lines = &found.response.frequency_hz;
    if lines.is_empty() {
        return Err("its input is constant".to_owned());
    }
    Ok(rows.curve(found, samples))
}

/// The even rows of a record from some time on.
struct Rows {
    first: usize,
    rate_hz: f64,
}

impl Rows {
    fn of(table: &Table, skip_s: f64) -> Result<Self, String> {
        let step_s = table
            .period()
            .or_else(|| table.mean_step())
            .ok_or("its record has only one sample")?;
        let time = table.time();
        if time
            .windows(2)
            .any(|pair| (pair[1] - pair[0] - step_s).abs() > 0.1 * step_s)
        {
            return Err(uneven(table, "spectra need"));
        }
        Ok(Self {
            // A row at that very time counts, however its number is rounded.
            first: time.partition_point(|t| *t < time[0] + skip_s - 1e-3 * step_s),
            rate_hz: 1.0 / step_s,
        })
    }

    /// Samples in a period: as declared, else as found.
    fn period(&self, input: &[f64], declared: Option<f64>) -> Result<usize, String> {
        let Some(time_s) = declared else {
            return period(input).ok_or_else(|| {
                "no period was found in its input: the record needs two whole periods after the skipped part; or give the period, `response(file.u, file.y, 1 [s])`".to_owned()
            });
        };
        let samples = time_s * self.rate_hz;
        let whole = samples.round();
        // The clock of a record may be off by a part in ten thousand.
        if whole < 4.0 || (samples - whole).abs() > 1e-4 * whole {
            return Err(format!(
                "{} s are {} of its rows, and a period is a whole number of them, 4 at least",
                hyde_units::significant(time_s, 6),
                hyde_units::significant(samples, 6)
            ));
        }
        if whole > input.len() as f64 {
            return Err("after the skipped part its record is shorter than a period".to_owned());
        }
        Ok(whole as usize)
    }

    fn curve(&self, found: PeriodicResponse, samples: usize) -> MeasuredCurve {
        MeasuredCurve {
            frequency_hz: found.response.frequency_hz,
            response: found.response.response,
            deviation: found.deviation,
            coherence: found.response.coherence,
            input: found.input,
            periods: Some((found.periods, samples as f64 / self.rate_hz)),
        }
    }
}

/// The response of a run at the same lines as a measured one over time, estimated in the same way from its values at the
/// rows of the record; `None` for a record over frequency, or where the run ended earlier or did not keep the input.
#[must_use]
pub fn curve_of_run(
    program: &Program,
    measured: &MeasuredResponse,
    records: &BTreeMap<String, Table>,
    results: &Results,
    skip_s: f64,
) -> Option<MeasuredCurve> {
    let RecordedResponse::Periodic(input, _, declared) = &measured.source else {
        return None;
    };
    let table = table(input, records).ok()?;
    let rows = Rows::of(table, skip_s).ok()?;
    let recorded = column(input, records).ok()?;
    let samples = rows.period(&recorded[rows.first..], *declared).ok()?;
    let bode = program.experiment.bodes.get(measured.place.0)?;
    let (_, output) = bode.outputs.get(measured.place.1)?;
    let (u, y) = (
        results.column(bode.input_output?)?,
        results.column(*output)?,
    );
    let instants = table.time()[rows.first..].iter();
    let at: Vec<usize> = instants
        .map(|t| results.rows_at(*t).map(|(left, _)| left))
        .collect::<Option<_>>()?;
    let pick = |values: &[f64]| at.iter().map(|&row| values[row]).collect::<Vec<f64>>();
    let found = periodic_response(&pick(&u), &pick(&y), rows.rate_hz, samples).ok()?;
    Some(rows.curve(found, samples))
}
