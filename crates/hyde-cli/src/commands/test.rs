//! `hyde test`: runs the experiments of a file or a package, looks at what they expect, and at whether effects vanish.

use crate::args::{ModelArgs, RunArgs, TestArgs};
use crate::commands::{check, run};
use crate::exit::Exit;
use crate::limits::{self, Neutral};
use crate::project::{self, print_output};
use hyde_present::summary;
use hyde_units::significant;
use serde_json::{Value, json};

/// What was tested, and what came of it.
pub(crate) struct Tested {
    /// The experiment, with the size for the limit test of an effect.
    pub(crate) name: String,
    pub(crate) verdict: Verdict,
    /// What was found, in a few words.
    pub(crate) found: String,
}

/// What came of a test.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verdict {
    Passed,
    Failed,
    /// Nothing was decided.
    Skipped,
}

impl Verdict {
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Passed => "passed",
            Self::Failed => "FAILED",
            Self::Skipped => "skipped",
        }
    }
}

/// Runs every test, prints a table, and ends with the gravest of what was found.
pub(crate) fn test(args: &TestArgs) -> Exit {
    match tested(&args.model) {
        Ok(exit) | Err(exit) => exit,
    }
}

fn tested(args: &ModelArgs) -> Result<Exit, Exit> {
    let mut exit = Exit::Done;
    let (mut all, mut list): (Vec<Tested>, Vec<Value>) = (Vec::new(), Vec::new());
    for file in project::files_of(args)? {
        let quiet = ModelArgs {
            json: false,
            quiet: true,
            ..file
        };
        let mut of_file = Vec::new();
        for one in check::each(&quiet, true)? {
            if one.experiment.is_some() {
                exit = exit.max(experiment(&one, &mut of_file));
            }
        }
        if of_file.is_empty() {
            continue;
        }
        let place = quiet.file.display().to_string();
        list.extend(of_file.iter().map(|test| {
            json!({ "file": place, "test": test.name, "verdict": test.verdict.word().to_lowercase(), "found": test.found })
        }));
        if !args.json && !args.quiet {
            print_output(&table(&place, &of_file));
        }
        all.extend(of_file);
    }
    let count = |verdict| all.iter().filter(|test| test.verdict == verdict).count();
    if args.json {
        print_output(&format!(
            "{:#}",
            json!({ "ok": exit == Exit::Done, "tests": list })
        ));
    } else if !args.quiet {
        let plural = if all.len() == 1 { "" } else { "s" };
        let passed = count(Verdict::Passed);
        let mut line = format!("{} test{plural}: {passed} passed", all.len());
        for (verdict, word) in [(Verdict::Failed, "failed"), (Verdict::Skipped, "skipped")] {
            if count(verdict) > 0 {
                line += &format!(", {} {word}", count(verdict));
            }
        }
        print_output(&line);
    }
    Ok(exit)
}

/// The tests of an experiment: what it expects, then the sizes of the effects on its model.
fn experiment(args: &ModelArgs, tests: &mut Vec<Tested>) -> Exit {
    let name = args.experiment.clone().unwrap_or_default();
    let run_args = run_args(args, None);
    let (_, compiled, run, _) = match run::solved(&run_args) {
        Ok(solved) => solved,
        Err(exit) => {
            tests.push(Tested {
                name,
                verdict: Verdict::Failed,
                found: "could not be run, see above".to_owned(),
            });
            return exit;
        }
    };
    let expected: Vec<_> = run.measures.iter().filter(|m| m.expectation).collect();
    let broken: Vec<String> = run
        .measures
        .iter()
        .filter(|measure| !measure.holds)
        .map(|measure| format!("{}{}", measure.name, summary::why_missing(measure)))
        .collect();
    let before = tests.len();
    tests.push(Tested {
        verdict: match (expected.len(), broken.len()) {
            (0, 0) => Verdict::Skipped,
            (_, 0) => Verdict::Passed,
            _ => Verdict::Failed,
        },
        found: match (expected.len(), broken.as_slice()) {
            (0, []) => "expects nothing".to_owned(),
            (1, []) => "1 expectation holds".to_owned(),
            (count, []) => format!("{count} expectations hold"),
            (_, broken) => format!("does not hold: {}", broken.join("; ")),
        },
        name,
    });
    let mut exit = Exit::Done;
    for size in limits::sizes(&compiled.program, &run, Neutral::LeftOut) {
        match limits::tested(args, &size) {
            Ok(test) => tests.push(test),
            Err(failed) => exit = exit.max(failed),
        }
    }
    let failed = |test: &Tested| test.verdict == Verdict::Failed;
    if tests[before..].iter().any(failed) {
        exit = exit.max(Exit::Expectation);
    }
    exit
}

/// The arguments of a run that prints nothing but errors.
pub(crate) fn run_args(args: &ModelArgs, rtol: Option<f64>) -> RunArgs {
    RunArgs {
        rtol,
        ..RunArgs::of_model(args)
    }
}

/// The tests of a file, one a line.
pub(crate) fn table(place: &str, tests: &[Tested]) -> String {
    let width = tests.iter().map(|test| test.name.chars().count()).max();
    let width = width.unwrap_or(0).max(20);
    let lines: Vec<String> = tests
        .iter()
        .map(|test| {
            format!(
                "  {:<8}{:<width$}  {}",
                test.verdict.word(),
                test.name,
                test.found
            )
        })
        .collect();
    format!("{place}\n{}", lines.join("\n"))
}

/// A part as percent, for people.
pub(crate) fn percent(part: f64) -> String {
    format!("{} %", significant(100.0 * part, 3))
}
