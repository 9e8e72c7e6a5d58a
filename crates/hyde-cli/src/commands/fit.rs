//! `hyde fit`: calibrates a model on records, and says what that is worth.

use crate::args::FitArgs;
use crate::before_after::{self, RecordErrors};
use crate::diagnosis::{suspicion, wrapped};
use crate::exit::Exit;
use crate::files;
use crate::left_model;
use crate::project::{Told as _, complain, print_output};
use crate::study;
use crate::watch::Watch;
use hyde_calibrate::{Fit, Model, Problem, Unsupported};
use hyde_sim::Reached;
use hyde_study::Calibration;
use hyde_study::unobservable;
use hyde_units::{counted, engineering_as, engineering_difference, significant};
use serde_json::{Value, json};
use std::fmt::Write as _;
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
    let found = match watched(args, &calibration) {
        Ok(found) => found,
        Err(error) => return cannot(&mut calibration, args, &error),
    };
    if !found.learned() {
        let diagnostic = unobservable::unlearned(&calibration, &found.causes);
        calibration.project.diagnostics.push(diagnostic);
        let model_args = args.study.model_args();
        return calibration.project.finish_with_errors(&model_args);
    }
    let errors = match errors(&calibration, &found) {
        Ok(errors) => errors,
        Err(error) => return cannot(&mut calibration, args, &error),
    };
    let report = report(&calibration, &found, &errors);
    if let Some(folder) = &args.out
        && let Err(reason) = leave(folder, &args.study.file, &calibration, &found, &report)
    {
        return complain(&args.study.model_args(), Exit::CommandLine, &reason);
    }
    if args.study.json {
        print_output(&format!("{report:#}"));
    } else if !args.study.quiet {
        print_output(&text(&calibration, &found, &errors));
        if let Some(folder) = &args.out {
            print_output(&format!(
                "\n  fit.json and {} are in {}",
                model_file(&calibration),
                folder.display()
            ));
        }
    }
    Exit::Done
}

/// Calibrates, and shows how far that is.
fn watched(args: &FitArgs, calibration: &Calibration) -> Result<Fit, Unsupported> {
    let reached: Arc<Reached> = Arc::default();
    let shown = Arc::clone(&reached);
    let starts = calibration.plan.starts;
    let _watch = Watch::new(args.study.json || args.study.quiet, move || {
        let (steps, most) = shown.get();
        let most = most * starts.max(1) as f64;
        match steps > 0.0 {
            true => format!("fit: step {steps} of at most {most}"),
            false => "fitting".to_owned(),
        }
    });
    let problem = Problem {
        program: &calibration.compiled.program,
        recordings: &calibration.fitted,
        observer: &calibration.observer,
        varied: &calibration.varied,
        set: &calibration.set,
        fold: None,
        reached: Some(&*reached),
    };
    hyde_calibrate::fit(&problem, &calibration.holdout, starts)
}

/// The errors with the declared values and with the calibrated ones.
fn errors(calibration: &Calibration, found: &Fit) -> Result<Vec<RecordErrors>, Unsupported> {
    let declared = calibration.project.set();
    let mut calibrated = declared.clone();
    calibrated.extend(found.parameters.iter().map(|p| (p.name.clone(), p.value)));
    let closed = |set| before_after::closed(&calibration.project, &[], &[], &[], set);
    let old = closed(&declared);
    // A time that is delayed by shapes the equations of the closed loop: it is compiled anew.
    let shapes = |program: &hyde_program::Program| {
        let each = found.parameters.iter();
        let mut known = each.filter_map(|own| program.parameter(&own.name));
        known.any(|(parameter, _)| parameter.structural)
    };
    let anew = old.as_ref().is_some_and(|(program, _)| shapes(program));
    let shaped = if anew { closed(&calibrated) } else { None };
    let new = if anew { &shaped } else { &old };
    let observed = &calibration.compiled.program;
    let before = Model {
        observed,
        closed: old.as_ref().map(|(own, _)| own),
        shifted: None,
        set: &declared,
    };
    let after = Model {
        observed,
        closed: new.as_ref().map(|(own, _)| own),
        shifted: new.as_ref().map(|(_, shifted)| shifted),
        set: &calibrated,
    };
    before_after::errors(calibration, &calibration.observer, Some(before), after)
}

/// Tells why there is no calibration.
fn cannot(calibration: &mut Calibration, args: &FitArgs, error: &Unsupported) -> Exit {
    let diagnostic = unobservable::unsupported(error, calibration.plan.span);
    calibration.project.diagnostics.push(diagnostic);
    calibration
        .project
        .finish_with_errors(&args.study.model_args())
}

