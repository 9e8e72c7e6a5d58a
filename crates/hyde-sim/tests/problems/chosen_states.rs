//! A pendulum in Cartesian coordinates that turns over: of x and y, and of their velocities, the run chooses the states.
//!
//! ```text
//! 0 = x^2 + y^2 - 1                    constraint of the positions
//! 0 = x vx + y vy                      its derivative: constraint of the velocities
//! 0 = vx^2 + vy^2 + x ax + y ay        its second derivative
//! 0 = f1 (x' - vx) + f2 (y' - vy)      rates of the position chosen
//! 0 = f3 (vx' - ax) + f4 (vy' - ay)    and of the velocity chosen
//! 0 = ax + pull x,  0 = ay + pull y + g
//! ```

use crate::by_hand::{Equations, Partial, RTOL, algebraic, column, program, run};
use crate::differences::assert_partials;
use hyde_program::{Function, InitialCondition, Point, Program, Selection, Wrt};
use hyde_sim::Setup;
use std::f64::consts::FRAC_PI_2;

/// Gravity in m/s^2 over a length of 1 m, and the velocity at the bottom: enough to turn over, for which it takes 6.26.
const G: f64 = 9.81;
const SPEED: f64 = 7.0;

/// Turns of a run.
const TURNS: usize = 10;

/// The part of the energy that a run may lose: at every change of states the solver starts anew at order 1, with dozens of
/// small steps that are each within rtol; ten rtol a change.
const ENERGY: f64 = 4.0 * TURNS as f64 * 10.0 * RTOL;

struct Pendulum;

impl Equations for Pendulum {
    fn declared(&self) -> Vec<f64> {
        vec![]
    }

    fn start(&self, _p: &[f64], y: &mut [f64], _z: &mut [f64]) {
        // Below, moving to the right; y is a guess from which the constraint is to be met.
        y[..4].copy_from_slice(&[0.0, -0.8, SPEED, 0.0]);
    }

    fn values(&self, function: Function, at: Point<'_>) -> Vec<f64> {
        let (x, y, vx, vy) = (at.y[0], at.y[1], at.y[2], at.y[3]);
        let (ax, ay, pull) = (at.y[4], at.y[5], at.y[6]);
        match function {
            Function::Residual => vec![
                x * x + y * y - 1.0,
                at.z[0] * (at.yp[0] - vx) + at.z[1] * (at.yp[1] - vy),
                x * vx + y * vy,
                at.z[2] * (at.yp[2] - ax) + at.z[3] * (at.yp[3] - ay),
                ax + pull * x,
                ay + pull * y + G,
                vx * vx + vy * vy + x * ax + y * ay,
            ],
            Function::Outputs => vec![x, y, vx, vy, pull, at.z[0]],
            Function::Roots
            | Function::Assignments
            | Function::Initial
            | Function::Delayed
            | Function::Angles => {
                vec![]
            }
        }
    }

    fn partials(&self, function: Function, at: Point<'_>) -> Vec<Partial> {
        let (x, y, vx, vy) = (at.y[0], at.y[1], at.y[2], at.y[3]);
        let (ax, ay, pull) = (at.y[4], at.y[5], at.y[6]);
        match function {
            Function::Residual => vec![
                (0, Wrt::Unknown(0), 2.0 * x),
                (0, Wrt::Unknown(1), 2.0 * y),
                (1, Wrt::Derivative(0), at.z[0]),
                (1, Wrt::Unknown(2), -at.z[0]),
                (1, Wrt::Derivative(1), at.z[1]),
                (1, Wrt::Unknown(3), -at.z[1]),
                (2, Wrt::Unknown(0), vx),
                (2, Wrt::Unknown(1), vy),
                (2, Wrt::Unknown(2), x),
                (2, Wrt::Unknown(3), y),
                (3, Wrt::Derivative(2), at.z[2]),
                (3, Wrt::Unknown(4), -at.z[2]),
                (3, Wrt::Derivative(3), at.z[3]),
                (3, Wrt::Unknown(5), -at.z[3]),
                (4, Wrt::Unknown(4), 1.0),
                (4, Wrt::Unknown(0), pull),
                (4, Wrt::Unknown(6), x),
                (5, Wrt::Unknown(5), 1.0),
                (5, Wrt::Unknown(1), pull),
                (5, Wrt::Unknown(6), y),
                (6, Wrt::Unknown(0), ax),
                (6, Wrt::Unknown(1), ay),
                (6, Wrt::Unknown(2), 2.0 * vx),
                (6, Wrt::Unknown(3), 2.0 * vy),
                (6, Wrt::Unknown(4), x),
                (6, Wrt::Unknown(5), y),
            ],
            Function::Outputs => [0, 1, 2, 3, 6]
                .into_iter()
                .enumerate()
                .map(|(row, unknown)| (row, Wrt::Unknown(unknown), 1.0))
                .collect(),
            Function::Roots
            | Function::Assignments
            | Function::Initial
            | Function::Delayed
            | Function::Angles => {
                vec![]
            }
        }
    }
}

