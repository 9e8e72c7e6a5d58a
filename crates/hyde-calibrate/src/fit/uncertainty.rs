//! How sharply a solution determines its parameters: their covariance, with what innovations tell less than independent ones.

use super::solution::Solution;
use crate::observer::Innovations;
use hyde_signal::statistics::autocorrelation;
use hyde_signal::statistics::distributions::student;
use nalgebra::{DMatrix, DVector};
use std::borrow::Cow;

/// By how much a sum of squares overstates what is known: the mean square where it is above one, and (1 + rho)/(1 - rho)
/// for correlated errors (Bartlett, J. R. Stat. Soc. Suppl. 8, 1946, 27), over all channels.
pub(crate) fn inflation(innovations: &[Innovations]) -> f64 {
    inflation_over(innovations.iter().flat_map(Innovations::each_of_readings))
}

/// The same of the channel where it is largest.
fn largest_inflation(innovations: &[Innovations]) -> f64 {
    let channels = innovations.iter().map(|own| own.channels.len()).max();
    let each = (0..channels.unwrap_or(0)).map(|channel| {
        let with_it = innovations
            .iter()
            .filter(|own| channel < own.channels.len());
        inflation_over(with_it.map(|own| own.of_readings(channel)))
    });
    each.fold(1.0, f64::max)
}

fn inflation_over<'a>(lists: impl Iterator<Item = Cow<'a, [f64]>>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for list in lists {
        let rho = autocorrelation(&list, 1).clamp(0.0, 0.99);
        let squares: f64 = list.iter().map(|r| r * r).sum();
        sum += squares * (1.0 + rho) / (1.0 - rho);
        count += list.len() as f64;
    }
    (sum / f64::max(count, 1.0)).max(1.0)
}

/// By how much a sum of squares overstates what is known of some parameters: the scatter of gradients from second to second,
/// which knows how they go with what is not explained (White, Econometrica 50, 1982, 1); at most [`inflation`] of
/// the channel where it is largest, which takes them to change as slowly as they can.
pub(crate) fn inflation_of(solution: &Solution, own: impl IntoIterator<Item = usize>) -> f64 {
    let most = largest_inflation(&solution.innovations);
    let Some(bread) = solution.inverse_curvature() else {
        return most;
    };
    let (scatter, blocks) = &solution.scatter;
    let scattered = &bread * (scatter * few(*blocks)) * &bread;
    let each = own.into_iter().map(|i| scattered[(i, i)] / bread[(i, i)]);
    each.fold(1.0, f64::max).min(most)
}

/// The covariance of the parameters, in units of their scales: that of independent innovations, less what they tell less than
/// such, and no deviation smaller than the scatter of gradients from second to second says. What a model lacks is not
/// independent from row to row, and shows there (White, Econometrica 50, 1982, 1). The scatter of few blocks is itself uncertain:
/// Student's quantile for one freedom less takes the normal one's place (Cameron and Miller, J. Hum. Resour. 50, 2015, 317).
pub(crate) fn covariance(solution: &Solution, inflation: f64) -> DMatrix<f64> {
    covariance_of_first(solution, inflation, solution.values.len())
}

/// The same of the first `n` parameters, the others held where they are.
pub(crate) fn covariance_of_first(solution: &Solution, inflation: f64, n: usize) -> DMatrix<f64> {
    let first = |matrix: &DMatrix<f64>| matrix.view((0, 0), (n, n)).into_owned();
    let (data, priors) = &solution.curvature;
    let (data, priors) = (&first(data), &first(priors));
    let largest = data
        .diagonal()
        .iter()
        .fold(1e-300_f64, |most, v| most.max(*v));
    let floor = DMatrix::identity(n, n) * (1e-12 * largest);
    let unknown = || DMatrix::from_element(n, n, f64::NAN);
    let inverse = |matrix: DMatrix<f64>| matrix.try_inverse().unwrap_or_else(unknown);
    let independent = inverse(data / inflation + priors + &floor);
    let weighed = solution.weight * priors;
    let bread = inverse(data + &weighed + floor);
    let (scatter, blocks) = (first(&solution.scatter.0), &solution.scatter.1);
    let scattered = &bread * (scatter * few(*blocks) + weighed) * &bread;
    let wider = DVector::from_fn(n, |i, _| {
        (scattered[(i, i)] / independent[(i, i)]).max(1.0).sqrt() * solution.wider[i]
    });
    DMatrix::from_fn(n, n, |i, j| independent[(i, j)] * wider[i] * wider[j])
}

/// By how much the scatter of so many blocks is to be taken for more than it is.
fn few(blocks: usize) -> f64 {
    let blocks = blocks.max(2);
    blocks as f64 / (blocks - 1) as f64 * student(blocks - 1).powi(2)
}
