//! [`Written`]: samples as decimal digits whose differences keep the limits.
//!
//! A digit too few is a jerk: half a unit of the last place in each of four samples makes four units over the third power of
//! the period. So many digits are written that rounding takes a small part of each limit, and the signal is made to fit into
//! the rest. What is checked at last are differences of the digits themselves, whole numbers.

use super::limits::{Bounds, Impossible, Limits, Peak, Quantity};
use hyde_units::Unit;

/// Rounding takes at most this part of a limit, and signals are planned for this part of it.
const ROUNDING: f64 = 2e-3;
pub(super) const PLANNED: f64 = 0.996;
/// Digits that a double holds.
const DIGITS: f64 = 1e15;
/// A signal that does not fit yet is made smaller by this, and so often.
const SHRINK: f64 = 0.995;
const TRIES: usize = 40;
/// At most so many decimals.
const DECIMALS: i32 = 18;

/// Samples in units of their last decimal.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Written {
    pub(super) counts: Vec<i64>,
    pub(super) decimals: i32,
    pub(super) peaks: Vec<Peak>,
}

/// Whether a signal is made as large as its limits let it be, or only smaller.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Size {
    Largest,
    AsItIs,
}

/// Writes samples (SI, from where the axis stands at first) in a unit, beside a start.
pub(super) fn written(
    samples: &[f64],
    start: f64,
    unit: Unit,
    step_s: f64,
    bounds: &Bounds,
    size: Size,
) -> Result<Written, Impossible> {
    // Differences are of the unit's scale alone, whatever its zero point.
    let one = unit.difference_to_si(1.0);
    let decimals = decimals(bounds, start, one, step_s)?;
    let last = 10.0_f64.powi(-decimals) * one;
    let origin = (start / last).round();
    let planned = peaks(samples, step_s, bounds);
    let largest = planned.iter().map(Peak::part).fold(0.0, f64::max);
    let mut scale = match size {
        Size::Largest if largest > 0.0 => PLANNED / largest,
        Size::Largest => 1.0,
        Size::AsItIs => (PLANNED / largest).min(1.0),
    };
    for _ in 0..TRIES {
        let counts: Vec<i64> = samples
            .iter()
            .map(|value| (scale * value / last).round() as i64)
            .collect();
        let moved: Vec<f64> = counts.iter().map(|count| *count as f64).collect();
        let in_counts = in_counts(bounds, last);
        let counted = peaks(&moved, step_s, &in_counts);
        let peaks: Vec<Peak> = counted
            .iter()
            .zip(limits(bounds))
            .map(|(peak, (_, limit))| Peak {
                reached: peak.reached * last,
                limit,
                ..*peak
            })
            .collect();
        if counted.iter().all(|peak| peak.part() <= 1.0 - 1e-9) {
            let counts = counts.iter().map(|count| count + origin as i64).collect();
            return Ok(Written {
                counts,
                decimals,
                peaks,
            });
        }
        scale *= SHRINK;
    }
    let worst = planned.iter().max_by(|a, b| a.part().total_cmp(&b.part()));
    Err(Impossible::Digits(
        worst.map_or(Quantity::Effort, |worst| worst.quantity),
    ))
}

/// So many decimals of a unit (SI) that rounding takes little of each limit.
pub(super) fn decimals(
    bounds: &Bounds,
    start: f64,
    one: f64,
    step_s: f64,
) -> Result<i32, Impossible> {
    let finest = limits(bounds).into_iter().map(|(quantity, limit)| {
        // What half a unit of the last place in each sample makes of the difference, in such units.
        let made = match quantity {
            Quantity::Travel | Quantity::Effort => 1.0,
            Quantity::Speed => 1.0 / step_s,
            Quantity::Acceleration => 2.0 / step_s.powi(2),
            Quantity::Jerk => 4.0 / step_s.powi(3),
        };
        (quantity, ROUNDING * limit / made)
    });
    let finest = finest.min_by(|a, b| a.1.total_cmp(&b.1));
    let Some((quantity, finest)) = finest else {
        return Ok(0);
    };
    let decimals = -((finest / one).log10().floor()) as i32;
    let decimals = decimals.max(0);
    let farthest = match bounds {
        Bounds::Motion(limits) => start.abs() + limits.travel,
        Bounds::Effort(peak) => start.abs() + peak,
    };
    let digits = farthest / one * 10.0_f64.powi(decimals);
    if decimals > DECIMALS || digits > DIGITS {
        return Err(Impossible::Digits(quantity));
    }
    Ok(decimals)
}

