//! Measured frequency responses beside those of the model: errors as a table, curves for the figures.

use hyde_experiment::MeasuredCurve;
use hyde_report::{BodeCurve, LineStyle};
use hyde_signal::spectrum::Complex;
use hyde_study::responses::Compared;
use hyde_units::significant;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The table of errors, a line a response; empty without any. What is not known of any has no column.
pub fn table(all: &[&Compared]) -> String {
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

/// Its points, and those of the run.
pub(super) fn curves(
    one: &Compared,
    label: &dyn Fn(&str) -> String,
    colour: Option<usize>,
) -> Vec<BodeCurve> {
    let points = |kind: &str, curve: &MeasuredCurve, noise: bool| BodeCurve {
        label: label(kind),
        frequency: curve.frequency_hz.clone(),
        response: curve.response.iter().map(|g| (g.re, g.im)).collect(),
        style: LineStyle::Points,
        coherence: (!curve.coherence.is_empty()).then(|| curve.coherence.clone()),
        deviation: (noise && one.measured.noise_percent().is_some())
            .then(|| curve.deviation.clone()),
        colour,
    };
    let mut found = vec![points("measured", &one.measured, true)];
    found.extend(one.run.iter().map(|run| points("run", run, false)));
    found
}

/// The rows of the table of all curves: experiment, kind, frequency, real and imaginary part, coherence, and the amplitude
/// of the input.
pub(super) fn csv(one: &Compared, experiment: &str) -> String {
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
    rows("measured", &one.measured);
    if let Some(run) = &one.run {
        rows("run", run);
    }
    text
}

pub(super) fn json(one: &Compared) -> Value {
    let measured = &one.measured;
    let pairs = |values: &[Complex<f64>]| -> Vec<[f64; 2]> {
        values.iter().map(|g| [g.re, g.im]).collect()
    };
    let run = one.run.as_ref();
    json!({
        "name": one.name,
        "frequency_hz": measured.frequency_hz,
        "measured": pairs(&measured.response),
        "linearised": pairs(&one.linear),
        "run": run.map(|run| pairs(&run.response)),
        "deviation": measured.deviation,
        "coherence": measured.coherence,
        "error_percent": one.error_percent(),
        "time_error_percent": measured.time_error_percent(&one.linear),
        "run_error_percent": run.map(|run| measured.error_percent(&run.response)),
        "noise_percent": measured.noise_percent(),
        "periods": measured.periods.map(|(count, _)| count),
        "period_s": measured.periods.map(|(_, time)| time),
    })
}
