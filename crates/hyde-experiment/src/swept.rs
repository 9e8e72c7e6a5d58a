//! The response measured as on the machine: a sine swept through the full hybrid model, friction, backlash and sampling
//! included, and the spectra of what came out over what went in.

use crate::rows::EvenRows;
use hyde_program::Bode;
use hyde_signal::spectrum::{FrequencyResponse, swept_response as response};
use hyde_sim::Results;

/// A swept response of one output.
#[derive(Clone, Debug)]
pub struct Swept {
    /// Name of the output.
    pub output: String,
    /// Response and coherence over frequency.
    pub response: FrequencyResponse,
}

/// The swept responses of a run that an experiment asks for, between two frequencies in Hz; empty where the input was not
/// reported or the run is too short.
#[must_use]
pub fn swept_response(bode: &Bode, results: &Results, band_hz: (f64, f64)) -> Vec<Swept> {
    let Some(input) = bode.input_output.and_then(|output| results.column(output)) else {
        return Vec::new();
    };
    let spacing = results.time.windows(2).map(|t| t[1] - t[0]);
    let spacing = spacing.filter(|step| *step > 1e-9).fold(0.0, f64::max);
    let start = results.time.first().copied().unwrap_or(0.0);
    let rows = EvenRows::of(results, start, spacing);
    let time = &rows.time;
    if time.len() <= 64 {
        return Vec::new();
    }
    let step_s = (time[time.len() - 1] - time[0]) / (time.len() - 1) as f64;
    let driven = rows.values(&input);
    let mut found = Vec::new();
    for (name, output) in &bode.outputs {
        let Some(values) = results.column(*output) else {
            continue;
        };
        // Neighbouring lines are averaged over about half a percent of the record's lines.
        let neighbours = (time.len() / 2000).max(2);
        if let Ok(all) = response(&driven, &rows.values(&values), step_s, neighbours) {
            found.push(Swept {
                output: name.clone(),
                response: all.between(band_hz.0, band_hz.1),
            });
        }
    }
    found
}
