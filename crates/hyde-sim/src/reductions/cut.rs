//! Where a comparison in what is measured changes within a stretch: what is measured may jump or bend there.
//!
//! A comparison `a > b` shows in its margin a - b, which is as smooth as the solution where its truth is not.

use crate::lobatto::{self, POINTS};

/// The point, and the time behind it, between which the sign of a margin changes, as far as its values and the polynomial through
/// them show.
pub(super) fn turn(times: &[f64; POINTS], margin: &[f64; POINTS]) -> Option<(usize, f64)> {
    let above = margin.map(|value| value > 0.0);
    if let Some(k) = (1..POINTS).find(|&k| above[k] != above[k - 1]) {
        return Some((k - 1, times[k]));
    }
    // It may cross zero and come back between two points.
    let sign = if above[0] { -1.0 } else { 1.0 };
    let beneath = margin.map(|value| sign * value);
    let most = beneath.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = beneath.iter().copied().fold(f64::INFINITY, f64::min);
    if most + (most - least) <= 0.0 || !lobatto::may_peak(&beneath) {
        return None;
    }
    let (place, value) = lobatto::largest(&beneath);
    let [start, .., end] = *times;
    (value > 0.0).then_some((0, start + 0.5 * (place + 1.0) * (end - start)))
}

/// Where what `holds` changes between two times, `at_first` at the first and the contrary at the second: the last instant on the
/// side of the first, the first on the side of the second. At the first, values may be those behind an event, which the
/// solver's interpolant has to rounding alone: 0 there is -1e-19 by it.
pub(super) fn change(
    at: &mut dyn FnMut(f64) -> Vec<f64>,
    (first, second): (f64, f64),
    at_first: bool,
    holds: impl Fn(&[f64]) -> bool,
) -> (f64, f64) {
    let (mut a, mut b) = (first, second);
    loop {
        let middle = 0.5 * (a + b);
        if middle <= a || middle >= b || b - a <= 1e-14 * b.abs() {
            return (a, b);
        }
        if holds(&at(middle)) == at_first {
            a = middle;
        } else {
            b = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_margin_that_crosses_zero_between_two_points_turns_there() {
        let times = lobatto::times(0.0, 2.0);
        let margin = |height: f64| times.map(|t| height - (t - 0.85) * (t - 0.85));
        // 0.85 lies between the second point, 0.345, and the middle, 1.
        let (from, to) = turn(&times, &margin(0.01)).unwrap();
        assert!(from == 0 && (0.75..0.95).contains(&to), "{from} {to}");
        assert_eq!(turn(&times, &margin(-0.01)), None);
        assert_eq!(turn(&times, &margin(0.1)), Some((1, times[2])));
        let (before, behind) = change(
            &mut |t| vec![0.01 - (t - 0.85) * (t - 0.85)],
            (times[from], to),
            false,
            |v| v[0] > 0.0,
        );
        assert!((before - 0.75).abs() < 1e-12 && behind > before && behind - before < 1e-13);
    }
}
