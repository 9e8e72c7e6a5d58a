//! `hyde export`: a model for other tools.

mod c;
mod fmu;
mod modelica;
mod state_space;
mod switches;

use crate::args::{ExportArgs, ExportKind};
use crate::exit::Exit;
use crate::project::Project;
use hyde_program::Program;

/// Exports a model.
pub(crate) fn export(args: &ExportArgs) -> Exit {
    match &args.kind {
        ExportKind::C(args) => c::export(args),
        ExportKind::Fmu(args) => fmu::fmu(args),
        ExportKind::Modelica(args) => modelica::export(args),
        ExportKind::StateSpace(args) => state_space::export(args),
    }
}

/// Refuses the name of an array where those of its elements are asked for.
fn no_arrays(program: &Program, asked: &[String]) -> Result<(), String> {
    let is_array = |name: &&String| {
        let first = format!("{name}[1]");
        program.output(name).is_none() && program.output(&first).is_some()
    };
    match asked.iter().find(is_array) {
        None => Ok(()),
        Some(name) => Err(format!(
            "`--output {name}`: `{name}` is an array: write its elements, `--output {name}[1],{name}[2]`"
        )),
    }
}

/// The default name of what is exported: model and experiment as C writes names.
fn identifier(project: &Project) -> String {
    let mut name = project.model.clone();
    if let Some(experiment) = &project.experiment {
        name = format!("{name}_{experiment}");
    }
    let letter = |c: char| match c.is_ascii_alphanumeric() {
        true => c,
        false => '_',
    };
    name.chars().map(letter).collect()
}
