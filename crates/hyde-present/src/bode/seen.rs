//! What is seen in a magnitude: peaks, how far a mode stands out, and where two responses part.

use hyde_study::responses::Response;
use hyde_units::significant;

/// Responses that differ by less, in dB, are not told apart.
const APART: f64 = 3.0;

/// Magnitudes in dB.
pub(super) fn decibels(response: &[(f64, f64)]) -> Vec<f64> {
    let gain = |(re, im): &(f64, f64)| 20.0 * re.hypot(*im).log10();
    response.iter().map(gain).collect()
}

/// At which outputs a mode is seen: by how much each response stands out there.
pub(super) fn where_seen(frequency_hz: f64, responses: &[Response]) -> String {
    let seen: Vec<String> = responses
        .iter()
        .filter_map(|response| {
            let height = prominence(frequency_hz, &response.frequency, &response.linear)?;
            Some(format!("{} {height:+.1} dB", response.output))
        })
        .collect();
    seen.join(", ")
}

/// The magnitude at a frequency over the straight line in the Bode plot from 3/4 to 4/3 of it, in dB; the largest within a tenth around.
fn prominence(at: f64, frequency: &[f64], response: &[(f64, f64)]) -> Option<f64> {
    let gain = |f: f64| {
        let k = frequency.partition_point(|other| *other < f);
        let (re, im) = *response.get(k)?;
        let gain = 20.0 * re.hypot(im).log10();
        (k > 0 && gain.is_finite()).then_some(gain)
    };
    let (low, high) = (gain(at * 0.75)?, gain(at / 0.75)?);
    (-10..=10)
        .filter_map(|k| {
            let f = at * 1.1_f64.powf(f64::from(k) / 10.0);
            let along = (f / (0.75 * at)).ln() / (1.0 / (0.75 * 0.75_f64)).ln();
            Some(gain(f)? - (low + along * (high - low)))
        })
        .max_by(|a, b| a.abs().total_cmp(&b.abs()))
}

/// `peaks at 26.5 Hz, 43.1 Hz`
pub(super) fn peaks_told(response: &Response) -> String {
    let still = |(re, im): &(f64, f64)| re.hypot(*im) <= 0.0;
    if !response.linear.is_empty() && response.linear.iter().all(still) {
        return "no response: the input does not act on it at this operating point".to_owned();
    }
    let list: Vec<String> = peaks(&response.frequency, &response.linear)
        .iter()
        .map(|f| format!("{} Hz", significant(*f, 3)))
        .collect();
    if list.is_empty() {
        "no peak".to_owned()
    } else {
        format!("peaks at {}", list.join(", "))
    }
}

/// Frequencies at which the magnitude stands out by more than a decibel from its valleys on both sides.
fn peaks(frequency: &[f64], response: &[(f64, f64)]) -> Vec<f64> {
    let gain = decibels(response);
    let mut found = Vec::new();
    for k in 1..gain.len().saturating_sub(1) {
        if gain[k] < gain[k - 1] || gain[k] <= gain[k + 1] {
            continue;
        }
        // Down to the valley on either side, as long as nothing higher stands between.
        let valley = |side: &mut dyn Iterator<Item = &f64>| {
            side.take_while(|value| **value <= gain[k])
                .fold(gain[k], |least, value| least.min(*value))
        };
        let left = valley(&mut gain[..k].iter().rev());
        let right = valley(&mut gain[k + 1..].iter());
        if gain[k] - left.max(right) > 1.0 {
            found.push(frequency[k]);
        }
    }
    found
}

/// Where another linearised response parts from the first.
pub(super) fn apart(first: &Response, other: &Response) -> String {
    let own = first.frequency.iter().zip(decibels(&first.linear));
    let differences = own.filter_map(|(f, own)| Some((*f, at(*f, other)? - own)));
    told(&first.experiment, &differences.collect::<Vec<_>>())
}

/// Where the stepped sine parts from the linearised response.
pub(super) fn stepped_apart(response: &Response) -> String {
    let stepped = response.stepped.iter().filter_map(|(f, _, found)| {
        let gain = 20.0 * found.response.norm().log10();
        Some((*f, gain - at(*f, response)?))
    });
    told("linearised", &stepped.collect::<Vec<_>>())
}

/// Over which bands differences in dB are above 3 dB, and the most in each.
fn told(from: &str, differences: &[(f64, f64)]) -> String {
    let mut bands = Vec::new();
    let mut rest = differences;
    while let Some(start) = rest.iter().position(|(_, by)| by.abs() > APART) {
        rest = &rest[start..];
        let count = rest.iter().take_while(|(_, by)| by.abs() > APART).count();
        let (band, after) = rest.split_at(count);
        let most = band.iter().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
        let (f, by) = most.copied().unwrap_or(band[0]);
        let f = significant(f, 3);
        let most = if by.is_finite() {
            format!("{by:+.1} dB at {f} Hz")
        } else {
            format!("nothing moves at {f} Hz")
        };
        let end = |(f, _): &(f64, f64)| significant(*f, 3);
        bands.push(match band {
            [one] => format!("at {} Hz ({by:+.1} dB)", end(one)),
            [one, .., other] => format!("over {} .. {} Hz ({most})", end(one), end(other)),
            [] => String::new(),
        });
        rest = after;
    }
    if bands.is_empty() {
        format!("within {APART} dB of {from}")
    } else {
        format!("more than {APART} dB from {from} {}", bands.join(", "))
    }
}

/// The magnitude in dB at a frequency, between two points along its logarithm.
fn at(frequency_hz: f64, response: &Response) -> Option<f64> {
    let after = response
        .frequency
        .partition_point(|f| *f < frequency_hz * (1.0 - 1e-9));
    let gain = |k: usize| {
        let (re, im) = response.linear.get(k)?;
        Some(20.0 * re.hypot(*im).log10())
    };
    let right = gain(after)?;
    let Some(left) = after.checked_sub(1).and_then(gain) else {
        return (response.frequency[0] <= frequency_hz * (1.0 + 1e-9)).then_some(right);
    };
    let (low, high) = (response.frequency[after - 1], response.frequency[after]);
    let part = (frequency_hz / low).ln() / (high / low).ln();
    Some(left + part * (right - left))
}
