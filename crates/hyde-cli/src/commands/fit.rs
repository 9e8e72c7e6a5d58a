//! `hyde fit`: calibrates models on records, and says what that is worth.

use crate::args::FitArgs;
use crate::before_after::{self, RecordErrors};
use crate::exit::Exit;
use crate::files;
use crate::fitted::{Told, identified, json, model, page, plots, text};
use crate::left_model;
use crate::project::{Told as _, complain, print_output};
use crate::study;
use crate::watch::Watch;
use hyde_calibrate::{Fit, Identifiability, Joint, Model, Profile, Unsupported};
use hyde_diag::Diagnostic;
use hyde_program::Program;
use hyde_sim::Reached;
use hyde_study::{Calibration, JointCalibration, unobservable};
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;

/// Calibrates and tells.
pub(crate) fn fit(args: &FitArgs) -> Exit {
    let folder = args.out.as_deref().map_or(Ok(()), left_model::check_folder);
    if let Err(reason) = args.study.use_jobs().and(folder) {
        return complain(&args.study.model_args(), Exit::CommandLine, &reason);
    }
    let mut calibration = match study::calibration(&args.study) {
        Ok(calibration) => calibration,
        Err(exit) => return exit,
    };
    let asked = match profiled(&args.profiles, &calibration) {
        Ok(asked) => asked,
        Err(reason) => return complain(&args.study.model_args(), Exit::CommandLine, &reason),
    };
    let found = calibrated(args, &calibration, &asked);
    let Found {
        before,
        fit,
        profiles,
        errors,
    } = match found {
        Ok(Ok(found)) => found,
        Ok(Err(diagnostic)) => return refuse(&mut calibration, args, *diagnostic),
        Err(error) => {
            let diagnostic = unobservable::unsupported(&error, calibration.plan.span);
            return refuse(&mut calibration, args, diagnostic);
        }
    };
    let told = Told {
        calibration: &calibration,
        before: &before,
        fit: &fit,
        errors: &errors,
        profiles: &profiles,
    };
    let report = json::report(&told);
    if let Some(folder) = &args.out
        && let Err(reason) = leave(folder, &args.study.file, &told, &report)
    {
        return complain(&args.study.model_args(), Exit::CommandLine, &reason);
    }
    if args.study.json {
        print_output(&format!("{report:#}"));
    } else if !args.study.quiet {
        print_output(&text::text(&told, args.correlation));
        if let Some(folder) = &args.out {
            print_output(&format!(
                "\n  fit.json, fit.html and {} are in {}",
                model_file(&calibration),
                folder.display()
            ));
        }
    }
    Exit::Done
}

/// What was found.
struct Found {
    before: Identifiability,
    fit: Fit,
    profiles: Vec<Profile>,
    errors: Vec<Vec<RecordErrors>>,
}

/// The numbers whose profiles are asked for: of a parameter with a value each, all of them.
fn profiled(names: &[String], calibration: &JointCalibration) -> Result<Vec<usize>, String> {
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

/// Tells what the records determine, calibrates, and shows how far that is. A diagnostic says why nothing was learned.
fn calibrated(
    args: &FitArgs,
    calibration: &JointCalibration,
    asked: &[usize],
) -> Result<Result<Found, Box<Diagnostic>>, Unsupported> {
    let reached: Arc<Reached> = Arc::default();
    let shown = Arc::clone(&reached);
    let starts = calibration.plan.starts;
    let joint = calibration.joint(Some(&*reached));
    let nominal: Vec<f64> = calibration.varied.iter().map(|own| own.nominal).collect();
    let before = joint.identifiability(&nominal)?;
    let told = identified::text(calibration, &before);
    let nothing = before.unmoved.len() == nominal.len();
    if !args.study.json && !args.study.quiet && !told.is_empty() && !nothing {
        print_output(&told);
    }
    let _watch = Watch::new(args.study.json || args.study.quiet, move || {
        let (steps, most) = shown.get();
        let most = most * starts.max(1) as f64;
        match steps > 0.0 {
            true => format!("fit: step {steps} of at most {most}"),
            false => "fitting".to_owned(),
        }
    });
    let fit = hyde_calibrate::fit(&joint, starts)?;
    if !fit.learned() {
        let names = calibration.numbers.iter().map(hyde_study::Number::name);
        let names: Vec<String> = names.collect();
        let causes = fit.causes.iter();
        let causes: Vec<_> = causes
            .map(|(part, cause)| (crate::fitted::experiment(calibration, *part), cause))
            .collect();
        let diagnostic = unobservable::unlearned(&calibration.plan, &names, &causes);
        return Ok(Err(Box::new(diagnostic)));
    }
    let profiles = profiles(&joint, &fit, asked)?;
    let errors = errors(calibration, &fit)?;
    Ok(Ok(Found {
        before,
        fit,
        profiles,
        errors,
    }))
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
        let closed = |set: &[(String, f64)]| before_after::closed(&own.project, &[], &[], &[], set);
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
                list.extend(before_after::errors_on(
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

/// Tells why there is no calibration.
fn refuse(calibration: &mut JointCalibration, args: &FitArgs, diagnostic: Diagnostic) -> Exit {
    match calibration.experiments.first_mut() {
        Some(first) => {
            first.project.diagnostics.push(diagnostic);
            first.project.finish_with_errors(&args.study.model_args())
        }
        None => Exit::Model,
    }
}

/// Leaves the report, the page with its plots, and the calibrated models.
fn leave(folder: &Path, user: &Path, told: &Told<'_>, report: &Value) -> Result<(), String> {
    let calibration = told.calibration;
    files::make_folder(folder)?;
    files::write(&folder.join("fit.json"), format!("{report:#}\n").as_bytes())?;
    files::write(&folder.join("fit.html"), page::html(told).as_bytes())?;
    if told.fit.parameters.len() > 1 {
        let svg = hyde_report::to_svg(&plots::correlation(told));
        files::write(&folder.join("correlation.svg"), svg.as_bytes())?;
    }
    for profile in told.profiles {
        let number = &calibration.numbers[profile.parameter];
        let local = number.local.as_ref();
        let local = local.map_or_else(String::new, |own| {
            format!("_{}_{}", model::word(&own.label), model::word(&own.value))
        });
        let name = format!("{}{local}", number.varied.name);
        let svg = hyde_report::to_svg(&plots::profile(told, profile));
        files::write(&folder.join(format!("profile-{name}.svg")), svg.as_bytes())?;
    }
    let Some(first) = calibration.experiments.first() else {
        return Ok(());
    };
    let head = left_model::head(&first.project, user, folder, &model::name(calibration));
    let text = format!("{}\n\n{}", head.text, model::text(calibration, told.fit));
    files::write(&folder.join(model_file(calibration)), text.as_bytes())
}

fn model_file(calibration: &JointCalibration) -> String {
    format!("{}.hyde", model::name(calibration))
}