/// The calibration in lines of at most 80 columns.
fn text(calibration: &Calibration, fit: &Fit, errors: &[RecordErrors]) -> String {
    let program = &calibration.compiled.program;
    let mut out = String::new();
    let end = match fit.converged {
        _ if !fit.causes.is_empty() => "MODEL DOES NOT FOLLOW THEM".to_owned(),
        true => format!("converged in {}", counted(fit.steps, "step")),
        false => format!("NOT CONVERGED in {}", counted(fit.steps, "step")),
    };
    let _ = writeln!(
        out,
        "{} of {}: {} on {}, {end}",
        calibration.plan.name,
        calibration.plan.model,
        counted(fit.parameters.len(), "parameter"),
        counted(calibration.fitted.len(), "record"),
    );
    for cause in &fit.causes {
        wrapped(&mut out, "  -", &unobservable::reason(calibration, cause));
    }
    if fit.agreeing_starts.1 > 1 {
        let (agreeing, all) = fit.agreeing_starts;
        let _ = writeln!(
            out,
            "  {agreeing} of {all} starts converged to these values"
        );
    }
    let _ = writeln!(
        out,
        "\n  {:<24} {:>13} {:>13} {:>7}  {:<10}",
        "parameter", "declared", "calibrated", "±", ""
    );
    for parameter in &fit.parameters {
        let unit = program.parameter(&parameter.name).map(|(p, _)| &p.unit);
        let number = |value: f64| {
            unit.map_or_else(|| significant(value, 5), |unit| engineering_as(value, unit))
        };
        let half = (parameter.interval.1 - parameter.interval.0) / 2.0;
        let line = format!(
            "  {:<24} {:>13} {:>13} {:>7}  {}",
            parameter.name,
            number(parameter.nominal),
            number(parameter.value),
            before_after::spread(half, parameter.value, |half| unit.map_or_else(
                || significant(half, 5),
                |unit| engineering_difference(half, unit)
            )),
            suspicion(parameter)
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
    for group in &fit.groups {
        let names: Vec<&str> = group
            .iter()
            .map(|&number| fit.parameters[number].name.as_str())
            .collect();
        let _ = writeln!(out, "  strongly correlated: {}", names.join(", "));
    }
    out.push('\n');
    out.push_str(&before_after::text(errors, calibration));
    out
}

/// The calibration as JSON; numbers are SI.
fn report(calibration: &Calibration, fit: &Fit, errors: &[RecordErrors]) -> Value {
    let program = &calibration.compiled.program;
    let parameters: Vec<Value> = fit
        .parameters
        .iter()
        .map(|parameter| {
            let unit = program
                .parameter(&parameter.name)
                .map(|(p, _)| p.dimension.usual_unit());
            json!({
                "name": parameter.name,
                "unit": unit,
                "declared": parameter.nominal,
                "value": parameter.value,
                "interval": [parameter.interval.0, parameter.interval.1],
                "prior_deviation": parameter.prior,
                "deviation": parameter.deviation,
                "left_range": parameter.left_range,
                "at_bound": parameter.at_bound,
                "not_told": parameter.untold,
                "no_effect": parameter.silent,
            })
        })
        .collect();
    let groups: Vec<Vec<&str>> = fit
        .groups
        .iter()
        .map(|group| {
            group
                .iter()
                .map(|&number| fit.parameters[number].name.as_str())
                .collect()
        })
        .collect();
    let causes = fit.causes.iter();
    let causes: Vec<String> = causes
        .map(|cause| unobservable::reason(calibration, cause))
        .collect();
    json!({
        "ok": true,
        "calibration": calibration.plan.name,
        "model": calibration.plan.model,
        "model_hash": calibration.project.hash,
        "converged": fit.converged && fit.causes.is_empty(),
        "causes": causes,
        "steps": fit.steps,
        "starts": fit.agreeing_starts.1,
        "agreeing_starts": fit.agreeing_starts.0,
        "parameters": parameters,
        "groups": groups,
        "records": before_after::json(errors, calibration),
        "inflation": fit.inflation,
    })
}

/// Leaves the report and the calibrated model.
fn leave(
    folder: &Path,
    user: &Path,
    calibration: &Calibration,
    fit: &Fit,
    report: &Value,
) -> Result<(), String> {
    files::make_folder(folder)?;
    files::write(&folder.join("fit.json"), format!("{report:#}\n").as_bytes())?;
    let stem = model_name(calibration);
    let head = left_model::head(&calibration.project, user, folder, &stem);
    let text = format!("{}\n\n{}", head.text, model(calibration, fit));
    files::write(&folder.join(model_file(calibration)), text.as_bytes())
}

fn model_file(calibration: &Calibration) -> String {
    format!("{}.hyde", model_name(calibration))
}

fn model_name(calibration: &Calibration) -> String {
    format!("{}_fitted", calibration.plan.model.replace('.', "_"))
}

/// The model with its calibrated values. Elements of an array are told beside it: no modification sets one.
fn model(calibration: &Calibration, fit: &Fit) -> String {
    let program = &calibration.compiled.program;
    let mut out = String::new();
    let mut values: Vec<String> = Vec::new();
    for parameter in &fit.parameters {
        let unit = program
            .parameter(&parameter.name)
            .map(|(p, _)| p.dimension.usual_unit());
        let unit = unit
            .filter(|unit| unit != "1")
            .map_or_else(String::new, |unit| format!(" [{unit}]"));
        let value = format!("{} = {:?}{unit}", parameter.name, parameter.value);
        if parameter.name.contains('[') {
            let _ = writeln!(out, "// {value}");
        } else {
            values.push(format!("  {value}"));
        }
    }
    let values = match values.is_empty() {
        true => String::new(),
        false => format!("(\n{}\n)", values.join(",\n")),
    };
    let _ = writeln!(
        out,
        "model {} = {}{values} \"calibrated by `{}`\";",
        model_name(calibration),
        calibration.plan.model,
        calibration.plan.name
    );
    out
}
