//! Natural frequencies and dampings of a linearised system: the eigenvalues of its matrix.

use crate::linearize::Linear;
use nalgebra::{Complex, DMatrix};

/// A mode of vibration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NaturalMode {
    /// Natural frequency in Hz, the magnitude of the eigenvalue over 2 pi.
    pub frequency_hz: f64,
    /// Damping ratio; negative if it grows.
    pub damping: f64,
    /// The eigenvalue in rad/s, of the pair the one that turns forwards.
    pub eigenvalue: Complex<f64>,
}

/// The modes that oscillate, by ascending frequency.
#[must_use]
pub fn modes(linear: &Linear) -> Vec<NaturalMode> {
    let balanced = balance(&linear.a);
    // A body that moves freely has two eigenvalues 0; rounding parts them by the root of what it leaves.
    let zero = 1e-8 * balanced.norm();
    let mut found: Vec<NaturalMode> = balanced
        .complex_eigenvalues()
        .iter()
        .filter(|eigenvalue| {
            eigenvalue.im > 1e-6 * (1.0 + eigenvalue.re.abs()) && eigenvalue.norm() > zero
        })
        .map(|eigenvalue| NaturalMode {
            frequency_hz: eigenvalue.norm() / std::f64::consts::TAU,
            damping: -eigenvalue.re / eigenvalue.norm(),
            eigenvalue: *eigenvalue,
        })
        .collect();
    found.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    found
}

/// Rows and columns scaled by powers of two until their norms agree: angles and metres, seconds and microseconds stand
/// side by side (Parlett and Reinsch, Numer. Math. 13 (1969) 293).
fn balance(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let mut balanced = matrix.clone();
    nalgebra::linalg::balancing::balance_parlett_reinsch(&mut balanced);
    balanced
}
