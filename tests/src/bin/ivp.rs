//! `ivp [PROBLEM…]`: correct digits against work of the problems of the Test Set for IVP Solvers, a line for each tolerance.

use hyde_tests::{data, ivp};
use std::process::ExitCode;

#[allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command prints"
)]
fn main() -> ExitCode {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let (reference, problems) = match (ivp::reference(&data()), ivp::problems()) {
        (Ok(Some(reference)), Ok(problems)) => (reference, problems),
        (Ok(None), Ok(_)) => {
            println!("nothing compared: {}", ivp::ABSENT);
            return ExitCode::SUCCESS;
        }
        (Err(error), _) | (_, Err(error)) => {
            eprintln!("{error}");
            return ExitCode::FAILURE;
        }
    };
    println!("problem       rtol  digits    steps residuals Jacobians failures worst component");
    let mut any_failed = false;
    for problem in problems {
        if !names.is_empty() && !names.contains(&problem.name) {
            continue;
        }
        for rtol in [1e-4, 1e-6, 1e-8] {
            match problem.solve(&reference, rtol) {
                Ok(solved) => {
                    let work = solved.work;
                    println!(
                        "{:<11} {rtol:>6.0e} {:>7.2} {:>8} {:>9} {:>9} {:>8} {}",
                        problem.name,
                        solved.digits,
                        work.steps,
                        work.residual_evaluations,
                        work.jacobian_evaluations,
                        work.error_test_failures + work.nonlinear_failures,
                        solved.worst,
                    );
                }
                Err(error) => {
                    println!("{:<11} {rtol:>6.0e} failed: {error}", problem.name);
                    any_failed = true;
                }
            }
        }
    }
    ExitCode::from(u8::from(any_failed))
}
