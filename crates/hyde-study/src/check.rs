//! A full check: every experiment of a file compiled with what its budget asks for, or its last model, its other classes each
//! looked at by itself, and its calibrations and diagnoses read. Sweeps are not planned.

use crate::aim::Aim;
use crate::asked::Asked;
use crate::project::{Loaded, Project};
use crate::records::Records;
use crate::refused::Fault;
use hyde_calibrate::CalibrationPlan;
use hyde_compiler::{Alone, Compiled, DiagnosisPlan, alone, ideals};
use hyde_syntax::ast::StudyKind;

/// What a check found.
pub struct Checked {
    /// The last thing that was compiled, with what is wrong in any of them; nothing where there is nothing to compile.
    pub project: Option<Project>,
    /// What was at fault, in the order found.
    pub faults: Vec<Fault>,
    /// What could not be checked at all: a record that cannot be read.
    pub refused: Vec<String>,
    /// The classes that were looked at by themselves, where the whole file is checked and all else is in order.
    pub alone: Alone,
}

/// Checks the experiment or the model that is asked for of a file that is parsed, else all experiments of the file, else its
/// last model, and then its other classes. One that is wrong does not keep the others from being looked at. `visit` sees what compiled; `stop` is asked between stages, and true
/// ends the check early with what was found so far.
pub fn check(
    mut loaded: Loaded,
    asked: &Asked,
    stop: &dyn Fn() -> bool,
    visit: &mut dyn FnMut(&Project, &Compiled),
) -> Checked {
    let mut found = Checked {
        project: None,
        faults: Vec::new(),
        refused: Vec::new(),
        alone: Alone::default(),
    };
    // A diagnosis names effects of packages that its model need not use.
    let studies = |kind| loaded.file.studies().any(|study| study.kind == kind);
    if studies(StudyKind::Diagnose) {
        loaded.file.add_library(&mut loaded.sources);
    }
    let mut chosen: Vec<Option<String>> = match (&asked.experiment, &asked.model) {
        (None, None) => {
            let all = loaded.file.experiments();
            all.map(|own| Some(own.name.text.clone())).collect()
        }
        (experiment, _) => vec![experiment.clone()],
    };
    let whole = asked.experiment.is_none() && asked.model.is_none();
    match (chosen.is_empty(), loaded.file.models().next()) {
        (false, _) => {}
        (true, None) if whole => found.project = Some(loaded.clone().without_model(asked)),
        (true, _) => chosen.push(None),
    }
    let mut models = Vec::new();
    for experiment in chosen {
        if stop() {
            return found;
        }
        let asked = Asked {
            experiment,
            ..asked.clone()
        };
        let mut project = match loaded.clone().choose(&asked, Records::IfThere) {
            Ok(project) => project,
            Err(reason) => {
                found.refused.push(reason);
                continue;
            }
        };
        models.push(project.model.clone());
        match compiled(&mut project, stop) {
            Ok(compiled) => visit(&project, &compiled),
            Err(fault) => found.faults.push(fault),
        }
        // The files are the same, so places are: what is wrong with a model is said once.
        if let Some(before) = found.project {
            let own = std::mem::replace(&mut project.diagnostics, before.diagnostics);
            own.iter()
                .for_each(|own| project.diagnostics.push(own.clone()));
        }
        found.project = Some(project);
    }
    if let Some(project) = &mut found.project
        && whole
        && found.refused.is_empty()
    {
        let (sources, diagnostics) = (&project.sources, &mut project.diagnostics);
        found.alone = alone(sources, &project.file, &models, stop, diagnostics);
        if project.diagnostics.has_errors() && found.faults.is_empty() {
            found.faults.push(Fault::Model);
        }
    }
    if let Some(project) = &mut found.project
        && !studies_in_order(project)
    {
        found.faults.push(Fault::Model);
    }
    found
}

/// Compiles a project, and its model as each part of the experiment's budget makes it.
fn compiled(project: &mut Project, stop: &dyn Fn() -> bool) -> Result<Compiled, Fault> {
    if project.diagnostics.has_errors() {
        return Err(Fault::Model);
    }
    let aim = match project.experiment {
        None => Aim::Look,
        Some(_) => Aim::Ledger,
    };
    let compiled = project.compile_unless(aim, stop)?;
    let Some(name) = project.experiment.clone() else {
        return Ok(compiled);
    };
    let own = project.file.clone();
    let asked = own.experiments().filter(|known| known.name.text == name);
    let mut result = Ok(compiled);
    for ideal in asked.flat_map(ideals) {
        project.file = own.idealised(&name, |other| other.name.text == ideal.name.text);
        if let Err(fault) = project.compile_unless(aim, stop) {
            result = Err(fault);
            break;
        }
    }
    project.file = own;
    result
}

/// Whether the calibrations and diagnoses of a file are in order; what is wrong in them is reported.
fn studies_in_order(project: &mut Project) -> bool {
    let mut in_order = true;
    for study in project.file.studies() {
        let diagnostics = &mut project.diagnostics;
        in_order &= match study.kind {
            StudyKind::Calibrate => CalibrationPlan::read(study, diagnostics).is_some(),
            StudyKind::Diagnose => {
                DiagnosisPlan::read(&project.file, &study.name.text, diagnostics).is_some()
            }
            StudyKind::Sweep => true,
        };
    }
    in_order
}
