//! One number of a signal over a run.

use hyde_program::ReductionKind;
use hyde_signal::spectrum::strongest_frequency;

/// The most samples of a spectrum: finer rows say no more about where it is highest.
const SAMPLES: usize = 1 << 15;

/// A signal over a run as one number; integrals by the trapezoidal rule, NaN where there is none. An instant with an event
/// has two rows, so a jump is no ramp.
pub(crate) fn reduce(kind: ReductionKind, time: &[f64], values: &[f64]) -> f64 {
    let mut known = values.iter().copied().filter(|value| !value.is_nan());
    match kind {
        ReductionKind::Max => values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        ReductionKind::Min => values.iter().copied().fold(f64::INFINITY, f64::min),
        ReductionKind::Mean => mean(time, values, |v| v),
        ReductionKind::Rms => mean(time, values, |v| v * v).sqrt(),
        ReductionKind::Integral => integral(time, values, |v| v),
        ReductionKind::First => known.next().unwrap_or(f64::NAN),
        ReductionKind::Last => known.next_back().unwrap_or(f64::NAN),
        ReductionKind::Settling => settled(time, values),
        ReductionKind::Resonance => resonance(time, values),
    }
}

/// The mean over time of a function of a signal, by the trapezoidal rule.
pub(crate) fn mean(time: &[f64], values: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let ends = time.last().zip(time.first());
    integral(time, values, of) / ends.map_or(0.0, |(last, first)| last - first)
}

fn integral(time: &[f64], values: &[f64], of: impl Fn(f64) -> f64) -> f64 {
    let pairs = time.windows(2).zip(values.windows(2));
    pairs
        .map(|(t, v)| 0.5 * (t[1] - t[0]) * (of(v[0]) + of(v[1])))
        .sum()
}

/// From when a signal stays at zero or below: between rows on the straight line, infinite if its last value is above.
fn settled(time: &[f64], values: &[f64]) -> f64 {
    let last_above = values.iter().rposition(|value| *value > 0.0);
    let Some(at) = last_above else {
        return time.first().copied().unwrap_or(f64::NAN);
    };
    match (time.get(at + 1), values.get(at + 1)) {
        (Some(after), Some(below)) => {
            let part = values[at] / (values[at] - below);
            time[at] + part * (after - time[at])
        }
        _ => f64::INFINITY,
    }
}

/// Where the spectrum is highest, of a signal read at as many even instants as it has rows.
fn resonance(time: &[f64], values: &[f64]) -> f64 {
    let (Some(first), Some(last)) = (time.first(), time.last()) else {
        return f64::NAN;
    };
    let count = time.len().min(SAMPLES);
    let step = (last - first) / (count.max(2) - 1) as f64;
    let mut row = 0;
    let even = (0..count).map(|k| {
        let t = first + k as f64 * step;
        while row + 2 < time.len() && time[row + 1] < t {
            row += 1;
        }
        let (from, to) = (row, (row + 1).min(time.len() - 1));
        let span = time[to] - time[from];
        let part = if span > 0.0 {
            ((t - time[from]) / span).clamp(0.0, 1.0)
        } else {
            0.0
        };
        values[from] + part * (values[to] - values[from])
    });
    let even: Vec<f64> = even.collect();
    strongest_frequency(&even, 1.0 / step).unwrap_or(f64::NAN)
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "halves and quarters are exact")]
mod tests {
    use super::*;

    #[test]
    fn a_signal_settles_where_it_last_crosses_the_band() {
        let time = [0.0, 1.0, 2.0, 3.0];
        let settled = |values: [f64; 4]| reduce(ReductionKind::Settling, &time, &values);
        assert_eq!(settled([1.0, -1.0, 3.0, -1.0]), 2.75);
        assert_eq!(settled([-1.0, -1.0, 0.0, -1.0]), 0.0);
        assert_eq!(settled([1.0, -1.0, -1.0, 0.5]), f64::INFINITY);
    }

    #[test]
    fn first_and_last_pass_over_what_has_no_value() {
        let (time, values) = ([0.0, 1.0, 2.0], [f64::NAN, 5.0, f64::NAN]);
        assert_eq!(reduce(ReductionKind::First, &time, &values), 5.0);
        assert_eq!(reduce(ReductionKind::Last, &time, &values), 5.0);
        assert!(reduce(ReductionKind::First, &time, &[f64::NAN; 3]).is_nan());
    }

    #[test]
    fn an_integral_takes_a_jump_as_a_jump() {
        let (time, values) = ([0.0, 1.0, 1.0, 3.0], [2.0, 2.0, 4.0, 0.0]);
        assert_eq!(reduce(ReductionKind::Integral, &time, &values), 6.0);
    }

    #[test]
    fn rows_at_events_do_not_shift_a_resonance() {
        let mut time: Vec<f64> = (0..=2000).map(|k| f64::from(k) * 1e-3).collect();
        time.extend([0.5004, 0.5004, 1.2341]);
        time.sort_by(f64::total_cmp);
        let values: Vec<f64> = time
            .iter()
            .map(|t| (-2.0 * t).exp() * (260.0 * t).cos())
            .collect();
        let found = reduce(ReductionKind::Resonance, &time, &values);
        // 260 rad/s; a decay of 2/s moves the peak by (2/260)^2 of it; lines are 0.5 Hz apart, and there are 83 periods.
        assert!(
            (found - 260.0 / std::f64::consts::TAU).abs() < 0.02,
            "{found}"
        );
    }
}
