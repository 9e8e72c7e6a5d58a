//! [`Path`]: the solution since the last event, for steps of the sensitivities that are longer than the solver's.
//!
//! After an event IDA takes many small steps of low order; sensitivities need few. So the ends and the middles of its
//! steps are kept, with the rates there, and cubic Hermite polynomials lie between them.

use crate::integrator::Integrator;
use crate::moment::Moment;
use std::collections::VecDeque;

/// So many points at most; then the sensitivities go on.
const MOST: usize = 256;

/// The solution at some instants, ascending.
#[derive(Default)]
pub(super) struct Path(VecDeque<Moment>);

impl Path {
    /// Adds the solver's last step, which began at `from`.
    pub(super) fn add_step(&mut self, integrator: &mut Integrator<'_>, from: f64) {
        let to = integrator.now.t;
        if self.0.is_empty() {
            self.add(integrator, from);
        }
        self.add(integrator, 0.5 * (from + to));
        self.add(integrator, to);
    }

    fn add(&mut self, integrator: &mut Integrator<'_>, t: f64) {
        let mut then = integrator.room(t);
        integrator.interpolate(&mut then);
        self.0.push_back(then);
    }

    /// Whether there is no room for more.
    pub(super) fn is_full(&self) -> bool {
        self.0.len() >= MOST
    }

    /// Forgets everything: an event.
    pub(super) fn clear(&mut self) {
        self.0.clear();
    }

    /// Forgets what lies before a time.
    pub(super) fn forget(&mut self, t: f64) {
        while self.0.get(1).is_some_and(|place| place.t <= t) {
            self.0.pop_front();
        }
    }

    /// Writes the solution at the time of `then`, on the path.
    pub(super) fn read(&self, then: &mut Moment) {
        let Moment { t, y, yp } = then;
        let t = *t;
        let after = self.0.partition_point(|place| place.t < t);
        let after = after.clamp(1, self.0.len().saturating_sub(1).max(1));
        let (Some(a), Some(b)) = (self.0.get(after - 1), self.0.get(after)) else {
            return;
        };
        let step = b.t - a.t;
        let x = (t - a.t) / step;
        for index in 0..y.len() {
            let rise = b.y[index] - a.y[index];
            let (first, last) = (step * a.yp[index] - rise, step * b.yp[index] - rise);
            y[index] = a.y[index] + x * (rise + (1.0 - x) * ((1.0 - x) * first - x * last));
            let bend = (1.0 - x) * (1.0 - 3.0 * x) * first - x * (2.0 - 3.0 * x) * last;
            yp[index] = (rise + bend) / step;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_kept_as_it_is() {
        let f = |t: f64| 1.0 - 2.0 * t + 0.5 * t.powi(3);
        let rate = |t: f64| -2.0 + 1.5 * t * t;
        let place = |t: f64| Moment {
            t,
            y: vec![f(t)],
            yp: vec![rate(t)],
        };
        let path = Path(VecDeque::from([place(0.5), place(1.5), place(2.0)]));
        for t in [0.5, 0.7, 1.5, 1.9, 2.0] {
            let mut then = Moment::zero(t, 1);
            path.read(&mut then);
            let Moment { y, yp, .. } = then;
            // Rounding of a few terms.
            assert!((y[0] - f(t)).abs() < 1e-14, "{t}: {y:?}");
            assert!((yp[0] - rate(t)).abs() < 1e-13, "{t}: {yp:?}");
        }
    }
}
