//! A calibration on its way to a report: its block, its records, its program in the observed form.

mod files;
mod joint;
mod numbers;
mod vary;

pub use joint::{JointCalibration, JointPart, joint_calibration};
pub use numbers::{Local, Number};

use crate::aim::Aim;
use crate::asked::Asked;
use crate::project::{Loaded, Project};
use crate::refusals::calibrations as refused;
use crate::refused::{Fault, Refused};
use hyde_calibrate::{CalibrationPlan, Observer, Recording, Varied};
use hyde_compiler::Compiled;
use hyde_diag::Diagnostic;
use hyde_program::Constant;
use hyde_syntax::ast::{Experiment, Study, StudyKind};
use hyde_units::engineering_difference;

/// Everything a calibration is made of, of one experiment.
pub struct Calibration {
    /// The file with its model.
    pub project: Project,
    /// The model in the observed form.
    pub compiled: Compiled,
    /// The block.
    pub plan: CalibrationPlan,
    /// The records to fit.
    pub fitted: Vec<Recording>,
    /// The records held out.
    pub holdout: Vec<Recording>,
    /// What is varied.
    pub varied: Vec<Varied>,
    /// Values set from outside: position and value.
    pub set: Vec<(usize, f64)>,
    /// What all models are compared by.
    pub observer: Observer,
}

/// Makes a calibration of one experiment of a file that is loaded: the one named, or the file's only one.
///
/// # Errors
/// There is none of that name, or it is of several experiments; its block, its model or its records are at fault.
pub fn calibration(
    loaded: Loaded,
    asked: &Asked,
    name: Option<&str>,
) -> Result<Calibration, Refused> {
    let mut loaded = loaded;
    if loaded.diagnostics.has_errors() {
        return Err(loaded.refused());
    }
    let Some((plan, experiment)) = single_plan(&mut loaded, name).map_err(Refused::Asked)? else {
        return Err(loaded.refused());
    };
    let mut found = joint::made(loaded, asked, plan, &[experiment])?;
    match found.experiments.pop() {
        Some(only) => Ok(only),
        None => Err(Refused::Asked("the calibration has no records".to_owned())),
    }
}

/// The model of a calibration, before its records are read.
pub(crate) struct Prepared {
    pub(crate) project: Project,
    pub(crate) compiled: Compiled,
    /// Values set from outside: position and value.
    pub(crate) set: Vec<(usize, f64)>,
    /// The parameter vector with them.
    pub(crate) p: Vec<f64>,
}

impl Prepared {
    /// What a calibration of this model alone varies, and what is wrong with that.
    pub(crate) fn varied(&self, plan: &CalibrationPlan) -> (Vec<Varied>, Vec<Diagnostic>) {
        let mut wrong = Vec::new();
        let program = &self.compiled.program;
        let found = vary::varied(plan, program, &self.p, &|_| false, &mut wrong);
        (found.into_iter().map(|(own, _)| own).collect(), wrong)
    }
}

/// Compiles a project in the observed form.
pub(crate) fn prepared(mut project: Project) -> Result<Prepared, Refused> {
    if project.diagnostics.has_errors() {
        return Err(project.refused(Fault::Model));
    }
    let compiled = match project.compile(Aim::Observe) {
        Ok(compiled) => compiled,
        Err(fault) => return Err(project.refused(fault)),
    };
    let program = &compiled.program;
    // What one model of several has not is not set there.
    let set: Vec<(usize, f64)> = project
        .set()
        .iter()
        .filter_map(|(name, value)| {
            let (parameter, element) = program.parameter(name)?;
            (!parameter.structural).then_some((parameter.place + element, *value))
        })
        .collect();
    let mut p = vec![0.0; program.n_parameters];
    program.kernels.parameters(&set, &mut p);
    let channels = program.experiment.measured.iter().enumerate();
    let negative: Vec<Diagnostic> = channels
        .filter_map(|(number, channel)| {
            let noise = program.kernels.constant(Constant::Noise(number), &p);
            let noise = noise.filter(|noise| *noise < 0.0)?;
            let shown = engineering_difference(noise, &channel.unit);
            let span = channel.origin.span;
            Some(refused::negative_noise(&channel.name, &shown, span))
        })
        .collect();
    if !negative.is_empty() {
        let each = negative.into_iter();
        each.for_each(|own| project.diagnostics.push(own));
        return Err(project.refused(Fault::Model));
    }
    Ok(Prepared {
        project,
        compiled,
        set,
        p,
    })
}