fn pendulum() -> Program {
    let names = ["x", "y", "vx", "vy", "ax", "ay", "pull"];
    let unknowns = (0..)
        .zip(names)
        .map(|(at, name)| algebraic(name, at, "rod"));
    let choice = |first: usize| Selection {
        candidates: vec![first, first + 1],
        constraints: vec![first],
        weights: vec![1.0; 2],
        factors: first,
    };
    let starts_at = |state: usize| InitialCondition::Fixed {
        state,
        len: 1,
        firmness: hyde_program::Firmness::Given,
        yields: false,
        origin: crate::by_hand::origin("start"),
    };
    Program {
        selections: vec![choice(0), choice(2)],
        initial: vec![starts_at(0), starts_at(2)],
        ..program(
            Pendulum,
            unknowns.collect(),
            4,
            &["x", "y", "vx", "vy", "pull", "x is a state"],
        )
    }
}

/// The time of a turn in s: of (angle')^2 = SPEED^2 (1 - m sin^2(angle/2)) with m = 4 G/SPEED^2 it is 4/SPEED times the
/// complete elliptic integral of the first kind, which is pi/2 over the arithmetic-geometric mean of 1 and sqrt(1 - m)
/// (Abramowitz and Stegun, 17.6).
fn turn_s() -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - 4.0 * G / (SPEED * SPEED)).sqrt());
    for _ in 0..10 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    4.0 / SPEED * FRAC_PI_2 / a
}

#[test]
fn the_start_meets_the_constraints_and_keeps_what_is_fixed() {
    let program = pendulum();
    let results = run(&program, &[], vec![0.0, 0.01]).unwrap();
    let first = |name| column(&program, &results, name)[0];
    assert_eq!((first("x"), first("vx")), (0.0, SPEED));
    // Newton's method to rounding.
    assert!((first("y") + 1.0).abs() <= 1e-14);
    assert!(first("vy").abs() <= 1e-14);
    // The pull holds the weight and turns the mass: two roundings of 60.
    assert!((first("pull") - (G + SPEED * SPEED)).abs() <= 1e-12);
    assert_eq!(first("x is a state"), 1.0);
}

#[test]
fn energy_and_length_stay_over_turns() {
    let program = pendulum();
    let stop = TURNS as f64 * turn_s();
    let results = run(&program, &[], Setup::rows_every(0.0, stop, stop / 1000.0)).unwrap();
    let of = |name| column(&program, &results, name);
    let energy = 0.5 * SPEED * SPEED - G;
    for row in 0..results.time.len() {
        let (x, y, vx, vy) = (of("x")[row], of("y")[row], of("vx")[row], of("vy")[row]);
        let now = 0.5 * (vx * vx + vy * vy) + G * y;
        assert!(
            (now - energy).abs() <= ENERGY * energy,
            "{now} J at row {row}"
        );
        // The constraint is an equation of the system: never integrated, so no drift but the tolerance of its solution.
        assert!((x.hypot(y) - 1.0).abs() <= 1e-8, "{x}, {y} at row {row}");
    }
}

#[test]
fn a_turn_takes_its_time() {
    let program = pendulum();
    let rows: Vec<f64> = (0..=TURNS).map(|turn| turn as f64 * turn_s()).collect();
    let results = run(&program, &[], rows).unwrap();
    for (turn, x) in column(&program, &results, "x").iter().enumerate() {
        // At the bottom, passed at 7 m/s. Of m above and the slope of the integral there, a part of the energy takes 0.78
        // of it off the time of a turn; it is lost evenly over the run, on average half of it.
        let late_s = 0.5 * 0.78 * ENERGY * TURNS as f64 * turn_s();
        assert!(x.abs() <= SPEED * late_s, "{x} m after {turn} turns");
    }
}

#[test]
fn states_change_four_times_a_turn() {
    let program = pendulum();
    // A little beyond the bottom, where nothing changes.
    let stop = TURNS as f64 * turn_s();
    let results = run(&program, &[], Setup::rows_every(0.0, stop, stop / 5000.0)).unwrap();
    let of = |name| column(&program, &results, name);
    let chosen = of("x is a state");
    let changes = chosen.windows(2).filter(|pair| pair[0] != pair[1]).count();
    assert_eq!(changes, 4 * TURNS);
    for ((x, y), x_is_state) in of("x").iter().zip(&of("y")).zip(&chosen) {
        // The other one is solved for; changed where another choice is five times as good, at the end of a step.
        let solved_for = if *x_is_state == 1.0 { y } else { x };
        assert!(solved_for.abs() >= 0.1, "{x}, {y}");
    }
}

#[test]
fn derivatives_are_those_of_differences_for_either_choice() {
    let y = [0.6, -0.7, 1.1, 0.4, -2.0, 3.0, 12.0];
    let yp = [0.5, 0.3, -0.9, 2.0, 0.0, 0.0, 0.0];
    for z in [[1.0, 0.0, 1.0, 0.0], [0.0, 1.0, 1.0, 0.0]] {
        assert_partials(&pendulum(), &y, &yp, &z);
    }
}
