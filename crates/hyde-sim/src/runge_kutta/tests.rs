//! Order, stiffness, algebraic variables, ends inside a step, and failures, on systems with a closed form.

use super::*;
use hyde_ida::{Pattern, Recoverable};

/// `x'' = -x`.
struct Oscillator;

/// `x' = -z`, `z = x^3`: x = 1/sqrt(1 + 2t) from 1.
struct Cubic;

/// `y' = -1e6 (y - cos t) - sin t`: y = cos t from 1 (A. Prothero, A. Robinson, Math. Comp. 28 (1974) 145).
struct Stiff;

/// `y' = -y`, with no residual behind t = 1.
struct Cliff;

/// Which unknowns are states.
trait States {
    const STATES: &'static [bool];
}

impl States for Oscillator {
    const STATES: &'static [bool] = &[true, true];
}

impl States for Cubic {
    const STATES: &'static [bool] = &[true, false];
}

impl States for Stiff {
    const STATES: &'static [bool] = &[true];
}

impl States for Cliff {
    const STATES: &'static [bool] = &[true];
}

impl System for Oscillator {
    fn residual(
        &mut self,
        _: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out.copy_from_slice(&[yp[0] - y[1], yp[1] + y[0]]);
        Ok(())
    }

    fn jacobian(
        &mut self,
        _: f64,
        cj: f64,
        _: &[f64],
        _: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        values.copy_from_slice(&[cj, 1.0, -1.0, cj]);
        Ok(())
    }
}

impl System for Cubic {
    fn residual(
        &mut self,
        _: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out.copy_from_slice(&[yp[0] + y[1], y[1] - y[0].powi(3)]);
        Ok(())
    }

    fn jacobian(
        &mut self,
        _: f64,
        cj: f64,
        y: &[f64],
        _: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        values.copy_from_slice(&[cj, -3.0 * y[0].powi(2), 1.0, 1.0]);
        Ok(())
    }
}

impl System for Stiff {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = yp[0] + 1e6 * (y[0] - t.cos()) + t.sin();
        Ok(())
    }

    fn jacobian(
        &mut self,
        _: f64,
        cj: f64,
        _: &[f64],
        _: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        values[0] = cj + 1e6;
        Ok(())
    }
}

impl System for Cliff {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = if t > 1.0 { f64::NAN } else { yp[0] + y[0] };
        Ok(())
    }

    fn jacobian(
        &mut self,
        _: f64,
        cj: f64,
        _: &[f64],
        _: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        values[0] = cj + 1.0;
        Ok(())
    }
}

fn solver<S: System + States>(
    system: S,
    y: &[f64],
    yp: &[f64],
    rtol: f64,
    max_step_s: f64,
) -> RungeKutta<S> {
    let (n, pattern) = (y.len(), Pattern::dense(y.len()).expect("of some unknowns"));
    let factors = Factors::new(pattern, false).expect("a small system");
    let (states, start) = (S::STATES.to_vec(), At { t: 0.0, y, yp });
    let mut solver = RungeKutta::new(system, factors, states, true, max_step_s, start);
    solver.set_tolerances(rtol, &vec![1e-2 * rtol; n]);
    solver.restart(start, f64::INFINITY, 1e-3f64.min(max_step_s));
    solver
}

fn run<S: System>(solver: &mut RungeKutta<S>, stop: f64) {
    while solver.end().t < stop {
        solver.step(stop).expect("a step");
    }
}

/// The error of the oscillation after 4 s in steps of this length, and that of the interpolant in the middle of the last.
fn oscillation(step_s: f64) -> (f64, f64) {
    // A tolerance so loose that the steps are as long as they may be, from the start.
    let mut solver = solver(Oscillator, &[0.0, 1.0], &[1.0, 0.0], 1e3, step_s);
    let start = At {
        t: 0.0,
        y: &[0.0, 1.0],
        yp: &[1.0, 0.0],
    };
    solver.restart(start, f64::INFINITY, step_s);
    solver.next_step_s = step_s;
    run(&mut solver, 4.0);
    let y = solver.end().y;
    let end = (y[0] - 4.0_f64.sin()).hypot(y[1] - 4.0_f64.cos());
    // From exact values, so that the error is that of one step.
    let (x, v) = (1.0_f64.sin(), 1.0_f64.cos());
    let exact = At {
        t: 1.0,
        y: &[x, v],
        yp: &[v, -x],
    };
    solver.restart(exact, f64::INFINITY, step_s);
    solver.next_step_s = step_s;
    solver.step(1.0 + step_s).expect("a step");
    let (mut y, mut yp) = ([0.0; 2], [0.0; 2]);
    let middle = 1.0 + 0.3 * step_s;
    solver.interpolate(middle, &mut y, &mut yp);
    (end, (y[0] - middle.sin()).hypot(y[1] - middle.cos()))
}

