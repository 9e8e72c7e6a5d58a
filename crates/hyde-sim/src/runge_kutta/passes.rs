//! Passes over vectors, each of which does at once what belongs together: memory is read once, and sums run in four lanes
//! that the processor adds side by side. A machine with AVX2 does the same operations in the same order, more of them at
//! once: the bits are those of any machine.

use std::array;

use multiversion::multiversion;

use super::LAST;
use super::tableau::STAGES;

/// Lanes of a sum.
const LANES: usize = 4;

/// `to = from + sum(factors[j]*slopes[j])`, summed from the first on.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn combine(to: &mut [f64], from: &[f64], factors: &[f64], slopes: &[Vec<f64>]) {
    match (factors, slopes) {
        ([a], [k, ..]) => {
            for ((to, from), k) in to.iter_mut().zip(from).zip(k) {
                *to = from + a * k;
            }
        }
        ([a, b], [k, l, ..]) => {
            for (((to, from), k), l) in to.iter_mut().zip(from).zip(k).zip(l) {
                *to = from + a * k + b * l;
            }
        }
        ([a, b, c, rest @ ..], [k, l, m, others @ ..]) => {
            for ((((to, from), k), l), m) in to.iter_mut().zip(from).zip(k).zip(l).zip(m) {
                *to = from + a * k + b * l + c * m;
            }
            add(to, rest, others);
        }
        _ => to.copy_from_slice(from),
    }
}

/// `to += sum(factors[j]*slopes[j])`.
#[inline(always)]
fn add(to: &mut [f64], factors: &[f64], slopes: &[Vec<f64>]) {
    match (factors, slopes) {
        ([a, b, rest @ ..], [k, l, others @ ..]) => {
            for ((to, k), l) in to.iter_mut().zip(k).zip(l) {
                *to = *to + a * k + b * l;
            }
            add(to, rest, others);
        }
        ([a], [k, ..]) => {
            for (to, k) in to.iter_mut().zip(k) {
                *to += a * k;
            }
        }
        _ => {}
    }
}

/// A first guess of a stage: a slope that goes on `part` of the way from the first to the second, and with it
/// `stage = base + diagonal*slope`.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn guess(
    (stage, slope): (&mut [f64], &mut [f64]),
    base: &[f64],
    (first, second): (&[f64], &[f64]),
    (part, diagonal): (f64, f64),
) {
    let guesses = stage.iter_mut().zip(slope.iter_mut());
    let known = base.iter().zip(first).zip(second);
    for ((stage, slope), ((base, first), second)) in guesses.zip(known) {
        *slope = first + part * (second - first);
        *stage = base + diagonal * *slope;
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
pub(super) fn keep_largest(largest: &mut [f64], values: &[f64]) {
    for (largest, value) in largest.iter_mut().zip(values) {
        *largest = larger(value.abs(), *largest);
    }
}

/// What is beyond the interpolant's cubic, in parts of `seen` of the largest that an unknown has been: of each that
/// counts.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn unseen(
    parts: &mut [f64],
    (h, seen): (f64, f64),
    (largest, stage): (&[f64], &[f64]),
    (atol, counted): (&[f64], &[f64]),
) {
    let sizes = largest.iter().zip(stage).zip(atol).zip(counted);
    for (part, (((largest, stage), atol), counted)) in parts.iter_mut().zip(sizes) {
        let largest = larger(*largest, stage.abs());
        let all = h * part.abs() / (seen * largest + atol);
        *part = if *counted > 0.0 { all } else { 0.0 };
    }
}

/// Makes of estimated errors of slopes the slopes whose residual the estimated error of values follows from,
/// `end + cj*h*error`. Returns the largest error in units of the tolerance.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn erroneous(
    errors: &mut [f64],
    end: &[f64],
    weights: &[f64],
    (h, cj): (f64, f64),
) -> f64 {
    let mut lanes = [0.0; LANES];
    for ((errors, end), weights) in
        (errors.chunks_mut(LANES).zip(end.chunks(LANES))).zip(weights.chunks(LANES))
    {
        let all = lanes.iter_mut().zip(errors).zip(end).zip(weights);
        for (((lane, error), end), weight) in all {
            *lane = larger((h * *error * weight).abs(), *lane);
            *error = end + cj * h * *error;
        }
    }
    lanes.into_iter().fold(0.0, larger)
}

/// The largest of values that are not negative.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn largest_of(values: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    for values in values.chunks(LANES) {
        for (lane, value) in lanes.iter_mut().zip(values) {
            *lane = larger(*value, *lane);
        }
    }
    lanes.into_iter().fold(0.0, larger)
}

/// The larger of two; the second where the first is no number.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// `to = sum(parts[j]*slopes[j])`, summed from the last one on and then from the first.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn weigh(to: &mut [f64], slopes: &[Vec<f64>], parts: &[f64; STAGES]) {
    let n = to.len();
    let slopes: [&[f64]; STAGES] = array::from_fn(|j| &slopes[j][..n]);
    for (index, to) in to.iter_mut().enumerate() {
        let last = parts[LAST] * slopes[LAST][index];
        let earlier = parts.iter().zip(slopes).take(LAST);
        *to = earlier.fold(last, |sum, (part, slope)| sum + part * slope[index]);
    }
}

