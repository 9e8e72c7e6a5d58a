//! How a channel was sampled: its range, its step, its noise, and what is wrong with its readings.

use crate::statistics::{mean_square, middle};

/// How a channel was sampled, in the unit of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct Sampled {
    /// The least and the greatest value.
    pub range: (f64, f64),
    /// The step of its quantisation, where it has one.
    pub step: Option<f64>,
    /// The standard deviation of its noise, quantisation included.
    pub noise: f64,
    /// The longest stretch with one value while the channel moves elsewhere.
    pub stuck: Option<Held>,
    /// That it stands at the end of its range, the upper one if at both.
    pub saturated: Option<Limit>,
    /// That it stands at the lower end too.
    pub saturated_below: Option<Limit>,
    /// That it begins again.
    pub wraps: Option<Wrap>,
    /// Single readings far off those beside them, in s.
    pub spikes: Vec<f64>,
}

/// A stretch with one value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Held {
    /// Where it begins, s.
    pub from_s: f64,
    /// Where it ends, s.
    pub to_s: f64,
    /// The value.
    pub value: f64,
}

/// A channel at the end of its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// The value.
    pub value: f64,
    /// How many samples have it.
    pub samples: usize,
}

/// A channel that begins again.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrap {
    /// After so many.
    pub period: f64,
    /// How often.
    pub times: usize,
}

/// What counters and angles begin again after.
const PERIODS: [f64; 8] = [
    65_536.0,
    4_294_967_296.0,
    16_777_216.0,
    360.0,
    std::f64::consts::TAU,
    1.0,
    4096.0,
    1000.0,
];

/// A channel of so few values is a state, such as an enable bit.
pub(super) const STATES: usize = 8;

/// A stretch with one value is stuck from so many samples on, if the channel leaves it by so many times a usual step.
const STUCK: usize = 10;
const RELEASE: f64 = 3.0;

pub(super) fn sampled(time: &[f64], values: &[f64]) -> Sampled {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let range = finite().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), value| {
        (a.min(value), b.max(value))
    });
    let mut levels: Vec<f64> = finite().collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    let is_state = levels.len() <= STATES;
    let wraps = if is_state { None } else { wraps(values, range) };
    let moving = !is_state && wraps.is_none();
    let mut limits = match moving {
        true => saturated(values, range).into_iter(),
        false => Vec::new().into_iter(),
    };
    Sampled {
        range,
        step: if is_state { None } else { step(&levels) },
        noise: if is_state { 0.0 } else { noise(values) },
        stuck: if is_state { None } else { stuck(time, values) },
        saturated: limits.next(),
        saturated_below: limits.next(),
        wraps,
        spikes: if moving {
            spikes(time, values)
        } else {
            Vec::new()
        },
    }
}

/// The number of which all distances of the values are multiples.
fn step(levels: &[f64]) -> Option<f64> {
    let distances = levels.windows(2).map(|pair| pair[1] - pair[0]);
    let size = levels.first()?.abs().max(levels.last()?.abs());
    let least = distances
        .clone()
        .filter(|d| *d > 1e-12 * size)
        .fold(f64::INFINITY, f64::min);
    if !least.is_finite() {
        return None;
    }
    // The mean of the distances in whole steps is better than the least one.
    let (mut steps, mut sum) = (0.0, 0.0);
    for distance in distances {
        let whole = (distance / least).round();
        if (distance / least - whole).abs() > 0.05_f64.max(1e-9 * size / least) || whole > 1e6 {
            return None;
        }
        steps += whole;
        sum += distance;
    }
    (steps > 0.0).then(|| sum / steps)
}

/// The standard deviation of what changes from sample to sample beyond a parabola: by third differences.
fn noise(values: &[f64]) -> f64 {
    // Where a quantised channel stands, equal values say nothing of its noise.
    let moves = |w: &&[f64]| w.iter().any(|value| value.total_cmp(&w[0]).is_ne());
    let third = values
        .windows(4)
        .filter(moves)
        .map(|w| (w[3] - 3.0 * w[2] + 3.0 * w[1] - w[0]).abs());
    let mut third: Vec<f64> = third.filter(|value| value.is_finite()).collect();
    third.sort_by(f64::total_cmp);
    // Spikes and steps are among the largest.
    third.truncate(third.len() * 9 / 10);
    (mean_square(&third) / LOWER_NINE_TENTHS / 20.0).sqrt()
}

