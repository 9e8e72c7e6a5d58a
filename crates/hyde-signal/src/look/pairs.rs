//! Channels beside each other: which one follows another later, which one is the slope of another.

use super::channel::STATES;
use crate::Table;
use crate::statistics::correlation;

/// A channel that follows another.
#[derive(Clone, Debug, PartialEq)]
pub struct Delay {
    /// The channel that comes first.
    pub leads: String,
    /// The one that follows.
    pub follows: String,
    /// How much later, s.
    pub by_s: f64,
    /// The time between samples, s: a small part of it is no delay.
    pub step_s: f64,
    /// How much alike they are then, from 0 to 1.
    pub correlation: f64,
    /// The range of the one that follows over that of the other.
    pub ratio: f64,
}

/// A channel that is the slope of another.
#[derive(Clone, Debug, PartialEq)]
pub struct Slope {
    /// The channel.
    pub of: String,
    /// Its slope.
    pub slope: String,
    /// What the slope is multiplied by: the unit of one over that of the other a second.
    pub factor: f64,
    /// How much alike they are, from 0 to 1.
    pub correlation: f64,
}

/// So many channels are compared with each other, so many samples of each, and so many samples of delay are tried.
const CHANNELS: usize = 12;
const SAMPLES: usize = 20_000;
const LAGS: usize = 60;

/// From this on two channels are alike.
const ALIKE: f64 = 0.98;

struct Trace {
    name: String,
    unit: Option<String>,
    rates: Vec<f64>,
    values: Vec<f64>,
    step_s: f64,
}

pub(super) fn of(parts: &[&Table]) -> (Vec<Slope>, Vec<Delay>) {
    let (mut slopes, mut delays) = (Vec::new(), Vec::new());
    for part in parts {
        let traces: Vec<Trace> = traces(part);
        for (at, a) in traces.iter().enumerate() {
            for (other, b) in traces.iter().enumerate() {
                if other == at {
                    continue;
                }
                if let Some(slope) = slope(a, b) {
                    slopes.push(slope);
                }
                let comparable = a.unit == b.unit || a.unit.is_none() || b.unit.is_none();
                if other > at && comparable {
                    delays.extend(delay(a, b));
                }
            }
        }
    }
    (slopes, delays)
}

/// The channels that move, with their slopes.
fn traces(part: &Table) -> Vec<Trace> {
    let time = &part.time()[..part.rows().min(SAMPLES)];
    let Some(step_s) = part.usual_step() else {
        return Vec::new();
    };
    if time.len() < 4 * LAGS / 3 {
        return Vec::new();
    }
    let moving = part.channels().filter_map(|column| {
        let values = column.in_unit()[..time.len()].to_vec();
        let mut levels = values.clone();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        let rate = |row: usize| {
            let span = time[row + 1] - time[row - 1];
            if span > 0.0 {
                (values[row + 1] - values[row - 1]) / span
            } else {
                0.0
            }
        };
        (levels.len() > STATES).then(|| Trace {
            name: column.name().to_owned(),
            unit: column.unit().map(|unit| unit.text().to_owned()),
            rates: limited((1..time.len() - 1).map(rate).collect()),
            values: values[1..time.len() - 1].to_vec(),
            step_s,
        })
    });
    moving.take(CHANNELS).collect()
}

