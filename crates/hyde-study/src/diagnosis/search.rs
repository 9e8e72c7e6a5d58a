//! [`search`]: looks for the effects that a model lacks.

use super::Diagnosed;
use super::held_out::{Agreed, Refused, agreed};
use crate::{Calibration, unknown, unobservable};
use hyde_calibrate::{
    Cause, CommandTiming, Diagnosis, Hypothesis, Inquiry, Knob, Problem, Site, Solution,
    Thresholds, Unsupported, fitted_parameters, moved_columns,
};
use hyde_compiler::{Candidate, DiagnosisPlan, Form, Laws};
use hyde_diag::Diagnostic;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Searches by some thresholds, and gives what was found to `tell`. `candidates` and `laws` are those of the model; `curves` asks for each
/// finding as a curve, which takes time. The calibration gets the observer that the search ended with.
///
/// # Errors
/// Nothing can be learned from the records, or an observer cannot run the model: a diagnostic of the file.
pub fn search<T>(
    plan: &DiagnosisPlan,
    calibration: &mut Calibration,
    (candidates, laws): (Vec<Candidate>, Laws),
    thresholds: &Thresholds,
    curves: bool,
    tell: impl FnOnce(&Diagnosed<'_>) -> T,
) -> Result<T, Box<Diagnostic>> {
    match searched(
        plan,
        calibration,
        (candidates, laws),
        thresholds,
        curves,
        tell,
    ) {
        Ok(told) => told,
        Err(error) => Err(Box::new(unobservable::unsupported(&error, plan.span))),
    }
}

fn searched<T>(
    plan: &DiagnosisPlan,
    calibration: &mut Calibration,
    (candidates, laws): (Vec<Candidate>, Laws),
    thresholds: &Thresholds,
    curves: bool,
    tell: impl FnOnce(&Diagnosed<'_>) -> T,
) -> Result<Result<T, Box<Diagnostic>>, Unsupported> {
    let sites: Vec<Site> = laws.sites.into_iter().map(unknown::site).collect();
    let shapes: Vec<_> = laws.shapes.into_iter().map(Arc::new).collect();
    let candidates: Vec<Candidate> = candidates
        .into_iter()
        .filter(|candidate| plan.selects(candidate))
        .collect();
    let mut hypotheses: Vec<Hypothesis> = candidates.iter().map(hypothesis).collect();
    let moved = mend_columns(calibration, thresholds)?;
    let (found, agreed, curves, commands) = {
        let project = &calibration.project;
        let settings: BTreeMap<String, f64> = project.set().into_iter().collect();
        let headers = crate::headers(&project.records);
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
            shapes: &shapes,
            author: &author,
            max_effects: plan.max_effects,
            barred: &[],
            thresholds,
        };
        let (found, agreed) = diagnosed(calibration, &candidates, &inquiry)?;
        let count = if curves { found.findings.len() } else { 0 };
        let curves = (0..count).map(|number| found.curve(&inquiry, number));
        let curves: Vec<_> = curves.collect();
        let mut commands = found.commands(&inquiry)?;
        let timings = &mut commands.timings;
        timings.retain(|own| moved.iter().all(|moved| moved.replayed != own.replayed));
        timings.extend(moved);
        (found, agreed, curves, commands)
    };
    if let Some(own) = &found.observer {
        calibration.observer = own.clone();
    }
    let calibration = &*calibration;
    let causes = causes(calibration, &found.before)?;
    let learned = fitted_parameters(&calibration.varied, &found.before);
    if !causes.is_empty() && learned.iter().all(|parameter| parameter.silent) {
        let names = calibration.varied.iter().map(|own| own.name.clone());
        let names: Vec<String> = names.collect();
        let each = causes.iter().map(|cause| (calibration, cause));
        let causes: Vec<_> = each.collect();
        let nothing = unobservable::unlearned(&calibration.plan, &names, &causes);
        return Ok(Err(Box::new(nothing)));
    }
    // A finding may be of the effect that was written.
    hypotheses.extend(found.law().map(|own| own.hypothesis.clone()));
    let told = Diagnosed::new(plan, calibration, &candidates, &hypotheses, &found, agreed);
    Ok(Ok(tell(&Diagnosed {
        causes,
        curves,
        commands,
        ..told
    })))
}

/// What the search finds, as far as it holds on the records held out. A law that does not may have taken the place of effects
/// that do: where nothing is left, the search begins again without laws.
fn diagnosed(
    calibration: &Calibration,
    candidates: &[Candidate],
    inquiry: &Inquiry<'_>,
) -> Result<(Diagnosis, Agreed), Unsupported> {
    let search = |inquiry: &Inquiry<'_>| {
        let mut found = hyde_calibrate::diagnose(inquiry)?;
        let agreed = agreed(calibration, candidates, inquiry, &mut found)?;
        Ok((found, agreed))
    };
    let (found, mut told) = search(inquiry)?;
    let is_law = |own: &Refused| own.hypothesis >= inquiry.hypotheses.len();
    if found.findings.is_empty() && told.1.iter().any(is_law) {
        let (again, (errors, refused)) = search(&Inquiry {
            sites: &[],
            ..*inquiry
        })?;
        if !again.findings.is_empty() {
            told.1.extend(refused);
            return Ok((again, (errors, told.1)));
        }
    }
    Ok((found, told))
}

/// Moves columns of commands that were recorded at other times than they acted, in all records: everything that follows would
/// stand in for the time between. Gives what was moved.
fn mend_columns(
    calibration: &mut Calibration,
    thresholds: &Thresholds,
) -> Result<Vec<CommandTiming>, Unsupported> {
    let program = &calibration.compiled.program;
    let problem = Problem {
        program,
        recordings: &calibration.fitted,
        observer: &calibration.observer,
        varied: &calibration.varied,
        set: &calibration.set,
        fold: None,
        reached: None,
    };
    let moved = moved_columns(&problem, thresholds)?;
    let records = calibration.fitted.iter_mut();
    for recording in records.chain(&mut calibration.holdout) {
        moved.iter().for_each(|own| own.mend(program, recording));
    }
    Ok(moved)
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

/// A candidate as the search takes it.
pub fn hypothesis(candidate: &Candidate) -> Hypothesis {
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
    let periodic = marked(&["position", "angle"]);
    let mut marks = candidate.signature.iter();
    let recurs = periodic.is_some() || marks.any(|(mark, _)| mark == "angle");
    Hypothesis {
        recurs,
        effect: candidate.name().to_owned(),
        site: candidate.site.clone(),
        aliases: candidate.aliases.clone(),
        sizes: candidate.sizes.iter().map(knob).collect(),
        shapes: candidate.shapes.iter().map(knob).collect(),
        periodic,
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
