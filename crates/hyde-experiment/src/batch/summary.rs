//! [`Summary`]: what a batch says as a whole: quantiles, rank correlations, the worst cases.

use super::dataset::Dataset;
use super::outcome::Outcome;
use super::plan::{Plan, Value};
use hyde_signal::statistics::{correlation, quantile};

/// The probabilities of the quantiles that are told.
pub const QUANTILES: [f64; 7] = [0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0];

/// How many of the worst cases of each measure are told.
const WORST: usize = 3;
/// How many failed cases are told.
const FAILED: usize = 10;

/// A measure over all cases.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasureSummary {
    /// Its number among the data set's measures.
    pub measure: usize,
    /// In how many cases it has a value.
    pub count: usize,
    /// Quantiles at [`QUANTILES`], SI.
    pub quantiles: [f64; 7],
    /// Whether all cases have one value, as far as the tolerance of their runs can tell.
    pub same: bool,
    /// Spearman's rank correlation with each numerical input that varies, by its number; none where all have one value.
    pub correlations: Vec<(usize, f64)>,
}

/// A case to look at.
#[derive(Clone, Debug, PartialEq)]
pub struct Worst {
    /// Its number.
    pub case: usize,
    /// The measure of which it has one of the largest magnitudes, and the value, SI.
    pub measure: usize,
    /// The value, SI.
    pub value: f64,
}

/// What a batch says as a whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Summary {
    /// Cases.
    pub cases: usize,
    /// How many failed, and the first of them with their reasons.
    pub failed: usize,
    /// The first failed cases, with their reasons.
    pub failures: Vec<(usize, String)>,
    /// The measures, expectations apart.
    pub measures: Vec<MeasureSummary>,
    /// Each expectation with the number of cases in which it does not hold, and the first of them.
    pub broken: Vec<(usize, usize, Option<usize>)>,
    /// The cases with the largest magnitudes, by measure.
    pub worst: Vec<Worst>,
}

/// Takes the numbers of cases, in their order.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    /// Numbers of cases that have values.
    numbers: Vec<usize>,
    /// One column an input; NaN of choices.
    inputs: Vec<Vec<f64>>,
    /// One column a measure.
    measures: Vec<Vec<f64>>,
    summary: Summary,
}

impl Gathered {
    /// Takes a case.
    pub fn add(&mut self, plan: &Plan, number: usize, outcome: &Outcome) {
        self.summary.cases += 1;
        if let Some(fault) = &outcome.fault {
            self.summary.failed += 1;
            if self.summary.failures.len() < FAILED {
                self.summary.failures.push((number, fault.reason.clone()));
            }
            return;
        }
        if self.numbers.is_empty() {
            // Room for all at once: growing would take twice as much.
            let room = |columns: usize| -> Vec<Vec<f64>> {
                (0..columns)
                    .map(|_| Vec::with_capacity(plan.count()))
                    .collect()
            };
            self.numbers.reserve_exact(plan.count());
            self.inputs = room(plan.inputs.len());
            self.measures = room(outcome.measures.len());
        }
        self.numbers.push(number);
        for (column, value) in self.inputs.iter_mut().zip(&plan.case(number).values) {
            column.push(match value {
                Value::Number(number) => *number,
                Value::Option(_) => f64::NAN,
            });
        }
        for (column, &value) in self.measures.iter_mut().zip(&outcome.measures) {
            column.push(value);
        }
    }

