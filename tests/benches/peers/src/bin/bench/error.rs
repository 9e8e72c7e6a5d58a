//! The error of a run against a tight one.

use crate::outcome::Outcome;
use crate::problem::{Compared, Problem};

/// As [`Compared`] says; infinite if another number of samples or events was found.
pub fn error(problem: &Problem, found: &Outcome, reference: &Outcome) -> f64 {
    match problem.compared {
        Compared::Samples => samples(&found.samples, &reference.samples),
        Compared::Events => events(&found.events, &reference.events),
        Compared::Cases => cases(&found.samples, &reference.samples),
    }
}

/// How many cases have another number of events than the reference, or no end (NaN); `None` if there are no cases.
pub fn wrong_cases(problem: &Problem, found: &Outcome, reference: &Outcome) -> Option<usize> {
    (problem.compared == Compared::Cases).then(|| {
        let pairs = found.samples.iter().zip(&reference.samples);
        let right = |a: f64, b: f64| (a - b).abs() < 0.5;
        pairs.filter(|(a, b)| !right(a[3], b[3])).count()
    })
}

fn samples(found: &[[f64; 4]], reference: &[[f64; 4]]) -> f64 {
    if found.len() != reference.len() {
        return f64::INFINITY;
    }
    let column = |k: usize| {
        let largest = reference
            .iter()
            .fold(0.0, |most: f64, row| most.max(row[k].abs()));
        farthest(found.iter().zip(reference).map(|(a, b)| a[k] - b[k])) / largest
    };
    (1..4).map(column).fold(0.0, f64::max)
}

fn events(found: &[f64], reference: &[f64]) -> f64 {
    if found.len() != reference.len() {
        return f64::INFINITY;
    }
    farthest(found.iter().zip(reference).map(|(a, b)| a - b))
}

/// Of the end positions of the cases that have an end.
fn cases(found: &[[f64; 4]], reference: &[[f64; 4]]) -> f64 {
    if found.len() != reference.len() {
        return f64::INFINITY;
    }
    farthest(found.iter().zip(reference).map(|(a, b)| a[1] - b[1]))
}

fn farthest(differences: impl Iterator<Item = f64>) -> f64 {
    differences.fold(0.0, |most: f64, difference| most.max(difference.abs()))
}
