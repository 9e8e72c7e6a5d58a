//! `hyde test`: runs the experiments of a file or a package, looks at what they expect, and at whether effects vanish.

use crate::args::{ModelArgs, TestArgs};
use crate::exit::Exit;
use crate::interruption::interrupted;
use crate::project::{self, Loaded, print_output};
use crate::watch::Watch;
use hyde_present::experiment_tests::table;
use hyde_study::experiment_tests::{self, Tested, Verdict};
use hyde_study::runs::How;
use serde_json::{Value, json};
use std::sync::Arc;

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
        let (loaded, experiments) = project::experiments_of(&quiet, true)?;
        let experiments = experiments.iter().filter(|one| one.experiment.is_some());
        for one in experiments {
            exit = exit.max(experiment(&loaded, one, &mut of_file)?);
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

/// The tests of an experiment; what could not be run is printed.
fn experiment(loaded: &Loaded, args: &ModelArgs, tests: &mut Vec<Tested>) -> Result<Exit, Exit> {
    let asked = project::asked(args)?;
    let how = how();
    let _watch = Watch::of_run(args.quiet, &how.reached);
    let found = experiment_tests::experiment(loaded, &asked, &how);
    let mut tested = found.tests.iter();
    let failed = tested.any(|test| test.verdict == Verdict::Failed);
    let mut exit = match failed && found.ran {
        true => Exit::Expectation,
        false => Exit::Done,
    };
    tests.extend(found.tests);
    for own in &found.refused {
        exit = exit.max(project::refused(args, own));
    }
    Ok(exit)
}

/// Runs that Ctrl-C ends.
pub(crate) fn how() -> How {
    How {
        rtol: None,
        atol: None,
        interrupted: interrupted(),
        reached: Arc::default(),
    }
}
