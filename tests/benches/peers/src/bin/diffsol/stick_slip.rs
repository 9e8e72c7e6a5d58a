//! P2: a saddle with Coulomb friction, drawn through a spring and a damper by a sine.

use crate::run::{Run, cpu_s, with_events};
use diffsol::{DiffsolError, NalgebraLU, NalgebraMat, OdeBuilder, OdeSolverMethod};
use std::cell::Cell;
use std::f64::consts::TAU;
use std::rc::Rc;

type M = NalgebraMat<f64>;

const MASS: f64 = 100.0;
const STIFFNESS: f64 = 1e6;
const DAMPING: f64 = 500.0;
const VISCOUS: f64 = 100.0;
const COULOMB: f64 = 300.0;
const STATIC: f64 = 400.0;
/// Speed by which the motion must have reversed before it sticks: a slip begins at a root.
const REVERSED: f64 = 1e-12;

fn pull(t: f64, x: f64, v: f64) -> f64 {
    STIFFNESS * (2e-3 * (TAU * t).sin() - x) + DAMPING * (2e-3 * TAU * (TAU * t).cos() - v)
}

/// `slip` is 0 while the saddle sticks, else the direction of its motion.
fn acceleration(slip: f64, t: f64, x: f64, v: f64) -> f64 {
    slip.abs() * (pull(t, x, v) - slip * COULOMB - VISCOUS * v) / MASS
}

pub fn solve(rtol: f64) -> Result<Run, DiffsolError> {
    let slip = Rc::new(Cell::new(0.0f64));
    let (of_rates, of_jacobian, of_roots) = (slip.clone(), slip.clone(), slip.clone());
    let problem = OdeBuilder::<M>::new()
        .rtol(rtol)
        .atol([1e-2 * rtol])
        .rhs_implicit(
            move |y, _p, t, dy| {
                dy[0] = y[1];
                dy[1] = acceleration(of_rates.get(), t, y[0], y[1]);
            },
            move |_y, _p, _t, v, jv| {
                let moves = of_jacobian.get().abs();
                jv[0] = v[1];
                jv[1] = -moves * (STIFFNESS * v[0] + (DAMPING + VISCOUS) * v[1]) / MASS;
            },
        )
        .init(|_p, _t, y| y.fill(0.0), 2)
        .root(
            move |y, _p, t, g| {
                let slip = of_roots.get();
                let force = pull(t, y[0], y[1]);
                (g[0], g[1]) = if slip == 0.0 {
                    (force - STATIC, force + STATIC)
                } else {
                    (y[1] + slip * REVERSED, 1.0)
                };
            },
            2,
        )
        .build()?;
    let mut solver = problem.bdf::<NalgebraLU<f64>>()?;
    let begin = cpu_s();
    let events = with_events(&mut solver, 10.0, |t, _root, y, dy| {
        let sticks = slip.get() == 0.0;
        slip.set(if sticks {
            pull(t, y[0], y[1]).signum()
        } else {
            0.0
        });
        y[1] = 0.0;
        dy[0] = 0.0;
        dy[1] = acceleration(slip.get(), t, y[0], y[1]);
    })?;
    Ok(Run {
        cpu_s: cpu_s() - begin,
        steps: solver.get_statistics().number_of_steps,
        events,
        samples: Vec::new(),
    })
}
