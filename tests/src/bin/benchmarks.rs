//! `benchmarks [NAME…]`: public benchmarks in their own units, beside published figures. Exit status 1 where a fit or a run fails,
//! 2 where there is none of that name; absent records are told and are no failure.

use hyde_tests::benchmarks::{BENCHMARKS, Benchmark, Reason, Row, words};
use std::process::ExitCode;

#[allow(
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a command prints"
)]
fn main() -> ExitCode {
    let names: Vec<String> = std::env::args().skip(1).collect();
    // A benchmark runs this very program as the command.
    if names.first().is_some_and(|name| hyde_cli::has(name)) {
        return hyde_cli::main(std::env::args_os());
    }
    let known: Vec<&str> = BENCHMARKS.iter().map(|benchmark| benchmark.name).collect();
    if let Some(name) = names.iter().find(|name| !known.contains(&name.as_str())) {
        eprintln!(
            "no benchmark is called `{name}`; there are {}",
            known.join(", ")
        );
        return ExitCode::from(2);
    }
    let chosen = |benchmark: &&Benchmark| {
        names.is_empty() || names.iter().any(|name| name == benchmark.name)
    };
    let mut status = ExitCode::SUCCESS;
    for benchmark in BENCHMARKS.iter().filter(chosen) {
        let folder = hyde_tests::data().join(benchmark.name);
        let program = std::env::current_exe().map_err(|error| error.to_string());
        match program.and_then(|program| (benchmark.measure)(&program, &folder)) {
            Ok(rows) => {
                println!("{}", words(benchmark, &rows, &folder));
                let failed = |row: &Row| matches!(row.value, Err(Reason::Failed(_)));
                if rows.iter().any(failed) {
                    status = ExitCode::FAILURE;
                }
            }
            Err(reason) => {
                eprintln!("{}: {reason}", benchmark.name);
                status = ExitCode::FAILURE;
            }
        }
    }
    status
}
