//! `hyde diagnose`: finds the effect that a model lacks.

use crate::args::DiagnoseArgs;
use crate::exit::Exit;
use crate::project::{Told as _, complain, print_output};
use crate::{clock, files, study};
use hyde_calibrate::Thresholds;
use hyde_present::diagnosed;
use hyde_study::diagnosis::{Diagnosed, search};
use hyde_study::left_model;
use serde_json::Value;
use std::path::Path;

/// Finds and tells.
pub(crate) fn diagnose(args: &DiagnoseArgs) -> Exit {
    match told(args) {
        Ok(exit) | Err(exit) => exit,
    }
}

fn told(args: &DiagnoseArgs) -> Result<Exit, Exit> {
    let model_args = args.study.model_args();
    let folder = args.out.as_deref();
    let folder = folder.map_or(Ok(()), |folder| {
        left_model::check_folder(&files::disk(), folder)
    });
    let ready = args.study.use_jobs().and(folder);
    ready.map_err(|reason| complain(&model_args, Exit::CommandLine, &reason))?;
    let (plan, mut calibration) = study::diagnosis(&args.study)?;
    let candidates = calibration.project.candidates_or_report(&model_args)?;
    let laws = calibration.project.laws_or_report(&model_args)?;
    // A terminal does not show the curves.
    let curves = args.out.is_some() || args.study.json;
    let tell = |told: &Diagnosed<'_>| tell(args, told);
    let missing = (candidates, laws);
    let method = Thresholds::default();
    let told = search(&plan, &mut calibration, missing, &method, curves, tell);
    told.map_err(|diagnostic| {
        calibration.project.diagnostics.push(*diagnostic);
        calibration.project.finish_with_errors(&model_args)
    })
}

/// Prints, and leaves the files where a folder is asked for.
fn tell(args: &DiagnoseArgs, told: &Diagnosed<'_>) -> Exit {
    let report = diagnosed::json(told);
    if let Some(folder) = &args.out
        && let Err(reason) = leave(folder, &args.study.file, told, &report)
    {
        return complain(&args.study.model_args(), Exit::CommandLine, &reason);
    }
    if args.study.json {
        print_output(&format!("{report:#}"));
    } else if !args.study.quiet {
        print_output(&diagnosed::text(told));
        if let Some(folder) = &args.out {
            print_output(&format!(
                "\n  {}, report.json and report.html are in {}",
                model_file(told),
                folder.display()
            ));
        }
    }
    Exit::Done
}

/// Writes the files, each whole or not at all; the page last.
fn leave(folder: &Path, user: &Path, told: &Diagnosed<'_>, report: &Value) -> Result<(), String> {
    files::make_folder(folder)?;
    let report = format!("{report:#}\n");
    let leave = |name: &str, content: &str| files::write(&folder.join(name), content.as_bytes());
    leave(&model_file(told), &model(folder, user, told))?;
    leave("report.json", &report)?;
    leave("report.html", &diagnosed::html(told, &clock::now()))
}

/// The new model as a file of a folder. Where it imports the user's package it stands alone: an experiment would not find
/// its records there.
fn model(folder: &Path, user: &Path, told: &Diagnosed<'_>) -> String {
    let head = left_model::head(
        &files::disk(),
        &told.calibration.project,
        user,
        folder,
        &told.written.model,
    );
    let mut text = told.new_text();
    if let Some(name) = &told.written.experiment
        && head.imports
        && let Some(at) = text.find(&format!("\nexperiment {name}"))
    {
        text = text[..at].trim_end();
    }
    format!("{}\n\n{text}\n", head.text)
}

fn model_file(told: &Diagnosed<'_>) -> String {
    format!("{}.hyde", told.written.model)
}
