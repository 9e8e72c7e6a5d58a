//! `hyde export modelica`: the model as one flat class of Modelica.

use super::identifier;
use crate::args::{ModelArgs, ModelicaArgs};
use crate::exit::Exit;
use crate::files;
use crate::project::{self, Aim, Project, Records, Told as _, complain, print_output};
use hyde_experiment::{RunError, extent, parameters};
use hyde_modelica::{Begun, ticks_before_change, written};
use hyde_program::{Constant, Program};
use hyde_units::counted;
use serde_json::json;
use std::path::PathBuf;

/// Writes the class.
pub(crate) fn export(args: &ModelicaArgs) -> Exit {
    match left(args) {
        Ok(text) => {
            if !args.model.quiet {
                print_output(&text);
            }
            Exit::Done
        }
        Err(exit) => exit,
    }
}

fn left(args: &ModelicaArgs) -> Result<String, Exit> {
    let own = &args.model;
    let refused = |reason: String| complain(own, Exit::CommandLine, &reason);
    let mut project = project::load(own, Records::Needed)?;
    project.release(&args.input).map_err(refused)?;
    let compiled = project.compile_or_report(own, Aim::Export)?;
    project.print_warnings(own);
    let name = identifier(&project);
    let begun = begun(own, &mut project, &compiled.program)?;
    let Some(class) = written(&mut project, &name, &begun) else {
        return Err(project.finish_with_errors(own));
    };
    let default = PathBuf::from(format!("{name}.mo"));
    let path = args.out.as_ref().unwrap_or(&default);
    files::write(path, class.text.as_bytes()).map_err(refused)?;
    let (unknowns, automata, clocks) = class.counts;
    let path = path.display().to_string();
    let columns = compiled.program.columns.len();
    if own.json {
        let told = json!({
            "ok": true, "file": path, "class": name, "unknowns": unknowns, "modes_blocks": automata, "clocks": clocks,
        });
        return Ok(format!("{told:#}"));
    }
    let mut text = format!(
        "  {path}\n  class {name}: {}, {}, {}",
        counted(unknowns, "unknown"),
        counted(automata, "modes block"),
        counted(clocks, "clock"),
    );
    if columns > 0 {
        text.push_str("\n  columns of records are inputs of the class");
    }
    for automaton in &compiled.program.automata {
        if let Some(mode) = begun.memory.get(&automaton.place) {
            text.push_str(&format!(
                "\n  `{}` begins in `{}`, to which a run with these values goes at its start",
                automaton.name, automaton.modes[*mode as usize]
            ));
        }
    }
    for input in &compiled.program.experiment.differentiated {
        text.push_str(&format!(
            "\n  the equations need the derivative of `{input}`; it is 0 in the class"
        ));
    }
    Ok(text)
}

/// What events at the start of a run with the values of the class change.
fn begun(own: &ModelArgs, project: &mut Project, program: &Program) -> Result<Begun, Exit> {
    let tables = hyde_study::tables(&project.records);
    let p = parameters(program, &tables, &project.set())
        .map_err(|error| project.report_refused(own, program, &error))?;
    let ((start_s, _), _) = extent(program, &tables, &p);
    let moved = hyde_sim::moved_at_start(program, &tables, &p, start_s);
    let moved = moved
        .map_err(|failure| project.report_refused(own, program, &RunError::Failed(failure)))?;
    Ok(Begun {
        states: moved.states,
        memory: moved.memory,
        earlier: (0..program.clocks.len())
            .map(|clock| {
                let constant = |which| program.kernels.constant(which, &p).unwrap_or(f64::NAN);
                ticks_before_change(
                    constant(Constant::Delay(clock)),
                    constant(Constant::Period(clock)),
                )
            })
            .collect(),
    })
}
