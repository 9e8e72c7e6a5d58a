//! x'' = -w^2 x as two states, against x = cos(w t).

use crate::by_hand::{Equations, Partial, column, program, run, state};
use crate::differences::assert_partials;
use hyde_program::{Function, Point, Program, Workspace, Wrt};
use hyde_sim::Setup;
use std::f64::consts::TAU;

/// Places of the parameters: the angular frequency, and its square, which follows from it.
const W: usize = 0;
const W_SQUARED: usize = 1;

struct Oscillator;

impl Equations for Oscillator {
    fn declared(&self) -> Vec<f64> {
        vec![3.0]
    }

    fn derived(&self, declared: &[f64]) -> Vec<f64> {
        vec![declared[W] * declared[W]]
    }

    fn start(&self, _p: &[f64], y: &mut [f64], _z: &mut [f64]) {
        y[0] = 1.0;
    }

    fn values(&self, function: Function, at: Point<'_>) -> Vec<f64> {
        let (y, yp) = (at.y, at.yp);
        match function {
            Function::Residual => vec![yp[0] - y[1], yp[1] + at.p[W_SQUARED] * y[0]],
            Function::Outputs => y.to_vec(),
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
        match function {
            Function::Residual => vec![
                (0, Wrt::Derivative(0), 1.0),
                (0, Wrt::Unknown(1), -1.0),
                (1, Wrt::Derivative(1), 1.0),
                (1, Wrt::Unknown(0), at.p[W_SQUARED]),
            ],
            Function::Outputs => vec![(0, Wrt::Unknown(0), 1.0), (1, Wrt::Unknown(1), 1.0)],
            Function::Roots
            | Function::Assignments
            | Function::Initial
            | Function::Delayed
            | Function::Angles => {
                vec![]
            }
        }
    }

    fn parameter_partials(&self, function: Function, at: Point<'_>) -> Vec<Partial> {
        match function {
            Function::Residual => vec![(1, Wrt::Parameter(W), 2.0 * at.p[W] * at.y[0])],
            Function::Outputs
            | Function::Roots
            | Function::Assignments
            | Function::Initial
            | Function::Delayed
            | Function::Angles => {
                vec![]
            }
        }
    }
}

fn oscillator() -> Program {
    let unknowns = vec![state("x", 0, "spring"), state("v", 1, "mass")];
    program(Oscillator, unknowns, 0, &["x", "v"])
}

#[test]
fn phase_and_amplitude_are_those_of_the_cosine_over_a_hundred_periods() {
    let program = oscillator();
    let period = TAU / 3.0;
    let rows = Setup::rows_every(0.0, 100.0 * period, period / 16.0);
    let results = run(&program, &[], rows).unwrap();
    let (x, v) = (
        column(&program, &results, "x"),
        column(&program, &results, "v"),
    );
    for ((t, x), v) in results.time.iter().zip(&x).zip(&v) {
        let amplitude = x.hypot(v / 3.0);
        let late = (-v / 3.0).atan2(*x) - 3.0 * t;
        let late = late - TAU * (late / TAU).round();
        // The project promises energy to 1e-6 over 100 periods at this rtol: amplitude to half of that. Phase errors grow
        // alike.
        assert!(
            (amplitude - 1.0).abs() <= 5e-7,
            "amplitude {amplitude} at {t} s"
        );
        assert!(late.abs() <= 1e-6, "phase off by {late} rad at {t} s");
    }
}

#[test]
fn a_parameter_that_is_set_carries_what_follows_from_it() {
    let program = oscillator();
    let results = run(&program, &[(W, 5.0)], vec![0.0, 1.0]).unwrap();
    let x = column(&program, &results, "x").last().copied().unwrap();
    // Less than a period: a few dozen steps, each within rtol.
    assert!((x - 5.0_f64.cos()).abs() <= 1e-7, "{x}");
}

#[test]
fn derivatives_are_those_of_differences() {
    assert_partials(&oscillator(), &[0.4, -1.3], &[0.7, 2.0], &[]);
}

#[test]
fn the_derivative_by_the_frequency_goes_through_its_square() {
    let program = oscillator();
    let residual = |w: f64| {
        let mut p = vec![0.0; program.n_parameters];
        program.kernels.parameters(&[(W, w)], &mut p);
        let mut out = vec![0.0; 2];
        let at = point(&p);
        let workspace = &mut Workspace::default();
        program
            .kernels
            .evaluate(Function::Residual, at, workspace, &mut out);
        out
    };
    let mut p = vec![0.0; program.n_parameters];
    program.kernels.parameters(&[], &mut p);
    let workspace = &mut Workspace::default();
    let found = program
        .kernels
        .parameter_partials(Function::Residual, &[W], point(&p), workspace);
    let (up, down) = (residual(3.001), residual(2.999));
    for row in 0..2 {
        let of_row = found.iter().filter(|(entry, _)| entry.row == row);
        let written: f64 = of_row.map(|(_, value)| value).sum();
        let difference = (up[row] - down[row]) / 2e-3;
        // The residual is quadratic in w, a central difference exact: rounding over the step is left.
        assert!((written - difference).abs() <= 1e-12 / 1e-3, "row {row}");
    }
    assert_eq!(
        found.iter().map(|(_, value)| *value).sum::<f64>(),
        2.0 * 3.0 * 0.4
    );
}

fn point(p: &[f64]) -> Point<'_> {
    Point {
        t: 0.0,
        y: &[0.4, -1.3],
        yp: &[0.7, 2.0],
        z: &[],
        u: &[],
        p,
    }
}
