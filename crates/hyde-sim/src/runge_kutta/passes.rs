//! Passes over vectors, each of which does at once what belongs together: memory is read once, and sums run in four lanes
//! that the processor adds side by side. A machine with AVX2 does the same operations in the same order, more of them at
//! once: the bits are those of any machine. Passes are plain loops, for closures
//! are not compiled for such a machine; and what they write to comes as an argument of its own, so that the compiler knows
//! that nothing else is there. Where nothing is summed, vectors of
//! one group to three have passes of their own, without loops.

#![allow(
    clippy::needless_range_loop,
    reason = "one counter goes over many vectors of one length"
)]

use hyde_ida::with_few;
use multiversion::multiversion;

use super::LAST;
use super::lanes::{Group, LANES, Lanes};
use super::tableau::{ERROR, INSIDE, STAGES};

/// What the earlier stages say of a stage, and a first guess of it: a slope that goes on `part` of the way from the first
/// slope to the second.
///
/// ```text
/// slope = first + part*(second - first)
/// stage = before + sum(factors[j]*slopes[j]) + diagonal*slope
/// ```
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn predict(
    stage: &mut [f64],
    slope: &mut [f64],
    before: &[f64],
    slopes: &[Lanes],
    along: &Along,
) {
    with_few!(
        before.len(),
        n in [4 8 12],
        match slopes {
            [a] => predict_of(n, stage, slope, before, [a], along),
            [a, b] => predict_of(n, stage, slope, before, [a, b], along),
            [a, b, c] => predict_of(n, stage, slope, before, [a, b, c], along),
            [a, b, c, d] => predict_of(n, stage, slope, before, [a, b, c, d], along),
            [a, b, c, d, e] => predict_of(n, stage, slope, before, [a, b, c, d, e], along),
            [a, b, c, d, e, f, ..] => {
                predict_of(n, stage, slope, before, [a, b, c, d, e, f], along);
            }
            [] => {}
        }
    );
}

/// What a stage takes of the slopes before it.
pub(super) struct Along {
    pub(super) factors: [f64; STAGES],
    pub(super) part: f64,
    pub(super) diagonal: f64,
}

/// The same for so many earlier stages, summed from the first on.
#[inline(always)]
fn predict_of<const EARLIER: usize>(
    n: usize,
    stage: &mut [f64],
    slope: &mut [f64],
    before: &[f64],
    earlier: [&Lanes; EARLIER],
    along: &Along,
) {
    let (stage, slope, before) = (&mut stage[..n], &mut slope[..n], &before[..n]);
    let mut slopes = [before; EARLIER];
    let mut factors = [0.0; EARLIER];
    for j in 0..EARLIER {
        slopes[j] = &earlier[j].whole()[..n];
        factors[j] = along.factors[j];
    }
    let (part, diagonal) = (along.part, along.diagonal);
    for k in 0..n {
        let mut known = before[k];
        for j in 0..EARLIER {
            known += factors[j] * slopes[j][k];
        }
        let (first, second) = (slopes[0][k], slopes[1.min(EARLIER - 1)][k]);
        let guess = first + part * (second - first);
        slope[k] = guess;
        stage[k] = known + diagonal * guess;
    }
}

/// 1 over the tolerance of each unknown, and the same where its error counts. The size of a state is its own, that of an
/// algebraic variable its largest: it is the difference of large ones wherever it passes zero.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn weights(
    (weights, counted): (&mut [f64], &mut [f64]),
    (differential, counts): (&[bool], &[bool]),
    (before, largest): (&[f64], &[f64]),
    (rtol, atol): (f64, &[f64]),
) {
    let kinds = differential.iter().zip(counts);
    let sizes = before.iter().zip(largest).zip(atol);
    let vectors = weights.iter_mut().zip(counted.iter_mut());
    for ((weight, counted), ((differential, counts), ((before, largest), atol))) in
        vectors.zip(kinds.zip(sizes))
    {
        let size = if *differential {
            before.abs()
        } else {
            *largest
        };
        *weight = 1.0 / (rtol * size + atol);
        *counted = if *counts { *weight } else { 0.0 };
    }
}

/// Keeps the largest size of each value.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn keep_largest(largest: &mut Lanes, values: &Lanes) {
    for (largest, value) in largest.whole_mut().iter_mut().zip(values.whole()) {
        *largest = larger(value.abs(), *largest);
    }
}

/// What estimates the errors of a step.
pub(super) struct Estimated {
    /// The largest error inside the step, in parts of what is seen there.
    pub(super) inside: f64,
    /// The largest difference of the two formulas, and of the interpolant to a stage, in units of the tolerance.
    pub(super) rough: f64,
}

