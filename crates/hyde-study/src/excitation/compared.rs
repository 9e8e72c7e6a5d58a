//! Signals compared by what they would tell about the parameters of a model, or about effects.

use super::bench::{Bench, Failed, bench};
use super::between::{self, Apart};
use super::candidates::{Candidate, candidates};
use super::held::Room;
use super::options::{Criterion, Options};
use super::refused;
use super::wish::{self, Wished};
use crate::{Asked, Fault, Loaded, Project, Refused};
use hyde_calibrate::{Information, Recording};
use hyde_diag::Diagnostic;
use hyde_signal::excite::{Bounds, Design};
use hyde_units::NamedUnit;

/// A signal with what it would tell.
pub struct Compared {
    /// Its name.
    pub name: String,
    /// The signal.
    pub design: Design,
    /// The part of its size that the travel leaves, of an effort.
    pub part: f64,
    /// What it would tell about the parameters.
    pub information: Information,
    /// How far effects are apart, if that is asked.
    pub apart: Option<Apart>,
}

/// All signals, and the one that is chosen.
pub struct Comparison {
    /// The model.
    pub bench: Bench,
    /// What was asked for.
    pub wished: Wished,
    /// All signals.
    pub all: Vec<Compared>,
    /// The number of the chosen one.
    pub best: usize,
    /// Signals that cannot be made or recorded, with the reason.
    pub unmade: Vec<(String, String)>,
}

/// Compares the signals that the options allow on the model of a calibration. `ready` gets the model before it is run.
///
/// # Errors
/// The model or the options are at fault, or no signal is possible.
pub fn compared(
    loaded: Loaded,
    asked: &Asked,
    study: Option<&str>,
    (options, wished): (&Options, Wished),
    ready: impl FnOnce(&Project),
) -> Result<Comparison, Refused> {
    let wish = &wished.wish;
    let column = options.column.as_deref();
    let mut bench = bench(loaded, asked, study, wish.step_s, column, &wish.unit)?;
    ready(&bench.project);
    let effects = match options.between.is_empty() {
        true => None,
        false if !(options.size > 0.0 && options.size <= 1.0) => {
            return Err(Refused::Asked(format!(
                "`--size {}` is not a part of a range\n  help: write a number above 0 and up to 1, `--size 0.1`",
                options.size
            )));
        }
        false => match bench.project.candidates() {
            Some(candidates) => Some(between::of(options, candidates).map_err(Refused::Asked)?),
            None => return Err(bench.project.refused(Fault::Model)),
        },
    };
    let signals = signals(&bench, options, &wished).map_err(Refused::Asked)?;
    let Signals {
        all: made,
        mut unmade,
        failed: mut first,
    } = signals;
    let mut all = Vec::new();
    for (mut own, recording) in made {
        let apart = match &effects {
            None => Ok(None),
            Some(effects) => bench
                .linearised(recording)
                .map(|record| Some(between::apart(&bench, effects, &record))),
        };
        match apart {
            Ok(None) => all.push(own),
            Ok(Some(Some(apart))) => {
                own.apart = Some(apart);
                all.push(own);
            }
            Ok(Some(None)) => {
                let reason = "a model with one of the effects cannot be observed";
                unmade.push((own.name, reason.to_owned()));
            }
            Err(failed) => {
                let diagnostic = bench.diagnostic(&own.name, &failed);
                unmade.push((own.name, diagnostic.message.clone()));
                first.get_or_insert(diagnostic);
            }
        }
    }
    let value = |own: &Compared| match (&own.apart, options.criterion) {
        (Some(apart), _) => -apart.least,
        (None, Criterion::D) => own.information.volume,
        (None, Criterion::A) => own.information.spread,
    };
    let best = (0..all.len()).min_by(|&i, &j| value(&all[i]).total_cmp(&value(&all[j])));
    match best {
        Some(best) => Ok(Comparison {
            bench,
            wished,
            all,
            best,
            unmade,
        }),
        None => Err(none(bench, &unmade, first)),
    }
}

/// The signals that options allow, each simulated and observed on a model without effects.
pub(crate) struct Signals {
    /// Those that can be made, with their records.
    pub(crate) all: Vec<(Compared, Recording)>,
    /// Those that cannot be made or recorded, with the reason.
    pub(crate) unmade: Vec<(String, String)>,
    /// What is wrong with the model on the first that cannot be recorded.
    pub(crate) failed: Option<Diagnostic>,
}

/// Makes and records the signals that options allow.
///
/// # Errors
/// An option is at fault.
pub(crate) fn signals(
    bench: &Bench,
    options: &Options,
    wished: &Wished,
) -> Result<Signals, String> {
    let (made, unmade) = candidates(&wished.wish, &options.signal);
    let unmade = unmade
        .into_iter()
        .map(|own| (own.name, refused::reason(&own.reason, &own.wish)));
    let mut signals = Signals {
        all: Vec::new(),
        unmade: unmade.collect(),
        failed: None,
    };
    let room = room(options, wished)?;
    for candidate in made {
        let name = candidate.name.clone();
        match of_candidate(room.as_ref(), bench, candidate) {
            Ok(Some(own)) => signals.all.push(own),
            Ok(None) => {
                let reason = "no size of it keeps the travel and the speed";
                signals.unmade.push((name, reason.to_owned()));
            }
            Err(failed) => {
                let diagnostic = bench.diagnostic(&name, &failed);
                signals.unmade.push((name, diagnostic.message.clone()));
                signals.failed.get_or_insert(diagnostic);
            }
        }
    }
    Ok(signals)
}

/// Why there is no signal at all.
pub(crate) fn none(
    mut bench: Bench,
    unmade: &[(String, String)],
    failed: Option<Diagnostic>,
) -> Refused {
    if let Some(diagnostic) = failed {
        bench.project.diagnostics.push(diagnostic);
        return bench.project.refused(Fault::Model);
    }
    let reasons = unmade
        .iter()
        .map(|(name, reason)| format!("  {name}: {reason}"));
    let reasons: Vec<String> = reasons.collect();
    Refused::Asked(format!("no signal can be designed\n{}", reasons.join("\n")))
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
fn room(options: &Options, wished: &Wished) -> Result<Option<Room>, String> {
    if matches!(wished.wish.bounds, Bounds::Motion(_)) {
        return Ok(None);
    }
    let travel = wish::limit(options, 0)?;
    let speed = wish::limit(options, 1)?;
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