    /// Sums up.
    #[must_use]
    pub fn summary(self, dataset: &Dataset) -> Summary {
        let mut summary = self.summary;
        let ranks: Vec<Option<Vec<f64>>> = self
            .inputs
            .iter()
            .map(|column| ranks_of(column, 0.0).filter(|ranks| varies(ranks)))
            .collect();
        for (measure, column) in self.measures.iter().enumerate() {
            if dataset.measures[measure].expectation {
                let broken = self
                    .numbers
                    .iter()
                    .zip(column)
                    .filter(|(_, value)| **value <= 0.5 || value.is_nan());
                let broken: Vec<usize> = broken.map(|(number, _)| *number).collect();
                summary
                    .broken
                    .push((measure, broken.len(), broken.first().copied()));
                continue;
            }
            let mut sorted: Vec<f64> = column
                .iter()
                .copied()
                .filter(|value| !value.is_nan())
                .collect();
            sorted.sort_unstable_by(f64::total_cmp);
            let own = ranks_of(column, dataset.rtol);
            let varying = own.as_ref().filter(|ranks| varies(ranks));
            let correlations = ranks.iter().enumerate().filter_map(|(input, ranks)| {
                let value = correlation(ranks.as_ref()?, varying?)?;
                Some((input, value))
            });
            summary.measures.push(MeasureSummary {
                measure,
                count: sorted.len(),
                quantiles: QUANTILES.map(|p| quantile(&sorted, p)),
                same: own
                    .as_ref()
                    .is_some_and(|ranks| ranks.len() > 1 && !varies(ranks)),
                correlations: correlations.collect(),
            });
            let mut order: Vec<usize> = (0..column.len())
                .filter(|&at| !column[at].is_nan())
                .collect();
            order.sort_by(|&a, &b| column[b].abs().total_cmp(&column[a].abs()));
            let worst = order.into_iter().take(WORST);
            summary.worst.extend(worst.map(|at| Worst {
                case: self.numbers[at],
                measure,
                value: column[at],
            }));
        }
        summary
    }
}

/// Ranks from 1; `None` where a value is missing. Values that are one within a part of the largest magnitude share their mean:
/// what the tolerance of the runs does not promise has no order.
fn ranks_of(values: &[f64], part: f64) -> Option<Vec<f64>> {
    if values.iter().any(|value| value.is_nan()) {
        return None;
    }
    let finite = values
        .iter()
        .map(|value| value.abs())
        .filter(|value| value.is_finite());
    let largest = finite.fold(0.0, f64::max);
    let one = |first: f64, value: f64| value <= first + part * largest;
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let mut ranks = vec![0.0; values.len()];
    let mut at = 0;
    while let Some(first) = order.get(at) {
        let rest = &order[at..];
        let group = rest.partition_point(|&place| one(values[*first], values[place]));
        let mean = at as f64 + 0.5 * (group + 1) as f64;
        for &place in &rest[..group] {
            ranks[place] = mean;
        }
        at += group;
    }
    Some(ranks)
}

/// Whether not all ranks are the same.
fn varies(ranks: &[f64]) -> bool {
    ranks.iter().any(|rank| rank.total_cmp(&ranks[0]).is_ne())
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "small integers and halves are exact")]
mod tests {
    use super::*;

    #[test]
    fn rank_correlations_see_order_and_share_ties() {
        let ranks = |values: &[f64]| ranks_of(values, 0.0).unwrap();
        assert_eq!(ranks(&[3.0, 1.0, 3.0, 2.0]), [3.5, 1.0, 3.5, 2.0]);
        let rising = ranks(&[1.0, 10.0, 100.0]);
        assert_eq!(correlation(&rising, &ranks(&[0.1, 0.2, 0.3])), Some(1.0));
        assert_eq!(correlation(&rising, &ranks(&[3.0, 2.0, 1.0])), Some(-1.0));
        // By hand: ranks 1 2 3 4 and 2 1 4 3, sum of squared differences 4: 1 - 6*4/(4*15) = 0.6.
        let found =
            correlation(&ranks(&[1.0, 2.0, 3.0, 4.0]), &ranks(&[2.0, 1.0, 4.0, 3.0])).unwrap();
        assert!((found - 0.6).abs() < 1e-15); // Small integers: rounding of one root.
        assert!(!varies(&ranks(&[1.0, 1.0])));
    }
    #[test]
    fn what_the_tolerance_does_not_promise_has_no_order() {
        let ranks = |values: &[f64]| ranks_of(values, 1e-6).unwrap();
        // Rounding of one number.
        assert!(!varies(&ranks(&[0.076, 0.076 + 1e-12, 0.076 - 1e-12])));
        assert_eq!(ranks(&[2.0, 1.0, 1.0 + 1e-7, 3.0]), [3.0, 1.5, 1.5, 4.0]);
        assert_eq!(ranks(&[1.0, 1.00001]), [1.0, 2.0]);
        assert_eq!(ranks(&[f64::INFINITY, 1.0]), [2.0, 1.0]);
        assert!(ranks_of(&[1.0, f64::NAN], 1e-6).is_none());
    }
}
