//! Nothing is printed, neither by IDA nor by us.

use std::process::Command;

use hyde_ida::{Error, Ida, Options, Pattern, Recoverable, System};

/// A residual that never has a value, and a root function that always is 0, which IDA would warn of.
struct Hopeless;

impl System for Hopeless {
    fn residual(
        &mut self,
        _t: f64,
        _y: &[f64],
        _yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = f64::NAN;
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
        values[0] = cj;
        Ok(())
    }

    fn n_roots(&self) -> usize {
        1
    }

    fn roots(
        &mut self,
        _t: f64,
        _y: &[f64],
        _yp: &[f64],
        out: &mut [f64],
    ) -> Result<(), Recoverable> {
        out[0] = 0.0;
        Ok(())
    }
}

/// Also run as a process of its own by the test below.
#[test]
fn a_failing_run_keeps_what_ida_says() {
    let options = Options::new(1e-6, vec![1e-6], vec![true]);
    let pattern = Pattern::dense(1).unwrap();
    let mut solver = Ida::new(Hopeless, pattern, options, 0.0, &[0.0], &[1.0]).unwrap();
    let Err(Error::Failed(failure)) = solver.step(1.0) else {
        panic!("the step should fail")
    };
    assert!(
        failure
            .message
            .contains("repeated recoverable residual errors"),
        "{failure}"
    );
    // Only of the last attempt, though the first step was tried five times.
    assert_eq!(
        failure.message.matches("residual errors").count(),
        1,
        "{failure}"
    );
}

#[test]
fn a_failing_run_prints_nothing() {
    let this = std::env::current_exe().unwrap();
    let arguments = [
        "--exact",
        "silence::a_failing_run_keeps_what_ida_says",
        "--nocapture",
        "--quiet",
    ];
    let output = Command::new(this).args(arguments).output().unwrap();
    assert!(output.status.success());
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
    let stdout = String::from_utf8_lossy(&output.stdout);
    assert!(
        stdout.contains("1 passed"),
        "the run itself was not found: {stdout}"
    );
    assert!(
        !stdout.contains("IDA") && !stdout.contains("rank"),
        "{stdout}"
    );
}
