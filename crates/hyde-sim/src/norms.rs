//! Norms of vectors, in lanes that the processor works on side by side. A number that is none counts for nothing.

use multiversion::multiversion;

/// Numbers that are worked on at once.
const LANES: usize = 8;

/// The Euclidean norm.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn norm(values: &[f64]) -> f64 {
    let mut sums = [0.0; LANES];
    let (groups, rest) = values.as_chunks::<LANES>();
    for group in groups {
        for lane in 0..LANES {
            sums[lane] += group[lane] * group[lane];
        }
    }
    let rest: f64 = rest.iter().map(|value| value * value).sum();
    (sums.iter().sum::<f64>() + rest).sqrt()
}

/// The largest magnitude.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn largest_of(values: &[f64]) -> f64 {
    let mut most = [0.0; LANES];
    let (groups, rest) = values.as_chunks::<LANES>();
    for group in groups {
        for lane in 0..LANES {
            most[lane] = larger(group[lane].abs(), most[lane]);
        }
    }
    let all = rest.iter().map(|value| value.abs()).chain(most);
    all.fold(0.0, |most, value| larger(value, most))
}

/// The largest magnitude over a number of the same place.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn largest_part(values: &[f64], of: &[f64]) -> f64 {
    let mut most = [0.0; LANES];
    let (values, rest) = values.as_chunks::<LANES>();
    let (of, of_rest) = of.as_chunks::<LANES>();
    for (group, of) in values.iter().zip(of) {
        for lane in 0..LANES {
            most[lane] = larger(group[lane].abs() / of[lane], most[lane]);
        }
    }
    let rest = rest.iter().zip(of_rest);
    let all = rest.map(|(value, of)| value.abs() / of).chain(most);
    all.fold(0.0, |most, value| larger(value, most))
}

/// The largest correction over `relative*(|value| + beside) + least`.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn largest_correction(
    corrections: &[f64],
    values: &[f64],
    (relative, beside, least): (f64, f64, f64),
) -> f64 {
    let mut most = [0.0; LANES];
    let (corrections, rest) = corrections.as_chunks::<LANES>();
    let (values, values_rest) = values.as_chunks::<LANES>();
    for (group, values) in corrections.iter().zip(values) {
        for lane in 0..LANES {
            let tolerance = relative * (values[lane].abs() + beside) + least;
            most[lane] = larger(group[lane].abs() / tolerance, most[lane]);
        }
    }
    let mut all = most.iter().fold(0.0, |most, value| larger(*value, most));
    for (correction, value) in rest.iter().zip(values_rest) {
        let tolerance = relative * (value.abs() + beside) + least;
        all = larger(correction.abs() / tolerance, all);
    }
    all
}

/// The root mean square of numbers over `relative*|value| + absolute`; 0 without any.
#[multiversion(targets("x86_64+avx2"))]
pub(crate) fn mean_over_tolerances(
    numbers: &[f64],
    values: &[f64],
    (relative, absolute): (f64, f64),
) -> f64 {
    let count = numbers.len().max(1) as f64;
    let mut sums = [0.0; LANES];
    let (numbers, rest) = numbers.as_chunks::<LANES>();
    let (values, values_rest) = values.as_chunks::<LANES>();
    for (group, values) in numbers.iter().zip(values) {
        for lane in 0..LANES {
            let part = group[lane] / (relative * values[lane].abs() + absolute);
            sums[lane] += part * part;
        }
    }
    let mut all: f64 = sums.iter().sum();
    for (number, value) in rest.iter().zip(values_rest) {
        let part = number / (relative * value.abs() + absolute);
        all += part * part;
    }
    (all / count).sqrt()
}

/// The first if it is larger.
#[inline(always)]
fn larger(value: f64, most: f64) -> f64 {
    if value > most { value } else { most }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_and_what_is_left_of_them_count_alike() {
        for n in [0, 1, 7, 8, 9, 16, 19] {
            for at in 0..n {
                let mut values = vec![0.5; n];
                values[at] = -3.0;
                let others = vec![2.0; n];
                assert!((largest_of(&values) - 3.0).abs() < 1e-15);
                assert!((largest_part(&values, &others) - 1.5).abs() < 1e-15);
                let size = largest_correction(&values, &others, (0.25, 1.0, 0.25));
                assert!((size - 3.0).abs() < 1e-15);
                let square = 9.0 + 0.25 * (n as f64 - 1.0);
                assert!((norm(&values) - square.sqrt()).abs() < 1e-14);
                let mean = mean_over_tolerances(&values, &others, (0.25, 0.5));
                assert!((mean - (square / n as f64).sqrt()).abs() < 1e-14);
                values[at] = f64::NAN;
                assert!(largest_of(&values) <= 0.5);
            }
        }
    }
}
