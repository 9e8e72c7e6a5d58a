//! `hyde check`: compiles everything in a file, or in the files of a package, and runs nothing.

mod found;
mod sweeps;

use crate::args::{CheckArgs, ModelArgs};
use crate::exit::Exit;
use crate::files;
use crate::project::{self, Told as _, print_output};
use crate::render;
use found::Found;
use hyde_compiler::Compiled;
use hyde_study::Project;
use serde_json::Value;
use sweeps::sweeps;

/// Checks every experiment of a file (its records included), or its last model if it has none, and its other classes; all files
/// of a folder. One that is wrong does not keep the others from being looked at.
pub(crate) fn check(args: &CheckArgs) -> Exit {
    let folder = files::is_folder(&args.model.file);
    let list = match project::files_of(&args.model) {
        Ok(list) => list,
        Err(exit) => return exit,
    };
    let (mut exit, mut all) = (Exit::Done, Found::default());
    for args in &list {
        match checked(args, folder) {
            Ok(found) => {
                if !args.json && !args.quiet {
                    print_output(&found.text(args));
                }
                all.append(found);
            }
            // One object on standard output: it is about the first file at fault.
            Err(failed) if args.json => return failed,
            Err(failed) => exit = exit.max(failed),
        }
    }
    if args.model.json {
        print_output(&format!("{:#}", all.json()));
    }
    exit
}

/// Checks the experiments of a file, one after the other; what is wrong in any is printed at the end. A file of a folder may
/// have nothing but types and functions.
fn checked(args: &ModelArgs, folder: bool) -> Result<Found, Exit> {
    let mut found = Found::default();
    let (loaded, each) = project::experiments_of(args, folder)?;
    if each.is_empty() && !loaded.file.has_classes() {
        return Ok(found);
    }
    let mut visit = |project: &Project, compiled: &Compiled| found.add(project, compiled);
    let complain = |reason: String| project::complain(args, Exit::CommandLine, &reason);
    let all = hyde_study::check(loaded, &project::asked(args)?, &|| false, &mut visit);
    if let Some(reason) = all.refused.into_iter().next() {
        return Err(complain(reason));
    }
    let Some(project) = all.project else {
        return Ok(found);
    };
    if let Some(exit) = all.faults.into_iter().map(Exit::from).max() {
        project.finish_with_errors(args);
        return Err(exit);
    }
    project.print_warnings(args);
    found.alone = all.alone;
    found.names.extend(sweeps(args, &project)?);
    if let Value::Array(list) = render::to_json(&project.diagnostics, &project.sources) {
        found.warnings = list;
    }
    Ok(found)
}
