//! Drops effects that no longer pass their gate beside what was taken in after them.
//!
//! Effects mask each other: the first one taken in may have stood for two that came later. Each effect is taken out on its
//! own, everything else is fitted again, and the one that is missed least goes if it is missed by less than its gate
//! (backward elimination; Draper and Smith, Applied Regression Analysis, 3rd ed. 1998, section 15.2).

use super::hypothesis::{Build, Built};
use super::search::Gates;
use super::stage::{Ground, Stage};
use crate::fit::inflation;
use crate::least_squares::{MAX_STEPS, Slopes};
use crate::varied::Varied;

/// The places among the effects of those that were dropped, in the order in which they were.
pub(crate) fn prune(
    ground: &Ground<'_>,
    stage: &mut Stage,
    build: &Build<'_>,
    gates: Gates,
) -> Vec<usize> {
    let mut dropped = Vec::new();
    while stage.effects.len() > 1 {
        let without: Vec<(usize, Stage)> = (0..stage.effects.len())
            .filter_map(|number| Some((number, without(ground, stage, number, build)?)))
            .collect();
        let least = without
            .into_iter()
            .min_by(|a, b| a.1.solution.cost().total_cmp(&b.1.solution.cost()));
        let Some((number, less)) = least else { break };
        let freedoms = stage.varied.len() - less.varied.len();
        let gate = gates.gain(freedoms) * inflation(&stage.solution.innovations);
        if stage.solution.gain_over(&less.solution) >= gate.max(gates.material()) {
            break;
        }
        *stage = less;
        dropped.push(number);
    }
    dropped
}

/// The stage fitted without one of its effects; `None` where it cannot be run.
pub(crate) fn without(
    ground: &Ground<'_>,
    stage: &Stage,
    number: usize,
    build: &Build<'_>,
) -> Option<Stage> {
    let mut others = stage.effects.clone();
    let (_, gone) = others.remove(number);
    let list: Vec<usize> = others.iter().map(|(effect, _)| *effect).collect();
    let Built { program, paths } = build(&list)?;
    // The second of an effect at a site has another name where the first is gone.
    let renamed = |name: &str| -> Option<String> {
        let below = |path: &str| name.strip_prefix(path)?.strip_prefix('.');
        if below(&gone).is_some() {
            return None;
        }
        let mut pairs = others.iter().zip(&paths);
        let own = pairs.find_map(|((_, old), new)| Some(format!("{new}.{}", below(old)?)));
        Some(own.unwrap_or_else(|| name.to_owned()))
    };
    let (mut varied, mut start) = (Vec::new(), Vec::new());
    for (known, &value) in stage.varied.iter().zip(&stage.solution.values) {
        let Some(name) = renamed(&known.name) else {
            continue;
        };
        let (parameter, element) = program.parameter(&name)?;
        varied.push(Varied {
            place: parameter.place + element,
            name,
            ..known.clone()
        });
        start.push(value);
    }
    let kept: Vec<(String, f64)> = stage
        .kept
        .iter()
        .filter_map(|(name, value)| Some((renamed(name)?, *value)))
        .collect();
    let set = ground.set_in(&program, &kept);
    let solution = ground
        .problem(&program, &varied, &set, None)
        .solve_in(&start, MAX_STEPS, Slopes::Tangents)
        .ok()?;
    Some(Stage {
        program,
        effects: list.into_iter().zip(paths).collect(),
        varied,
        kept,
        solution,
    })
}
