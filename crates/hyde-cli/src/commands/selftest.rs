//! `hyde selftest`: what the verdicts of a diagnosis are worth on this axis, with these sensors and these records.
//!
//! ```text
//! models        programs of the axis with effects put on, the observed ones made once   selftest/models.rs
//! work          what is missing, case by case, on all cores, kept as it finishes        selftest/work.rs
//! kept          an outcome as bytes and back                                            selftest/kept.rs
//! text, json    the tables                                                              selftest/text.rs, json.rs
//! records       the simulated records of one case as files                              selftest/records.rs
//! ```

mod json;
mod kept;
mod models;
mod records;
mod text;
mod work;

use crate::args::{CaseKind, SelftestArgs};
use crate::batch::store::Journals;
use crate::exit::Exit;
use crate::files;
use crate::interruption;
use crate::project::{Told as _, complain, print_error, print_output};
use crate::study;
use hyde_calibrate::{
    Asked, Axis, Case, Hypothesis, Planting, SelftestError, Size, Tally, Written, cases, tally,
};
use hyde_compiler::{Candidate, DiagnosisPlan};
use hyde_experiment::batch::{Identity, digest};
use hyde_signal::Table;
use hyde_study::Calibration;
use hyde_study::Store;
use hyde_study::diagnosed;
use hyde_study::unknown;
use hyde_units::counted;
use models::Models;
use serde_json::json;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

/// Everything that is told.
pub(super) struct Told<'a> {
    pub(super) plan: &'a DiagnosisPlan,
    pub(super) seed: u64,
    pub(super) asked: &'a Asked,
    pub(super) hypotheses: &'a [Hypothesis],
    pub(super) outcomes: &'a [(Case, kept::Kept)],
    pub(super) table: &'a Tally,
    /// Effects of the diagnosis that fit nowhere on the model.
    pub(super) siteless: Vec<String>,
}

/// Plants, diagnoses, counts.
pub(crate) fn selftest(args: &SelftestArgs) -> Exit {
    match tested(args) {
        Ok(exit) | Err(exit) => exit,
    }
}

