//! Steps, stops, outputs, interpolation, and the limits that are set on them.

use hyde_ida::{Error, Ida, Options, Pattern, Recoverable, Stopped, System};

/// `x' = v`, `v' = -x`, and the latest time at which it was evaluated.
struct Oscillator {
    latest: f64,
}

impl System for Oscillator {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        self.latest = self.latest.max(t);
        out[0] = yp[0] - y[1];
        out[1] = yp[1] + y[0];
        Ok(())
    }

    fn jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        values.copy_from_slice(&[cj, 1.0, -1.0, cj]);
        Ok(())
    }
}

fn oscillator(change: impl FnOnce(&mut Options)) -> Ida<Oscillator> {
    let mut options = Options::new(1e-8, vec![1e-8; 2], vec![true; 2]);
    change(&mut options);
    let system = Oscillator { latest: 0.0 };
    Ida::new(
        system,
        Pattern::dense(2).unwrap(),
        options,
        0.0,
        &[1.0, 0.0],
        &[0.0, -1.0],
    )
    .unwrap()
}

#[test]
fn no_step_passes_the_stop_time() {
    let mut solver = oscillator(|_| ());
    for stop in [0.1, 0.11, 3.0, 3.0 + 1e-9] {
        while solver.step(stop).unwrap() != Stopped::Stop {
            assert!(solver.t() < stop);
        }
        assert_eq!(solver.t(), stop);
        assert!(solver.system().latest <= stop);
    }
    // There already.
    assert_eq!(solver.step(3.0 + 1e-9).unwrap(), Stopped::Stop);
}

#[test]
fn a_stop_time_behind_is_refused() {
    let mut solver = oscillator(|_| ());
    solver.solve(1.0, 2.0).unwrap();
    assert_eq!(solver.step(0.5), Err(Error::Behind { t: 1.0, asked: 0.5 }));
    assert_eq!(
        solver.solve(0.5, 2.0),
        Err(Error::Behind { t: 1.0, asked: 0.5 })
    );
}

#[test]
fn outputs_and_stops_are_told_apart() {
    let mut solver = oscillator(|_| ());
    assert_eq!(solver.solve(1.0, 2.0).unwrap(), Stopped::Output);
    assert_eq!(solver.t(), 1.0);
    // Inside the step that passed t = 1.
    let inside = 0.5 * (1.0 + solver.last_interval().1);
    assert_eq!(solver.solve(inside, 2.0).unwrap(), Stopped::Output);
    assert_eq!(solver.solve(2.0, 2.0).unwrap(), Stopped::Stop);
    assert_eq!(solver.solve(5.0, 2.5).unwrap(), Stopped::Stop);
    assert_eq!(solver.t(), 2.5);
    // 100 steps or so of rtol 1e-8.
    assert!((solver.y()[0] - 2.5_f64.cos()).abs() < 1e-6);
}

#[test]
fn interpolates_over_the_last_step() {
    let mut solver = oscillator(|_| ());
    let mut out = [0.0; 2];
    while solver.step(10.0).unwrap() != Stopped::Stop {
        let (from, to) = solver.last_interval();
        assert_eq!(to, solver.t());
        for part in 0..=4 {
            let t = from + 0.25 * f64::from(part) * (to - from);
            solver.interpolate(t, 0, &mut out).unwrap();
            // Ten time units of rtol 1e-8, a hundredfold for the sum of all steps.
            assert!((out[0] - t.cos()).abs() < 1e-6, "at {t}: {}", out[0]);
            solver.interpolate(t, 1, &mut out).unwrap();
            // A derivative loses some digits, the more the shorter the step; the first ones are of order 1.
            assert!((out[0] + t.sin()).abs() < 1e-3, "at {t}: {}", out[0]);
        }
    }
}

#[test]
fn interpolation_outside_is_refused() {
    let mut solver = oscillator(|_| ());
    let mut out = [0.0; 2];
    solver.interpolate(0.0, 0, &mut out).unwrap();
    assert_eq!(out, [1.0, 0.0]);
    assert_eq!(solver.last_interval(), (0.0, 0.0));
    solver.step(10.0).unwrap();
    let (from, to) = solver.last_interval();
    let order = solver.last_order();
    let outside = Error::OutsideLastStep {
        t: to + 0.1,
        from,
        to,
    };
    assert_eq!(solver.interpolate(to + 0.1, 0, &mut out), Err(outside));
    assert!(matches!(
        solver.interpolate(-0.1, 0, &mut out),
        Err(Error::OutsideLastStep { .. })
    ));
    let none = Error::NoSuchDerivative {
        derivative: order + 1,
        largest: order,
    };
    assert_eq!(solver.interpolate(to, order + 1, &mut out), Err(none));
}

#[test]
fn limits_are_kept() {
    let mut solver = oscillator(|options| {
        options.max_step_s = 0.01;
        options.max_order = 2;
        options.first_step_s = Some(1e-5);
    });
    solver.step(10.0).unwrap();
    assert_eq!(solver.last_step_s(), 1e-5);
    for _ in 0..500 {
        solver.step(10.0).unwrap();
        assert!(solver.last_step_s() <= 0.01 && solver.last_order() <= 2);
    }
    solver.set_max_step(f64::INFINITY).unwrap();
    solver.set_tolerances(1e-2, &[1e-2; 2]).unwrap();
    for _ in 0..20 {
        solver.step(10.0).unwrap();
    }
    assert!(
        solver.last_step_s() > 0.02,
        "the limits are off: {}",
        solver.last_step_s()
    );
}

#[test]
fn one_step_at_a_time_never_is_too_much_work() {
    let mut solver = oscillator(|options| options.max_steps_per_solve = Some(3));
    while solver.step(20.0).unwrap() != Stopped::Stop {}
    let error = solver.solve(40.0, 40.0).unwrap_err();
    assert!(matches!(&error, Error::Failed(failure)
        if failure.kind == hyde_ida::FailureKind::TooMuchWork && failure.t == solver.t()));
    // It goes on from there.
    assert!(solver.t() > 20.0);
    solver.step(40.0).unwrap();
}

#[test]
fn an_output_may_be_many_steps_away() {
    let mut solver = oscillator(|_| ());
    assert_eq!(solver.solve(50.0, 60.0).unwrap(), Stopped::Output);
    assert!(
        solver.statistics().steps > 500,
        "the test has lost its point"
    );
    // A thousand steps of rtol 1e-8.
    assert!((solver.y()[0] - 50.0_f64.cos()).abs() < 1e-5);
}

/// `0 = y - sin t`: no state at all.
struct Algebraic;

impl System for Algebraic {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        _yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = y[0] - t.sin();
        Ok(())
    }

    fn jacobian(
        &mut self,
        _t: f64,
        _cj: f64,
        _y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        values[0] = 1.0;
        Ok(())
    }
}

#[test]
fn a_system_without_states_follows_its_equations() {
    let options = Options::new(1e-8, vec![1e-10], vec![false]);
    let pattern = Pattern::dense(1).unwrap();
    let mut solver = Ida::new(Algebraic, pattern, options, 0.0, &[0.0], &[1.0]).unwrap();
    while solver.step(3.0).unwrap() != Stopped::Stop {
        // Newton's method ends within a hundredth of the tolerance.
        assert!((solver.y()[0] - solver.t().sin()).abs() < 1e-9);
    }
}
