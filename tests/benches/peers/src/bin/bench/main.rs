//! Runs Hyde beside its peers on the same problems, in one batch, and prints ratios, errors and what was promised.

mod command;
mod curves;
mod error;
mod measure;
mod outcome;
mod problem;
mod promise;
mod table;
mod whole;

use clap::Parser;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Runs Hyde beside C programs with IDA and beside diffsol on the same problems, and draws work-precision curves.
#[derive(Parser)]
struct Arguments {
    /// Also the shaft of 100 000 cells, and Hyde alone: the Y axis, the bench axis.
    #[arg(long)]
    all: bool,
    /// Print the names of the problems and nothing else.
    #[arg(long)]
    list: bool,
    /// The problems, `alone` for Hyde alone; `P1` stands for all whose names begin with `P1_`. All if none is given.
    names: Vec<String>,
    /// The command that is measured.
    #[arg(long, default_value = "target/release/hyde")]
    hyde: PathBuf,
    /// Folder for curves, runs and references.
    #[arg(long, default_value = "target/bench")]
    out: PathBuf,
}

/// Stands for what is measured of Hyde without a peer.
const ALONE: &str = "alone";

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> Result<(), String> {
    let all = problem::problems();
    let known = |word: &String| word == ALONE || all.iter().any(|one| stands_for(word, one.name));
    if let Some(word) = arguments.names.iter().find(|word| !known(word)) {
        return Err(format!(
            "no problem is called `{word}`: `./dev bench --list` prints the names"
        ));
    }
    let chosen: Vec<problem::Problem> = all
        .into_iter()
        .filter(|problem| chosen(arguments, problem.name, problem.long))
        .collect();
    if arguments.list {
        for problem in &chosen {
            println!("{:<16}{}", problem.name, problem.about);
        }
        println!("{ALONE:<16}Hyde alone: start, Y axis, calibration, diagnosis");
        return Ok(());
    }
    let tools = command::Tools {
        hyde: absolute(&arguments.hyde)?,
        reference: PathBuf::from(env!("REFERENCE")),
        diffsol: sibling("diffsol")?,
        models: absolute(Path::new("tests/benches/models"))?,
        out: arguments.out.clone(),
    };
    std::fs::create_dir_all(&tools.out)
        .map_err(|error| format!("{}: {error}", tools.out.display()))?;
    let mut rows = Vec::new();
    if !chosen.is_empty() {
        table::print_head();
    }
    for problem in &chosen {
        let row = measure::row(problem, &tools)?;
        table::print_row(&row);
        rows.push(row);
    }
    if !rows.is_empty() {
        table::print_legend();
        promise::print(&rows);
    }
    let drawn: Vec<&problem::Problem> = chosen.iter().filter(|problem| problem.curve).collect();
    if !drawn.is_empty() {
        println!(
            "\nwork-precision curves: {}",
            curves::draw(&drawn, &tools)?.display()
        );
    }
    let alone = arguments.names.iter().any(|name| name == ALONE);
    if alone || arguments.all && arguments.names.is_empty() {
        whole::print(&tools)?;
    }
    Ok(())
}

fn chosen(arguments: &Arguments, name: &str, long: bool) -> bool {
    if arguments.names.is_empty() {
        return arguments.all || arguments.list || !long;
    }
    arguments.names.iter().any(|part| stands_for(part, name))
}

/// Whether a word of the command line is a name, or the beginning of one before `_`.
fn stands_for(word: &str, name: &str) -> bool {
    let rest = name.strip_prefix(word);
    rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('_'))
}

fn absolute(path: &Path) -> Result<PathBuf, String> {
    std::fs::canonicalize(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// A program that was built together with this one.
fn sibling(name: &str) -> Result<PathBuf, String> {
    let this = std::env::current_exe().map_err(|error| error.to_string())?;
    absolute(&this.with_file_name(name))
}
