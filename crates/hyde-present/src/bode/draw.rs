//! The figure of a response, with those of other experiments, and its numbers as CSV.

use super::{drawn as per, measured};
use hyde_report::{BodeCurve, Figure, LineStyle, bode_plot};
use hyde_study::responses::Response;
use hyde_units::significant;
use std::fmt::Write as _;

/// Below this coherence nothing of the input is seen in the output: left out of magnitude and phase.
const LEAST: f64 = 0.02;

/// The figure of them.
pub fn drawn(title: &str, responses: &[&Response]) -> Figure {
    let mut experiments: Vec<&str> = Vec::new();
    for response in responses {
        if !experiments.contains(&response.experiment.as_str()) {
            experiments.push(&response.experiment);
        }
    }
    let several = experiments.len() > 1;
    let mut curves: Vec<BodeCurve> = Vec::new();
    let mut linear: Vec<&Response> = Vec::new();
    for response in responses {
        let name = response.experiment.as_str();
        let label = |kind: &str| {
            let name = if several {
                format!("{name}, ")
            } else {
                String::new()
            };
            format!("{name}{kind}")
        };
        // One colour an experiment if there are several, else one a kind.
        let place = experiments.iter().position(|known| *known == name);
        let colour = place.filter(|_| several);
        // What was measured lies below the model.
        for one in &response.measured {
            curves.extend(measured::curves(one, &label, colour));
        }
        // Several amplitudes, or swept and stepped, have one linearised model.
        if !linear.iter().any(|other| same_linear(other, response)) {
            linear.push(response);
            curves.push(BodeCurve {
                label: label("linearised"),
                frequency: response.frequency.clone(),
                response: response.linear.clone(),
                style: LineStyle::Solid,
                coherence: None,
                deviation: None,
                colour,
            });
        }
        if let Some(swept) = &response.swept {
            let values = swept.response.iter().map(|value| (value.re, value.im));
            curves.push(BodeCurve {
                label: label("swept"),
                frequency: swept.frequency_hz.clone(),
                response: seen(values, &swept.coherence),
                style: LineStyle::Points,
                coherence: Some(swept.coherence.clone()),
                deviation: None,
                colour,
            });
        }
        if !response.stepped.is_empty() {
            let stepped = || response.stepped.iter();
            let coherence: Vec<f64> = stepped().map(|(.., found)| found.coherence).collect();
            let values = stepped().map(|(.., found)| (found.response.re, found.response.im));
            curves.push(BodeCurve {
                label: label("stepped"),
                frequency: stepped().map(|(f, ..)| *f).collect(),
                response: seen(values, &coherence),
                style: LineStyle::Rings,
                coherence: Some(coherence),
                deviation: None,
                colour,
            });
        }
    }
    let Some(first) = responses.first() else {
        return bode_plot(title, ("", ""), &curves, &[]);
    };
    let (unit, factor) = per(first);
    for curve in &mut curves {
        let values = curve.response.iter_mut();
        values.for_each(|(re, im)| (*re, *im) = (*re * factor, *im * factor));
        let noise = curve.deviation.iter_mut().flatten();
        noise.for_each(|value| *value *= factor);
    }
    let band = (
        first.frequency[0],
        first.frequency[first.frequency.len() - 1],
    );
    let resonances: Vec<(f64, String)> = first
        .resonances
        .iter()
        .filter(|(f, damping)| *damping < 0.1 && (band.0..=band.1).contains(f))
        .map(|(f, _)| (*f, format!("{} Hz", significant(*f, 3))))
        .collect();
    bode_plot(title, (&first.output, &unit), &curves, &resonances)
}

fn same_linear(one: &Response, other: &Response) -> bool {
    let close =
        |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).hypot(a.1 - b.1) <= 1e-6 * a.0.hypot(a.1);
    one.frequency.len() == other.frequency.len()
        && one.frequency.first() == other.frequency.first()
        && one.frequency.last() == other.frequency.last()
        && one.linear.iter().zip(&other.linear).all(close)
}

fn seen(values: impl Iterator<Item = (f64, f64)>, coherence: &[f64]) -> Vec<(f64, f64)> {
    let gap = (f64::NAN, f64::NAN);
    let pairs = values.zip(coherence);
    pairs
        .map(|(value, coherence)| if *coherence >= LEAST { value } else { gap })
        .collect()
}

/// One line a frequency; of a stepped sine with the amplitude of its input, SI, and the distortion.
pub(super) fn csv(responses: &[&Response]) -> String {
    let mut csv = String::from("experiment,kind,f [Hz],re,im,coherence,amplitude,distortion\n");
    for response in responses {
        let experiment = &response.experiment;
        for (f, (re, im)) in response.frequency.iter().zip(&response.linear) {
            let _ = writeln!(csv, "{experiment},linearised,{f},{re},{im},1,,");
        }
        if let Some(swept) = &response.swept {
            let lines = swept.frequency_hz.iter().zip(&swept.response);
            for ((f, value), coherence) in lines.zip(&swept.coherence) {
                let _ = writeln!(
                    csv,
                    "{experiment},swept,{f},{},{},{coherence},,",
                    value.re, value.im
                );
            }
        }
        for one in &response.measured {
            csv.push_str(&measured::csv(one, experiment));
        }
        for (f, amplitude, found) in &response.stepped {
            let (re, im) = (found.response.re, found.response.im);
            let _ = writeln!(
                csv,
                "{experiment},stepped,{f},{re},{im},{},{amplitude},{}",
                found.coherence, found.distortion
            );
        }
    }
    csv
}
