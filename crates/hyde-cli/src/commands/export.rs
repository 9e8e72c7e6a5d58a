//! `hyde export`: a model for other tools.

mod c;
mod fmu;
mod modelica;
mod state_space;

use crate::args::{ExportArgs, ExportKind};
use crate::exit::Exit;
use crate::project::Project;

/// Exports a model.
pub(crate) fn export(args: &ExportArgs) -> Exit {
    match &args.kind {
        ExportKind::C(args) => c::export(args),
        ExportKind::Fmu(args) => fmu::fmu(args),
        ExportKind::Modelica(args) => modelica::export(args),
        ExportKind::StateSpace(args) => state_space::export(args),
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
