//! `hyde check`: compiles everything in a file, runs nothing.

use crate::args::{CheckArgs, ModelArgs};
use crate::exit::Exit;
use crate::project::{self, Aim, Records, print_output};
use crate::render;
use serde_json::{Value, json};

/// Checks every experiment of a file (its records included), or its last model if it has none.
pub(crate) fn check(args: &CheckArgs) -> Exit {
    match checked(args) {
        Ok((names, warnings)) => {
            if args.model.json {
                print_output(&format!(
                    "{:#}",
                    json!({ "ok": true, "checked": names, "diagnostics": warnings })
                ));
            } else if !args.model.quiet {
                print_output(&format!(
                    "{}: {} in order",
                    args.model.file.display(),
                    names.join(", ")
                ));
            }
            Exit::Done
        }
        Err(exit) => exit,
    }
}

/// What was checked, and the warnings of it as JSON.
fn checked(args: &CheckArgs) -> Result<(Vec<String>, Vec<Value>), Exit> {
    let (mut names, mut warnings) = (Vec::new(), Vec::new());
    for args in each(&args.model)? {
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
fn each(args: &ModelArgs) -> Result<Vec<ModelArgs>, Exit> {
    if args.experiment.is_some() || args.model.is_some() {
        return Ok(vec![args.clone()]);
    }
    let text = crate::files::read_text(&args.file)
        .map_err(|reason| project::complain(args, Exit::CommandLine, &reason))?;
    let mut sources = hyde_diag::Sources::new();
    let mut diagnostics = hyde_diag::Diagnostics::new();
    let file = project::loaded(args, &mut sources, &text, &mut diagnostics);
    let names: Vec<String> = file
        .experiments()
        .map(|experiment| experiment.name.text.clone())
        .collect();
    if names.is_empty() {
        return Ok(vec![args.clone()]);
    }
    Ok(names
        .into_iter()
        .map(|name| ModelArgs {
            experiment: Some(name),
            ..args.clone()
        })
        .collect())
}
