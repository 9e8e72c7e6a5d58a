//! Measured frequency responses beside those of the model: errors as a table, curves for the figures.

use hyde_diag::{Code, Diagnostic};
use hyde_experiment::{
    Linear, MeasuredCurve, Run, curve_of_run, frequency_response, measured_curve,
};
use hyde_program::{Constant, MeasuredResponse, Program};
use hyde_report::{BodeCurve, LineStyle};
use hyde_signal::Table;
use hyde_signal::spectrum::Complex;
use hyde_units::significant;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// A measured response, and what the model has at its lines.
pub(crate) struct Compared {
    /// Its name.
    pub(super) name: String,
    /// Number of the `bode`, and of its output.
    pub(super) place: (usize, usize),
    measured: MeasuredCurve,
    linear: Vec<Complex<f64>>,
    run: Option<MeasuredCurve>,
}

/// All measured responses of an experiment, those of a `bode` with a band within it.
pub(super) fn curves(
    program: &Program,
    tables: &BTreeMap<String, Table>,
    p: &[f64],
) -> Result<Vec<MeasuredCurve>, Box<Diagnostic>> {
    let skip_s = program.kernels.constant(Constant::Skip, p).unwrap_or(0.0);
    let of = |measured: &MeasuredResponse| {
        let curve = measured_curve(measured, tables, skip_s).map_err(|error| {
            let (name, cause) = (error.channel, error.cause);
            let message = format!("the response `{name}` cannot be compared: {cause}");
            let diagnostic = Diagnostic::error(Code::BadResponse, message);
            Box::new(diagnostic.label(measured.origin.span, "measured here"))
        })?;
        Ok(match super::response::band(program, measured.place.0, p) {
            Some((from, to)) => curve.between(from, to),
            None => curve,
        })
    };
    program
        .experiment
        .measured_responses
        .iter()
        .map(of)
        .collect()
}

/// From the lowest to the highest line measured of a `bode`.
pub(super) fn band(
    program: &Program,
    number: usize,
    curves: &[MeasuredCurve],
) -> Option<(f64, f64)> {
    let responses = &program.experiment.measured_responses;
    let own = responses
        .iter()
        .zip(curves)
        .filter(|(m, _)| m.place.0 == number);
    let ends = own
        .filter_map(|(_, curve)| Some((*curve.frequency_hz.first()?, *curve.frequency_hz.last()?)));
    ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)))
        .filter(|(from, to)| from < to)
}

/// What was measured of a `bode` beside its linearised system and the run.
pub(super) fn compared(
    program: &Program,
    number: usize,
    curves: &[MeasuredCurve],
    system: &Linear,
    tables: &BTreeMap<String, Table>,
    run: Option<(&Program, &Run)>,
) -> Vec<Compared> {
    let responses = program.experiment.measured_responses.iter().enumerate();
    let own = responses
        .zip(curves)
        .filter(|((_, m), _)| m.place.0 == number);
    own.filter_map(|((at, response), measured)| {
        let output = program.experiment.bodes[number].outputs[response.place.1].1;
        let linear = frequency_response(system, 0, &[output], &measured.frequency_hz).ok()?;
        let run = run.and_then(|(program, run)| {
            let response = program.experiment.measured_responses.get(at)?;
            let skip = program.kernels.constant(Constant::Skip, &run.parameters);
            let skip_s = skip.unwrap_or(0.0);
            let curve = curve_of_run(program, response, tables, &run.results, skip_s)?;
            let (first, last) = (
                measured.frequency_hz.first()?,
                measured.frequency_hz.last()?,
            );
            let curve = curve.between(*first, *last);
            (curve.frequency_hz == measured.frequency_hz).then_some(curve)
        });
        Some(Compared {
            name: response.name.clone(),
            place: response.place,
            measured: measured.clone(),
            linear: linear.into_iter().next()?,
            run,
        })
    })
    .collect()
}

