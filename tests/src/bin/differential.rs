//! `differential [FROM TO [WAY…]]`: compares the models of some seeds, and prints what disagrees and what is refused as it is
//! found.

use hyde_tests::differential::{Summary, Way, compare};
use std::process::ExitCode;

/// Models between two lines that say how far it is.
const AT_ONCE: usize = 100;

#[allow(clippy::print_stdout, reason = "a command prints")]
fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize, default: u64| {
        let word = words.get(at);
        word.and_then(|word| word.parse().ok()).unwrap_or(default)
    };
    if words.first().is_some_and(|word| word == "show") {
        println!("{}", hyde_tests::differential::random(number(1, 0)).text);
        return ExitCode::SUCCESS;
    }
    let (from, to) = (number(0, 0), number(1, 200));
    let chosen: Vec<Way> = Way::ALL
        .into_iter()
        .filter(|way| words.len() < 3 || words[2..].contains(&format!("{way:?}")))
        .collect();
    let mut all = Summary::default();
    for first in (from..to).step_by(AT_ONCE) {
        let next = to.min(first + AT_ONCE as u64);
        let summary = compare(first..next, |_| chosen.clone());
        for refusal in &summary.refusals {
            println!("refused: {}", refusal.lines().next().unwrap_or_default());
        }
        for disagreement in &summary.disagreements {
            println!("{disagreement}");
        }
        all.add(summary);
        println!("{next} of {to}: {} disagreements", all.disagreements.len());
    }
    println!("{:#?}\nrefused {}", all.counts, all.refused());
    ExitCode::from(u8::from(!all.disagreements.is_empty()))
}
