//! [`Information`]: what records would tell of parameters, before anything is fitted to them.
//!
//! The innovations of a record that the model itself made are white, and their derivatives J by the parameters say how
//! sharply it determines them: the covariance is at least `(J'J + P)^-1`, where P is what is known beforehand (Cramér and
//! Rao; Ljung, System Identification, 2nd ed. 1999, section 7.4). Of several records the one is best whose ellipsoid has the
//! least volume (D), or the least mean square of its deviations (A; Goodwin and Payne, Dynamic System Identification, 1977,
//! chapter 6).

use super::least_squares::Problem;
use super::linearised::Slopes;
use crate::plant::Unsupported;
use nalgebra::{DMatrix, SymmetricEigen};

/// A direction of the parameters is not determined that is known to no more than so many scales.
pub const UNKNOWN: f64 = 1e6;

/// What records would tell of parameters.
#[derive(Clone, Debug)]
pub struct Information {
    /// Expected standard deviation of each parameter, SI, with what is known beforehand.
    pub deviations: Vec<f64>,
    /// The same in units of [`crate::Varied::scale`]: of a parameter with a prior, the part of its deviation that is left.
    pub parts: Vec<f64>,
    /// The geometric mean of the half axes of the ellipsoid, in these units.
    pub volume: f64,
    /// The root mean square of the parts.
    pub spread: f64,
}

impl Problem<'_> {
    /// What the records tell of the parameters at some values: of records that the model made with these.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub fn information(&self, values: &[f64]) -> Result<Information, Unsupported> {
        let n = self.varied.len();
        let at = self.linearise(values, Slopes::Tangents)?;
        let mut matrix = DMatrix::<f64>::zeros(n, n);
        for own in &at.derivatives {
            matrix += own.tr_mul(own);
        }
        for (number, varied) in self.varied.iter().enumerate() {
            if let Some(sd) = varied.prior {
                matrix[(number, number)] += (varied.scale() / sd).powi(2);
            }
        }
        // In its own axes, none longer than what counts as unknown.
        let axes = SymmetricEigen::new(matrix);
        let lengths = axes.eigenvalues.map(|value| {
            let value = if value.is_finite() { value } else { 0.0 };
            1.0 / value.max(UNKNOWN.powi(-2)).sqrt()
        });
        let part = |number: usize| {
            let row = axes.eigenvectors.row(number);
            let each = row.iter().zip(lengths.iter());
            each.map(|(along, length)| (along * length).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        let parts: Vec<f64> = (0..n).map(part).collect();
        let count = n.max(1) as f64;
        Ok(Information {
            deviations: parts
                .iter()
                .zip(self.varied)
                .map(|(part, varied)| part * varied.scale())
                .collect(),
            volume: (lengths.iter().map(|length| length.ln()).sum::<f64>() / count).exp(),
            spread: (parts.iter().map(|part| part * part).sum::<f64>() / count).sqrt(),
            parts,
        })
    }
}
