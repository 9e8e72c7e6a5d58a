//! Traces as drive software leaves them: read as what they are, or refused with what to say.

use hyde_tests::traces::{Mutated, Outcome, layouts};

/// Where the project's data are beside it, every layout gives its truth.
#[test]
fn every_layout_gives_its_truth() {
    let folder = hyde_tests::data().join("traces");
    if !folder.is_dir() {
        return;
    }
    let all = layouts(&folder).unwrap();
    let wrong: Vec<_> = all.iter().filter(|(_, reason)| reason.is_some()).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Nothing is taken for something else without a word, and what has nothing odd about it is read.
#[test]
fn odd_traces_are_read_right_or_refused() {
    let (mut wrong, mut right) = (Vec::new(), 0);
    for seed in 0..1000 {
        let trace = Mutated::of(seed);
        match trace.outcome() {
            Outcome::Right => right += 1,
            Outcome::Refused(reason) => {
                if std::env::args().any(|argument| argument == "--nocapture") {
                    println!("{seed}: {reason}\n{}", trace.describe());
                }
            }
            Outcome::Misread(reason) => {
                wrong.push(format!("{seed}: {reason}\n{}", trace.describe()))
            }
        }
    }
    assert!(
        wrong.is_empty(),
        "{} misread\n{}",
        wrong.len(),
        wrong[..wrong.len().min(6)].join("\n")
    );
    assert!(right > 350, "{right} are read");
}
