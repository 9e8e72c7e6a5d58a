//! Where a model cannot be solved: what is recovered, and what is named.

use hyde_ida::{
    Error, Failure, FailureKind, Ida, LinearMethod, Options, Pattern, Recoverable, Singular,
    SparseSolver, Stopped, System,
};

/// Three unknowns, `x' = 1`, `w' = 0`, `z = x`, with something wrong from `t = 1` on.
struct Trouble(Wrong);

#[derive(Clone, Copy, PartialEq)]
enum Wrong {
    ResidualNan,
    ResidualGivesUp,
    JacobianNan,
    Singular,
    /// The equation of `z` becomes `z^2 + 1 = 0`, scaled down so that its residual is the smallest number around.
    NoSolution,
    RootNan,
}

impl System for Trouble {
    fn residual(
        &mut self,
        t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        let late = t > 1.0;
        out[0] = yp[0] - 1.0;
        out[1] = yp[1];
        out[2] = y[2] - y[0];
        if late && self.0 == Wrong::ResidualNan {
            out[1] = (1.0 - t).sqrt();
        }
        if late && self.0 == Wrong::NoSolution {
            out[2] = 1e-12 * (y[2] * y[2] + 1.0);
        }
        if late && self.0 == Wrong::ResidualGivesUp {
            Err(Recoverable)
        } else {
            Ok(())
        }
    }

    fn jacobian(
        &mut self,
        t: f64,
        cj: f64,
        y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        values.copy_from_slice(&[cj, 0.0, -1.0, 0.0, cj, 0.0, 0.0, 0.0, 1.0]);
        match self.0 {
            Wrong::JacobianNan if t > 1.0 => values[5] = f64::NAN,
            Wrong::Singular if t > 1.0 => values[8] = 0.0,
            Wrong::NoSolution if t > 1.0 => (values[2], values[8]) = (0.0, 2e-12 * y[2]),
            _ => {}
        }
        Ok(())
    }

    fn n_roots(&self) -> usize {
        if self.0 == Wrong::RootNan { 2 } else { 0 }
    }

    fn roots(
        &mut self,
        t: f64,
        _y: &[f64],
        _yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = 1.0;
        // Not written is no value either.
        if t <= 1.0 {
            out[1] = 1.0;
        }
        Ok(())
    }
}

fn fail(wrong: Wrong) -> Failure {
    let options = Options::new(1e-6, vec![1e-6; 3], vec![true, true, false]);
    let pattern = Pattern::dense(3).unwrap();
    let mut solver = Ida::new(
        Trouble(wrong),
        pattern,
        options,
        0.0,
        &[0.0; 3],
        &[1.0, 0.0, 1.0],
    )
    .unwrap();
    loop {
        // Another step size, and so another Jacobian, near t = 1.
        solver
            .set_max_step(if solver.t() < 0.9 { 0.3 } else { 0.02 })
            .unwrap();
        match solver.step(10.0) {
            Ok(stopped) => assert_eq!(stopped, Stopped::Step),
            Err(Error::Failed(failure)) => {
                assert_eq!(
                    failure.t,
                    solver.t(),
                    "the solver stands where the last step ended"
                );
                // z is x there: the point is one of the solution, not of the attempt that failed.
                assert!((solver.y()[2] - solver.t()).abs() < 1e-5);
                return *failure;
            }
            Err(error) => panic!("{error}"),
        }
    }
}

#[test]
fn a_residual_without_a_value_names_the_equation() {
    let failure = fail(Wrong::ResidualNan);
    assert_eq!(
        (failure.kind, failure.equation),
        (FailureKind::Residual, Some(1))
    );
    // IDA comes as near as time can tell: the smallest step is 16 units in the last place.
    assert!(failure.t <= 1.0 && failure.t > 1.0 - 1e-14, "{failure}");
    assert_eq!(failure.flag, "IDA_REP_RES_ERR");
}

#[test]
fn a_model_that_gives_up_is_a_residual_without_a_value() {
    let failure = fail(Wrong::ResidualGivesUp);
    assert_eq!(
        (failure.kind, failure.equation),
        (FailureKind::Residual, None)
    );
}

#[test]
fn a_jacobian_without_a_value_names_equation_and_unknown() {
    let failure = fail(Wrong::JacobianNan);
    assert_eq!(failure.kind, FailureKind::Jacobian);
    assert_eq!((failure.equation, failure.unknown), (Some(2), Some(1)));
}

#[test]
fn a_singular_jacobian_names_the_unknown() {
    let failure = fail(Wrong::Singular);
    assert_eq!(
        (failure.kind, failure.unknown),
        (FailureKind::SingularJacobian, Some(2))
    );
}

#[test]
fn an_equation_without_a_solution_is_named_whatever_its_scale() {
    let failure = fail(Wrong::NoSolution);
    assert_eq!(failure.kind, FailureKind::Convergence, "{failure}");
    assert_eq!((failure.equation, failure.unknown), (Some(2), Some(2)));
}

