//! A tank that empties through a valve: an index-1 DAE whose flow is an algebraic variable in the solver's vector.
//!
//! ```text
//! x' = -(q + pump)                          tank
//! reading = 2 x                             gauge
//! x = cubic q^3 + square q^2 + linear q     valve
//! ```

use crate::by_hand::{Equations, Partial, RTOL, algebraic, column, origin, program, run, state};
use crate::differences::assert_partials;
use hyde_program::{Function, Point, Program, Wrt};
use hyde_sim::{FailureKind, Setup};

/// Places of the parameters: start of x, the guess of q, and what the equations name.
const START: usize = 0;
const GUESS: usize = 1;
const PUMP: usize = 2;
const CUBIC: usize = 3;
const SQUARE: usize = 4;
const LINEAR: usize = 5;

/// A valve without a slope at q = 0, where the flow of a level below zero has no value.
const FOLDED: [(usize, f64); 3] = [(CUBIC, 0.0), (SQUARE, 1.0), (LINEAR, 0.0)];

struct Tank;

impl Equations for Tank {
    fn declared(&self) -> Vec<f64> {
        vec![2.0, -40.0, 0.0, 1.0, 0.0, 1.0]
    }

    fn start(&self, p: &[f64], y: &mut [f64], _z: &mut [f64]) {
        (y[0], y[2]) = (p[START], p[GUESS]);
    }

    fn values(&self, function: Function, at: Point<'_>) -> Vec<f64> {
        let (x, reading, q, p) = (at.y[0], at.y[1], at.y[2], at.p);
        match function {
            Function::Residual => vec![
                at.yp[0] + q + p[PUMP],
                reading - 2.0 * x,
                p[CUBIC] * q * q * q + p[SQUARE] * q * q + p[LINEAR] * q - x,
            ],
            Function::Outputs => at.y.to_vec(),
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
        let (q, p) = (at.y[2], at.p);
        let slope = 3.0 * p[CUBIC] * q * q + 2.0 * p[SQUARE] * q + p[LINEAR];
        match function {
            Function::Residual => vec![
                (0, Wrt::Derivative(0), 1.0),
                (0, Wrt::Unknown(2), 1.0),
                (1, Wrt::Unknown(1), 1.0),
                (1, Wrt::Unknown(0), -2.0),
                (2, Wrt::Unknown(2), slope),
                (2, Wrt::Unknown(0), -1.0),
            ],
            Function::Outputs => (0..3).map(|row| (row, Wrt::Unknown(row), 1.0)).collect(),
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

fn tank() -> Program {
    let unknowns = vec![
        state("x", 0, "tank"),
        algebraic("reading", 1, "gauge"),
        algebraic("q", 2, "valve"),
    ];
    program(Tank, unknowns, 0, &["x", "reading", "q"])
}

#[test]
fn consistent_values_are_found_from_a_wrong_guess() {
    let program = tank();
    let results = run(&program, &[], vec![0.0, 1.0]).unwrap();
    // x = 2 = q^3 + q at q = 1. Newton's method ends where its step is 1e-12 of the value; the step is quadratic there.
    assert!((column(&program, &results, "q")[0] - 1.0).abs() <= 1e-14);
    assert_eq!(column(&program, &results, "x")[0], 2.0);
    assert_eq!(column(&program, &results, "reading")[0], 4.0);
}

#[test]
fn the_flow_is_that_of_the_closed_form() {
    let program = tank();
    let results = run(&program, &[], Setup::rows_every(0.0, 5.0, 0.25)).unwrap();
    let (x, q) = (
        column(&program, &results, "x"),
        column(&program, &results, "q"),
    );
    for ((t, x), q) in results.time.iter().zip(x).zip(q) {
        // The real root of q^3 + q = x, by hyperbolic functions.
        let exact = 2.0 / 3.0_f64.sqrt() * ((1.5 * 3.0_f64.sqrt() * x).asinh() / 3.0).sinh();
        // From q' (3 q^2 + 1) = x' = -q, integrated from q = 1: the time at which the flow is q.
        let expected = 1.5 * (1.0 - exact * exact) - exact.ln();
        // An error in x is over x' = -q one in time; thirty times rtol for what a hundred steps
        // add up to.
        let tolerance = 30.0 * RTOL / exact;
        assert!(
            (t - expected).abs() <= tolerance,
            "x = {x} at {t} s, not {expected} s"
        );
        // IDA ends Newton's method by the rate of convergence that it remembers of an earlier step, after one iteration if
        // that was good, so that the algebraic equation is off by some tens of the tolerance.
        assert!((q - exact).abs() <= 100.0 * RTOL, "{q} not {exact}");
    }
}

#[test]
fn a_start_without_a_solution_names_the_valve() {
    let program = tank();
    // q^2 = -1: the first step from q = 1 lands where the slope is zero; from elsewhere Newton's method wanders.
    for guess in [1.0, 0.7] {
        let set = [&FOLDED[..], &[(START, -1.0), (GUESS, guess)]].concat();
        let failure = run(&program, &set, vec![0.0, 1.0]).unwrap_err();
        let FailureKind::Inconsistent { at_start, .. } = failure.kind else {
            panic!("{:?}", failure.kind)
        };
        assert!(at_start);
        assert_eq!(failure.t, 0.0);
        assert_eq!(failure.origins, vec![origin("valve")]);
        assert_eq!(failure.unknowns[0].0, "q");
        assert!(failure.results.time.is_empty());
    }
}

#[test]
fn a_flow_that_no_equation_determines_is_named() {
    let program = tank();
    let set = [(CUBIC, 0.0), (LINEAR, 0.0)];
    let failure = run(&program, &set, vec![0.0, 1.0]).unwrap_err();
    let kind = FailureKind::Inconsistent {
        singular: vec!["q".to_owned()],
        at_start: true,
    };
    assert_eq!(failure.kind, kind);
    assert_eq!(failure.origins, vec![origin("valve")]);
}

#[test]
fn a_solution_that_ends_is_a_failure_there_that_names_the_valve() {
    let program = tank();
    // x' = -(sqrt(x) + 1) from x = 1 empties the tank at full speed; below zero there is no flow.
    let set = [&FOLDED[..], &[(START, 1.0), (GUESS, 1.0), (PUMP, 1.0)]].concat();
    let failure = run(&program, &set, Setup::rows_every(0.0, 1.0, 0.01)).unwrap_err();
    // The integral of dx/(1 + sqrt(x)) from 0 to 1.
    let end = 2.0 - 2.0 * 2.0_f64.ln();
    // The solver stops where its step is too small: q is the root of what is left, so x is near zero to well below atol.
    assert!((failure.t - end).abs() <= 1e-6, "{} not {end}", failure.t);
    assert_eq!(failure.origins[0], origin("valve"), "{:?}", failure.origins);
    // What was computed up to there is kept: 62 rows, the first at 0.
    assert_eq!(failure.results.time.len(), 62);
}

#[test]
fn derivatives_are_those_of_differences() {
    assert_partials(&tank(), &[2.0, 1.5, 0.7], &[0.7, 2.0, 0.0], &[]);
}
