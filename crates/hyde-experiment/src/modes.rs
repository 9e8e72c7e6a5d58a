//! Natural frequencies and dampings of a linearised system: the eigenvalues of its matrix.
//!
//! With delays the characteristic equation `det(sI - A - B d(s)) = 0` holds exp(-sT) and has no end of roots. The past of
//! each delayed quantity at Chebyshev points makes a matrix whose lower eigenvalues are close to them (Breda, Maset and
//! Vermiglio, SIAM J. Sci. Comput. 27 (2005) 482); Newton's method on the equation itself makes them exact.

use crate::linearize::{Delayed, Linear};
use crate::poles::{Pole, poles};
use nalgebra::{Complex, DMatrix, DVector};

/// Chebyshev points of the shortest past, that of now apart; longer ones have more in proportion, up to the other number.
const POINTS: usize = 24;
const MOST_POINTS: usize = 192;
/// Newton iterations for a root.
const MAX_ITERATIONS: usize = 30;
/// How far a root may be from the eigenvalue that led to it, as a part of it: further off the eigenvalue is none of a root.
const NEAR: f64 = 0.01;

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

/// The modes that oscillate, by ascending frequency: with clocks those of the closed loop. With delays those that the points
/// of the past lead to: without a gap up to some times the frequency 1/T of the shortest, beyond that some.
#[must_use]
pub fn modes(linear: &Linear) -> Vec<NaturalMode> {
    let poles = poles(linear).oscillating();
    poles.iter().map(Pole::mode).collect()
}

/// The eigenvalues of a linearised system, given its balanced matrix, or with delays the roots in the upper half plane.
pub(crate) fn continuous_roots(linear: &Linear, balanced: &DMatrix<f64>) -> Vec<Complex<f64>> {
    match &linear.delayed {
        None => eigenvalues(balanced),
        Some(delayed) => roots_with_delays(linear, delayed),
    }
}

/// The eigenvalues of a matrix; a model without states has none.
pub(crate) fn eigenvalues(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    if matrix.is_empty() {
        return Vec::new();
    }
    matrix.complex_eigenvalues().iter().copied().collect()
}

/// A matrix with rows and columns scaled by powers of two until their norms agree, and the scale: angles and metres, seconds
/// and microseconds stand side by side (Parlett and Reinsch, Numer. Math. 13 (1969) 293).
pub(crate) fn balanced(matrix: &DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let mut balanced = matrix.clone();
    let scale = nalgebra::linalg::balancing::balance_parlett_reinsch(&mut balanced);
    (balanced, scale)
}

/// The roots in the upper half plane that Newton's method reaches from the eigenvalues of the matrix with a past.
fn roots_with_delays(linear: &Linear, delayed: &Delayed) -> Vec<Complex<f64>> {
    let mut roots: Vec<Complex<f64>> = Vec::new();
    let (matrix, _) = balanced(&with_past(linear, delayed));
    for &candidate in eigenvalues(&matrix).iter().filter(|root| root.im >= 0.0) {
        let Some(root) = polished(linear, candidate) else {
            continue;
        };
        if (root - candidate).norm() > NEAR * root.norm() {
            continue;
        }
        let known = |other: &Complex<f64>| (other - root).norm() <= 1e-7 * root.norm();
        if !roots.iter().any(known) {
            roots.push(root);
        }
    }
    roots
}

