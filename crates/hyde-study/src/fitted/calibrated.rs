//! [`calibrated`]: what the records determine, the fit, and how good it is.

use super::experiment;
use crate::comparison::{self, RecordErrors};
use crate::{Calibration, JointCalibration, Number, unobservable};
use hyde_calibrate::{Fit, Identifiability, Joint, Model, Profile, Unsupported};
use hyde_diag::Diagnostic;
use hyde_program::Program;
use hyde_sim::Reached;

/// What was found.
pub struct Calibrated {
    /// What the records determine.
    pub before: Identifiability,
    /// The fit.
    pub fit: Fit,
    /// The profiles that were asked for.
    pub profiles: Vec<Profile>,
    /// Errors of each experiment, in the order of its records.
    pub errors: Vec<Vec<RecordErrors>>,
}

/// A start that is taken from a record is looked for again at most so often.
const ROUNDS: usize = 6;
/// A fit has come to its end when a new start moves no parameter by more than this part of its standard deviation.
const STILL: f64 = 0.01;

/// Calibrates; `profiled` are the numbers whose profiles are asked for. `told` gets what the records determine before the fit
/// begins; `reached` says how far the fit is. Where a record begins elsewhere than the model, its start follows the parameters.
///
/// # Errors
/// Nothing is learned, or an observer cannot run a model: a diagnostic of the file.
pub fn calibrated(
    calibration: &mut JointCalibration,
    profiled: &[usize],
    reached: &Reached,
    told: impl FnOnce(&JointCalibration, &Identifiability),
) -> Result<Calibrated, Box<Diagnostic>> {
    let span = calibration.plan.span;
    let unsupported = |error: Unsupported| Box::new(unobservable::unsupported(&error, span));
    let joint = calibration.joint(Some(reached));
    let nominal: Vec<f64> = calibration.varied.iter().map(|own| own.nominal).collect();
    let before = joint.identifiability(&nominal).map_err(unsupported)?;
    told(calibration, &before);
    let fit = hyde_calibrate::fit(&joint, calibration.plan.starts).map_err(unsupported)?;
    let fit = begun_anew(calibration, fit, reached).map_err(unsupported)?;
    let calibration = &*calibration;
    let joint = calibration.joint(Some(reached));
    if !fit.learned() {
        let names = calibration.numbers.iter().map(Number::name);
        let names: Vec<String> = names.collect();
        let causes = fit.causes.iter();
        let causes: Vec<_> = causes
            .map(|(part, cause)| (experiment(calibration, *part), cause))
            .collect();
        let nothing = unobservable::unlearned(&calibration.plan, &names, &causes);
        return Err(Box::new(nothing));
    }
    let profiles = profiles(&joint, &fit, profiled).map_err(unsupported)?;
    let errors = errors(calibration, &fit).map_err(unsupported)?;
    Ok(Calibrated {
        before,
        fit,
        profiles,
        errors,
    })
}

/// The fit with the starts of the records as its own parameters have them: a start that is found with wrong parameters pulls
/// the next ones towards these.
fn begun_anew(
    calibration: &mut JointCalibration,
    first: Fit,
    reached: &Reached,
) -> Result<Fit, Unsupported> {
    let mut found = first;
    for _ in 0..ROUNDS {
        if !found.learned() || !calibration.begin(&found.solution.values) {
            break;
        }
        let joint = calibration.joint(Some(reached));
        let next = hyde_calibrate::fit(&joint, calibration.plan.starts)?;
        let mut pairs = next.parameters.iter().zip(&found.parameters);
        let still = pairs.all(|(new, old)| (new.value - old.value).abs() <= STILL * new.deviation);
        found = next;
        if still {
            break;
        }
    }
    Ok(found)
}

/// The numbers whose profiles are asked for by name: of a parameter with a value each, all of them.
///
/// # Errors
/// The calibration varies no such parameter.
pub fn profiled(names: &[String], calibration: &JointCalibration) -> Result<Vec<usize>, String> {
    let mut found = Vec::new();
    for name in names {
        let numbers = calibration.numbers.iter().enumerate();
        let own = numbers.filter(|(_, own)| own.varied.name == *name || own.name() == *name);
        let own: Vec<usize> = own.map(|(number, _)| number).collect();
        if own.is_empty() {
            let mut known: Vec<String> = Vec::new();
            for number in &calibration.numbers {
                let shown = format!("`{}`", number.varied.name);
                if !known.contains(&shown) {
                    known.push(shown);
                }
            }
            return Err(format!(
                "`--profile {name}`: the calibration does not vary `{name}`; it varies {}",
                known.join(", ")
            ));
        }
        found.extend(
            own.into_iter()
                .filter(|number| !found.contains(number))
                .collect::<Vec<_>>(),
        );
    }
    Ok(found)
}

fn profiles(joint: &Joint<'_>, fit: &Fit, asked: &[usize]) -> Result<Vec<Profile>, Unsupported> {
    let each = asked.iter();
    each.map(|&number| joint.profile(fit, number)).collect()
}

/// The errors with the declared values and with the calibrated ones, experiment by experiment, in the order of the records.
fn errors(
    calibration: &JointCalibration,
    found: &Fit,
) -> Result<Vec<Vec<RecordErrors>>, Unsupported> {
    let mut all = Vec::new();
    for (number, own) in calibration.experiments.iter().enumerate() {
        let declared = own.project.set();
        let closed = |set: &[(String, f64)]| comparison::closed(&own.project, &[], &[], &[], set);
        let old = closed(&declared);
        let (mut fitted, mut holdout) = (Vec::new(), Vec::new());
        let parts = calibration.parts.iter().enumerate();
        for (index, part) in parts.filter(|(_, part)| part.experiment == number) {
            let values = calibration.settings(index, &found.solution.values);
            // A time that is delayed by shapes the equations of the closed loop: it is compiled anew.
            let shapes = |program: &Program| {
                let mut known = values
                    .iter()
                    .filter_map(|(name, _)| program.parameter(name));
                known.any(|(parameter, _)| parameter.structural)
            };
            let anew = old.as_ref().is_some_and(|(program, _)| shapes(program));
            let set = [declared.clone(), values.clone()].concat();
            let shaped = if anew { closed(&set) } else { None };
            let new = if anew { &shaped } else { &old };
            let models = models(own, &declared, &set, old.as_ref(), new.as_ref());
            let lists = [
                (&own.fitted[part.fitted.clone()], &mut fitted, false),
                (&own.holdout[part.holdout.clone()], &mut holdout, true),
            ];
            for (recordings, list, held_out) in lists {
                let (before, after) = models;
                list.extend(comparison::errors_on(
                    recordings,
                    held_out,
                    &own.observer,
                    Some(before),
                    after,
                )?);
            }
        }
        fitted.extend(holdout);
        all.push(fitted);
    }
    Ok(all)
}

/// A program with its loop closed, and the same with quantisers shifted.
type Closed<'a> = Option<&'a (Program, Program)>;

/// The models before and after.
fn models<'a>(
    own: &'a Calibration,
    declared: &'a [(String, f64)],
    calibrated: &'a [(String, f64)],
    old: Closed<'a>,
    new: Closed<'a>,
) -> (Model<'a>, Model<'a>) {
    let observed = &own.compiled.program;
    let before = Model {
        observed,
        closed: old.map(|(own, _)| own),
        shifted: None,
        set: declared,
    };
    let after = Model {
        observed,
        closed: new.map(|(own, _)| own),
        shifted: new.map(|(_, shifted)| shifted),
        set: calibrated,
    };
    (before, after)
}
