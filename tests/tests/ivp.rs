//! Problems of the Test Set for IVP Solvers against its reference end values.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]

use hyde_experiment::Options;
use hyde_tests::{Example, data, ivp};

/// Those that must be there whatever others are.
const NAMED: [&str; 5] = ["andrews", "caraxis", "hires", "rober", "transistor"];

/// Every problem of `tests/models/ivp` that does not say why it falls short has six correct digits at rtol 1e-8.
#[test]
#[allow(clippy::print_stderr, reason = "absent data must be said")]
fn problems_reach_their_reference_end_values() {
    let Some(reference) = ivp::reference(&data()).unwrap() else {
        eprintln!("nothing compared: {}", ivp::ABSENT);
        return;
    };
    let problems = ivp::problems().unwrap();
    let (mut solved, mut wrong) = (Vec::new(), Vec::new());
    for problem in &problems {
        let name = problem.name.as_str();
        if let Some(reason) = &problem.short {
            eprintln!("{name}: not counted: {reason}");
            continue;
        }
        match problem.solve(&reference, ivp::RTOL) {
            Ok(run) if run.digits >= ivp::ENOUGH_DIGITS => solved.push(name),
            Ok(run) => wrong.push(format!(
                "{name}: {:.2} digits in `{}`",
                run.digits, run.worst
            )),
            Err(error) => wrong.push(format!("{name}: {error}")),
        }
    }
    eprintln!("{} of {} problems solved", solved.len(), problems.len());
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    for name in NAMED {
        assert!(solved.contains(&name), "{name} is not among {solved:?}");
    }
}

/// The start of a car axis: the constraints' Jacobian is singular until the prescribed motion has its value.
#[test]
fn constraints_with_a_prescribed_motion_hold_from_the_start() {
    let axis = Example::load("tests/models/ivp/caraxis.hyde", Some("solve")).unwrap();
    let options = Options {
        stop_s: Some(0.5),
        ..Options::default()
    };
    let (compiled, run) = axis.run_with(&options).unwrap();
    let column = |name| {
        let output = compiled.program.output(name).unwrap();
        run.results.column(output).unwrap()
    };
    let (xl, yl, xr, yr) = (column("xl"), column("yl"), column("xr"), column("yr"));
    let (xb, yb) = (column("xb"), column("yb"));
    // The start values as given.
    assert_eq!([yl[0].to_bits(), yr[0].to_bits()], [0.5_f64.to_bits(); 2]);
    for row in 0..xl.len() {
        // Newton's method leaves errors below the tolerance of 1e-8; lengths are about 1 m.
        assert!((xl[row] * xb[row] + yl[row] * yb[row]).abs() < 1e-8);
        assert!(((xl[row] - xr[row]).hypot(yl[row] - yr[row]) - 1.0).abs() < 1e-8);
    }
}
