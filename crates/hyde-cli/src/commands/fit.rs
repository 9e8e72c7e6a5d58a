//! `hyde fit`: calibrates models on records, and says what that is worth.

use crate::args::FitArgs;
use crate::exit::Exit;
use crate::project::{Told as _, complain, print_output};
use crate::watch::Watch;
use crate::{clock, files, study};
use hyde_calibrate::Identifiability;
use hyde_diag::Diagnostic;
use hyde_present::fitted::{identified, json, page, plots, text};
use hyde_sim::Reached;
use hyde_study::fitted::{Calibrated, Fitted, calibrated, model, profiled};
use hyde_study::{JointCalibration, left_model};
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;

/// Calibrates and tells.
pub(crate) fn fit(args: &FitArgs) -> Exit {
    match told(args) {
        Ok(exit) | Err(exit) => exit,
    }
}

fn told(args: &FitArgs) -> Result<Exit, Exit> {
    let wrong = |reason: String| complain(&args.study.model_args(), Exit::CommandLine, &reason);
    let folder = args.out.as_deref();
    let folder = folder.map_or(Ok(()), |folder| {
        left_model::check_folder(&files::disk(), folder)
    });
    args.study.use_jobs().and(folder).map_err(wrong)?;
    let mut calibration = study::calibration(&args.study)?;
    let asked = profiled(&args.profiles, &calibration).map_err(wrong)?;
    let reached: Arc<Reached> = Arc::default();
    let mut watch = None;
    let told = |calibration: &JointCalibration, before: &Identifiability| {
        watch = begun(args, calibration, before, &reached);
    };
    let found = calibrated(&mut calibration, &asked, &reached, told);
    drop(watch);
    let Calibrated {
        before,
        fit,
        profiles,
        errors,
    } = found.map_err(|diagnostic| refuse(&mut calibration, args, *diagnostic))?;
    let told = Fitted {
        calibration: &calibration,
        before: &before,
        fit: &fit,
        errors: &errors,
        profiles: &profiles,
    };
    let report = json::report(&told);
    if let Some(folder) = &args.out {
        leave(folder, &args.study.file, &told, &report).map_err(wrong)?;
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
    Ok(Exit::Done)
}

/// Tells what the records determine, and shows how far the fit is.
fn begun(
    args: &FitArgs,
    calibration: &JointCalibration,
    before: &Identifiability,
    reached: &Arc<Reached>,
) -> Option<Watch> {
    let silent = args.study.json || args.study.quiet;
    let told = identified::text(calibration, before);
    let nothing = before.unmoved.len() == calibration.varied.len();
    if !silent && !told.is_empty() && !nothing {
        print_output(&told);
    }
    let (reached, starts) = (Arc::clone(reached), calibration.plan.starts);
    Some(Watch::new(args.study.quiet, move || {
        let (steps, most) = reached.get();
        let most = most * starts.max(1) as f64;
        match steps > 0.0 {
            true => format!("fit: step {steps} of at most {most}"),
            false => "fitting".to_owned(),
        }
    }))
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
fn leave(folder: &Path, user: &Path, told: &Fitted<'_>, report: &Value) -> Result<(), String> {
    let calibration = told.calibration;
    files::make_folder(folder)?;
    files::write(&folder.join("fit.json"), format!("{report:#}\n").as_bytes())?;
    files::write(
        &folder.join("fit.html"),
        page::html(told, &clock::now()).as_bytes(),
    )?;
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
    let head = left_model::head(
        &files::disk(),
        &first.project,
        user,
        folder,
        &model::name(calibration),
    );
    let text = format!("{}\n\n{}", head.text, model::text(calibration, told.fit));
    files::write(&folder.join(model_file(calibration)), text.as_bytes())
}

fn model_file(calibration: &JointCalibration) -> String {
    format!("{}.hyde", model::name(calibration))
}