#[test]
fn a_start_that_is_not_consistent_names_the_unknown() {
    let mut options = Options::new(1e-6, vec![1e-6; 3], vec![true, true, false]);
    options.suppress_algebraic = false;
    let pattern = Pattern::dense(3).unwrap();
    let y0 = [0.0, 0.0, 10.0];
    let system = Trouble(Wrong::RootNan);
    let mut solver = Ida::new(system, pattern, options, 0.0, &y0, &[1.0, 0.0, 1.0]).unwrap();
    let Err(Error::Failed(failure)) = solver.step(0.5) else {
        panic!("no step makes z = x of z = 10")
    };
    assert_eq!(
        (failure.kind, failure.unknown),
        (FailureKind::ErrorTest, Some(2))
    );
    assert_eq!(failure.flag, "IDA_ERR_FAIL");
    assert_eq!(
        (solver.t(), solver.y()),
        (0.0, y0.as_slice()),
        "back at the start"
    );
    assert_eq!(solver.statistics().first_step_retries, 4);
}

#[test]
fn a_mode_may_change_which_unknowns_are_states() {
    let options = Options::new(1e-6, vec![1e-6; 3], vec![true, true, false]);
    let pattern = Pattern::dense(3).unwrap();
    let (y0, yp0) = ([0.0, 0.0, 10.0], [1.0, 0.0, 1.0]);
    let system = Trouble(Wrong::RootNan);
    let mut solver = Ida::new(system, pattern, options, 0.0, &y0, &yp0).unwrap();
    // As an algebraic variable z may jump, as a state it may not.
    solver.set_differential(&[true; 3]).unwrap();
    solver.step(0.5).unwrap_err();
    solver.set_differential(&[true, true, false]).unwrap();
    solver.reinit(0.0, &y0, &yp0, None).unwrap();
    solver.step(0.5).unwrap();
}

#[test]
fn a_root_function_without_a_value_is_named() {
    let failure = fail(Wrong::RootNan);
    assert_eq!(
        (failure.kind, failure.root),
        (FailureKind::RootFunction, Some(1))
    );
}

#[test]
fn the_text_has_all_of_it() {
    let text = Error::Failed(Box::new(fail(Wrong::ResidualNan))).to_string();
    for part in [
        "the residual has no value at t = ",
        "equation 1",
        "IDA_REP_RES_ERR: ",
        " s with a step of ",
    ] {
        assert!(text.contains(part), "no `{part}` in `{text}`");
    }
    assert!(
        text.contains("repeated recoverable residual errors"),
        "IDA's words are missing in `{text}`"
    );
}

/// `y' = -sqrt(y)`, which has no value below 0.
struct Draining {
    refused: u32,
}

impl System for Draining {
    fn residual(
        &mut self,
        _t: f64,
        y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        self.refused += u32::from(y[0] < 0.0);
        out[0] = yp[0] + y[0].sqrt();
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
        values[0] = cj + 0.5 / y[0].sqrt();
        Ok(())
    }
}

#[test]
fn a_nan_on_the_way_is_stepped_around() {
    let mut options = Options::new(1e-8, vec![1e-10], vec![true]);
    // The predictor of this step is 1 - 1.5, where the root has no value.
    options.first_step_s = Some(1.5);
    let system = Draining { refused: 0 };
    let mut solver = Ida::new(
        system,
        Pattern::dense(1).unwrap(),
        options,
        0.0,
        &[1.0],
        &[-1.0],
    )
    .unwrap();
    while solver.step(1.8).unwrap() != Stopped::Stop {}
    assert!(solver.system().refused > 0, "the test has lost its point");
    // y = (1 - t / 2)^2; a hundred tolerances for a hundred steps.
    assert!((solver.y()[0] - 0.01).abs() < 1e-6);
}

/// Two equations that only a first step far below IDA's choice gets into: `x' = 1e9 * (x < 1e-9)`, one unknown idle.
struct Jerk;

impl System for Jerk {
    fn residual(
        &mut self,
        t: f64,
        _y: &[f64],
        yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = yp[0] - 1.0;
        if t > 0.0 && t < 1e3 && yp[0] > 0.5 && self.step_of(t) {
            Err(Recoverable)
        } else {
            Ok(())
        }
    }

    fn jacobian(
        &mut self,
        _t: f64,
        cj: f64,
        _y: &[f64],
        _yp: &[f64],
        values: &mut [f64],
    ) -> Result<(), Recoverable> {
        values[0] = cj;
        Ok(())
    }
}

impl Jerk {
    /// Whether the step from 0 to `t` is longer than the model bears.
    fn step_of(&self, t: f64) -> bool {
        t > 1e-10 && t < 10.0
    }
}

#[test]
fn a_first_step_that_fails_is_tried_again_much_smaller() {
    let mut options = Options::new(1e-6, vec![1e-6], vec![true]);
    options.first_step_s = Some(1.0);
    let mut solver = Ida::new(
        Jerk,
        Pattern::dense(1).unwrap(),
        options,
        0.0,
        &[0.0],
        &[1.0],
    )
    .unwrap();
    // IDA's ten attempts go from 1 to 4e-6; with a thousandth as the next start, to 4e-9; then to 4e-12.
    assert_eq!(solver.step(5.0).unwrap(), Stopped::Step);
    assert!(solver.t() <= 1e-10);
    assert_eq!(solver.statistics().first_step_retries, 2);
}

#[test]
fn singular_is_an_error_of_its_own() {
    let mut solver = SparseSolver::new(Pattern::dense(2).unwrap(), LinearMethod::Dense).unwrap();
    let error = solver.factor(&[1.0, 2.0, 2.0, 4.0]).unwrap_err();
    assert_eq!(error, Singular { unknown: 1 });
}
