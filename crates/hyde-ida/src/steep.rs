//! [`Steep`]: whether an old Jacobian still serves where equations are steep.
//!
//! A correction by an old Jacobian shows nothing where its entries are much too large: beside the conductance of a diode that
//! has ceased to conduct, volts are a correction of nanovolts, the first iteration passes as the last, and IDA keeps the
//! Jacobian. So it is compared with the one of the present step, entry by entry, before the first correction is believed.

use crate::{Pattern, System};

/// Entries of a row that changed by this part of the largest of them, each over the tolerance of its unknown, serve no longer:
/// the largest one is four times as large, or a quarter of what it was.
const CHANGED: f64 = 0.75;

/// The point of the last residual, and room to compare.
#[derive(Default)]
pub(crate) struct Steep {
    t: f64,
    y: Vec<f64>,
    yp: Vec<f64>,
    fresh: Vec<f64>,
    largest: Vec<f64>,
    changed: Vec<f64>,
}

impl Steep {
    /// The residual is evaluated here.
    pub(crate) fn at(&mut self, t: f64, y: &[f64], yp: &[f64]) {
        self.t = t;
        self.y.clear();
        self.y.extend_from_slice(y);
        self.yp.clear();
        self.yp.extend_from_slice(yp);
    }

    /// Whether the old Jacobian is still near enough to that of the point of the last residual.
    pub(crate) fn serves<S: System>(
        &mut self,
        system: &mut S,
        (pattern, old): (&Pattern, &[f64]),
        cj: f64,
        weights: &[f64],
    ) -> bool {
        self.fresh.resize(old.len(), 0.0);
        let evaluated = system.jacobian(self.t, cj, &self.y, &self.yp, &mut self.fresh);
        if evaluated.is_err() {
            return false;
        }
        for sums in [&mut self.largest, &mut self.changed] {
            sums.clear();
            sums.resize(weights.len(), 0.0);
        }
        for (row, column, entry) in pattern.entries() {
            let (old, new) = (
                old[entry] / weights[column],
                self.fresh[entry] / weights[column],
            );
            self.largest[row] = self.largest[row].max(old.abs()).max(new.abs());
            self.changed[row] = self.changed[row].max((new - old).abs());
        }
        let mut rows = self.changed.iter().zip(&self.largest);
        rows.all(|(changed, largest)| *changed <= CHANGED * largest)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Recoverable;

    /// The current of a diode at its voltage: `0 = y[1] - exp(y[0]/0.04)`, and `0 = y[0] + 1000*y[1] - t`.
    struct Diode;

    impl System for Diode {
        fn residual(
            &mut self,
            t: f64,
            y: &[f64],
            _yp: &[f64],
            out: &mut [f64],
        ) -> Result<(), Recoverable> {
            out[0] = y[1] - (y[0] / 0.04).exp();
            out[1] = y[0] + 1000.0 * y[1] - t;
            Ok(())
        }

        fn jacobian(
            &mut self,
            _t: f64,
            _cj: f64,
            y: &[f64],
            _yp: &[f64],
            values: &mut [f64],
        ) -> Result<(), Recoverable> {
            values.copy_from_slice(&[-(y[0] / 0.04).exp() / 0.04, 1.0, 1.0, 1000.0]);
            Ok(())
        }
    }

    #[test]
    fn a_matrix_from_where_the_diode_conducted_serves_only_near_there() {
        let pattern = Pattern::dense(2).unwrap();
        let mut old = [0.0; 4];
        Diode
            .jacobian(0.0, 0.0, &[0.6, 0.0], &[0.0; 2], &mut old)
            .unwrap();
        let mut steep = Steep::default();
        let mut serves = |volt: f64, weights: [f64; 2]| {
            steep.at(0.0, &[volt, 0.0], &[0.0; 2]);
            steep.serves(&mut Diode, (&pattern, &old), 0.0, &weights)
        };
        assert!(serves(0.6, [1.0; 2]) && serves(0.56, [1.0; 2]));
        assert!(!serves(0.5, [1.0; 2]) && !serves(-1.0, [1.0; 2]) && !serves(0.7, [1.0; 2]));
        // Where the current counts for more than the voltage can change, it does not matter.
        assert!(serves(0.5, [1e12, 1e-3]));
    }
}