/// The errors that the slopes of a step tell.
///
/// The `errors` become slopes whose residual the estimated error of values follows from: `end + cj*h*error`, where `error` is
/// the difference of the two formulas. What is beyond the interpolant's cubic becomes `inside`, in parts of `seen` of the
/// largest that an unknown has been, of each that counts.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn estimate(
    (errors, inside): (&mut Lanes, &mut Lanes),
    slopes: &[Lanes],
    (largest, stage): (&Lanes, &Lanes),
    (atol, weights, counted): (&Lanes, &Lanes, &Lanes),
    (h, cj, seen): (f64, f64, f64),
) -> Estimated {
    let errors = errors.groups_mut();
    let n = errors.len();
    let inside = &mut inside.groups_mut()[..n];
    let (largest, stage) = (&largest.groups()[..n], &stage.groups()[..n]);
    let (weights, counted) = (&weights.groups()[..n], &counted.groups()[..n]);
    let atol = &atol.groups()[..n];
    let mut groups = [largest; STAGES];
    for j in 0..STAGES {
        groups[j] = &slopes[j].groups()[..n];
    }
    let (mut most, mut rough) = ([0.0; LANES], [0.0; LANES]);
    for group in 0..n {
        let last = groups[LAST][group];
        let (mut error, mut beyond) = ([0.0; LANES], [0.0; LANES]);
        for k in 0..LANES {
            error[k] = ERROR[LAST] * last[k];
            beyond[k] = INSIDE[LAST] * last[k];
        }
        for j in 0..LAST {
            let slope = groups[j][group];
            for k in 0..LANES {
                error[k] += ERROR[j] * slope[k];
                beyond[k] += INSIDE[j] * slope[k];
            }
        }
        let (largest, stage, atol) = (largest[group], stage[group], atol[group]);
        let (weights, counted) = (weights[group], counted[group]);
        for k in 0..LANES {
            // What fills up a group has no size and no tolerance.
            let size = seen * larger(largest[k], stage[k].abs()) + atol[k];
            let off = larger(beyond[k].abs(), error[k].abs());
            rough[k] = larger(h * off * weights[k], rough[k]);
            let part = h * beyond[k].abs() / size;
            beyond[k] = if counted[k] > 0.0 { part } else { 0.0 };
            most[k] = larger(beyond[k], most[k]);
            error[k] = last[k] + cj * h * error[k];
        }
        (inside[group], errors[group]) = (beyond, error);
    }
    Estimated {
        inside: largest_of(most),
        rough: largest_of(rough),
    }
}

/// The larger of two; the second where the first is no number.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The largest of values that are not negative.
#[inline(always)]
fn largest_of(values: Group) -> f64 {
    let mut largest = 0.0;
    for value in values {
        largest = larger(value, largest);
    }
    largest
}

/// A value and a rate within a step: those of its begin and of the rise to its end, and of the slopes with their shares.
///
/// ```text
/// y = before + rise.0*(end - before) + sum(shares[j].0*slopes[j])
/// yp =         rise.1*(end - before) + sum(shares[j].1*slopes[j])
/// ```
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn inside(
    y: &mut [f64],
    yp: &mut [f64],
    (before, end): (&Lanes, &Lanes),
    rise: (f64, f64),
    (slopes, shares): (&[Lanes], &[(f64, f64); STAGES]),
) {
    let (before, end) = (before.whole(), end.whole());
    let mut whole = [before; STAGES];
    for j in 0..STAGES {
        whole[j] = slopes[j].whole();
    }
    with_few!(
        y.len(),
        n in [1 2 3 4 5 6 7 8],
        inside_of(n, y, yp, (before, end), rise, (whole, shares))
    );
}

#[inline(always)]
fn inside_of(
    n: usize,
    y: &mut [f64],
    yp: &mut [f64],
    (before, end): (&[f64], &[f64]),
    rise: (f64, f64),
    (mut slopes, shares): ([&[f64]; STAGES], &[(f64, f64); STAGES]),
) {
    let (y, yp, before, end) = (&mut y[..n], &mut yp[..n], &before[..n], &end[..n]);
    for slope in &mut slopes {
        *slope = &slope[..n];
    }
    for k in 0..n {
        let step = end[k] - before[k];
        let (mut value, mut rate) = (before[k] + rise.0 * step, rise.1 * step);
        for j in 0..STAGES {
            value += shares[j].0 * slopes[j][k];
            rate += shares[j].1 * slopes[j][k];
        }
        (y[k], yp[k]) = (value, rate);
    }
}

/// Whether all values are finite: what is not, times 0, is not 0.
#[inline(always)]
pub(super) fn are_finite(values: &Lanes) -> bool {
    let mut sums = [0.0; LANES];
    for values in values.groups() {
        for (sum, value) in sums.iter_mut().zip(values) {
            *sum += 0.0 * value;
        }
    }
    sums.iter().sum::<f64>() == 0.0
}

