//! `hyde fit`: calibrates a model on records, and says what that is worth.

use crate::args::FitArgs;
use crate::before_after::{self, RecordErrors};
use crate::diagnosis::suspicion;
use crate::exit::Exit;
use crate::files;
use crate::project::{complain, print_output};
use crate::study::{self, Calibration};
use hyde_calibrate::{Fit, Model, Unsupported};
use hyde_units::{engineering, significant};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::path::Path;

/// Calibrates and tells.
pub(crate) fn fit(args: &FitArgs) -> Exit {
    if let Err(reason) = args.study.use_jobs() {
        return complain(&args.study.model_args(), Exit::CommandLine, &reason);
    }
    let mut calibration = match study::load(&args.study, false) {
        Ok(calibration) => calibration,
        Err(exit) => return exit,
    };
    let found = hyde_calibrate::fit(
        &calibration.compiled.program,
        &calibration.fitted,
        &calibration.holdout,
        &calibration.observer,
        &calibration.varied,
        &calibration.set,
        calibration.plan.starts,
    );
    let found = match found {
        Ok(found) => found,
        Err(error) => return cannot(&mut calibration, args, &error),
    };
    let errors = match errors(&calibration, &found) {
        Ok(errors) => errors,
        Err(error) => return cannot(&mut calibration, args, &error),
    };
    let report = report(&calibration, &found, &errors);
    if let Some(folder) = &args.out
        && let Err(reason) = leave(folder, &calibration, &found, &report)
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
    before_after::errors(calibration, Some(before), after)
}

/// Tells why there is no calibration.
fn cannot(calibration: &mut Calibration, args: &FitArgs, error: &Unsupported) -> Exit {
    let diagnostic = study::unsupported(error, calibration.plan.span);
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
        true => format!("converged in {} steps", fit.steps),
        false => format!("NOT CONVERGED in {} steps", fit.steps),
    };
    let _ = writeln!(
        out,
        "{} of {}: {} parameters on {} records, {end}",
        calibration.plan.name,
        calibration.plan.model,
        fit.parameters.len(),
        calibration.fitted.len(),
    );
    if fit.agreeing_starts.1 > 1 {
        let (agreeing, all) = fit.agreeing_starts;
        let _ = writeln!(out, "  {agreeing} of {all} starts ended there");
    }
    let _ = writeln!(
        out,
        "\n  {:<24} {:>13} {:>13} {:>7}  {:<10}",
        "parameter", "declared", "calibrated", "±", ""
    );
    for parameter in &fit.parameters {
        let dimension = program.parameter(&parameter.name).map(|(p, _)| p.dimension);
        let number =
            |value: f64| dimension.map_or_else(|| significant(value, 5), |d| engineering(value, d));
        let half = (parameter.interval.1 - parameter.interval.0) / 2.0;
        let line = format!(
            "  {:<24} {:>13} {:>13} {:>7}  {}",
            parameter.name,
            number(parameter.nominal),
            number(parameter.value),
            before_after::spread(half, parameter.value, number),
            suspicion(parameter)
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
    for group in &fit.groups {
        let names: Vec<&str> = group
            .iter()
            .map(|&number| fit.parameters[number].name.as_str())
            .collect();
        let _ = writeln!(out, "  the data hardly tell apart: {}", names.join(", "));
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
    json!({
        "ok": true,
        "calibration": calibration.plan.name,
        "model": calibration.plan.model,
        "model_hash": calibration.project.hash,
        "converged": fit.converged,
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
    calibration: &Calibration,
    fit: &Fit,
    report: &Value,
) -> Result<(), String> {
    files::make_folder(folder)?;
    files::write(&folder.join("fit.json"), format!("{report:#}\n").as_bytes())?;
    files::write(
        &folder.join(model_file(calibration)),
        model(calibration, fit).as_bytes(),
    )
}

fn model_file(calibration: &Calibration) -> String {
    format!("{}_fitted.hyde", calibration.plan.model.replace('.', "_"))
}

/// The model with its calibrated values, as a file that imports the other.
fn model(calibration: &Calibration, fit: &Fit) -> String {
    let program = &calibration.compiled.program;
    let name = &calibration.plan.model;
    let mut out = String::new();
    let package = calibration
        .project
        .file
        .files
        .first()
        .and_then(|(_, tree)| tree.package.as_ref());
    match package {
        Some((path, _)) => {
            let _ = writeln!(out, "import {}.*;\n", path.dotted());
        }
        None => {
            let _ = writeln!(
                out,
                "// For the file of `{name}`: a file without a package cannot be imported."
            );
        }
    }
    let values: Vec<String> = fit
        .parameters
        .iter()
        .map(|parameter| {
            let unit = program
                .parameter(&parameter.name)
                .map(|(p, _)| p.dimension.usual_unit());
            let unit = unit
                .filter(|unit| unit != "1")
                .map_or_else(String::new, |unit| format!(" [{unit}]"));
            format!("  {} = {:?}{unit}", parameter.name, parameter.value)
        })
        .collect();
    let _ = writeln!(
        out,
        "model {}_fitted = {name}(\n{}\n) \"calibrated by `{}`\";",
        name.replace('.', "_"),
        values.join(",\n"),
        calibration.plan.name
    );
    out
}
