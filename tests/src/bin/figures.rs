//! `figures [--whole] [--seed S] [NAME…]`: measures the promises of the project and prints a line each. Exit status 1 where one falls
//! short, 2 where there is none of that name. `--whole` plants the whole library first and records what became of it.

use hyde_tests::figures::{FIGURES, Figure, Session};
use std::process::ExitCode;

#[allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command prints"
)]
fn main() -> ExitCode {
    let mut names: Vec<String> = std::env::args().skip(1).collect();
    // Figures of batches, diagnoses, self-tests, cases and editors run this very program as the command.
    if names.first().is_some_and(|name| hyde_cli::has(name)) {
        return hyde_cli::main(std::env::args_os());
    }
    if names.first().is_some_and(|name| name == "--parses") {
        // The command line behind it, and how often it parsed the file that it parsed most often.
        let program = std::env::args_os().take(1);
        let code = hyde_cli::main(program.chain(std::env::args_os().skip(2)));
        let most = hyde_compiler::parses().into_values().max();
        println!("{}", most.unwrap_or(0));
        return code;
    }
    if let [reads, file] = &names[..]
        && reads == "--read-record"
    {
        return match hyde_tests::figures::read_record(file.as_ref()) {
            Ok(said) => {
                println!("{said}");
                ExitCode::SUCCESS
            }
            Err(reason) => {
                eprintln!("{reason}");
                ExitCode::FAILURE
            }
        };
    }
    let mut session = Session::new(hyde_tests::data());
    if let Some(at) = names.iter().position(|name| name == "--seed") {
        let Some(seed) = names.get(at + 1).and_then(|seed| seed.parse().ok()) else {
            eprintln!("`--seed` takes a whole number");
            return ExitCode::from(2);
        };
        session.seed = seed;
        names.drain(at..at + 2);
    }
    if let Some(at) = names.iter().position(|name| name == "--whole") {
        session.whole = true;
        names.remove(at);
    }
    let mut chosen: Vec<&Figure> = Vec::new();
    for name in &names {
        match FIGURES.iter().find(|figure| figure.name == name) {
            Some(figure) => chosen.push(figure),
            None => {
                let known: Vec<&str> = FIGURES.iter().map(|figure| figure.name).collect();
                eprintln!(
                    "no figure is called `{name}`; there are {}",
                    known.join(", ")
                );
                return ExitCode::from(2);
            }
        }
    }
    if names.is_empty() {
        chosen = FIGURES.iter().collect();
    }
    if session.whole {
        match hyde_tests::figures::record(&session) {
            Ok(path) => eprintln!("the self-test in full is in {}", path.display()),
            Err(reason) => {
                eprintln!("{reason}");
                return ExitCode::from(1);
            }
        }
    }
    let mut any_short = false;
    for figure in chosen {
        let (line, short) = figure.line(&(figure.measure)(&session));
        println!("{line}");
        any_short |= short;
    }
    ExitCode::from(u8::from(any_short))
}