/// In units of the tolerance, a correction that is none: it is far below the rounding of what it corrects, unless that is 0.
const NONE: f64 = 1e-9;

/// What Newton's method makes of a correction: `stage -= correction` and `slope -= cj*correction`. What rests at 0 rests to
/// the last bit. Returns the sum of the squares of the corrections that count, in units of the tolerance; NaN if one is not
/// finite.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn correct(
    (stage, slope): (&mut Lanes, &mut Lanes),
    correction: &Lanes,
    (weights, counted): (&Lanes, &Lanes),
    cj: f64,
) -> f64 {
    let corrected = stage.groups_mut().iter_mut().zip(slope.groups_mut());
    let corrections = correction.groups().iter();
    let tolerances = weights.groups().iter().zip(counted.groups());
    let mut sums = [0.0; LANES];
    for (((to_stage, to_slope), correction), (weights, counted)) in
        corrected.zip(corrections).zip(tolerances)
    {
        let (mut stage, mut slope) = (*to_stage, *to_slope);
        for k in 0..LANES {
            let part = correction[k] * counted[k];
            sums[k] += part * part;
            let none = (correction[k] * weights[k]).abs() <= NONE;
            let correction = if none { 0.0 } else { correction[k] };
            stage[k] -= correction;
            slope[k] -= cj * correction;
        }
        (*to_stage, *to_slope) = (stage, slope);
    }
    sums.iter().sum()
}

/// The sum of the squares of weighted values; NaN if one of them is not finite, whatever its weight.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn sum_of_squares(values: &Lanes, weights: &Lanes) -> f64 {
    let groups = values.groups().iter();
    let mut sums = [0.0; LANES];
    for (values, weights) in groups.zip(weights.groups()) {
        for ((sum, value), weight) in sums.iter_mut().zip(values).zip(weights) {
            let part = value * weight;
            *sum += part * part;
        }
    }
    sums.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn waves(count: usize, n: usize) -> Vec<Lanes> {
        let value = |j: usize, i: usize| ((j * n + i) as f64).sin();
        let wave = |j| Lanes::from((0..n).map(|i| value(j, i)).collect::<Vec<_>>().as_slice());
        (0..count).map(wave).collect()
    }

    #[test]
    fn a_stage_is_the_sum_of_one_term_after_the_other() {
        let factors = [0.1, -0.2, 0.3, 0.7, -1.1, 2.0, 0.5];
        let (slopes, before) = (waves(6, 7), waves(7, 7).remove(6));
        for count in 1..=6 {
            let (mut stage, mut slope) = (Lanes::zeros(7), Lanes::zeros(7));
            let earlier = &slopes[..count];
            let (to_stage, to_slope) = (stage.whole_mut(), slope.whole_mut());
            let along = Along {
                factors,
                part: 0.4,
                diagonal: 0.3,
            };
            predict(to_stage, to_slope, before.whole(), earlier, &along);
            for index in 0..7 {
                let terms = factors.iter().zip(earlier);
                let known = terms.fold(before[index], |sum, (a, k)| sum + a * k[index]);
                let (first, second) = (earlier[0][index], earlier[1.min(count - 1)][index]);
                let guessed = first + 0.4 * (second - first);
                assert_eq!(slope[index].to_bits(), guessed.to_bits(), "{count} terms");
                let expected = known + 0.3 * guessed;
                assert_eq!(stage[index].to_bits(), expected.to_bits(), "{count} terms");
            }
            assert_eq!(stage.whole()[7].to_bits(), 0, "what fills up");
        }
    }

    #[test]
    fn what_is_not_finite_is_seen_at_any_weight() {
        let weights = Lanes::from([1.0, 2.0, 0.0, 1.0, 0.0].as_slice());
        let sum = sum_of_squares(&Lanes::from([1.0, 1.0, 9.0, 2.0, 9.0].as_slice()), &weights);
        assert_eq!(sum.to_bits(), 9.0_f64.to_bits());
        for bad in [f64::NAN, f64::INFINITY] {
            for place in 0..weights.len() {
                let mut values = Lanes::from([1.0; 5].as_slice());
                values[place] = bad;
                let (mut stage, mut slope) = (values.clone(), values.clone());
                let corrected =
                    correct((&mut stage, &mut slope), &values, (&weights, &weights), 1.0);
                let sums = [sum_of_squares(&values, &weights), corrected];
                assert!(sums.iter().all(|sum| !sum.is_finite()), "{bad} at {place}");
                assert!(!are_finite(&values), "{bad} at {place}");
            }
        }
    }
}
