//! A system of index 1 from rest at tight tolerances: the case in which IDA's own defaults fail at the first step.

use hyde_ida::{Ida, Options, Pattern, Recoverable, Stopped, System};

const STIFFNESS: f64 = 4e6;
const MASS: f64 = 100.0;
const DRIVE_SPEED: f64 = 0.02;

/// A mass drawn through a spring whose other end moves at constant speed: `x' = v`, `m v' = f`, `f = k (u t - x)`.
struct DrawnMass;

impl System for DrawnMass {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = yp[0] - y[1];
        out[1] = MASS * yp[1] - y[2];
        out[2] = y[2] - STIFFNESS * (DRIVE_SPEED * t - y[0]);
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
        values.copy_from_slice(&[cj, 0.0, STIFFNESS, -1.0, MASS * cj, 0.0, 0.0, -1.0, 1.0]);
        Ok(())
    }
}

fn run(rtol: f64, suppress_algebraic: bool) -> Ida<DrawnMass> {
    let mut options = Options::new(rtol, vec![rtol * 1e-3; 3], vec![true, true, false]);
    options.suppress_algebraic = suppress_algebraic;
    let pattern = Pattern::dense(3).unwrap();
    // All zero: the derivative of the force is not consistent.
    let mut solver = Ida::new(DrawnMass, pattern, options, 0.0, &[0.0; 3], &[0.0; 3]).unwrap();
    while solver.step(0.1).unwrap() != Stopped::Stop {}
    solver
}

#[test]
fn starts_from_rest_at_tight_tolerances() {
    for rtol in [1e-4, 1e-6, 1e-8, 1e-10] {
        let solver = run(rtol, true);
        let omega = (STIFFNESS / MASS).sqrt();
        let (t, y) = (0.1, solver.y());
        let x = DRIVE_SPEED * (t - (omega * t).sin() / omega);
        // The error of some 100 to 2000 steps adds up to some 100 tolerances over the three periods.
        let error = (y[0] - x).abs() / (DRIVE_SPEED * t);
        assert!(error < 300.0 * rtol, "{error} at rtol {rtol}");
    }
}

#[test]
fn finds_its_first_step_even_with_the_algebraic_variable_in_the_error_test() {
    let solver = run(1e-10, false);
    // IDA would give up at the tenth.
    assert!(
        solver.statistics().error_test_failures > 10,
        "the test has lost its point"
    );
    let omega = (STIFFNESS / MASS).sqrt();
    let x = DRIVE_SPEED * (0.1 - (omega * 0.1).sin() / omega);
    // As above.
    assert!((solver.y()[0] - x).abs() < 300.0 * 1e-10 * DRIVE_SPEED * 0.1);
}
