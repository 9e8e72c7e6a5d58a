//! `hyde diagnose`: finds the effect that a model lacks.

use crate::args::{DiagnoseArgs, ModelArgs, StudyArgs};
use crate::exit::Exit;
use crate::files;
use crate::project::{self, complain, print_output};
use crate::records;
use crate::study::{self, Calibration};
use crate::unknown;
use hyde_calibrate::{Built, Diagnosis, Hypothesis, Inquiry, Knob, Rejection, Verdict};
use hyde_compiler::{Additions, Backend, Candidate, DiagnosisPlan, Request};
use hyde_diag::{Diagnostics, Sources};
use hyde_syntax::ast::{Study, StudyKind};
use hyde_units::significant;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Finds and tells.
pub(crate) fn diagnose(args: &DiagnoseArgs) -> Exit {
    let model_args = args.study.model_args();
    if let Err(reason) = args.study.use_jobs() {
        return complain(&model_args, Exit::CommandLine, &reason);
    }
    let plan = match plan(&args.study) {
        Ok(plan) => plan,
        Err(exit) => return exit,
    };
    let of_calibration = StudyArgs {
        study: Some(plan.calibration.clone()),
        ..args.study.clone()
    };
    let mut calibration = match study::load(&of_calibration, true) {
        Ok(calibration) => calibration,
        Err(exit) => return exit,
    };
    let candidates = match calibration.project.candidates(&model_args) {
        Ok(candidates) => candidates,
        Err(exit) => return exit,
    };
    let sites = unknown::sites(&candidates);
    let candidates: Vec<Candidate> = candidates
        .into_iter()
        .filter(|candidate| plan.selects(candidate))
        .collect();
    let mut hypotheses: Vec<Hypothesis> = candidates.iter().map(hypothesis).collect();
    let found = {
        let project = &calibration.project;
        let settings: BTreeMap<String, f64> = project.set().into_iter().collect();
        let headers = records::headers(&project.records);
        let request = Request {
            sources: &project.sources,
            file: &project.file,
            model: &project.model,
            experiment: project.experiment.as_deref(),
            settings: &settings,
            records: &headers,
            free_inputs: false,
            ledger: false,
            observed: true,
            backend: Backend::Native,
        };
        let build = |numbers: &[usize]| {
            let file = project.file.files.first()?.0;
            let mut additions = Additions::kept();
            let paths = numbers
                .iter()
                .map(|&number| additions.put(file, &candidates[number]))
                .collect();
            let compiled =
                hyde_compiler::compile_with(&request, &additions, &mut Diagnostics::new())?;
            Some(Built {
                program: compiled.program,
                paths,
            })
        };
        let found = hyde_calibrate::diagnose(
            &calibration.fitted,
            &calibration.observer,
            &calibration.varied,
            &project.set(),
            &hypotheses,
            &build,
            plan.max_effects,
        );
        let author = |known: &[usize], written: &[hyde_calibrate::Written]| {
            unknown::built(&request, &candidates, known, written)
        };
        found.and_then(|mut found| {
            let inquiry = Inquiry {
                recordings: &calibration.fitted,
                observer: &calibration.observer,
                set: &project.set(),
                hypotheses: &hypotheses,
                sites: &sites,
                author: &author,
            };
            hyde_calibrate::propose(&inquiry, &mut found).map(|()| found)
        })
    };
    match found {
        Ok(found) => {
            // A finding may be of the effect that was written.
            let own = found
                .unknown
                .as_ref()
                .and_then(|unknown| unknown.found.as_ref());
            hypotheses.extend(own.map(|own| own.hypothesis.clone()));
            if args.study.json {
                print_output(&format!(
                    "{:#}",
                    report(&plan, &calibration, &hypotheses, &found)
                ));
            } else if !args.study.quiet {
                print_output(&text(&plan, &hypotheses, &found));
            }
            Exit::Done
        }
        Err(error) => {
            let diagnostic = study::unsupported(&error, plan.span);
            calibration.project.diagnostics.push(diagnostic);
            calibration.project.finish_with_errors(&model_args)
        }
    }
}

