//! `hyde diagnose`: finds the effect that a model lacks.

use crate::args::DiagnoseArgs;
use crate::diagnosis::{self, Told};
use crate::exit::Exit;
use crate::files;
use crate::left_model;
use crate::project::{Told as _, complain, print_output};
use crate::study;
use crate::unknown;
use hyde_calibrate::{
    Cause, Hypothesis, Inquiry, Knob, Site, Solution, Unsupported, fitted_parameters,
};
use hyde_compiler::{Candidate, Form};
use hyde_study::Calibration;
use hyde_study::unobservable;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Finds and tells.
pub(crate) fn diagnose(args: &DiagnoseArgs) -> Exit {
    let model_args = args.study.model_args();
    let folder = args.out.as_deref().map_or(Ok(()), left_model::check_folder);
    if let Err(reason) = args.study.use_jobs().and(folder) {
        return complain(&model_args, Exit::CommandLine, &reason);
    }
    let (plan, mut calibration) = match study::diagnosis(&args.study) {
        Ok(diagnosis) => diagnosis,
        Err(exit) => return exit,
    };
    let candidates = match calibration.project.candidates_or_report(&model_args) {
        Ok(candidates) => candidates,
        Err(exit) => return exit,
    };
    let sites = match calibration.project.law_sites_or_report(&model_args) {
        Ok(sites) => sites,
        Err(exit) => return exit,
    };
    let sites: Vec<Site> = sites.into_iter().map(unknown::site).collect();
    let candidates: Vec<Candidate> = candidates
        .into_iter()
        .filter(|candidate| plan.selects(candidate))
        .collect();
    let mut hypotheses: Vec<Hypothesis> = candidates.iter().map(hypothesis).collect();
    let found = {
        let project = &calibration.project;
        let settings: BTreeMap<String, f64> = project.set().into_iter().collect();
        let headers = hyde_study::headers(&project.records);
        let request = project.request(&settings, &headers, Form::Observed);
        let author = |known: &[usize], written: &[hyde_calibrate::Written]| {
            unknown::built(&request, &candidates, known, written)
        };
        let inquiry = Inquiry {
            recordings: &calibration.fitted,
            observer: &calibration.observer,
            varied: &calibration.varied,
            set: &project.set(),
            hypotheses: &hypotheses,
            sites: &sites,
            author: &author,
            max_effects: plan.max_effects,
            barred: &[],
        };
        hyde_calibrate::diagnose(&inquiry).and_then(|mut found| {
            let agreed = diagnosis::agreed(&calibration, &candidates, &inquiry, &mut found)?;
            // A terminal does not show them.
            let count = match args.out.is_some() || args.study.json {
                true => found.findings.len(),
                false => 0,
            };
            let curves = (0..count).map(|number| found.curve(&inquiry, number));
            let curves: Vec<_> = curves.collect();
            Ok((found, agreed, curves))
        })
    };
    let told = found.and_then(|(found, agreed, curves)| {
        if let Some(own) = &found.observer {
            calibration.observer = own.clone();
        }
        let causes = causes(&calibration, &found.before)?;
        let learned = fitted_parameters(&calibration.varied, &found.before);
        if !causes.is_empty() && learned.iter().all(|parameter| parameter.silent) {
            let names = calibration.varied.iter().map(|own| own.name.clone());
            let names: Vec<String> = names.collect();
            let each = causes.iter().map(|cause| (&calibration, cause));
            let causes: Vec<_> = each.collect();
            return Ok(Err(unobservable::unlearned(
                &calibration.plan,
                &names,
                &causes,
            )));
        }
        // A finding may be of the effect that was written.
        hypotheses.extend(found.law().map(|own| own.hypothesis.clone()));
        // What it says borrows what was found; so it is said here.
        let told = Told::new(
            &plan,
            &calibration,
            &candidates,
            &hypotheses,
            &found,
            agreed,
        );
        let told = Told {
            causes,
            curves,
            ..told
        };
        Ok(Ok(tell(args, &told)))
    });
    let diagnostic = match told {
        Ok(Ok(exit)) => return exit,
        Ok(Err(nothing)) => nothing,
        Err(error) => unobservable::unsupported(&error, plan.span),
    };
    calibration.project.diagnostics.push(diagnostic);
    calibration.project.finish_with_errors(&model_args)
}

/// Why the calibrated model does not follow the records, if it does not.
fn causes(calibration: &Calibration, solution: &Solution) -> Result<Vec<Cause>, Unsupported> {
    hyde_calibrate::standstill(
        &calibration.compiled.program,
        &calibration.fitted,
        &calibration.observer,
        &calibration.varied,
        &calibration.set,
        solution,
    )
}

/// Prints, and leaves the files where a folder is asked for.
fn tell(args: &DiagnoseArgs, told: &Told<'_>) -> Exit {
    let report = diagnosis::json(told);
    if let Some(folder) = &args.out
        && let Err(reason) = leave(folder, &args.study.file, told, &report)
    {
        return complain(&args.study.model_args(), Exit::CommandLine, &reason);
    }
    if args.study.json {
        print_output(&format!("{report:#}"));
    } else if !args.study.quiet {
        print_output(&diagnosis::text(told));
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
fn leave(folder: &Path, user: &Path, told: &Told<'_>, report: &Value) -> Result<(), String> {
    files::make_folder(folder)?;
    let report = format!("{report:#}\n");
    let leave = |name: &str, content: &str| files::write(&folder.join(name), content.as_bytes());
    leave(&model_file(told), &model(folder, user, told))?;
    leave("report.json", &report)?;
    leave("report.html", &diagnosis::html(told))
}

/// The new model as a file of a folder. Where it imports the user's package it stands alone: an experiment would not find
/// its records there.
fn model(folder: &Path, user: &Path, told: &Told<'_>) -> String {
    let head = left_model::head(&told.calibration.project, user, folder, &told.written.model);
    let mut text = told.new_text();
    if let Some(name) = &told.written.experiment
        && head.imports
        && let Some(at) = text.find(&format!("\nexperiment {name}"))
    {
        text = text[..at].trim_end();
    }
    format!("{}\n\n{text}\n", head.text)
}

fn model_file(told: &Told<'_>) -> String {
    format!("{}.hyde", told.written.model)
}

/// A candidate as the search takes it.
pub(crate) fn hypothesis(candidate: &Candidate) -> Hypothesis {
    let knob = |knob: &hyde_compiler::Knob| Knob {
        name: knob.name.clone(),
        value: knob.value,
        range: knob.range.unwrap_or_else(|| around(knob.value)),
        integer: knob.integer,
        unit: knob.quantity.unit.clone(),
    };
    let marked = |marks: &[&str]| {
        let mut marks = candidate
            .signature
            .iter()
            .filter(|(mark, _)| marks.contains(&mark.as_str()));
        marks.find_map(|(_, shape)| {
            let shape = shape.as_ref()?;
            let mut shapes = candidate.shapes.iter();
            shapes.position(|known| known.name == *shape)
        })
    };
    Hypothesis {
        effect: candidate.name().to_owned(),
        site: candidate.site.clone(),
        aliases: candidate.aliases.clone(),
        sizes: candidate.sizes.iter().map(knob).collect(),
        shapes: candidate.shapes.iter().map(knob).collect(),
        periodic: marked(&["position", "angle"]),
        resonant: marked(&["resonance"]),
    }
}

/// A range where none is declared: a decade to either side.
fn around(value: f64) -> (f64, f64) {
    if value == 0.0 {
        (-1.0, 1.0)
    } else {
        (0.1 * value.abs(), 10.0 * value.abs())
    }
}