/// The block that is meant, and its only experiment; `None` where one of them is at fault, as diagnostics say.
pub(crate) fn single_plan(
    loaded: &mut Loaded,
    name: Option<&str>,
) -> Result<Option<(CalibrationPlan, Experiment)>, String> {
    let Some((plan, experiments)) = plan(loaded, name)? else {
        return Ok(None);
    };
    let per = plan.labels().next().map(|per| per.span);
    let wrong = match (per, experiments.as_slice()) {
        (Some(span), _) => refused::several_values(&plan.name, span),
        (None, [only]) => return Ok(Some((plan, only.clone()))),
        (None, several) => refused::several_experiments(&plan.name, plan.span, several.len()),
    };
    loaded.diagnostics.push(wrong);
    Ok(None)
}

/// The block that is meant, and the experiments of its records; `None` where one of them is at fault, as diagnostics say.
fn plan(
    loaded: &mut Loaded,
    name: Option<&str>,
) -> Result<Option<(CalibrationPlan, Vec<Experiment>)>, String> {
    let Loaded {
        file, diagnostics, ..
    } = loaded;
    let studies = file.studies();
    let studies: Vec<&Study> = studies
        .filter(|study| study.kind == StudyKind::Calibrate)
        .collect();
    let study = chosen(&studies, name, "calibration")?;
    let Some(plan) = CalibrationPlan::read(study, diagnostics) else {
        return Ok(None);
    };
    let mut found: Vec<Experiment> = Vec::new();
    for source in plan.fit.iter().chain(&plan.holdout) {
        let known = file
            .experiments()
            .find(|experiment| experiment.name.text == source.experiment);
        diagnostics.push(match known {
            None => refused::no_experiment(&source.experiment, source.span),
            Some(known) if !plan.models.contains(&known.model.dotted()) => {
                let (model, own) = (known.model.dotted(), (&*source.experiment, source.span));
                let mut experiments = file.experiments();
                let of_experiment = experiments.any(|own| plan.models == [own.name.text.clone()]);
                refused::experiment_of_another_model(
                    own,
                    &model,
                    &plan.name,
                    &plan.models,
                    of_experiment,
                )
            }
            Some(known) => {
                if !found.iter().any(|own| own.name.text == known.name.text) {
                    found.push(known.clone());
                }
                continue;
            }
        });
    }
    for (number, model) in plan.models.iter().enumerate() {
        if plan.models[..number].contains(model) {
            diagnostics.push(refused::model_twice(model, plan.span));
        } else if !found.is_empty() && found.iter().all(|own| own.model.dotted() != *model) {
            diagnostics.push(refused::model_without_record(model, plan.span));
        }
    }
    Ok((!diagnostics.has_errors() && !found.is_empty()).then_some((plan, found)))
}

/// The study meant: the one named, or the only one.
pub fn chosen<'s>(
    studies: &[&'s Study],
    name: Option<&str>,
    what: &str,
) -> Result<&'s Study, String> {
    let known: Vec<String> = studies
        .iter()
        .map(|study| format!("`{}`", study.name.text))
        .collect();
    let listed = known.join(", ");
    match (name, studies) {
        (_, []) => Err(format!("the file has no {what}: {}", declaration(what))),
        (Some(name), _) => studies
            .iter()
            .copied()
            .find(|study| study.name.text == name)
            .ok_or_else(|| format!("the file has no {what} `{name}`; it has {listed}")),
        (None, [only]) => Ok(only),
        (None, _) => Err(format!(
            "the file has several {}: name one behind the file, {listed}",
            if what == "diagnosis" {
                "diagnoses"
            } else {
                "calibrations"
            }
        )),
    }
}

/// How a study of a kind is declared.
fn declaration(what: &str) -> &'static str {
    match what {
        "diagnosis" => {
            "declare one, `diagnose found of calibrate fitted candidates Effects.*; end found;`"
        }
        _ => {
            "declare one, `calibrate fitted of Axis fit bench(\"*.csv\"); vary uncertain; end fitted;`"
        }
    }
}