/// What is limited, each with its limit; of a travel half of it, to either side.
fn limits(bounds: &Bounds) -> Vec<(Quantity, f64)> {
    match bounds {
        Bounds::Motion(Limits {
            travel,
            speed,
            acceleration,
            jerk,
        }) => vec![
            (Quantity::Travel, *travel),
            (Quantity::Speed, *speed),
            (Quantity::Acceleration, *acceleration),
            (Quantity::Jerk, *jerk),
        ],
        Bounds::Effort(peak) => vec![(Quantity::Effort, *peak)],
    }
}

fn in_counts(bounds: &Bounds, last: f64) -> Bounds {
    match bounds {
        Bounds::Motion(limits) => Bounds::Motion(limits.times(1.0 / last)),
        Bounds::Effort(peak) => Bounds::Effort(peak / last),
    }
}

/// The largest differences of samples; beyond both ends they stand still.
pub(super) fn peaks(samples: &[f64], step_s: f64, bounds: &Bounds) -> Vec<Peak> {
    let size = |values: &[f64]| values.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    let peak = |(quantity, limit), reached| Peak {
        quantity,
        reached,
        limit,
    };
    if let Bounds::Effort(limit) = bounds {
        return vec![peak((Quantity::Effort, *limit), size(samples))];
    }
    let (first, last) = (samples.first(), samples.last());
    let ends = |value: Option<&f64>| [value.copied().unwrap_or(0.0); 3];
    let mut values: Vec<f64> = [&ends(first), samples, &ends(last)].concat();
    // The axis stands in the middle of its travel at first: what is free is half of it to either side.
    let farthest = 2.0 * size(samples);
    let mut found = Vec::new();
    for (order, own) in limits(bounds).into_iter().enumerate() {
        let order_s = step_s.powi(i32::try_from(order).unwrap_or(0));
        found.push(match order {
            0 => peak(own, farthest),
            _ => peak(own, size(&values) / order_s),
        });
        values = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    }
    found
}

/// A count of a last decimal, as digits.
pub(super) fn digits(count: i64, decimals: i32) -> String {
    let decimals = usize::try_from(decimals).unwrap_or(0);
    let sign = if count < 0 { "-" } else { "" };
    let all = format!("{:0width$}", count.unsigned_abs(), width = decimals + 1);
    let (whole, part) = all.split_at(all.len() - decimals);
    let part = part.trim_end_matches('0');
    match part.is_empty() {
        true => format!("{sign}{whole}"),
        false => format!("{sign}{whole}.{part}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_are_digits() {
        assert_eq!(digits(-1_250, 3), "-1.25");
        assert_eq!(digits(7, 4), "0.0007");
        assert_eq!(digits(0, 4), "0");
        assert_eq!(digits(120, 0), "120");
    }

    /// Third differences of 1, 0, 0, 0: the jerk of a single step.
    #[test]
    fn a_step_is_a_jerk() {
        let bounds = Bounds::Motion(Limits {
            travel: 10.0,
            speed: 1.0,
            acceleration: 1.0,
            jerk: 1.0,
        });
        let found = peaks(&[0.0, 0.0, 1.0, 1.0], 0.1, &bounds);
        let reached: Vec<f64> = found.iter().map(|peak| peak.reached).collect();
        let expected = [2.0, 10.0, 100.0, 2000.0];
        for (reached, expected) in reached.iter().zip(expected) {
            assert!((reached - expected).abs() < 1e-9 * expected, "{reached}");
        }
    }
}