#[test]
fn halving_the_step_divides_both_errors_by_32() {
    let (long, short) = (oscillation(0.4), oscillation(0.2));
    for (long, short) in [(long.0, short.0), (long.1, short.1)] {
        // 2^5; terms of the next order are some tenths of it.
        assert!((25.0..45.0).contains(&(long / short)), "{long} {short}");
    }
}

#[test]
fn the_interpolant_meets_both_ends_with_their_slopes() {
    let mut solver = solver(Oscillator, &[0.0, 1.0], &[1.0, 0.0], 1e-6, 0.5);
    run(&mut solver, 2.0);
    let (mut y, mut yp) = ([0.0; 2], [0.0; 2]);
    solver.interpolate(solver.t, &mut y, &mut yp);
    // Rounding of a sum of ten terms.
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-13, "{a} {b}");
    near(y[0], solver.y[0]);
    near(yp[1], solver.slopes[LAST][1]);
    solver.interpolate(solver.from, &mut y, &mut yp);
    near(y[0], solver.before[0]);
    near(yp[1], solver.slopes[0][1]);
}

#[test]
fn algebraic_variables_satisfy_their_equation_at_the_end_of_every_step() {
    let mut solver = solver(Cubic, &[1.0, 1.0], &[-1.0, -3.0], 1e-8, f64::INFINITY);
    while solver.end().t < 10.0 {
        solver.step(10.0).expect("a step");
        let At { t, y, .. } = solver.end();
        // Newton's method leaves a fiftieth of the tolerance.
        assert!((y[1] - y[0].powi(3)).abs() < 1e-9, "at {t}");
        // The tolerance, for the errors decay.
        assert!((y[0] - 1.0 / (1.0 + 2.0 * t).sqrt()).abs() < 1e-7, "at {t}");
    }
    assert!(solver.statistics().steps < 100, "{:?}", solver.statistics());
}

#[test]
fn what_is_stiff_costs_no_steps() {
    let mut solver = solver(Stiff, &[1.0], &[0.0], 1e-6, f64::INFINITY);
    run(&mut solver, 10.0);
    // An explicit method would take a step each microsecond.
    assert!(solver.statistics().steps < 300, "{:?}", solver.statistics());
    assert!((solver.end().y[0] - 10.0_f64.cos()).abs() < 1e-6);
}

#[test]
fn a_step_can_be_taken_again_to_end_before() {
    let mut solver = solver(Oscillator, &[0.0, 1.0], &[1.0, 0.0], 1e-8, 0.1);
    run(&mut solver, 1.0);
    solver.step(2.0).expect("a step");
    let (steps, from, next) = (solver.statistics().steps, solver.from, solver.next_step_s);
    let end = from + 0.3 * (solver.t - from);
    assert!(solver.step_again(end).expect("a shorter step"));
    assert_eq!(solver.end().t.to_bits(), end.to_bits());
    assert_eq!(solver.statistics().steps, steps);
    assert_eq!(solver.next_step_s.to_bits(), next.to_bits());
    // The tolerance, over ten steps and more.
    assert!((solver.end().y[0] - end.sin()).abs() < 1e-7);
}

#[test]
fn a_residual_without_a_value_is_approached_and_told() {
    let mut solver = solver(Cliff, &[1.0], &[-1.0], 1e-6, f64::INFINITY);
    let error = loop {
        if let Err(error) = solver.step(2.0) {
            break error;
        }
    };
    let Error::Failed(failure) = error else {
        panic!("{error}")
    };
    assert_eq!(failure.kind, FailureKind::Residual);
    assert_eq!(failure.equation, Some(0));
    // Up to what is left of a step after so many attempts.
    assert!((failure.t - 1.0).abs() < 1e-9, "{}", failure.t);
}
