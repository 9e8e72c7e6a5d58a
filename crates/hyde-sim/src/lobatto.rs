//! The rule of Lobatto with five points, and the polynomial of degree 4 through its values.
//!
//! Both ends of a stretch are points of the rule, so neighbouring stretches share them. It is exact to degree 7 (Hairer,
//! Nørsett, Wanner, *Solving Ordinary Differential Equations I*, II.7).

/// Points of the rule.
pub(crate) const POINTS: usize = 5;
/// The point in the middle.
pub(crate) const MIDDLE: usize = 2;
/// sqrt(3/7)
const INNER: f64 = 0.654_653_670_707_977_1;
/// The points on -1..1.
pub(crate) const NODES: [f64; POINTS] = [-1.0, -INNER, 0.0, INNER, 1.0];
/// The share of each point in an integral over -1..1.
pub(crate) const WEIGHTS: [f64; POINTS] = [0.1, 49.0 / 90.0, 32.0 / 45.0, 49.0 / 90.0, 0.1];
/// The share of each value in the coefficient of Legendre's polynomial of degree 4.
const FOURTH: [f64; POINTS] = [0.2, -7.0 / 15.0, 8.0 / 15.0, -7.0 / 15.0, 0.2];
/// The share of each value in the slope of the polynomial at -1.
const FIRST_SLOPE: [f64; POINTS] = [
    -5.0,
    6.756_502_488_724_238,
    -8.0 / 3.0,
    1.410_164_177_942_427,
    -0.5,
];
/// Where the largest value of a polynomial is looked for: the parts that -1..1 is divided into.
const PARTS: u32 = 32;

/// The points between two times.
pub(crate) fn times(from: f64, to: f64) -> [f64; POINTS] {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let mut times = NODES.map(|node| middle + half * node);
    (times[0], times[POINTS - 1]) = (from, to);
    times
}

/// What the polynomial through these values has beyond a cubic: the largest value of its part of degree 4.
pub(crate) fn beyond_cubic(values: &[f64; POINTS]) -> f64 {
    let parts = FOURTH.iter().zip(values);
    parts.map(|(part, value)| part * value).sum::<f64>().abs()
}

/// Whether the polynomial through these values may be larger between them than at both ends and every point: it is not
/// where they rise or fall all along, and its slopes at both ends do so too.
pub(crate) fn may_peak(values: &[f64; POINTS]) -> bool {
    let rises = |sign: f64| {
        let mut pairs = values.windows(2).map(|pair| sign * (pair[1] - pair[0]));
        pairs.all(|rise| rise >= 0.0)
    };
    let slope = |shares: &[f64; POINTS]| -> f64 {
        shares.iter().zip(values).map(|(share, v)| share * v).sum()
    };
    let backwards: [f64; POINTS] = std::array::from_fn(|k| -FIRST_SLOPE[POINTS - 1 - k]);
    let (first, last) = (slope(&FIRST_SLOPE), slope(&backwards));
    !(rises(1.0) && first >= 0.0 && last >= 0.0 || rises(-1.0) && first <= 0.0 && last <= 0.0)
}

/// Where on -1..1 the polynomial through these values is largest, and its value there.
pub(crate) fn largest(values: &[f64; POINTS]) -> (f64, f64) {
    let at = |place: f64| (place, polynomial(values, place));
    let grid = (0..=PARTS).map(|k| at(2.0 * f64::from(k) / f64::from(PARTS) - 1.0));
    let best = |a: (f64, f64), b: (f64, f64)| if b.1 > a.1 { b } else { a };
    let mut found = grid.fold((-1.0, f64::NEG_INFINITY), best);
    let mut step = 2.0 / f64::from(PARTS);
    while step > 1e-7 {
        step *= 0.5;
        let sides = [found.0 - step, found.0 + step].map(|place| at(place.clamp(-1.0, 1.0)));
        found = sides.into_iter().fold(found, best);
    }
    found
}

/// The polynomial at a place on -1..1, by Lagrange's formula.
fn polynomial(values: &[f64; POINTS], place: f64) -> f64 {
    let term = |i: usize| {
        let others = (0..POINTS).filter(|&k| k != i);
        let parts = others.map(|k| (place - NODES[k]) / (NODES[i] - NODES[k]));
        values[i] * parts.product::<f64>()
    };
    (0..POINTS).map(term).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_degree_four_is_met_everywhere() {
        let f = |x: f64| 1.0 - (x - 0.3).powi(2) * (1.0 + 0.1 * x * x);
        let values = NODES.map(f);
        let (place, value) = largest(&values);
        // The place by halving down to 1e-7, the value to the square of it.
        assert!((place - 0.3).abs() < 1e-6, "{place}");
        assert!((value - 1.0).abs() < 1e-12, "{value}");
        // x^4 = 8/35 P4 + …
        let quartic = beyond_cubic(&NODES.map(|x| x.powi(4)));
        assert!((quartic - 8.0 / 35.0).abs() < 1e-15);
        // The slope at -1 of x + 2 x^2 is -3.
        let slope = FIRST_SLOPE.iter().zip(NODES.map(|x| x + 2.0 * x * x));
        let slope: f64 = slope.map(|(share, v)| share * v).sum();
        assert!((slope + 3.0).abs() < 1e-14, "{slope}");
        assert!(may_peak(&values) && !may_peak(&NODES) && may_peak(&NODES.map(|x| -x * x)));
        assert!(beyond_cubic(&NODES.map(|x| 3.0 * x.powi(3) - x * x)) < 1e-15);
    }
}
