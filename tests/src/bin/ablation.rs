//! `ablation [--cases N] [--seed S] [--bench] [--book] [NAME…]`: sets one threshold of a diagnosis at a time to the value with which it decides
//! nothing, and prints right answers, false alarms and seconds.
//!
//! A NAME is a threshold, `NAME=VALUE`, or several with `+` between; all thresholds if none is given. Rows are added to
//! `tests/ablation.csv` as they are measured; what is there already is not measured again. `--bench` diagnoses the six sets of
//! the bench as well. `--book` only writes the table of the book.

use hyde_tests::ablation::{BEGIN, Change, END, Results, Suite, in_book, measured};
use hyde_tests::root;
use std::process::ExitCode;

#[allow(clippy::print_stderr, reason = "a command prints")]
fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(reason) => {
            eprintln!("{reason}");
            ExitCode::from(2)
        }
    }
}

#[allow(clippy::print_stdout, reason = "a command prints")]
fn run() -> Result<(), String> {
    let mut names: Vec<String> = std::env::args().skip(1).collect();
    let mut results = Results::read()?;
    if taken(&mut names, "--book") {
        return write_book(&results);
    }
    let bench = taken(&mut names, "--bench");
    let count = number(&mut names, "--cases", 8)?;
    let seed = number(&mut names, "--seed", 1)?;
    let mut changes = vec![Change::none()];
    if names.is_empty() {
        changes.extend(hyde_calibrate::TABLE.iter().map(Change::removing));
    }
    for name in &names {
        changes.push(Change::read(name)?);
    }
    let cases = usize::try_from(count).unwrap_or(usize::MAX);
    let mut suites = Vec::new();
    if cases > 0 {
        suites.extend([Suite::Planted(cases, seed), Suite::Clean(cases, seed)]);
    }
    let folder = hyde_tests::data().join("bench");
    if bench && folder.is_dir() {
        suites.extend((0..6).map(|number| Suite::Bench(number, folder.clone())));
    } else if bench {
        println!("absent: {}, the six sets of the bench", folder.display());
    }
    for change in &changes {
        for suite in &suites {
            let name = suite.name();
            if results.of(&change.name, &name).is_none() {
                results.add(measured(change, suite)?)?;
            }
            let row = results.of(&change.name, &name);
            let row = row.ok_or("a row that was measured is lost")?;
            let before = results.of(Change::METHOD, &name);
            let same = before.is_some_and(|own| own.answers == row.answers);
            println!(
                "{} {name}: {} of {} right, {} false alarms, {:.1} s{}",
                row.change,
                row.right,
                row.cases,
                row.false_alarms,
                row.seconds,
                if same { "" } else { ", other answers" }
            );
        }
    }
    Ok(())
}

/// Whether an option is there; it is taken out.
fn taken(names: &mut Vec<String>, option: &str) -> bool {
    let before = names.len();
    names.retain(|name| name != option);
    names.len() < before
}

/// The number of an option, which is taken out.
fn number(names: &mut Vec<String>, option: &str, default: u64) -> Result<u64, String> {
    let Some(at) = names.iter().position(|name| name == option) else {
        return Ok(default);
    };
    let value = names.get(at + 1).and_then(|text| text.parse().ok());
    let value = value.ok_or_else(|| format!("`{option}` takes a whole number"))?;
    names.drain(at..at + 2);
    Ok(value)
}

/// Puts the table between its lines in the book.
#[allow(clippy::disallowed_methods, reason = "a page of the book is made")]
fn write_book(results: &Results) -> Result<(), String> {
    let path = root().join("book/src/how/diagnosis.md");
    let failed = |error: std::io::Error| format!("{}: {error}", path.display());
    let text = std::fs::read_to_string(&path).map_err(failed)?;
    let parts = text.split_once(BEGIN).and_then(|(before, rest)| {
        let (_, after) = rest.split_once(END)?;
        Some((before, after))
    });
    let (before, after) = parts.ok_or("the book has no place for the table")?;
    let table = in_book(results);
    std::fs::write(&path, format!("{before}{BEGIN}\n\n{table}\n{END}{after}")).map_err(failed)
}