/// Rates of which no spike is so large that it decides everything.
fn limited(mut rates: Vec<f64>) -> Vec<f64> {
    let mut sizes: Vec<f64> = rates.iter().map(|rate| rate.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let limit = 2.0 * sizes[sizes.len() * 98 / 100];
    rates
        .iter_mut()
        .for_each(|rate| *rate = rate.clamp(-limit, limit));
    rates
}

/// Whether the second channel is the slope of the first.
fn slope(a: &Trace, b: &Trace) -> Option<Slope> {
    let correlation = correlation(&a.rates, &b.values).unwrap_or(0.0);
    let energy = a.rates.iter().map(|rate| rate * rate).sum::<f64>();
    let common = a
        .rates
        .iter()
        .zip(&b.values)
        .map(|(a, b)| a * b)
        .sum::<f64>();
    let factor = common / energy;
    // A factor of the other direction too: they are one but for noise, not merely alike.
    let rest = a
        .rates
        .iter()
        .zip(&b.values)
        .map(|(a, b)| (b - factor * a).powi(2));
    let small = rest.sum::<f64>() < 0.05 * b.values.iter().map(|b| b * b).sum::<f64>();
    (correlation.abs() > ALIKE && small && factor.is_finite()).then(|| Slope {
        of: a.name.clone(),
        slope: b.name.clone(),
        factor,
        correlation: correlation.abs(),
    })
}

/// Which of two channels follows the other: the lag at which their slopes are most alike.
fn delay(a: &Trace, b: &Trace) -> Option<Delay> {
    let most = LAGS.min(a.rates.len() / 4);
    let at = |lag: isize| {
        let shift = lag.unsigned_abs();
        let (earlier, later) = match lag >= 0 {
            true => (&a.rates[..a.rates.len() - shift], &b.rates[shift..]),
            false => (&a.rates[shift..], &b.rates[..b.rates.len() - shift]),
        };
        correlation(earlier, later).unwrap_or(0.0)
    };
    let most = isize::try_from(most).unwrap_or(0);
    let (best, found) = (-most..=most)
        .map(|lag| (lag, at(lag)))
        .max_by(|x, y| x.1.total_cmp(&y.1))?;
    if found < ALIKE || best.abs() == most {
        return None;
    }
    // The top of a parabola through the best lag and its neighbours.
    let (before, after) = (at(best - 1), at(best + 1));
    let bend = before - 2.0 * found + after;
    let part = if bend < 0.0 {
        0.5 * (before - after) / bend
    } else {
        0.0
    };
    let lag = best as f64 + part.clamp(-0.5, 0.5);
    let (leads, follows) = if lag >= 0.0 { (a, b) } else { (b, a) };
    Some(Delay {
        leads: leads.name.clone(),
        follows: follows.name.clone(),
        by_s: lag.abs() * a.step_s,
        step_s: a.step_s,
        correlation: found,
        ratio: range(&follows.values) / range(&leads.values),
    })
}

/// How far a channel goes, a hundredth of its samples at either end left out.
fn range(values: &[f64]) -> f64 {
    let mut values = values.to_vec();
    values.sort_by(f64::total_cmp);
    let part = values.len() / 100;
    values[values.len() - 1 - part] - values[part]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Column;

    #[test]
    fn delays_and_slopes_are_those_of_the_channels() {
        let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 1e-3).collect();
        let x = |t: f64| (12.0 * t).sin() + 0.4 * (31.0 * t).sin();
        let v = |t: f64| 12.0 * (12.0 * t).cos() + 0.4 * 31.0 * (31.0 * t).cos();
        let of = |f: &dyn Fn(f64) -> f64| time.iter().map(|t| f(*t)).collect::<Vec<f64>>();
        let table = Table::new(vec![
            Column::raw("t", time.clone()),
            Column::raw("soll", of(&x)),
            Column::raw("ist", of(&|t| x(t - 0.0042))),
            Column::raw("v", of(&|t| 60.0 * v(t))),
        ])
        .unwrap();
        let (slopes, delays) = super::of(&[&table]);
        let delay = delays.iter().find(|d| d.follows == "ist").unwrap();
        assert_eq!(delay.leads, "soll");
        assert!((delay.by_s - 0.0042).abs() < 1e-4, "{}", delay.by_s);
        let slope = slopes
            .iter()
            .find(|s| s.slope == "v" && s.of == "soll")
            .unwrap();
        assert!((slope.factor - 60.0).abs() < 0.1);
    }
}
