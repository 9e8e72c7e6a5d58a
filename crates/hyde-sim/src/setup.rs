//! [`Setup`]: what a run is told beside its program.

use crate::reached::Reached;
use hyde_program::{Method, Reduction};
use hyde_signal::Table;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// Parameters, records, times and tolerances of a run.
#[derive(Clone, Debug)]
pub struct Setup<'a> {
    /// The whole parameter vector.
    pub parameters: Vec<f64>,
    /// The records by the name the experiment gives them; columns in SI.
    pub records: &'a BTreeMap<String, Table>,
    /// Start in s.
    pub start_s: f64,
    /// Stop in s.
    pub stop_s: f64,
    /// The method.
    pub method: Method,
    /// Whether the tolerance of a step falls with the steps since the last event, so that the errors of a long smooth
    /// stretch do not add up.
    pub conserve: bool,
    /// Relative tolerance.
    pub rtol: f64,
    /// Absolute tolerance, SI.
    pub atol: f64,
    /// Largest step in s.
    pub max_step_s: f64,
    /// Times of the results' rows in s, ascending; rows at events come in addition.
    pub rows_s: Vec<f64>,
    /// Signals that are to become one number each.
    pub reductions: Vec<Reduction>,
    /// What they are before this time, in s, does not count.
    pub reduced_from_s: f64,
    /// The outputs to keep, by number, ascending; `None` for all.
    pub keep: Option<Vec<usize>>,
    /// The parameters by which the run is differentiated: positions in the parameter vector, of plain parameters; `None` for
    /// no gradient, which costs nothing.
    pub sensitivities: Option<&'a [usize]>,
    /// Set from outside to end the run after the step under way.
    pub interrupted: Arc<AtomicBool>,
    /// How far the run is, for whoever watches it.
    pub reached: Arc<Reached>,
}

impl<'a> Setup<'a> {
    /// A run from 0 to `stop_s` with 1000 rows, a relative tolerance of 1e-6 and an absolute one of 1e-8.
    #[must_use]
    pub fn new(parameters: Vec<f64>, records: &'a BTreeMap<String, Table>, stop_s: f64) -> Self {
        Self {
            parameters,
            records,
            start_s: 0.0,
            stop_s,
            method: Method::default(),
            conserve: false,
            rtol: 1e-6,
            atol: 1e-8,
            max_step_s: f64::INFINITY,
            rows_s: Self::rows_every(0.0, stop_s, stop_s / 1000.0),
            reductions: Vec::new(),
            reduced_from_s: f64::NEG_INFINITY,
            keep: None,
            sensitivities: None,
            interrupted: Arc::default(),
            reached: Arc::default(),
        }
    }

    /// The mean time between rows in s; infinite if there are none between.
    #[must_use]
    pub fn row_spacing(&self) -> f64 {
        match self.rows_s.as_slice() {
            [first, .., last] => (last - first) / (self.rows_s.len() - 1) as f64,
            _ => f64::INFINITY,
        }
    }

    /// Times from `start_s` to `stop_s`, `step_s` apart, the stop included.
    #[must_use]
    pub fn rows_every(start_s: f64, stop_s: f64, step_s: f64) -> Vec<f64> {
        if !(step_s > 0.0 && stop_s > start_s) {
            return vec![start_s];
        }
        let count = ((stop_s - start_s) / step_s * (1.0 + 1e-12)).floor() as usize;
        let mut rows: Vec<f64> = (0..=count).map(|k| start_s + k as f64 * step_s).collect();
        if let Some(last) = rows.last_mut() {
            if (stop_s - *last).abs() <= 1e-9 * step_s {
                *last = stop_s;
            } else {
                rows.push(stop_s);
            }
        }
        rows
    }
}

/// Whether two instants are one: closer than rounding of times computed in different ways.
pub(crate) fn same_instant(a: f64, b: f64) -> bool {
    // The smaller magnitude: an instant that never comes, at infinity, is none.
    (a - b).abs() <= 1e-12 + 1e-13 * a.abs().min(b.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn instants_computed_in_different_ways_are_one_and_never_is_not_now() {
        assert!(same_instant(0.1 * 3.0, 0.3));
        assert!(!same_instant(1.0, 1.0 + 1e-9));
        assert!(!same_instant(f64::INFINITY, 3.0));
        assert!(!same_instant(3.0, f64::INFINITY));
    }
}
