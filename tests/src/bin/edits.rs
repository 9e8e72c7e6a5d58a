//! `edits [FROM TO]`: sequences of random edits in the language server, those of these numbers; prints what it answers wrongly.

use hyde_tests::edits::edit;
use std::process::ExitCode;

/// Sequences between two lines of progress.
const LINE: u64 = 5_000;

#[allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command prints"
)]
fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize, default: u64| {
        let word = words.get(at);
        word.and_then(|word| word.parse().ok()).unwrap_or(default)
    };
    let (from, to) = (number(0, 0), number(1, 1_000));
    let (mut edits, mut requests, mut findings) = (0, 0, 0);
    let mut start = from;
    while start < to {
        let end = (start + LINE).min(to);
        let found = match edit(start..end) {
            Ok(found) => found,
            Err(reason) => {
                eprintln!("{start}..{end}: {reason}");
                return ExitCode::FAILURE;
            }
        };
        for finding in &found.findings {
            println!("{finding}\n");
        }
        edits += found.edits;
        requests += found.requests;
        findings += found.findings.len();
        println!(
            "{} sequences, {edits} edits, {requests} requests: {findings} findings",
            end - from
        );
        start = end;
    }
    ExitCode::from(u8::from(findings > 0))
}
