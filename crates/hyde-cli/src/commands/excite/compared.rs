//! Signals compared by what they would tell about the parameters of a model, or about effects.

use super::between::{self, Apart};
use super::wish::{self, Asked};
use super::{Failure, refused};
use crate::args::{Criterion, ExciteArgs, ModelArgs};
use crate::project::{Told as _, complain};
use crate::study;
use hyde_calibrate::{Information, Recording};
use hyde_signal::excite::{Bounds, Design};
use hyde_study::excitation::{Bench, Candidate, Failed, Room, candidates};
use hyde_units::NamedUnit;

/// A signal with what it would tell.
pub(super) struct Compared {
    pub(super) name: String,
    pub(super) design: Design,
    /// The part of its size that the travel leaves, of an effort.
    pub(super) part: f64,
    pub(super) information: Information,
    /// How far effects are apart, if that is asked.
    pub(super) apart: Option<Apart>,
}

/// All signals, and the one that is chosen.
pub(super) struct Comparison {
    pub(super) bench: Bench,
    pub(super) asked: Asked,
    pub(super) all: Vec<Compared>,
    pub(super) best: usize,
    /// Signals that cannot be made or recorded, with the reason.
    pub(super) unmade: Vec<(String, String)>,
}

/// Compares the signals that the options allow.
pub(super) fn compared(args: &ExciteArgs) -> Result<Comparison, Failure> {
    let model_args = model_args(args);
    let asked = wish::of(args).map_err(Failure::Asked)?;
    let wish = &asked.wish;
    let column = args.column.as_deref();
    let bench = study::bench(
        &model_args,
        args.study.as_deref(),
        wish.step_s,
        column,
        &wish.unit,
    );
    let mut bench = bench.map_err(Failure::Told)?;
    let effects = between::of(args, &model_args, &mut bench)?;
    let kinds: Vec<_> = args.signal.iter().map(|name| wish::shape(*name)).collect();
    let (made, unmade) = candidates(wish, &kinds);
    let mut unmade: Vec<(String, String)> = unmade
        .into_iter()
        .map(|own| (own.name, refused::reason(&own.reason, &own.wish)))
        .collect();
    let (mut all, mut first) = (Vec::new(), None);
    let room = room(args, &asked).map_err(Failure::Asked)?;
    for candidate in made {
        let name = candidate.name.clone();
        let found = of_candidate(room.as_ref(), &bench, candidate).and_then(|found| {
            let Some((mut own, recording)) = found else {
                return Ok(Err("no size of it keeps the travel and the speed"));
            };
            if let Some(effects) = &effects {
                match between::apart(&bench, effects, recording, args.size)? {
                    Some(apart) => own.apart = Some(apart),
                    None => {
                        return Ok(Err("a model with one of the effects cannot be observed"));
                    }
                }
            }
            Ok(Ok(own))
        });
        match found {
            Ok(Ok(own)) => all.push(own),
            Ok(Err(reason)) => unmade.push((name, reason.to_owned())),
            Err(failed) => {
                let diagnostic = bench.diagnostic(&name, &failed);
                unmade.push((name, diagnostic.message.clone()));
                first.get_or_insert(diagnostic);
            }
        }
    }
    let value = |own: &Compared| match (&own.apart, args.criterion) {
        (Some(apart), _) => -apart.least,
        (None, Criterion::D) => own.information.volume,
        (None, Criterion::A) => own.information.spread,
    };
    let best = (0..all.len()).min_by(|&i, &j| value(&all[i]).total_cmp(&value(&all[j])));
    if let (None, Some(diagnostic)) = (best, first) {
        bench.project.diagnostics.push(diagnostic);
        return Err(Failure::Told(bench.project.finish_with_errors(&model_args)));
    }
    let Some(best) = best else {
        let reasons = unmade
            .iter()
            .map(|(name, reason)| format!("  {name}: {reason}"));
        let reasons: Vec<String> = reasons.collect();
        return Err(Failure::Asked(format!(
            "no signal can be designed\n{}",
            reasons.join("\n")
        )));
    };
    Ok(Comparison {
        bench,
        asked,
        all,
        best,
        unmade,
    })
}

/// The model's file with what is set.
fn model_args(args: &ExciteArgs) -> ModelArgs {
    let file = args.file.clone().unwrap_or_default();
    ModelArgs {
        settings: args.settings.clone(),
        json: args.json,
        quiet: args.quiet,
        whole_library: !args.between.is_empty(),
        ..ModelArgs::of_file(&file)
    }
}

/// One signal: made small enough, simulated, observed; `None` if no size of it is small enough.
fn of_candidate(
    room: Option<&Room>,
    bench: &Bench,
    candidate: Candidate,
) -> Result<Option<(Compared, Recording)>, Failed> {
    let Candidate { name, design } = candidate;
    let held = match room {
        None => Some((design, 1.0)),
        Some(room) => bench.held(&design, room)?,
    };
    let Some((design, part)) = held else {
        return Ok(None);
    };
    let tables = bench.tables(&design.values(), design.wish.step_s);
    let told = bench.told(&name, &tables)?;
    let compared = Compared {
        name,
        design,
        part,
        information: told.information,
        apart: None,
    };
    Ok(Some((compared, told.recording)))
}

/// The travel and the speed that an effort leaves the axis, if they are limited.
fn room(args: &ExciteArgs, asked: &Asked) -> Result<Option<Room>, String> {
    if matches!(asked.wish.bounds, Bounds::Motion(_)) {
        return Ok(None);
    }
    let travel = wish::limit(args, 0)?;
    let speed = wish::limit(args, 1)?;
    let unit = match (&travel, &speed) {
        (None, None) => return Ok(None),
        (Some(travel), _) => travel.unit.clone(),
        (None, Some(speed)) => {
            let turns = wish::turns(&speed.unit, 1);
            NamedUnit::parse(if turns { "rad" } else { "m" }).map_err(|error| error.to_string())?
        }
    };
    Ok(Some(Room {
        unit,
        travel: travel.map(|own| own.value),
        speed: speed.map(|own| own.value),
    }))
}

/// Reports why there is no comparison.
pub(super) fn report(args: &ExciteArgs, reason: &str) -> crate::exit::Exit {
    complain(&model_args(args), crate::exit::Exit::CommandLine, reason)
}
