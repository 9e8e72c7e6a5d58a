//! `differential [FROM TO [WAY…]]`: compares the models of some seeds, and prints what disagrees and what is refused.

use hyde_tests::differential::{Way, compare};
use std::process::ExitCode;

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
    let summary = compare(from..to, |_| chosen.clone());
    for refusal in &summary.refusals {
        println!("refused: {}", refusal.lines().next().unwrap_or_default());
    }
    for disagreement in &summary.disagreements {
        println!("{disagreement}");
    }
    println!("{:#?}\nrefused {}", summary.counts, summary.refused());
    println!("{} disagreements", summary.disagreements.len());
    ExitCode::from(u8::from(!summary.disagreements.is_empty()))
}
