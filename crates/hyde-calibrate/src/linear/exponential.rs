//! What a linear system does in a step of any dyadic length: exp(A h), and the two integrals of it that exponential
//! integrators are made of.
//!
//! ```text
//! phi1(z) = (exp(z) - 1)/z        phi2(z) = (exp(z) - 1 - z)/z^2
//! ```
//! By the power series at a step so short that few terms do, then by doubling the step: phi1(2z) = (exp(z)*phi1(z) +
//! phi1(z))/2, phi2(2z) = (exp(z)*phi2(z) + phi1(z) + phi2(z))/4 (Hochbruck and Ostermann, Exponential integrators, Acta
//! Numerica 19, 2010, section 4). No division: A may be singular, as that of every free axis is.

use nalgebra::DMatrix;

/// Terms of the power series: the rest is below rounding for a norm of a half.
const TERMS: usize = 12;

/// A step of one length.
pub(crate) struct Step {
    /// exp(A h).
    pub(crate) exp: DMatrix<f64>,
    /// h phi1(A h).
    pub(crate) first: DMatrix<f64>,
    /// h phi2(A h).
    pub(crate) second: DMatrix<f64>,
}

/// Steps of the lengths h, h/2, h/4, … , `count` of them.
pub(crate) fn steps(a: &DMatrix<f64>, h: f64, count: usize) -> Vec<Step> {
    let n = a.nrows();
    let identity = DMatrix::<f64>::identity(n, n);
    let mut length = h * 0.5_f64.powi(i32::try_from(count).unwrap_or(0) - 1);
    let norm = a.column_iter().map(|c| c.abs().sum()).fold(0.0, f64::max);
    let mut doublings = count - 1;
    while norm * length > 0.5 && doublings < 200 {
        length *= 0.5;
        doublings += 1;
    }
    let z = a * length;
    // phi2 by Horner's rule: 1/2! + z/3! + z^2/4! + …
    let factorial = |k: usize| (1..=k).map(|i| i as f64).product::<f64>();
    let mut second = &identity / factorial(TERMS + 2);
    for term in (0..TERMS).rev() {
        second = &z * second + &identity / factorial(term + 2);
    }
    let mut first = &identity + &z * &second;
    let mut exp = &identity + &z * &first;
    let mut found = Vec::with_capacity(count);
    let mut keep = |left: usize,
                    length: f64,
                    exp: &DMatrix<f64>,
                    first: &DMatrix<f64>,
                    second: &DMatrix<f64>| {
        if left < count {
            found.push(Step {
                exp: exp.clone(),
                first: first * length,
                second: second * length,
            });
        }
    };
    keep(doublings, length, &exp, &first, &second);
    for left in (0..doublings).rev() {
        second = (&exp * &second + &first + &second) * 0.25;
        first = (&exp * &first + &first) * 0.5;
        exp = &exp * &exp;
        length *= 2.0;
        keep(left, length, &exp, &first, &second);
    }
    found.reverse();
    found
}

/// phi1 of a number.
pub(crate) fn phi1(z: f64) -> f64 {
    if z.abs() < 1e-8 { 1.0 } else { z.exp_m1() / z }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_with_decay_and_a_free_mass_come_out_as_in_closed_form() {
        // x'' = 0 beside a decay of rate 3 and a rotation of rate 40.
        let a = DMatrix::from_row_slice(
            5,
            5,
            &[
                0.0, 1.0, 0.0, 0.0, 0.0, //
                0.0, 0.0, 0.0, 0.0, 0.0, //
                0.0, 0.0, -3.0, 0.0, 0.0, //
                0.0, 0.0, 0.0, 0.0, -40.0, //
                0.0, 0.0, 0.0, 40.0, 0.0,
            ],
        );
        for (number, step) in steps(&a, 0.1, 4).iter().enumerate() {
            let h = 0.1 * 0.5_f64.powi(i32::try_from(number).unwrap());
            // Rounding of a few doublings.
            let close =
                |a: f64, b: f64| assert!((a - b).abs() < 1e-14 * (1.0 + b.abs()), "{a} {b}");
            close(step.exp[(0, 1)], h);
            close(step.first[(0, 1)], h * h / 2.0);
            close(step.second[(0, 1)], h * h / 6.0);
            close(step.exp[(2, 2)], (-3.0 * h).exp());
            close(step.first[(2, 2)], (1.0 - (-3.0 * h).exp()) / 3.0);
            close(
                step.second[(2, 2)],
                ((-3.0 * h).exp() - 1.0 + 3.0 * h) / (9.0 * h),
            );
            close(step.exp[(4, 3)], (40.0 * h).sin());
            close(step.first[(4, 3)], (1.0 - (40.0 * h).cos()) / 40.0);
        }
    }
}
