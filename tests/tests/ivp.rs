//! Problems of the Test Set for IVP Solvers against its reference end values.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]

use hyde_tests::{data, ivp};

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
