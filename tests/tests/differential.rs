//! Random drive models, each computed in two ways that must agree; `./dev long` compares 10 000.

use hyde_tests::differential::{Way, compare};

const MODELS: u64 = 200;
/// More than this part of the comparisons refused tests too little.
const MOST_REFUSED: f64 = 0.1;

#[test]
fn two_ways_to_one_result_agree() {
    // All ways for all models take minutes in a debug build: each model goes two ways, and the long run all.
    let ways = |seed: u64| {
        let first = (seed / 5) as usize % Way::ALL.len();
        vec![Way::ALL[first], Way::ALL[(first + 3) % Way::ALL.len()]]
    };
    let summary = compare(0..MODELS, ways);
    assert!(
        summary.disagreements.is_empty(),
        "{}",
        summary.disagreements.join("\n")
    );
    assert!(
        summary.refused() < MOST_REFUSED,
        "{} of the comparisons are refused:\n{}",
        summary.refused(),
        summary.refusals.join("\n")
    );
    for way in Way::ALL {
        let agree = summary.counts.get(&way).map_or(0, |counts| counts[0]);
        assert!(agree > 5, "{way:?}: {agree} comparisons");
    }
}
