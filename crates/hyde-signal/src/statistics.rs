//! Statistics, for the whole project: single numbers of a sequence of samples, how two sequences go together, and quantiles of
//! the [`distributions`] that tests compare them with.
//!
//! Numbers of an empty sequence are NaN unless a function says otherwise.

pub mod distributions;

/// The arithmetic mean, in the unit of the values.
#[must_use]
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / count(values)
}

/// The root mean square, in the unit of the values.
#[must_use]
pub fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / count(values)).sqrt()
}

/// The mean of the squares, in the square of the unit of the values; 0 of none.
#[must_use]
pub fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>() / count(values).max(1.0)
}

/// The median, of an even number of values the upper one of the two in the middle; `None` of none.
#[must_use]
pub fn median(values: &[f64]) -> Option<f64> {
    median_of(&mut values.to_vec())
}

/// The [median] of values whose order does not matter any more.
pub(crate) fn median_of(values: &mut [f64]) -> Option<f64> {
    let at = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(at, f64::total_cmp).1)
}

/// The [median] of sorted values.
#[must_use]
pub fn middle(sorted: &[f64]) -> Option<f64> {
    sorted.get(sorted.len() / 2).copied()
}

/// The quantile of sorted values: linear between order statistics (definition 7 of Hyndman and Fan 1996). NaN of none.
#[must_use]
pub fn quantile(sorted: &[f64], p: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else {
        return f64::NAN;
    };
    let at = p * last as f64;
    let below = at.floor() as usize;
    let part = at - below as f64;
    let (low, high) = (sorted[below], sorted[(below + 1).min(last)]);
    // Equal values may be infinite.
    if part > 0.0 && low < high {
        low + part * (high - low)
    } else {
        low
    }
}

/// Pearson's correlation of two sequences; `None` if one of them is constant or their lengths differ.
#[must_use]
pub fn correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    let (a_mean, b_mean) = (mean(a), mean(b));
    let (mut ab, mut aa, mut bb) = (0.0, 0.0, 0.0);
    for (a, b) in a.iter().zip(b) {
        ab += (a - a_mean) * (b - b_mean);
        aa += (a - a_mean) * (a - a_mean);
        bb += (b - b_mean) * (b - b_mean);
    }
    (a.len() == b.len() && aa > 0.0 && bb > 0.0).then(|| ab / (aa * bb).sqrt())
}

/// Autocorrelation about zero: of values with those `lag` places later; 0 if all are 0.
#[must_use]
pub fn autocorrelation(values: &[f64], lag: usize) -> f64 {
    let total: f64 = values.iter().map(|value| value * value).sum();
    let pairs = values.iter().zip(values.iter().skip(lag));
    let products: f64 = pairs.map(|(value, later)| value * later).sum();
    if total > 0.0 { products / total } else { 0.0 }
}

/// The standard deviation about the mean, divided by n (not n - 1), in the unit of the values.
#[must_use]
pub fn standard_deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    (values
        .iter()
        .map(|value| (value - mean) * (value - mean))
        .sum::<f64>()
        / count(values))
    .sqrt()
}

/// The largest absolute value, in the unit of the values; NaN if one of them is.
#[must_use]
pub fn max_abs(values: &[f64]) -> f64 {
    let larger = |a: f64, b: f64| if a >= b || a.is_nan() { a } else { b };
    values
        .iter()
        .map(|value| value.abs())
        .reduce(larger)
        .unwrap_or(f64::NAN)
}

/// `100 * norm(a - b) / norm(a)` in percent: how far `b` is from the reference `a`.
///
/// The measure of the EMPS benchmark (Janot, Gautier, Brunot 2019), where `a` is measured and `b` simulated.
///
/// # Panics
/// If the sequences differ in length.
#[must_use]
pub fn relative_error_percent(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len(), "the sequences have one length");
    let difference: f64 = a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum();
    let reference: f64 = a.iter().map(|a| a * a).sum();
    100.0 * (difference / reference).sqrt()
}

fn count(values: &[f64]) -> f64 {
    values.len() as f64
}

#[cfg(test)]
#[allow(
    clippy::float_cmp,
    reason = "whole numbers and their roots are exact here"
)]
mod tests {
    use super::*;

    #[test]
    fn small_sequences_by_hand() {
        let values = [3.0, -5.0, 1.0, 1.0];
        assert_eq!(mean(&values), 0.0);
        assert_eq!(rms(&values), 3.0);
        assert_eq!(standard_deviation(&[13.0, 5.0, 11.0, 11.0]), 3.0);
        assert_eq!(max_abs(&values), 5.0);
        assert_eq!(relative_error_percent(&[3.0, 4.0], &[3.0, 3.5]), 10.0);
    }

    #[test]
    fn medians_and_mean_squares_by_hand() {
        assert_eq!(median(&[5.0, 1.0, 3.0]), Some(3.0));
        assert_eq!(median(&[5.0, 1.0, 3.0, 4.0]), Some(4.0));
        assert_eq!(median(&[]), None);
        assert_eq!(mean_square(&[3.0, -1.0]), 5.0);
        assert_eq!(mean_square(&[]), 0.0);
    }

    #[test]
    fn quantiles_are_those_of_the_definition() {
        // R's default, type 7: quantile(c(1, 2, 4, 8), 0.25) = 1.75 and 0.5 = 3.
        let sorted = [1.0, 2.0, 4.0, 8.0];
        assert_eq!(
            [0.0, 0.25, 0.5, 1.0].map(|p| quantile(&sorted, p)),
            [1.0, 1.75, 3.0, 8.0]
        );
        assert!(quantile(&[], 0.5).is_nan());
        let some_never = [1.0, f64::INFINITY, f64::INFINITY];
        assert_eq!(quantile(&some_never, 0.9), f64::INFINITY);
        assert_eq!(quantile(&some_never, 0.25), f64::INFINITY);
    }

    #[test]
    fn correlations_by_hand() {
        assert_eq!(correlation(&[1.0, 2.0, 3.0], &[5.0, 7.0, 9.0]), Some(1.0));
        assert_eq!(correlation(&[1.0, 2.0, 3.0], &[3.0, 0.0, 3.0]), Some(0.0));
        assert_eq!(correlation(&[1.0, 2.0], &[3.0, 3.0]), None);
        assert_eq!(correlation(&[1.0, 2.0], &[3.0]), None);
        assert_eq!(correlation(&[], &[]), None);
        let alternating = [1.0, -1.0, 1.0, -1.0];
        assert_eq!(autocorrelation(&alternating, 1), -0.75);
        assert_eq!(autocorrelation(&alternating, 2), 0.5);
        assert_eq!(autocorrelation(&[0.0, 0.0], 1), 0.0);
    }

    #[test]
    fn what_is_not_a_number_stays_so() {
        for value in [mean(&[]), rms(&[]), standard_deviation(&[]), max_abs(&[])] {
            assert!(value.is_nan());
        }
        assert!(max_abs(&[f64::NAN, 1.0]).is_nan());
        assert!(max_abs(&[1.0, f64::NAN, 2.0]).is_nan());
    }
}
