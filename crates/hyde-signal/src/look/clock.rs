//! The instants of a record: how far apart, where some are missing or double, how the clock goes.

use crate::statistics::middle;

/// The samples of one rate.
#[derive(Clone, Debug, PartialEq)]
pub struct Clock {
    /// How many there are.
    pub rows: usize,
    /// The first one in s.
    pub start_s: f64,
    /// From the first to the last in s.
    pub length_s: f64,
    /// The usual time between two of them in s; 0 for a single one.
    pub step_s: f64,
    /// The standard deviation of that time, gaps left out, in s.
    pub jitter_s: f64,
    /// By how much the mean time between samples differs from the usual one, in parts per million, gaps left out.
    pub drift_ppm: f64,
    /// Gaps: where they begin and how long they are, in s.
    pub gaps: Vec<(f64, f64)>,
    /// The samples that have the time of the one before, in s.
    pub doubles: Vec<f64>,
}

/// A distance of more than so many usual ones is a gap.
const GAP: f64 = 1.5;

pub(super) fn of(time: &[f64]) -> Clock {
    let steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut sorted: Vec<f64> = steps.iter().copied().filter(|step| *step > 0.0).collect();
    sorted.sort_by(f64::total_cmp);
    let usual = middle(&sorted).unwrap_or(0.0);
    let places = || steps.iter().zip(time);
    let ordinary: Vec<f64> = sorted
        .iter()
        .copied()
        .filter(|step| *step <= GAP * usual)
        .collect();
    let mean = ordinary.iter().sum::<f64>() / ordinary.len().max(1) as f64;
    let spread = ordinary
        .iter()
        .map(|step| (step - mean).powi(2))
        .sum::<f64>();
    let (first, last) = (time.first().copied(), time.last().copied());
    Clock {
        rows: time.len(),
        start_s: first.unwrap_or(0.0),
        length_s: last.zip(first).map_or(0.0, |(last, first)| last - first),
        step_s: usual,
        jitter_s: (spread / ordinary.len().max(1) as f64).sqrt(),
        drift_ppm: if usual > 0.0 {
            1e6 * (mean / usual - 1.0)
        } else {
            0.0
        },
        gaps: places()
            .filter(|(step, _)| **step > GAP * usual)
            .map(|(step, from)| (*from, *step))
            .collect(),
        doubles: places()
            .filter(|(step, _)| **step == 0.0)
            .map(|(_, at)| *at)
            .collect(),
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "copied values")]
mod tests {
    use super::*;

    #[test]
    fn gaps_doubles_and_drift_are_found() {
        let mut time: Vec<f64> = (0..100).map(|k| f64::from(k) * 1e-3).collect();
        time.remove(50);
        time.insert(20, time[20]);
        let clock = of(&time);
        assert!((clock.step_s - 1e-3).abs() < 1e-12);
        assert_eq!((clock.gaps.len(), clock.doubles.len()), (1, 1));
        assert!((clock.gaps[0].0 - 0.049).abs() < 1e-9);
        // Mostly 1 ms, each tenth 1.1 ms: 10 000 parts per million slower than it shows.
        let mut at = 0.0;
        let late: Vec<f64> = (0..200)
            .map(|k| {
                at += if k % 10 == 0 { 1.1e-3 } else { 1e-3 };
                at
            })
            .collect();
        let drift = of(&late).drift_ppm;
        assert!((drift - 10_000.0).abs() < 600.0, "{drift}");
    }
}
