//! `hyde budget`: which imperfection of a model contributes how much to the measures of an experiment.

use super::test::how;
use crate::args::BudgetArgs;
use crate::exit::Exit;
use crate::files;
use crate::project::{self, Project, Told as _, complain, print_error, print_output};
use crate::watch::Watch;
use hyde_present::budget::{csv, json, text};
use hyde_study::budget::{Budget, budget as made};
use std::sync::Arc;

/// Runs the experiment as it is, with all ideal, without each imperfection and with it alone, and prints what every measure is made of.
pub(crate) fn budget(args: &BudgetArgs) -> Exit {
    match told(args) {
        Ok(()) => Exit::Done,
        Err(exit) => exit,
    }
}

fn told(args: &BudgetArgs) -> Result<(), Exit> {
    let model = &args.model;
    let (asked, loaded) = (project::asked(model)?, project::parsed(model)?);
    let how = how();
    let reached = Arc::clone(&how.reached);
    let watch = Watch::new(model.quiet, move || match reached.get() {
        (done, all) if all > 0.0 => format!("{done} of {all} runs"),
        _ => "running the model as it is".to_owned(),
    });
    let ready = |project: &Project| project.print_warnings(model);
    let found = made(&loaded, &asked, &how, ready);
    drop(watch);
    let found = found.map_err(|no| {
        let exit = project::refused(model, &no.refused);
        if let Some(of) = no.of {
            print_error(&format!("so it is {of}"));
        }
        exit
    })?;
    leave(args, &found)
}

/// Prints the budget, and leaves its file where a folder is asked for.
fn leave(args: &BudgetArgs, made: &Budget) -> Result<(), Exit> {
    if let Some(folder) = &args.out {
        let written = files::make_folder(folder)
            .and_then(|()| files::write(&folder.join("budget.csv"), csv(made).as_bytes()));
        written.map_err(|reason| complain(&args.model, Exit::CommandLine, &reason))?;
    }
    if args.model.json {
        print_output(&format!("{:#}", json(made)));
    } else if !args.model.quiet {
        print_output(&text(made));
    }
    Ok(())
}