/// A value and a rate within a step: those of its begin and of the rise to its end, and of the slopes with their shares.
///
/// ```text
/// y = before + rise.0*(end - before) + sum(shares[j].0*slopes[j])
/// yp =         rise.1*(end - before) + sum(shares[j].1*slopes[j])
/// ```
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn inside(
    (y, yp): (&mut [f64], &mut [f64]),
    (before, end): (&[f64], &[f64]),
    rise: (f64, f64),
    slopes: &[Vec<f64>],
    shares: &[(f64, f64); STAGES],
) {
    let n = y.len();
    let slopes: [&[f64]; STAGES] = array::from_fn(|j| &slopes[j][..n]);
    let ends = before[..n].iter().zip(&end[..n]).enumerate();
    for ((y, yp), (index, (before, end))) in y.iter_mut().zip(&mut yp[..n]).zip(ends) {
        let step = end - before;
        (*y, *yp) = (before + rise.0 * step, rise.1 * step);
        for ((value, rate), slope) in shares.iter().zip(slopes) {
            *y += value * slope[index];
            *yp += rate * slope[index];
        }
    }
}

/// Whether all values are finite: what is not, times 0, is not 0.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn are_finite(values: &[f64]) -> bool {
    let mut lanes = [0.0; LANES];
    let mut values = values.chunks_exact(LANES);
    for values in values.by_ref() {
        for (lane, value) in lanes.iter_mut().zip(values) {
            *lane += 0.0 * value;
        }
    }
    let rest = values.remainder().iter().all(|value| value.is_finite());
    rest && lanes.iter().all(|lane| lane.is_finite())
}

/// In units of the tolerance, a correction that is none: it is far below the rounding of what it corrects, unless that is 0.
const NONE: f64 = 1e-9;

/// What Newton's method makes of a correction: `stage -= correction` and `slope -= cj*correction`. What rests at 0 rests to
/// the last bit.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn correct(
    stage: &mut [f64],
    slope: &mut [f64],
    correction: &[f64],
    weights: &[f64],
    cj: f64,
) {
    let vectors = stage.iter_mut().zip(slope.iter_mut());
    for (((stage, slope), correction), weight) in vectors.zip(correction).zip(weights) {
        let none = (correction * weight).abs() <= NONE;
        let correction = if none { 0.0 } else { *correction };
        *stage -= correction;
        *slope -= cj * correction;
    }
}

/// The sum of the squares of weighted values; NaN if one of them is not finite, whatever its weight.
#[multiversion(targets("x86_64+avx2"))]
pub(super) fn sum_of_squares(values: &[f64], weights: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    let (mut values, mut weights) = (values.chunks_exact(LANES), weights.chunks_exact(LANES));
    for (values, weights) in values.by_ref().zip(weights.by_ref()) {
        for ((lane, value), weight) in lanes.iter_mut().zip(values).zip(weights) {
            let part = value * weight;
            *lane += part * part;
        }
    }
    let rest = values.remainder().iter().zip(weights.remainder());
    for ((value, weight), lane) in rest.zip(&mut lanes) {
        let part = value * weight;
        *lane += part * part;
    }
    lanes.iter().sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sums_are_those_of_one_term_after_the_other() {
        let slopes: Vec<Vec<f64>> = (0..6)
            .map(|j| (0..7).map(|i| f64::from(j * 7 + i).sin()).collect())
            .collect();
        let from: Vec<f64> = (0..7).map(|i| f64::from(i).cos()).collect();
        let factors = [0.1, -0.2, 0.3, 0.7, -1.1, 2.0];
        for count in 0..=factors.len() {
            let mut to = vec![f64::NAN; 7];
            combine(&mut to, &from, &factors[..count], &slopes);
            for (index, value) in to.iter().enumerate() {
                let terms = factors[..count].iter().zip(&slopes);
                let expected = terms.fold(from[index], |sum, (a, k)| sum + a * k[index]);
                assert_eq!(value.to_bits(), expected.to_bits(), "{count} terms");
            }
        }
    }

    #[test]
    fn what_is_not_finite_is_seen_at_any_weight() {
        let weights = [1.0, 2.0, 0.0, 1.0, 0.0];
        let sum = sum_of_squares(&[1.0, 1.0, 9.0, 2.0, 9.0], &weights);
        assert_eq!(sum.to_bits(), 9.0_f64.to_bits());
        for bad in [f64::NAN, f64::INFINITY] {
            for place in 0..weights.len() {
                let mut values = [1.0; 5];
                values[place] = bad;
                assert!(
                    !sum_of_squares(&values, &weights).is_finite(),
                    "{bad} at {place}"
                );
                assert!(!are_finite(&values), "{bad} at {place}");
            }
        }
    }
}
