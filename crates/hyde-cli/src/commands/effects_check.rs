//! `hyde effects FILE --check`: the limit test of every size of the effects on the models of a file's experiments (E3).
//!
//! [`hyde_study::experiment_tests`] does it, as for `hyde test`; here the sizes that are 0 are tested too, at a tenth of their range.

use super::test::how;
use crate::args::ModelArgs;
use crate::exit::Exit;
use crate::project::{self, complain, print_output};
use hyde_present::experiment_tests::table;
use hyde_study::experiment_tests::{Neutral, Tested, Verdict, limit, sizes};
use hyde_study::runs::{project_of, solved};
use serde_json::json;
use std::collections::BTreeSet;

/// Runs the tests; the model is at fault where a size does not vanish.
pub(super) fn check(args: &ModelArgs) -> Exit {
    match tested(args) {
        Ok((tests, unused)) => {
            let good = tests.iter().all(|test| test.verdict != Verdict::Failed);
            if args.json {
                let list = tests.iter().map(|test| {
                    json!({ "test": test.name, "verdict": test.verdict.word().to_lowercase(), "found": test.found })
                });
                let list: Vec<_> = list.collect();
                let unused_in = match args.experiment {
                    Some(_) => "not_in_experiment",
                    None => "without_experiment",
                };
                print_output(&format!(
                    "{:#}",
                    json!({ "ok": good, "tests": list, unused_in: unused })
                ));
            } else if !args.quiet {
                print_output(&table(&args.file.display().to_string(), &tests));
                if tests.is_empty() {
                    print_output(
                        "no model of an experiment has an effect: `model New = Old with Effect(…) on site;`",
                    );
                }
                if !unused.is_empty() {
                    let place = match &args.experiment {
                        Some(experiment) => format!("not in {experiment}"),
                        None => "in no experiment".to_owned(),
                    };
                    print_output(&format!("{place}: {}", unused.join(", ")));
                }
            }
            if good { Exit::Done } else { Exit::Model }
        }
        Err(exit) => exit,
    }
}

/// What came of each size of each experiment that is asked for, and the effects of the file that none of them has.
fn tested(args: &ModelArgs) -> Result<(Vec<Tested>, Vec<String>), Exit> {
    let quiet = ModelArgs {
        json: false,
        quiet: true,
        ..args.clone()
    };
    let mut tests = Vec::new();
    let mut known: Vec<String> = Vec::new();
    let mut used: BTreeSet<String> = BTreeSet::new();
    let (loaded, each) = project::experiments_of(&quiet, false)?;
    for one in each {
        if one.experiment.is_none() {
            let reason = "the file has no experiment: an effect is tested on a model that moves";
            return Err(complain(args, Exit::CommandLine, reason));
        }
        let (asked, how) = (project::asked(&one)?, how());
        let refused = |own| project::refused(&one, &own);
        let project = project_of(&loaded, &asked).map_err(refused)?;
        known = project.file.effects().map(str::to_owned).collect();
        let (compiled, run) = solved(project, &how, |_| {}).map_err(refused)?;
        for size in sizes(&compiled.program, &run, Neutral::AtATenth) {
            used.extend(size.path.rsplit('.').nth(1).map(str::to_owned));
            tests.push(limit(&loaded, &asked, &size, &how).map_err(|own| refused(*own))?);
        }
    }
    known.retain(|name| !used.contains(name));
    Ok((tests, known))
}
