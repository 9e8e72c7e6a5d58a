//! Models of the Modelica Standard Library, written anew, against the trajectories that its own tests keep.
#![allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]

use hyde_tests::{data, msl};

/// Every model of `tests/models/msl` runs, and what it says it compares matches.
#[test]
#[allow(clippy::print_stderr, reason = "absent data must be said")]
fn models_match_their_reference_trajectories() {
    let Some(folder) = msl::reference(&data()) else {
        eprintln!("nothing compared: {}", msl::ABSENT);
        return;
    };
    let cases = msl::cases().unwrap();
    let (mut signals, mut matched) = (0, 0);
    let mut wrong = Vec::new();
    for case in &cases {
        match case.compare(&folder) {
            Ok(verdict) => {
                signals += verdict.signals.len();
                matched += usize::from(verdict.matches());
                let bad = verdict.signals.iter().filter(|signal| !signal.matches());
                let bad: Vec<String> = bad
                    .map(|signal| {
                        let msl::Signal { name, worst, at } = signal;
                        format!("{name} is {worst:.3} tolerances away at {at} s")
                    })
                    .collect();
                if !verdict.compared_match() {
                    wrong.push(format!("{}: {}", case.name, bad.join("; ")));
                }
                for (name, reason) in &verdict.left_out {
                    eprintln!("{}: without {name}: {reason}", case.name);
                }
            }
            Err(error) => wrong.push(format!("{}: {error}", case.name)),
        }
    }
    let all = cases.len();
    eprintln!(
        "{signals} signals compared; {matched} of {all} models match in all comparison signals"
    );
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(signals > 0, "the data are there and nothing was compared");
}