fn tested(args: &SelftestArgs) -> Result<Exit, Exit> {
    let model_args = args.study.model_args();
    let refused = |reason: String| complain(&model_args, Exit::CommandLine, &reason);
    args.study.use_jobs().map_err(refused)?;
    let asked = asked(args).map_err(refused)?;
    let (plan, mut calibration) = study::diagnosis(&args.study)?;
    let candidates = calibration.project.candidates_or_report(&model_args)?;
    let sites = calibration.project.law_sites_or_report(&model_args)?;
    let sites: Vec<_> = sites.into_iter().map(unknown::site).collect();
    let candidates: Vec<Candidate> = candidates
        .into_iter()
        .filter(|candidate| plan.selects(candidate))
        .collect();
    let hypotheses: Vec<Hypothesis> = candidates.iter().map(diagnosed::hypothesis).collect();
    let seed = args.seed.unwrap_or(plan.seed);
    let channels: Vec<String> = {
        let measured = &calibration.compiled.program.experiment.measured;
        measured.iter().map(|m| m.name.clone()).collect()
    };
    let all = cases(&hypotheses, &calibration.varied, &channels, &asked);
    let all = chosen(args, all, &hypotheses).map_err(refused)?;
    let records: Vec<BTreeMap<String, Table>> = calibration
        .fitted
        .iter()
        .map(|recording| recording.tables.clone())
        .collect();
    let identity = identity(&calibration, &plan, seed, &records);
    let set = calibration.project.set();
    let outcomes = {
        let models = Models::new(&calibration.project, &candidates);
        let simulate = |numbers: &[usize], sizes: &[f64], shapes: &[f64]| {
            models.recorded(numbers, sizes, shapes)
        };
        let author = |numbers: &[usize], written: &[Written]| models.observed(numbers, written);
        let interrupted = interruption::interrupted();
        let axis = Axis::new(
            &calibration.compiled.program,
            &records,
            &calibration.varied,
            &set,
            &hypotheses,
            (&sites, &author),
            &simulate,
            plan.max_effects,
            seed,
            Arc::clone(&interrupted),
        );
        match axis {
            Err(SelftestError::Interrupted) => return Ok(Exit::Interrupted),
            Err(error) => Err(error),
            Ok(axis) => {
                if let (Some(name), Some(folder)) = (&args.case, &args.out) {
                    let case = all.iter().find(|case| case.key == *name).ok_or_else(|| {
                        refused(format!("no case is called `{name}`; `--json` lists them"))
                    })?;
                    return records::leave(&axis, case, &calibration, folder)
                        .map(|()| Exit::Done)
                        .map_err(refused);
                }
                let store = match &args.out {
                    Some(folder) => with_program(&identity)
                        .and_then(|own| store(folder, own))
                        .map(Some),
                    None => Ok(None),
                };
                let store = store.map_err(refused)?;
                let quiet = args.study.json || args.study.quiet;
                match work::outcomes(
                    &axis,
                    all,
                    store.as_ref().map(|own| own as &dyn Store),
                    quiet,
                ) {
                    Ok(outcomes) => Ok(outcomes),
                    Err(work::Ended::Store(reason)) => return Err(refused(reason)),
                    Err(work::Ended::Interrupted(done, total)) => {
                        let kept = match &args.out {
                            Some(folder) => {
                                format!(
                                    "; they are kept in `{}`: run the command again to resume",
                                    folder.display()
                                )
                            }
                            None => "; use `--out DIR` to keep finished cases".to_owned(),
                        };
                        print_error(&format!(
                            "interrupted after {done} of {}{kept}",
                            counted(total, "case")
                        ));
                        return Ok(Exit::Interrupted);
                    }
                }
            }
        }
    };
    let outcomes = match outcomes {
        Ok(outcomes) => outcomes,
        Err(error) => {
            let diagnostic = work::cannot(&error, plan.span);
            calibration.project.diagnostics.push(diagnostic);
            return Err(calibration.project.finish_with_errors(&model_args));
        }
    };
    let found: Vec<_> = outcomes
        .iter()
        .filter_map(|(case, kept)| Some((case, kept.as_ref().ok()?.clone())))
        .collect();
    let confounds = |number: usize, other: usize| {
        let name = candidates[other].name();
        candidates[number]
            .confounds
            .iter()
            .any(|known| known == name)
    };
    let told = Told {
        plan: &plan,
        seed,
        asked: &asked,
        table: &tally(&found, &confounds),
        siteless: siteless(&calibration, &plan, &candidates),
        hypotheses: &hypotheses,
        outcomes: &outcomes,
    };
    let report = format!("{:#}", json::report(&told));
    if let Some(folder) = &args.out {
        let path = folder.join("selftest.json");
        files::write(&path, format!("{report}\n").as_bytes()).map_err(refused)?;
    }
    if args.study.json {
        print_output(&report);
    } else if !args.study.quiet {
        print_output(text::text(&told).trim_end());
    }
    Ok(Exit::Done)
}

/// The cases that the arguments ask for.
fn asked(args: &SelftestArgs) -> Result<Asked, String> {
    let size = |text: &String| {
        let times = text.strip_suffix('x');
        let number = times.unwrap_or(text).trim().parse::<f64>().ok();
        match (number.filter(|number| *number > 0.0), times) {
            (Some(number), Some(_)) => Ok(Size::Detectable(number)),
            (Some(number), None) if number <= 1.0 => Ok(Size::Part(number)),
            (Some(_) | None, _) => Err(format!(
                "`{text}` is not a size: write a fraction of the range, `0.1`, or a multiple of the smallest detectable size, `2x`"
            )),
        }
    };
    let sizes: Result<Vec<Size>, String> = args.sizes.iter().map(size).collect();
    let wanted = |kind| args.only.is_empty() || args.only.contains(&kind);
    Ok(Asked {
        sizes: sizes?,
        seeds: args.seeds.max(1),
        empties: if wanted(CaseKind::Empty) {
            args.empties
        } else {
            0
        },
        planted: wanted(CaseKind::Planted),
        parameters: wanted(CaseKind::Parameters),
        open_set: wanted(CaseKind::Unknown),
        sensors: wanted(CaseKind::Sensors),
    })
}

