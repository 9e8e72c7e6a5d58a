//! The problems as a user of diffsol writes them: right-hand sides and Jacobians as closures, events by stepping.
//!
//!     diffsol shaft N RTOL [SAMPLE_TIME]
//!     diffsol stick_slip RTOL
//!     diffsol backlash RTOL GAP | RTOL FIRST LAST N
//!     diffsol nonlinear N RTOL INDEX_1
//!
//! The arguments and the lines printed are those of the reference programs (`../../../../reference/reference.h`).

mod backlash;
mod nonlinear;
mod run;
mod shaft;
mod stick_slip;

use std::process::ExitCode;

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let Some((problem, rest)) = words.split_first() else {
        return ExitCode::from(2);
    };
    let numbers: Option<Vec<f64>> = rest.iter().map(|word| word.parse().ok()).collect();
    let solved = match (problem.as_str(), numbers.as_deref()) {
        ("shaft", Some(&[cells, rtol])) => shaft::step(cells as usize, rtol),
        ("shaft", Some(&[cells, rtol, every])) => shaft::sampled(cells as usize, rtol, every),
        ("stick_slip", Some(&[rtol])) => stick_slip::solve(rtol),
        ("backlash", Some(&[rtol, gap])) => backlash::solve(rtol, gap),
        ("backlash", Some(&[rtol, first, last, n])) => {
            backlash::solve_all(rtol, first, last, n as usize)
        }
        ("nonlinear", Some(&[cells, rtol, form])) => {
            nonlinear::solve(cells as usize, rtol, form > 0.0)
        }
        _ => return ExitCode::from(2),
    };
    match solved {
        Ok(run) => {
            run.print();
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("{error}");
            ExitCode::FAILURE
        }
    }
}
