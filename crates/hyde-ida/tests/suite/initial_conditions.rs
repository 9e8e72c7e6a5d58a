//! Consistent initial conditions, found and not found.

use hyde_ida::{Error, FailureKind, Given, Ida, Options, Pattern, Recoverable, System};

/// `x' = 1 - x + z`, `0 = z^3 + z - x + offset`; without a solution if `hopeless`.
struct Cubic {
    hopeless: bool,
}

impl System for Cubic {
    fn residual(
        &mut self,
        _t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = yp[0] - 1.0 + y[0] - y[1];
        out[1] = if self.hopeless {
            y[1] * y[1] + 1.0
        } else {
            y[1].powi(3) + y[1] - y[0]
        };
        Ok(())
    }

    fn jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        let lower = if self.hopeless {
            [0.0, 2.0 * y[1]]
        } else {
            [-1.0, 3.0 * y[1] * y[1] + 1.0]
        };
        values.copy_from_slice(&[cj + 1.0, lower[0], -1.0, lower[1]]);
        Ok(())
    }
}

fn solver(hopeless: bool, y0: [f64; 2]) -> Ida<Cubic> {
    let options = Options::new(1e-10, vec![1e-12; 2], vec![true, false]);
    let pattern = Pattern::dense(2).unwrap();
    Ida::new(Cubic { hopeless }, pattern, options, 0.0, &y0, &[0.0; 2]).unwrap()
}

#[test]
fn from_the_states() {
    let mut solver = solver(false, [10.0, 1.0]);
    solver
        .consistent_initial_conditions(Given::States, 1.0)
        .unwrap();
    // x = 10 gives z = 2 and x' = -7, to a hundredth of the tolerance on which Newton's method stops.
    assert_eq!(solver.y()[0], 10.0);
    assert!((solver.y()[1] - 2.0).abs() < 1e-9);
    assert!((solver.yp()[0] + 7.0).abs() < 1e-9);
    solver.step(1.0).unwrap();
    assert_eq!(solver.statistics().restarts, 0);
}

#[test]
fn from_the_derivatives() {
    let mut solver = solver(false, [1.9, 0.9]);
    solver
        .consistent_initial_conditions(Given::Derivatives, 1.0)
        .unwrap();
    // x = 1 + z and z^3 = 1. As above.
    assert!((solver.y()[0] - 2.0).abs() < 1e-9);
    assert!((solver.y()[1] - 1.0).abs() < 1e-9);
}

#[test]
fn after_a_step_is_a_restart_from_there() {
    let mut solver = solver(false, [10.0, 2.0]);
    solver
        .consistent_initial_conditions(Given::States, 1.0)
        .unwrap();
    solver.solve(0.1, 1.0).unwrap();
    let (t, y) = (solver.t(), solver.y().to_vec());
    solver
        .consistent_initial_conditions(Given::States, 1.0)
        .unwrap();
    assert_eq!(solver.t(), t);
    assert_eq!(solver.y()[0], y[0]);
    // z was as exact as the integration leaves it.
    assert!((solver.y()[1] - y[1]).abs() < 1e-8);
    assert_eq!(solver.statistics().restarts, 1);
}

#[test]
fn none_found_names_the_equation_and_changes_nothing() {
    let mut solver = solver(true, [10.0, 1.0]);
    let error = solver
        .consistent_initial_conditions(Given::States, 1.0)
        .unwrap_err();
    let Error::Failed(failure) = error else {
        panic!("{error}")
    };
    assert_eq!(failure.kind, FailureKind::InitialConditions);
    assert_eq!(failure.equation, Some(1));
    assert_eq!((solver.t(), solver.y()), (0.0, [10.0, 1.0].as_slice()));
}