/// The mean square of the nine tenths of a normal distribution that are nearest to 0, over its variance.
const LOWER_NINE_TENTHS: f64 = 0.623;

/// The sizes of the steps from sample to sample, the smallest first.
fn sorted_steps(values: &[f64]) -> Vec<f64> {
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let mut steps: Vec<f64> = steps.collect();
    steps.sort_by(f64::total_cmp);
    steps
}

/// The stretches with one value: first and last row.
fn stretches(values: &[f64]) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut first = 0;
    for row in 1..=values.len() {
        if row == values.len() || values[row].total_cmp(&values[first]).is_ne() {
            found.push((first, row - 1));
            first = row;
        }
    }
    found
}

/// The longest stretch that a channel leaves with a jump: it moved on meanwhile.
fn stuck(time: &[f64], values: &[f64]) -> Option<Held> {
    let steps = sorted_steps(values);
    let usual = steps.get(steps.len() * 95 / 100).copied()?;
    let jumps = |to: usize| {
        values
            .get(to + 1)
            .is_some_and(|next| (next - values[to]).abs() > RELEASE * usual)
    };
    let frozen = stretches(values)
        .into_iter()
        .filter(|(from, to)| to - from + 1 >= STUCK && jumps(*to));
    let (from, to) = frozen.max_by_key(|(from, to)| to - from)?;
    Some(Held {
        from_s: time[from],
        to_s: time[to],
        value: values[from],
    })
}

/// The ends of the range at which a channel stands, the upper one first.
fn saturated(values: &[f64], range: (f64, f64)) -> Vec<Limit> {
    let mut steps = sorted_steps(values);
    steps.retain(|step| *step > 0.0);
    let Some(usual) = middle(&steps) else {
        return Vec::new();
    };
    let stretches = stretches(values);
    let limits = [range.1, range.0].into_iter().filter_map(|value| {
        let at_end = |(from, to): &&(usize, usize)| {
            values[*from].total_cmp(&value).is_eq() && to - from >= 3
        };
        let long: Vec<&(usize, usize)> = stretches.iter().filter(at_end).collect();
        let samples: usize = long.iter().map(|(from, to)| to - from + 1).sum();
        // A limit cuts a channel that was on its way, where a crest is flat on both sides.
        let slope = |a: Option<usize>, b: Option<usize>| match (a, b) {
            (Some(a), Some(b)) if a < values.len() && b < values.len() => {
                (values[a] - values[b]).abs()
            }
            _ => 0.0,
        };
        let steep = long.iter().any(|(from, to)| {
            let before = slope(from.checked_sub(2), from.checked_sub(1));
            before.max(slope(Some(to + 1), Some(to + 2))) > 0.3 * usual
        });
        (steep && samples >= 4).then_some(Limit { value, samples })
    });
    limits.collect()
}

fn wraps(values: &[f64], range: (f64, f64)) -> Option<Wrap> {
    let span = range.1 - range.0;
    let steps: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let jumps: Vec<f64> = steps
        .iter()
        .copied()
        .filter(|step| step.abs() > 0.6 * span)
        .collect();
    let rest = steps.iter().filter(|step| step.abs() <= 0.6 * span);
    let most = rest.fold(0.0_f64, |most, step| most.max(step.abs()));
    let (first, small) = (jumps.first()?.abs(), most < 0.2 * span);
    let alike = jumps
        .iter()
        .all(|jump| (jump.abs() - first).abs() <= 2.0 * most + 1e-9 * span);
    if !small || !alike || jumps.len() * 4 > values.len() {
        return None;
    }
    let period = PERIODS
        .iter()
        .find(|period| (first..=first + 2.0 * most + 1e-9 * span).contains(period));
    let times = jumps.len();
    // What stands for readings beyond the range, such as 9.9E37, is one value; what begins again passes through many.
    let middle = range.0 + 0.5 * span;
    let above = |value: &&f64| **value > middle;
    let one = |value: &f64, end: f64| value.total_cmp(&end).is_eq();
    let stands_for = values.iter().filter(above).all(|v| one(v, range.1))
        || values.iter().filter(|v| !above(v)).all(|v| one(v, range.0));
    // One jump alone may be a step of the channel, unless it is that of a counter or an angle.
    match period {
        Some(period) => Some(Wrap {
            period: *period,
            times,
        }),
        None if times > 1 && !stands_for => Some(Wrap {
            period: first + most,
            times,
        }),
        None => None,
    }
}

