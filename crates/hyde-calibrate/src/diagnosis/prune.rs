//! Drops effects that no longer pass their gate beside what was taken in after them.
//!
//! Effects mask each other: the first one taken in may have stood for two that came later. Each effect is taken out on its
//! own, everything else is fitted again, and the one that is missed least goes if it is missed by less than its gate
//! (backward elimination; Draper and Smith, Applied Regression Analysis, 3rd ed. 1998, section 15.2).

use super::evidence::Gates;
use super::hypothesis::{Build, Built};
use super::stage::{Ground, Stage, below};
use crate::fit::{MAX_STEPS, Objective, Slopes, Varied, inflation_of};
use nalgebra::DVector;

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
        let own = stage.sizes_of(&stage.effects[number].1);
        let gate = gates.gain(freedoms) * inflation_of(&stage.solution, own);
        if stage.solution.gain_over(&less.solution) >= gate.max(gates.material()) {
            break;
        }
        *stage = less;
        dropped.push(number);
    }
    dropped
}

/// The values of a stage once the sizes of an effect have gone to 0, by slopes: what had been led away by them comes back at
/// once, where a fit from where it is may be stuck.
fn answered(ground: &Ground<'_>, stage: &Stage, gone: &str) -> Vec<f64> {
    let values = &stage.solution.values;
    let sizes = stage.sizes_of(gone);
    let step = || {
        let covariance = stage.solution.inverse_curvature()?;
        let own = covariance.select_rows(&sizes).select_columns(&sizes);
        let to_nought = sizes
            .iter()
            .map(|&size| -values[size] / stage.varied[size].scale());
        let to_nought = DVector::from_iterator(sizes.len(), to_nought);
        Some(covariance.select_columns(&sizes) * own.try_inverse()? * to_nought)
    };
    let problem = ground.problem(&stage.program, &stage.varied, &[], None);
    step().map_or_else(|| values.clone(), |step| problem.moved(values, &step))
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
        if below(name, &gone).is_some() {
            return None;
        }
        let mut pairs = others.iter().zip(&paths);
        let own = pairs.find_map(|((_, old), new)| Some(format!("{new}.{}", below(name, old)?)));
        Some(own.unwrap_or_else(|| name.to_owned()))
    };
    let answered = answered(ground, stage, &gone);
    let (mut varied, mut start, mut follow) = (Vec::new(), Vec::new(), Vec::new());
    let values = stage.solution.values.iter().zip(&answered);
    for (known, (&value, &answered)) in stage.varied.iter().zip(values) {
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
        follow.push(answered);
    }
    let kept: Vec<(String, f64)> = stage
        .kept
        .iter()
        .filter_map(|(name, value)| Some((renamed(name)?, *value)))
        .collect();
    let set = ground.set_in(&program, &kept);
    let problem = ground.problem(&program, &varied, &set, None);
    let weight = stage.solution.weight;
    let cost = |values: &[f64]| problem.cost(values, weight).unwrap_or(f64::INFINITY);
    if cost(&follow) < cost(&start) {
        start = follow;
    }
    let solution = problem.solve_in(&start, MAX_STEPS, Slopes::Tangents).ok()?;
    Some(Stage {
        program,
        effects: list.into_iter().zip(paths).collect(),
        varied,
        kept,
        solution,
    })
}