/// `x' = A x + B d` with the past of each delayed quantity as further states: w' = dw/dtheta at Chebyshev points of
/// `-T .. 0`, where w(0) is the quantity now and w(-T) the delayed value d.
fn with_past(linear: &Linear, delayed: &Delayed) -> DMatrix<f64> {
    let (nx, nd) = (linear.a.nrows(), delayed.times.len());
    let shortest = delayed.times.iter().copied().fold(f64::INFINITY, f64::min);
    let points =
        |time: &f64| ((POINTS as f64 * time / shortest) as usize).clamp(POINTS, MOST_POINTS);
    let points: Vec<usize> = delayed.times.iter().map(points).collect();
    let before = |line: usize| points[..line].iter().sum::<usize>();
    let place = |line: usize, point: usize| nx + before(line) + point - 1;
    let size = nx + before(nd);
    let mut whole = DMatrix::zeros(size, size);
    whole.view_mut((0, 0), (nx, nx)).copy_from(&linear.a);
    for line in 0..nd {
        let derivative = chebyshev_derivative(points[line]);
        whole
            .view_mut((0, place(line, points[line])), (nx, 1))
            .copy_from(&delayed.b.column(line));
        let scale = 2.0 / delayed.times[line];
        for point in 1..=points[line] {
            let row = place(line, point);
            for other in 1..=points[line] {
                whole[(row, place(line, other))] += scale * derivative[(point, other)];
            }
            // The value now is given by the states and the delayed values.
            let now = scale * derivative[(point, 0)];
            for state in 0..nx {
                whole[(row, state)] += now * delayed.by_state[(line, state)];
            }
            for (other, &last) in points.iter().enumerate() {
                let late = place(other, last);
                whole[(row, late)] += now * delayed.by_delayed[(line, other)];
            }
        }
    }
    whole
}

/// The derivative at the points cos(k pi/n) of the polynomial through them (Trefethen, Spectral Methods in MATLAB, ch. 6).
fn chebyshev_derivative(n: usize) -> DMatrix<f64> {
    let x: Vec<f64> = (0..=n)
        .map(|k| (k as f64 * std::f64::consts::PI / n as f64).cos())
        .collect();
    let c = |k: usize| {
        let end = if k == 0 || k == n { 2.0 } else { 1.0 };
        if k.is_multiple_of(2) { end } else { -end }
    };
    let mut d = DMatrix::zeros(n + 1, n + 1);
    for i in 0..=n {
        for j in (0..=n).filter(|&j| j != i) {
            d[(i, j)] = c(i) / c(j) / (x[i] - x[j]);
            d[(i, i)] -= d[(i, j)];
        }
    }
    d
}

/// The root near a candidate by Newton's method on det M(s): each step is 1/trace(M^-1 M').
fn polished(linear: &Linear, candidate: Complex<f64>) -> Option<Complex<f64>> {
    let mut s = candidate;
    for _ in 0..MAX_ITERATIONS {
        let h = 1e-6 * s.norm();
        let slope = (characteristic(linear, s + h)? - characteristic(linear, s - h)?)
            / Complex::new(2.0 * h, 0.0);
        let Some(turned) = characteristic(linear, s)?.lu().solve(&slope) else {
            return Some(s);
        };
        let step = turned.trace().inv();
        s -= step;
        if !s.is_finite() {
            return None;
        }
        if step.norm() <= 1e-12 * s.norm() {
            return Some(s);
        }
    }
    None
}

/// `sI - A`, with delays `sI - A - B d(s)`: delayed values d by the states, d = exp(-sT) (by_state x + by_delayed d).
pub(crate) fn characteristic(linear: &Linear, s: Complex<f64>) -> Option<DMatrix<Complex<f64>>> {
    let complex = |matrix: &DMatrix<f64>| matrix.map(|value| Complex::new(value, 0.0));
    let nx = linear.a.nrows();
    let matrix = DMatrix::identity(nx, nx) * s - complex(&linear.a);
    let Some(delayed) = &linear.delayed else {
        return Some(matrix);
    };
    let nd = delayed.times.len();
    let times = delayed.times.iter().map(|time| (-s * *time).exp());
    let turn = DMatrix::from_diagonal(&DVector::from_iterator(nd, times));
    let loops = DMatrix::identity(nd, nd) - &turn * complex(&delayed.by_delayed);
    let by_state = loops.lu().solve(&(turn * complex(&delayed.by_state)))?;
    Some(matrix - complex(&delayed.b) * by_state)
}
