//! `hyde check`: compiles everything in a file, or in the files of a package, and runs nothing.

use crate::args::{CheckArgs, ModelArgs};
use crate::exit::Exit;
use crate::files;
use crate::project::{self, Aim, Records, complain, print_output, report_errors};
use crate::render;
use hyde_diag::{Diagnostics, Sources};
use serde_json::{Value, json};

/// Checks every experiment of a file (its records included), or its last model if it has none; all files of a folder.
pub(crate) fn check(args: &CheckArgs) -> Exit {
    let folder = files::is_folder(&args.model.file);
    let list = match project::files_of(&args.model) {
        Ok(list) => list,
        Err(exit) => return exit,
    };
    let (mut exit, mut all, mut warnings) = (Exit::Done, Vec::new(), Vec::new());
    for args in &list {
        match checked(args, folder) {
            Ok((names, found)) => {
                if !args.json && !args.quiet {
                    let names = if names.is_empty() {
                        "nothing to compile".to_owned()
                    } else {
                        names.join(", ")
                    };
                    print_output(&format!("{}: {names} in order", args.file.display()));
                }
                all.extend(names);
                warnings.extend(found);
            }
            // One object on standard output: it is about the first file at fault.
            Err(failed) if args.json => return failed,
            Err(failed) => exit = exit.max(failed),
        }
    }
    if args.model.json {
        print_output(&format!(
            "{:#}",
            json!({ "ok": true, "checked": all, "diagnostics": warnings })
        ));
    }
    exit
}

/// What was checked, and the warnings of it as JSON. A file of a folder may have nothing but types and functions.
fn checked(args: &ModelArgs, folder: bool) -> Result<(Vec<String>, Vec<Value>), Exit> {
    let (mut names, mut warnings) = (Vec::new(), Vec::new());
    for args in each(args, folder)? {
        let mut project = project::load(&args, Records::IfThere)?;
        let alone = project.experiment.is_none();
        let compiled = project.compile(&args, if alone { Aim::Linearize } else { Aim::Ledger })?;
        project.print_warnings(&args);
        if let Value::Array(list) = render::to_json(&project.diagnostics, &project.sources) {
            warnings.extend(list);
        }
        let what = project.experiment.as_ref().map_or_else(
            || format!("model {}", project.model),
            |experiment| format!("experiment {experiment}"),
        );
        names.push(format!("{what} ({} unknowns)", compiled.program.n_unknowns));
    }
    Ok((names, warnings))
}

/// The arguments for each experiment of the file, if none is named.
pub(crate) fn each(args: &ModelArgs, folder: bool) -> Result<Vec<ModelArgs>, Exit> {
    if args.experiment.is_some() || args.model.is_some() {
        return Ok(vec![args.clone()]);
    }
    let text = files::read_text(&args.file)
        .map_err(|reason| complain(args, Exit::CommandLine, &reason))?;
    let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
    let (file, _) = project::loaded(args, &mut sources, &text, &mut diagnostics);
    let names: Vec<String> = file
        .experiments()
        .map(|experiment| experiment.name.text.clone())
        .collect();
    if names.is_empty() {
        let nothing = folder && file.models().next().is_none();
        if nothing && diagnostics.has_errors() {
            return Err(report_errors(args, &sources, &diagnostics));
        }
        return Ok(if nothing {
            Vec::new()
        } else {
            vec![args.clone()]
        });
    }
    Ok(names
        .into_iter()
        .map(|name| ModelArgs {
            experiment: Some(name),
            ..args.clone()
        })
        .collect())
}
