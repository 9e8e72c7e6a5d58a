//! [`Past`]: the last values of smooth signals, and the polynomials through them in Newton's form.

use crate::lobatto::{self, MIDDLE, POINTS};

/// Values that are kept: the solver's own polynomials are of degree 5 at most.
const KEPT: usize = 6;
/// With fewer nothing is foretold.
const LEAST: usize = 4;

/// The last values since something happened.
pub(super) struct Past {
    /// Their times, the newest first.
    times: [f64; KEPT],
    count: usize,
    /// Of each signal the divided differences of its newest value, of the newest two, and so on.
    differences: Vec<[f64; KEPT]>,
}

impl Past {
    pub(super) fn new(signals: usize) -> Self {
        Self {
            times: [0.0; KEPT],
            count: 0,
            differences: vec![[0.0; KEPT]; signals],
        }
    }

    /// Forgets what was before: something happens here.
    pub(super) fn begin(&mut self, t: f64, values: &[f64]) {
        self.count = 0;
        self.add(t, values);
    }

    /// Adds values behind the others.
    pub(super) fn add(&mut self, t: f64, values: &[f64]) {
        let known = self.count.min(KEPT - 1);
        let spans: [f64; KEPT] = self.times.map(|other| 1.0 / (t - other));
        for (differences, value) in self.differences.iter_mut().zip(values) {
            let mut new = *value;
            for (old, span) in differences.iter_mut().zip(spans).take(known) {
                let next = (new - *old) * span;
                *old = new;
                new = next;
            }
            differences[known] = new;
        }
        self.times.rotate_right(1);
        self.times[0] = t;
        self.count = known + 1;
    }

    pub(super) fn ends_at(&self) -> Option<f64> {
        (self.count > 0).then_some(self.times[0])
    }

    /// The newest values.
    pub(super) fn last(&self) -> impl Iterator<Item = f64> {
        self.differences.iter().map(|differences| differences[0])
    }

    /// Whether enough is known to foretell what comes next.
    pub(super) fn foretells(&self) -> bool {
        self.count >= LEAST
    }

    /// The polynomial of a signal at a time.
    pub(super) fn value(&self, column: usize, t: f64) -> f64 {
        let known = self.differences[column].iter().zip(&self.times);
        let known = known.take(self.count).rev();
        known.fold(0.0, |sum, (difference, time)| difference + (t - time) * sum)
    }

    /// The polynomials at the points of Lobatto's rule, from the values `before` to the newest.
    pub(super) fn between(&self, before: &[f64], room: &mut [[f64; POINTS]]) {
        let times = lobatto::times(self.times[1], self.times[0]);
        for (column, room) in room.iter_mut().enumerate() {
            let inside = [times[1], times[MIDDLE], times[3]].map(|t| self.value(column, t));
            let [second, middle, fourth] = inside;
            // Both ends to the last bit.
            let last = self.differences[column][0];
            *room = [before[column], second, middle, fourth, last];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polynomial_of_degree_five_is_foretold_from_uneven_times() {
        let f = |t: f64| 1.0 + t - 3.0 * t.powi(3) + 0.5 * t.powi(5);
        let mut past = Past::new(1);
        for t in [-1.0, 0.0, 0.1, 0.4, 0.5, 0.9, 1.0] {
            past.add(t, &[f(t)]);
        }
        // Rounding of differences over a tenth.
        assert!((past.value(0, 1.5) - f(1.5)).abs() < 1e-9);
        let mut room = [[0.0; POINTS]];
        past.between(&[f(0.9)], &mut room);
        let right = lobatto::times(0.9, 1.0).map(f);
        for (found, right) in room[0].iter().zip(right) {
            assert!((found - right).abs() < 1e-12);
        }
    }
}
