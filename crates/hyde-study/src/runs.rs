//! [`solved`]: the run of an experiment, as studies of several runs need it.

use crate::{Aim, Asked, Fault, Loaded, Project, Records, Refused, run_failure};
use hyde_compiler::Compiled;
use hyde_experiment::{Options, Run};
use hyde_sim::Reached;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// How runs are done.
#[derive(Clone, Default)]
pub struct How {
    /// Relative tolerance, instead of that of the experiment.
    pub rtol: Option<f64>,
    /// Absolute tolerance, likewise.
    pub atol: Option<f64>,
    /// Set by whoever wants them to end early.
    pub interrupted: Arc<AtomicBool>,
    /// How far the present run is.
    pub reached: Arc<Reached>,
}

/// The experiment of a file that is parsed.
///
/// # Errors
/// There is none, or the file or its records are at fault.
pub fn project_of(loaded: &Loaded, asked: &Asked) -> Result<Project, Refused> {
    let project = loaded.clone().choose(asked, Records::Needed);
    let project = project.map_err(Refused::Asked)?;
    match project.diagnostics.has_errors() {
        true => Err(project.refused(Fault::Model)),
        false => Ok(project),
    }
}

/// Compiles an experiment and runs it. `ready` gets it before it is run.
///
/// # Errors
/// The model is at fault, or it cannot be run.
pub fn solved(
    mut project: Project,
    how: &How,
    ready: impl FnOnce(&Project),
) -> Result<(Compiled, Run), Refused> {
    let compiled = match project.compile(Aim::Run) {
        Ok(compiled) => compiled,
        Err(fault) => return Err(project.refused(fault)),
    };
    ready(&project);
    let options = Options {
        set: project.set(),
        rtol: how.rtol,
        atol: how.atol,
        interrupted: how.interrupted.clone(),
        reached: how.reached.clone(),
        ..Options::default()
    };
    let tables = crate::tables(&project.records);
    match hyde_experiment::run(&compiled.program, &tables, &options) {
        Ok(run) => Ok((compiled, run)),
        Err(error) => {
            let (diagnostic, fault) = {
                let mut all = project.file.experiments();
                let name = project.experiment.as_deref();
                let experiment = all.find(|known| name == Some(known.name.text.as_str()));
                run_failure::diagnostic(&error, &compiled.program, experiment)
            };
            if fault == Fault::Interrupted {
                return Err(Refused::Because(diagnostic.message, fault));
            }
            project.diagnostics.push(diagnostic);
            Err(project.refused(fault))
        }
    }
}
