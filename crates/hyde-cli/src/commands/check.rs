//! `hyde check`: compiles everything in a file, or in the files of a package, and runs nothing.

use super::sweep::prepared;
use crate::args::{CheckArgs, ModelArgs};
use crate::exit::Exit;
use crate::files;
use crate::project::{self, Loaded, Project, Records, Told as _, print_output};
use crate::render;
use hyde_compiler::{Compiled, States};
use hyde_diag::Origin;
use hyde_present::assumptions;
use hyde_present::lines::wrapped;
use hyde_program::Program;
use hyde_study::Inputs;
use hyde_study::sweep::Order;
use hyde_syntax::ast::StudyKind;
use hyde_units::counted;
use serde_json::{Value, json};
use std::sync::Arc;

/// Checks every experiment of a file (its records included), or its last model if it has none; all files of a folder. One
/// that is wrong does not keep the others from being looked at.
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
                all.names.extend(found.names);
                all.choices.extend(found.choices);
                all.states.extend(found.states);
                all.warnings.extend(found.warnings);
                all.notes.extend(found.notes);
            }
            // One object on standard output: it is about the first file at fault.
            Err(failed) if args.json => return failed,
            Err(failed) => exit = exit.max(failed),
        }
    }
    if args.model.json {
        print_output(&format!(
            "{:#}",
            json!({ "ok": true, "checked": all.names, "states": all.states, "diagnostics": all.warnings, "notes": all.notes })
        ));
    }
    exit
}

/// What was in order.
#[derive(Default)]
struct Found {
    names: Vec<String>,
    /// Lines on the states of each model.
    choices: Vec<String>,
    /// The states of each model as JSON.
    states: Vec<Value>,
    /// Warnings as JSON.
    warnings: Vec<Value>,
    /// What was taken for granted of records and tables.
    notes: Vec<String>,
}

impl Found {
    /// Notes what is taken for granted of the records of an experiment, once for all experiments that read them.
    fn note(&mut self, project: &Project, program: &Program) {
        let tables = hyde_study::tables(&project.records);
        let parameters = hyde_experiment::parameters(program, &tables, &project.set());
        for note in parameters.map_or_else(
            |_| Vec::new(),
            |parameters| hyde_study::assumptions::of_model(project, program, &parameters),
        ) {
            if !self.notes.contains(&note) {
                self.notes.push(note);
            }
        }
    }

    fn text(&self, args: &ModelArgs) -> String {
        let names = match self.names.as_slice() {
            [] => "nothing to compile".to_owned(),
            names => names.join(", "),
        };
        let mut lines = vec![format!("{}: {names} in order", args.file.display())];
        lines.extend(self.choices.iter().cloned());
        let notes = assumptions::text(&self.notes);
        lines.extend(notes.lines().map(str::to_owned));
        lines.join("\n")
    }
}

/// Checks the experiments of a file, one after the other; what is wrong in any is printed at the end. A file of a folder may
/// have nothing but types and functions.
fn checked(args: &ModelArgs, folder: bool) -> Result<Found, Exit> {
    let mut found = Found::default();
    let (loaded, each) = each(args, folder)?;
    if each.is_empty() {
        return Ok(found);
    }
    let mut models: Vec<String> = Vec::new();
    let mut visit = |project: &Project, compiled: &Compiled| {
        let what = project.experiment.as_ref().map_or_else(
            || format!("model {}", project.model),
            |experiment| format!("experiment {experiment}"),
        );
        found.note(project, &compiled.program);
        let unknowns = counted(compiled.program.n_unknowns, "unknown");
        found.names.push(format!("{what} ({unknowns})"));
        if !models.contains(&project.model) {
            let states = &compiled.states;
            let choices = choices(&project.model, states, project);
            found.choices.extend(choices);
            let json = states_json(&project.model, states, project);
            found.states.push(json);
            models.push(project.model.clone());
        }
    };
    let complain = |reason: String| project::complain(args, Exit::CommandLine, &reason);
    let all = hyde_study::check(loaded, &project::asked(args)?, &|| false, &mut visit).map_err(complain)?;
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
    found.names.extend(sweeps(args, &project)?);
    if let Value::Array(list) = render::to_json(&project.diagnostics, &project.sources) {
        found.warnings = list;
    }
    Ok(found)
}