/// The cases left of the effects named, and of the planted ones a sample.
fn chosen(
    args: &SelftestArgs,
    mut all: Vec<Case>,
    hypotheses: &[Hypothesis],
) -> Result<Vec<Case>, String> {
    let known = |name: &String| hypotheses.iter().any(|h| h.effect == *name);
    if let Some(unknown) = args.effects.iter().find(|name| !known(name)) {
        return Err(format!(
            "this diagnosis has no effect `{unknown}` with a site on the model; `hyde effects FILE` lists them"
        ));
    }
    all.retain(|case| match case.kind {
        Planting::Planted(number, _) | Planting::OpenSet(number, _) => {
            args.effects.is_empty() || args.effects.contains(&hypotheses[number].effect)
        }
        Planting::Empty | Planting::Parameter(_) | Planting::Sensor(..) => true,
    });
    let is_planted = |case: &Case| matches!(case.kind, Planting::Planted(..));
    let count = all.iter().filter(|case| is_planted(case)).count();
    if let Some(most) = args.sample.filter(|most| *most < count) {
        let mut number = 0;
        all.retain(|case| {
            if !is_planted(case) {
                return true;
            }
            number += 1;
            number * most / count > (number - 1) * most / count
        });
    }
    Ok(all)
}

/// Effects that the diagnosis names and the model has no site for.
fn siteless(
    calibration: &Calibration,
    plan: &DiagnosisPlan,
    candidates: &[Candidate],
) -> Vec<String> {
    let names = calibration.project.file.effects_known();
    let selected = |full: &String| {
        plan.candidates.iter().any(|pattern| {
            let package = pattern.strip_suffix(".*");
            package.map_or(pattern == full, |package| {
                full.strip_prefix(package)
                    .is_some_and(|rest| rest.starts_with('.'))
            })
        })
    };
    let short = |full: String| full.rsplit('.').next().unwrap_or_default().to_owned();
    names
        .filter(selected)
        .map(short)
        .filter(|name| !candidates.iter().any(|candidate| candidate.name() == name))
        .collect()
}

/// The store of a folder; cases of another axis, seed or program are in others beside it.
fn store(folder: &Path, identity: Identity) -> Result<Journals, String> {
    files::make_folder(folder)?;
    let own: String = identity.0[..6].iter().map(|b| format!("{b:02x}")).collect();
    Journals::open(&folder.join(format!("journal-{own}")), identity)
}

/// The identity with that of this very program: another one may judge otherwise.
fn with_program(identity: &Identity) -> Result<Identity, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    Ok(digest(&[&identity.0, &files::read(&program)?]))
}

/// What decides the outcome of a case beside its name: all texts of the model and the library, the records, the seed.
fn identity(
    calibration: &Calibration,
    plan: &DiagnosisPlan,
    seed: u64,
    records: &[BTreeMap<String, Table>],
) -> Identity {
    let sources: Vec<&[u8]> = calibration
        .project
        .sources
        .iter()
        .map(|(_, source)| source.text.as_bytes())
        .collect();
    let mut numbers = Vec::new();
    for column in records
        .iter()
        .flat_map(BTreeMap::values)
        .flat_map(Table::columns)
    {
        numbers.extend(
            column
                .values()
                .iter()
                .flat_map(|value| value.to_bits().to_le_bytes()),
        );
    }
    let set = calibration.project.set();
    let order = json!({ "diagnosis": plan.name, "seed": seed, "set": set, "hyde": env!("CARGO_PKG_VERSION") });
    digest(&[
        &digest(&sources).0,
        &digest(&[&numbers]).0,
        order.to_string().as_bytes(),
    ])
}
