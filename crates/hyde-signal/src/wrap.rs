//! Signals that begin again after a period, as an angle after a turn.

/// A difference but for whole periods: the one nearest to 0.
#[must_use]
pub fn nearest(difference: f64, period: f64) -> f64 {
    difference - period * (difference / period).round()
}

/// Makes a signal go on where it began again: from value to value it then changes by half a period at most. A value that is
/// missing is passed over.
pub fn unwrap(values: &mut [f64], period: f64) {
    let mut last = None;
    for value in values.iter_mut().filter(|value| value.is_finite()) {
        if let Some(last) = last {
            *value = last + nearest(*value - last, period);
        }
        last = Some(*value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_angle_within_its_turn_goes_on() {
        let whole: Vec<f64> = (0..100).map(|row| 0.7 * f64::from(row)).collect();
        let mut turning: Vec<f64> = whole.iter().map(|x| x.rem_euclid(6.0)).collect();
        turning[40] = f64::NAN;
        unwrap(&mut turning, 6.0);
        for (row, (a, b)) in turning.iter().zip(&whole).enumerate() {
            assert!(row == 40 || (a - b).abs() < 1e-9, "{row}: {a} {b}");
        }
        assert!((nearest(5.9, 6.0) + 0.1).abs() < 1e-12);
    }
}