/// The sweeps of a file, each laid out.
fn sweeps(args: &ModelArgs, project: &Project) -> Result<Vec<String>, Exit> {
    let mut names = Vec::new();
    for study in project
        .file
        .studies()
        .filter(|study| study.kind == StudyKind::Sweep)
    {
        let order = Order {
            file: args.file.clone(),
            sweep: study.name.text.clone(),
            settings: args.settings.clone(),
            records: args.records.clone(),
            data: args.data.clone(),
            seed: None,
            keep: Vec::new(),
        };
        let inputs = Arc::new(Inputs::recording());
        if let Some(batch) = prepared(&order, &inputs, Records::IfThere, (args.json, true))? {
            let cases = counted(batch.plan.count(), "case");
            names.push(format!("sweep {} ({cases})", order.sweep));
        }
    }
    Ok(names)
}

/// Lines on states where the equations left a choice, or a start value is no condition of the model.
fn choices(model: &str, states: &States, project: &Project) -> Vec<String> {
    let place = |origin: &Origin| project.sources.place(origin.span);
    let mut lines = Vec::new();
    for choice in &states.chosen {
        let places: Vec<String> = choice.constraints.iter().map(place).collect();
        lines.push(format!(
            "  {model}: {} of {} is chosen as a state during the run, constrained at {}",
            choice.states,
            choice.candidates.join(", "),
            places.join(", ")
        ));
    }
    for (name, origin) in &states.dependent {
        lines.push(format!(
            "  {model}: {name} is not a state; it is determined at {}",
            place(origin)
        ));
    }
    if !states.filled.is_empty() {
        let list = states.filled.join(", ");
        let equations = match states.equations {
            0 => " alone".to_owned(),
            1 => " or the initial equation".to_owned(),
            count => format!(" or one of {count} initial equations"),
        };
        lines.push(format!(
            "  {model}: initial value from `start`{equations}: {list}"
        ));
    }
    // Eighty columns: what does not fit goes on below, deeper in.
    let wrapped = lines.iter().flat_map(|line| {
        let parts = wrapped(line.trim_start(), 74).into_iter().enumerate();
        parts.map(|(number, part)| match number {
            0 => format!("  {part}"),
            _ => format!("      {part}"),
        })
    });
    wrapped.collect()
}

fn states_json(model: &str, states: &States, project: &Project) -> Value {
    let place = |origin: &Origin| project.sources.place(origin.span);
    let chosen: Vec<Value> = states
        .chosen
        .iter()
        .map(|choice| {
            let places: Vec<String> = choice.constraints.iter().map(place).collect();
            json!({ "states": choice.states, "of": choice.candidates, "constraints": places })
        })
        .collect();
    let dependent: Vec<Value> = states
        .dependent
        .iter()
        .map(|(name, origin)| json!({ "name": name, "constraint": place(origin) }))
        .collect();
    json!({
        "model": model, "states": states.states, "chosen": chosen, "dependent": dependent,
        "start_only": states.filled,
    })
}

/// The file, parsed once, and the arguments for each of its experiments, if none is named; no arguments where a file of a folder
/// has nothing to compile.
pub(crate) fn each(args: &ModelArgs, folder: bool) -> Result<(Loaded, Vec<ModelArgs>), Exit> {
    let loaded = project::parsed(args)?;
    if args.experiment.is_some() || args.model.is_some() {
        return Ok((loaded, vec![args.clone()]));
    }
    let named = |name: &str| ModelArgs {
        experiment: Some(name.to_owned()),
        ..args.clone()
    };
    let experiments = loaded.file.experiments();
    let mut each: Vec<ModelArgs> = experiments.map(|own| named(&own.name.text)).collect();
    let nothing = folder && loaded.file.models().next().is_none();
    if each.is_empty() && nothing && loaded.diagnostics.has_errors() {
        return Err(project::refused(args, &loaded.refused()));
    }
    if each.is_empty() && !nothing {
        each.push(args.clone());
    }
    Ok((loaded, each))
}
