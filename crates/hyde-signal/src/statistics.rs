//! Single numbers of a sequence of samples. All of them are NaN for an empty sequence.

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
    fn what_is_not_a_number_stays_so() {
        for value in [mean(&[]), rms(&[]), standard_deviation(&[]), max_abs(&[])] {
            assert!(value.is_nan());
        }
        assert!(max_abs(&[f64::NAN, 1.0]).is_nan());
        assert!(max_abs(&[1.0, f64::NAN, 2.0]).is_nan());
    }
}