/// The table of errors, a line a response; empty without any. What is not known of any has no column.
pub(super) fn table(all: &[Compared]) -> String {
    if all.is_empty() {
        return String::new();
    }
    let of_run = |one: &Compared| {
        let run = one.run.as_ref()?;
        Some(one.measured.error_percent(&run.response))
    };
    type Value<'a> = &'a dyn Fn(&Compared) -> Option<f64>;
    let columns: [(&str, Value<'_>); 4] = [
        ("linearised", &|one| Some(one.error_percent())),
        ("in time", &|one| {
            one.measured.time_error_percent(&one.linear)
        }),
        ("run", &of_run),
        ("noise", &|one| one.measured.noise_percent()),
    ];
    let known = columns
        .iter()
        .filter(|(_, value)| all.iter().any(|one| value(one).is_some()));
    let known: Vec<_> = known.collect();
    let mut text = format!("\n  {:<24} {:>7}", "measured - model", "lines");
    for (title, _) in &known {
        let _ = write!(text, " {title:>11}");
    }
    text.push('\n');
    for one in all {
        let lines = one.measured.frequency_hz.len();
        let mut line = format!("  {:<24} {lines:>7}", one.name);
        for (_, value) in &known {
            let percent = value(one).map(|value| format!("{} %", significant(value, 3)));
            let _ = write!(line, " {:>11}", percent.unwrap_or_default());
        }
        let _ = writeln!(text, "{}", line.trim_end());
    }
    if let Some((count, time)) = all.iter().find_map(|one| one.measured.periods) {
        let time = significant(time, 4);
        let _ = writeln!(text, "  over {count} periods of {time} s");
    }
    text
}

impl Compared {
    fn error_percent(&self) -> f64 {
        self.measured.error_percent(&self.linear)
    }

    /// Whether the run was driven by what was measured.
    pub(super) fn has_run(&self) -> bool {
        self.run.is_some()
    }

    /// Its points, and those of the run.
    pub(super) fn curves(
        &self,
        label: &dyn Fn(&str) -> String,
        colour: Option<usize>,
    ) -> Vec<BodeCurve> {
        let points = |kind: &str, curve: &MeasuredCurve, noise: bool| BodeCurve {
            label: label(kind),
            frequency: curve.frequency_hz.clone(),
            response: curve.response.iter().map(|g| (g.re, g.im)).collect(),
            style: LineStyle::Points,
            coherence: (!curve.coherence.is_empty()).then(|| curve.coherence.clone()),
            deviation: (noise && self.measured.noise_percent().is_some())
                .then(|| curve.deviation.clone()),
            colour,
        };
        let mut found = vec![points("measured", &self.measured, true)];
        found.extend(self.run.iter().map(|run| points("run", run, false)));
        found
    }

    /// The rows of the table of all curves: experiment, kind, frequency, real and imaginary part, coherence, and the amplitude
    /// of the input.
    pub(super) fn csv(&self, experiment: &str) -> String {
        let mut text = String::new();
        let mut rows = |kind: &str, curve: &MeasuredCurve| {
            for (at, (f, g)) in curve.frequency_hz.iter().zip(&curve.response).enumerate() {
                let known = |list: &[f64]| list.get(at).map(f64::to_string).unwrap_or_default();
                let (coherence, amplitude) = (known(&curve.coherence), known(&curve.input));
                let _ = writeln!(
                    text,
                    "{experiment},{kind},{f},{},{},{coherence},{amplitude},",
                    g.re, g.im
                );
            }
        };
        rows("measured", &self.measured);
        if let Some(run) = &self.run {
            rows("run", run);
        }
        text
    }

    pub(super) fn json(&self) -> Value {
        let measured = &self.measured;
        let pairs = |values: &[Complex<f64>]| -> Vec<[f64; 2]> {
            values.iter().map(|g| [g.re, g.im]).collect()
        };
        let run = self.run.as_ref();
        json!({
            "name": self.name,
            "frequency_hz": measured.frequency_hz,
            "measured": pairs(&measured.response),
            "linearised": pairs(&self.linear),
            "run": run.map(|run| pairs(&run.response)),
            "deviation": measured.deviation,
            "coherence": measured.coherence,
            "error_percent": self.error_percent(),
            "time_error_percent": measured.time_error_percent(&self.linear),
            "run_error_percent": run.map(|run| measured.error_percent(&run.response)),
            "noise_percent": measured.noise_percent(),
            "periods": measured.periods.map(|(count, _)| count),
            "period_s": measured.periods.map(|(_, time)| time),
        })
    }
}
