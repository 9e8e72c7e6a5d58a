//! Where the ticks of an axis go and what is written at them.
//!
//! Evenly divided axes step by 1, 2 or 5 times a power of ten (decibels and degrees have steps of their own). Log axes
//! have decades with minor ticks between them, fewer decades if they are many, 1-2-5 if they are few.

use crate::Scale;
use crate::number::{fixed, power_of_ten};

/// The ticks of one axis, in rising order.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Ticks {
    /// Labelled ticks, in the unit shown.
    pub(crate) major: Vec<f64>,
    /// One text for each of `major`.
    pub(crate) labels: Vec<String>,
    /// Ticks without a label.
    pub(crate) minor: Vec<f64>,
    /// The labels are to be multiplied by ten to this power.
    pub(crate) exponent: i32,
}

/// Ticks for `lo..hi` (finite, `lo < hi`, positive on a log axis), about `at_most` of them labelled.
pub(crate) fn ticks(scale: Scale, lo: f64, hi: f64, at_most: usize) -> Ticks {
    let at_most = at_most.max(2);
    match scale {
        Scale::Log => log_ticks(lo, hi, at_most),
        Scale::Linear => even_ticks(lo, hi, at_most, &[]),
        Scale::Decibel => even_ticks(lo, hi, at_most, &[20.0, 40.0, 60.0]),
        Scale::Degrees => even_ticks(
            lo,
            hi,
            at_most,
            &[15.0, 30.0, 45.0, 90.0, 180.0, 360.0, 720.0, 1440.0],
        ),
    }
}

/// `special` steps, ascending, take the place of the 1-2-5 steps from their first one to their last one.
fn even_ticks(lo: f64, hi: f64, at_most: usize, special: &[f64]) -> Ticks {
    let count = at_most as f64;
    let raw = hi / count - lo / count;
    let special_step = special.iter().copied().find(|step| *step >= raw);
    let round = Step::at_least(raw);
    let step = match (special.first(), special_step) {
        (Some(first), Some(step)) if round.size() >= *first => Step {
            digit: step,
            exponent: 0,
        },
        _ => round,
    };
    let size = step.size();
    let first = (lo / size - 1e-9).ceil();
    let last = (hi / size + 1e-9).floor();
    let steps = if last - first < 1000.0 {
        (last - first) as i64
    } else {
        0
    };
    let major: Vec<f64> = (0..=steps.max(-1))
        .map(|k| step.times(first + k as f64))
        .collect();
    label_evenly(major, step.exponent)
}

/// A step of `digit · 10^exponent`.
struct Step {
    digit: f64,
    exponent: i32,
}

impl Step {
    fn at_least(raw: f64) -> Self {
        let exponent = raw.log10().floor().clamp(-300.0, 300.0) as i32;
        let scaled = raw / 10f64.powi(exponent);
        // 1 + 1e-9: a span divided by a count is seldom exact.
        match [1.0, 2.0, 5.0]
            .into_iter()
            .find(|digit| scaled <= digit * (1.0 + 1e-9))
        {
            Some(digit) => Self { digit, exponent },
            None => Self {
                digit: 1.0,
                exponent: exponent + 1,
            },
        }
    }

    fn size(&self) -> f64 {
        self.times(1.0)
    }

    /// Divides by a positive power of ten rather than multiply by a negative one: 3 tenths are then 0.3 exactly.
    fn times(&self, count: f64) -> f64 {
        let digits = count * self.digit;
        if self.exponent < 0 {
            digits / 10f64.powi(-self.exponent)
        } else {
            digits * 10f64.powi(self.exponent)
        }
    }
}

/// Labels with the decimals of the step; a common power of ten for values from 10⁶ on or below 10⁻².
fn label_evenly(major: Vec<f64>, step_exponent: i32) -> Ticks {
    let largest = major
        .iter()
        .fold(0.0, |most: f64, value| most.max(value.abs()));
    let order = if largest > 0.0 {
        (largest * (1.0 + 1e-9)).log10().floor() as i32
    } else {
        0
    };
    let exponent = if (-2..6).contains(&order) {
        0
    } else {
        3 * order.div_euclid(3)
    };
    let decimals = usize::try_from(exponent - step_exponent)
        .unwrap_or(0)
        .min(12);
    let shown = |value: f64| {
        if exponent < 0 {
            value * 10f64.powi(-exponent)
        } else {
            value / 10f64.powi(exponent)
        }
    };
    let labels = major
        .iter()
        .map(|value| fixed(shown(*value), decimals))
        .collect();
    Ticks {
        major,
        labels,
        minor: Vec::new(),
        exponent,
    }
}

fn log_ticks(lo: f64, hi: f64, at_most: usize) -> Ticks {
    let inside = |value: &f64| *value >= lo * (1.0 - 1e-9) && *value <= hi * (1.0 + 1e-9);
    let decades = || lo.log10().floor() as i32..=hi.log10().floor() as i32;
    let every = |digits: &'static [i32]| -> Vec<(i32, i32)> {
        let all = decades().flat_map(|decade| digits.iter().map(move |digit| (*digit, decade)));
        all.filter(|(digit, decade)| inside(&power(*digit, *decade)))
            .collect()
    };
    let one_two_five = every(&[1, 2, 5]);
    if one_two_five.len() < 3 {
        return even_ticks(lo, hi, at_most, &[]);
    }
    let tens = every(&[1]);
    let stride = i32::try_from(tens.len().div_ceil(at_most)).unwrap_or(i32::MAX);
    let major = if one_two_five.len() <= at_most || tens.len() < 2 {
        one_two_five
    } else {
        tens.iter()
            .copied()
            .filter(|(_, decade)| decade.rem_euclid(stride) == 0)
            .collect()
    };
    let minor = if stride > 1 {
        tens
    } else {
        every(&[1, 2, 3, 4, 5, 6, 7, 8, 9])
    };
    let plain = major.iter().all(|(_, decade)| (-3..=4).contains(decade));
    Ticks {
        labels: major
            .iter()
            .map(|(digit, decade)| log_label(*digit, *decade, plain))
            .collect(),
        minor: minor
            .into_iter()
            .filter(|tick| !major.contains(tick))
            .map(|(d, decade)| power(d, decade))
            .collect(),
        major: major
            .into_iter()
            .map(|(digit, decade)| power(digit, decade))
            .collect(),
        exponent: 0,
    }
}

fn power(digit: i32, decade: i32) -> f64 {
    Step {
        digit: f64::from(digit),
        exponent: decade,
    }
    .size()
}

fn log_label(digit: i32, decade: i32, plain: bool) -> String {
    match (plain, digit) {
        (true, _) => fixed(power(digit, decade), usize::try_from(-decade).unwrap_or(0)),
        (false, 1) => power_of_ten(decade),
        (false, _) => format!("{digit}·{}", power_of_ten(decade)),
    }
}

#[cfg(test)]
mod tests;
