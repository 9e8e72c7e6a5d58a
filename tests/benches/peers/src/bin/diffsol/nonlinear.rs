//! The nonlinear shaft: cubic stiffening and Stribeck friction in every node; with an implicit law of every element it has
//! a mass matrix with rows of zeros.

use crate::run::{Run, with_samples};
use crate::shaft::{Shaft, sample};
use diffsol::{DiffsolError, FaerSparseMat, KLU, OdeBuilder};

type M = FaerSparseMat<f64>;

const BRAKE: f64 = 0.5;
const TORQUE: f64 = 10.0;
const COULOMB: f64 = 2e-3;
const STATIC: f64 = 4e-3;
const SMOOTH: f64 = 1e-2;
const CUBIC: f64 = 1e9;
const CUBIC_TORQUE: f64 = 2e-9;

/// Friction torque at a speed, and its slope.
fn friction(w: f64) -> (f64, f64) {
    let (decay, sign) = ((-w * w).exp(), (w / SMOOTH).tanh());
    let level = COULOMB + (STATIC - COULOMB) * decay;
    let slope = (STATIC - COULOMB) * decay * -2.0 * w * sign + level * (1.0 - sign * sign) / SMOOTH;
    (level * sign, slope)
}

/// The rates of the explicit form; `elastic` gives the torque of an element.
fn rates(shaft: &Shaft, y: &[f64], elastic: impl Fn(usize, f64) -> f64, dy: &mut [f64]) {
    let m = shaft.nodes();
    let (angle, speed) = (&y[..m], &y[m..2 * m]);
    let mut before = -TORQUE;
    for i in 0..m {
        let mut after = BRAKE * -speed[m - 1];
        if i < m - 1 {
            after =
                elastic(i, angle[i + 1] - angle[i]) + shaft.damping[i] * (speed[i + 1] - speed[i]);
        }
        dy[i] = speed[i];
        dy[m + i] = (after - before - friction(speed[i]).0) / shaft.inertia[i];
        before = after;
    }
}

/// The Jacobian times `v`; `elastic` gives the change of the torque of an element.
fn product(
    shaft: &Shaft,
    y: &[f64],
    v: &[f64],
    elastic: impl Fn(usize, f64) -> f64,
    jv: &mut [f64],
) {
    let m = shaft.nodes();
    let (angle, speed) = (&v[..m], &v[m..2 * m]);
    let mut before = 0.0;
    for i in 0..m {
        let mut after = BRAKE * -speed[m - 1];
        if i < m - 1 {
            after =
                elastic(i, angle[i + 1] - angle[i]) + shaft.damping[i] * (speed[i + 1] - speed[i]);
        }
        jv[i] = speed[i];
        jv[m + i] = (after - before - friction(y[m + i]).1 * speed[i]) / shaft.inertia[i];
        before = after;
    }
}

pub fn solve(cells: usize, rtol: f64, implicit: bool) -> Result<Run, DiffsolError> {
    if implicit {
        index_1(cells, rtol)
    } else {
        explicit(cells, rtol)
    }
}

fn explicit(cells: usize, rtol: f64) -> Result<Run, DiffsolError> {
    let shaft = Shaft::new(cells);
    let (of_jacobian, n) = (shaft.clone(), 2 * shaft.nodes());
    let problem = OdeBuilder::<M>::new()
        .rtol(rtol)
        .atol([1e-2 * rtol])
        .rhs_implicit(
            move |y, _p, _t, dy| {
                rates(
                    &shaft,
                    y,
                    |i, e| shaft.stiffness[i] * e * (1.0 + CUBIC * e * e),
                    dy,
                );
            },
            move |y, _p, _t, v, jv| {
                let stiffness = |i: usize, change: f64| {
                    let e = y[i + 1] - y[i];
                    of_jacobian.stiffness[i] * (1.0 + 3.0 * CUBIC * e * e) * change
                };
                product(&of_jacobian, y, v, stiffness, jv);
            },
        )
        .init(|_p, _t, y| y.fill(0.0), n)
        .build()?;
    with_samples(problem.bdf::<KLU<M>>()?, sample(cells + 2))
}

fn index_1(cells: usize, rtol: f64) -> Result<Run, DiffsolError> {
    let shaft = Shaft::new(cells);
    let m = shaft.nodes();
    let of_jacobian = shaft.clone();
    let problem = OdeBuilder::<M>::new()
        .rtol(rtol)
        .atol([1e-2 * rtol])
        .rhs_implicit(
            move |y, _p, _t, dy| {
                rates(&shaft, y, |i, _| y[2 * m + i], dy);
                for i in 0..m - 1 {
                    let q = y[2 * m + i];
                    dy[2 * m + i] =
                        y[i + 1] - y[i] - q / shaft.stiffness[i] - CUBIC_TORQUE * q.powi(3);
                }
            },
            move |y, _p, _t, v, jv| {
                product(&of_jacobian, y, v, |i, _| v[2 * m + i], jv);
                for i in 0..m - 1 {
                    let q = y[2 * m + i];
                    let slope = 1.0 / of_jacobian.stiffness[i] + 3.0 * CUBIC_TORQUE * q * q;
                    jv[2 * m + i] = v[i + 1] - v[i] - slope * v[2 * m + i];
                }
            },
        )
        .mass(move |v, _p, _t, beta, y| {
            for i in 0..y.len() {
                y[i] = beta * y[i] + if i < 2 * m { v[i] } else { 0.0 };
            }
        })
        .init(|_p, _t, y| y.fill(0.0), 3 * m - 1)
        .build()?;
    with_samples(problem.bdf::<KLU<M>>()?, sample(m))
}