/// Instruments write 9.9E37 for readings beyond their range; no channel of a machine goes that far.
const BEYOND: f64 = 1e30;

/// Samples that differ from both neighbours, in one direction, by far more than others do.
fn spikes(time: &[f64], values: &[f64]) -> Vec<f64> {
    let off = |row: usize| {
        let (before, after) = (values[row] - values[row - 1], values[row] - values[row + 1]);
        if before * after > 0.0 {
            before.abs().min(after.abs())
        } else {
            0.0
        }
    };
    let all: Vec<f64> = (1..values.len().saturating_sub(1)).map(off).collect();
    let mut sorted = all.clone();
    sorted.sort_by(f64::total_cmp);
    let usual = sorted.get(sorted.len() * 95 / 100).copied().unwrap_or(0.0);
    let steps = sorted_steps(values);
    let step = steps.get(steps.len() * 95 / 100).copied().unwrap_or(0.0);
    let limit = (8.0 * usual).max(4.0 * step);
    let is_far = |row: usize| {
        let off = row.checked_sub(1).and_then(|at| all.get(at));
        limit > 0.0 && off.is_some_and(|off| *off > limit)
    };
    let far = (0..values.len()).filter(|&row| is_far(row) || values[row].abs() > BEYOND);
    far.map(|row| time[row]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(rows: usize) -> Vec<f64> {
        (0..rows).map(|k| k as f64 * 1e-3).collect()
    }

    fn sine(rows: usize) -> Vec<f64> {
        (0..rows)
            .map(|k| 12.5 * (0.0125 * k as f64).sin())
            .collect()
    }

    #[test]
    fn the_step_of_a_quantiser_is_found() {
        let counts: Vec<f64> = sine(400)
            .iter()
            .map(|x| (x / 0.005).round() * 0.005)
            .collect();
        let found = sampled(&times(400), &counts);
        assert!((found.step.unwrap() - 0.005).abs() < 1e-9);
        assert!(found.wraps.is_none() && found.spikes.is_empty() && found.saturated.is_none());
    }

    #[test]
    fn the_noise_is_that_of_the_sensor() {
        // Sums of twelve numbers of a generator are nearly normal.
        let mut state = 1_u64;
        let mut uniform = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let noisy: Vec<f64> = sine(4000)
            .iter()
            .map(|x| x + 0.01 * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0))
            .collect();
        let found = sampled(&times(4000), &noisy);
        assert!((found.noise - 0.01).abs() < 1e-3, "{}", found.noise);
    }

    #[test]
    fn what_is_wrong_with_readings_is_found_with_its_place() {
        let mut values = sine(400);
        values[100] += 9.0;
        for row in 200..240 {
            values[row] = values[200];
        }
        let found = sampled(&times(400), &values);
        assert_eq!(found.spikes, [0.1]);
        let stuck = found.stuck.unwrap();
        assert!((stuck.from_s - 0.2).abs() < 1e-9 && (stuck.to_s - 0.239).abs() < 1e-9);
        let clipped: Vec<f64> = sine(1000).iter().map(|x| x.min(8.0)).collect();
        let limit = sampled(&times(1000), &clipped).saturated.unwrap();
        assert!((limit.value - 8.0).abs() < 1e-12 && limit.samples > 50);
        let both: Vec<f64> = sine(1000).iter().map(|x| x.clamp(-6.0, 8.0)).collect();
        let both = sampled(&times(1000), &both);
        assert!((both.saturated.unwrap().value - 8.0).abs() < 1e-12);
        assert!((both.saturated_below.unwrap().value + 6.0).abs() < 1e-12);
        let mut overflown = sine(400);
        (overflown[100], overflown[300], overflown[301]) = (9.9e37, 9.9e37, 9.9e37);
        let overflown = sampled(&times(400), &overflown);
        assert!(overflown.wraps.is_none());
        assert_eq!(
            overflown.spikes,
            [times(400)[100], times(400)[300], times(400)[301]]
        );
        let counter: Vec<f64> = (0..4000).map(|k| f64::from((k * 37) % 65_536)).collect();
        let wrap = sampled(&times(4000), &counter).wraps.unwrap();
        assert!((wrap.period - 65_536.0).abs() < 1e-9 && wrap.times == 2);
        let clean = sampled(&times(400), &sine(400));
        assert!(clean.stuck.is_none() && clean.spikes.is_empty() && clean.saturated.is_none());
    }
}