/// The block that the arguments name.
fn plan(args: &StudyArgs) -> Result<DiagnosisPlan, Exit> {
    // Effects of packages that the model itself need not use may be named.
    let model_args = ModelArgs {
        whole_library: true,
        ..args.model_args()
    };
    let text = files::read_text(&args.file)
        .map_err(|reason| complain(&model_args, Exit::CommandLine, &reason))?;
    let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
    let (file, _) = project::loaded(&model_args, &mut sources, &text, &mut diagnostics);
    if diagnostics.has_errors() {
        return Err(project::report_errors(&model_args, &sources, &diagnostics));
    }
    let studies: Vec<&Study> = file
        .studies()
        .filter(|study| study.kind == StudyKind::Diagnose)
        .collect();
    let study = study::chosen(&studies, args.study.as_deref(), "diagnosis")
        .map_err(|reason| complain(&model_args, Exit::CommandLine, &reason))?;
    let name = study.name.text.clone();
    DiagnosisPlan::read(&file, &name, &mut diagnostics)
        .ok_or_else(|| project::report_errors(&model_args, &sources, &diagnostics))
}

fn hypothesis(candidate: &Candidate) -> Hypothesis {
    let knob = |knob: &hyde_compiler::Knob| Knob {
        name: knob.name.clone(),
        value: knob.value,
        range: knob.range.unwrap_or_else(|| around(knob.value)),
        integer: knob.integer,
        unit: knob.quantity.dimension.usual_unit(),
    };
    let periodic = candidate
        .signature
        .iter()
        .filter(|(mark, _)| matches!(mark.as_str(), "position" | "angle"))
        .find_map(|(_, shape)| {
            let shape = shape.as_ref()?;
            candidate
                .shapes
                .iter()
                .position(|known| known.name == *shape)
        });
    Hypothesis {
        effect: candidate.name().to_owned(),
        site: candidate.site.clone(),
        aliases: candidate.aliases.clone(),
        sizes: candidate.sizes.iter().map(knob).collect(),
        shapes: candidate.shapes.iter().map(knob).collect(),
        periodic,
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

fn named(hypothesis: &Hypothesis) -> String {
    format!("{} at {}", hypothesis.effect, hypothesis.site)
}

/// The diagnosis in lines of at most 80 columns.
fn text(plan: &DiagnosisPlan, hypotheses: &[Hypothesis], found: &Diagnosis) -> String {
    let mut out = String::new();
    let _ = writeln!(out, "{}: {}", plan.name, sentence(hypotheses, found));
    for finding in &found.findings {
        let hypothesis = &hypotheses[finding.hypothesis];
        let _ = writeln!(out, "\n  {}", named(hypothesis));
        for quantity in std::iter::once(&finding.size).chain(&finding.shapes) {
            let half = (quantity.interval.1 - quantity.interval.0) / 2.0;
            let _ = writeln!(
                out,
                "    {:<12} {} ± {} {}",
                quantity.name,
                significant(quantity.value, 4),
                significant(half, 2),
                quantity.unit
            );
        }
        for &other in &finding.alternatives {
            let _ = writeln!(out, "    or {}", named(&hypotheses[other]));
        }
    }
    if let Some(own) = &found.unknown {
        out.push_str(&unknown::text(own, found));
    }
    for (number, round) in found.rounds.iter().enumerate() {
        let _ = writeln!(
            out,
            "\n  round {}: {} nodes tried, gates {} and {}",
            number + 1,
            round.gates.tried,
            significant(round.gates.gain(1), 3),
            significant(round.gates.material(), 3)
        );
        let _ = writeln!(
            out,
            "    {:<34} {:>9} {:>9} {:>9}  ",
            "fitted", "score", "gain", "unseen"
        );
        for trial in &round.trials {
            let _ = writeln!(
                out,
                "    {:<34} {:>9} {:>9} {:>9}  {}",
                named(&hypotheses[trial.hypothesis]),
                significant(trial.score, 3),
                significant(trial.gain, 3),
                trial
                    .fold_gain
                    .map_or_else(String::new, |gain| significant(gain, 3)),
                trial.rejected.map_or("", remark)
            );
        }
        for score in round.scores.iter().take(5) {
            let _ = writeln!(
                out,
                "    {:<34} {:>9}  {}",
                named(&hypotheses[score.hypothesis]),
                significant(score.gain(), 3),
                score.tried
            );
        }
    }
    out
}

fn remark(rejection: Rejection) -> &'static str {
    match rejection {
        Rejection::Score => "score too small",
        Rejection::Gain => "gain too small",
        Rejection::Folds => "not on unseen rows",
        Rejection::Bound => "on a bound",
        Rejection::Behind => "behind the best",
        Rejection::TooGood => "more than it can",
    }
}

fn sentence(hypotheses: &[Hypothesis], found: &Diagnosis) -> String {
    let names: Vec<String> = found
        .findings
        .iter()
        .map(|finding| named(&hypotheses[finding.hypothesis]))
        .collect();
    match found.verdict {
        Verdict::None => "no effect is missing that these records would show".to_owned(),
        Verdict::Unknown if names.is_empty() => {
            "something is missing, and no effect known is it".to_owned()
        }
        Verdict::Unknown => format!(
            "something is missing that is in no library; it was written as {}",
            names.join(", then ")
        ),
        Verdict::Effect => format!("missing is {}", names.join(", then ")),
        Verdict::OneOf => format!(
            "missing is {}, or what cannot be told from it",
            names.join(", then ")
        ),
    }
}

/// The diagnosis as JSON; numbers are SI.
fn report(
    plan: &DiagnosisPlan,
    calibration: &Calibration,
    hypotheses: &[Hypothesis],
    found: &Diagnosis,
) -> Value {
    let verdict = match found.verdict {
        Verdict::None => "none",
        Verdict::Effect => "effect",
        Verdict::OneOf => "one_of",
        Verdict::Unknown => "unknown",
    };
    let effects: Vec<Value> = found
        .findings
        .iter()
        .map(|finding| {
            let hypothesis = &hypotheses[finding.hypothesis];
            let quantity = |q: &hyde_calibrate::Quantity| {
                json!({ "value": q.value, "unit": q.unit, "interval": [q.interval.0, q.interval.1] })
            };
            let shape: serde_json::Map<String, Value> =
                finding.shapes.iter().map(|q| (q.name.clone(), quantity(q))).collect();
            let sizes: serde_json::Map<String, Value> =
                finding.sizes.iter().map(|q| (q.name.clone(), quantity(q))).collect();
            let one_of: Vec<Value> = finding
                .alternatives
                .iter()
                .map(|&other| json!({ "effect": hypotheses[other].effect, "site": hypotheses[other].site }))
                .collect();
            json!({
                "effect": hypothesis.effect,
                "site": hypothesis.site,
                "aliases": hypothesis.aliases,
                "size": finding.size.value,
                "unit": finding.size.unit,
                "interval": [finding.size.interval.0, finding.size.interval.1],
                "sizes": sizes,
                "shape": shape,
                "one_of": one_of,
            })
        })
        .collect();
    json!({
        "ok": true,
        "diagnosis": plan.name,
        "model": calibration.plan.model,
        "model_hash": calibration.project.hash,
        "verdict": verdict,
        "sentence": sentence(hypotheses, found),
        "effects": effects,
        "unexplained": found.unexplained,
        "unknown": found.unknown.as_ref().map(|own| unknown::report(own, found)),
    })
}
