//! [`Trial`]: a hypothesis fitted together with all parameters, and judged on halves of the records that its fit has not
//! seen.

use super::evidence::Gates;
use super::hypothesis::{Build, Built, Hypothesis, is_on_bound};
use super::scan::{Node, Score};
use super::stage::{Ground, Stage};
use super::undetermined;
use super::unknowns::{Refit, Unknowns};
use crate::fit::{
    Fold, Goal, LAST_STEPS, MAX_STEPS, Objective, Slopes, Solution, Varied, covariance,
    covariance_of_first, inflation_of,
};
use crate::observer::Innovations;
use hyde_program::Program;
use hyde_signal::statistics::distributions::{OUTSIDE, TWO_SIDED, chi_squared};
use nalgebra::DVector;
use std::ops::Range;

/// Numerics: steps from a node before nodes are compared, and twice as many from the whole fit to that of a half: laws that are
/// far from linear need more than one or two.
const FIRST_STEPS: usize = 3;

/// Why a hypothesis was not taken in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rejection {
    /// The scan gains too little.
    Score,
    /// The fit gains too little.
    Gain,
    /// It gains too little on what it was not fitted to.
    Folds,
    /// A size is on its bound.
    Bound,
    /// Another one gains more.
    Behind,
    /// The fit gains far more than the scan, which a linear effect cannot.
    TooGood,
    /// The same effect is there already, with nearly the same period, order or frequency.
    Twice,
}

/// A hypothesis after its fit.
pub struct Trial {
    /// Number of the hypothesis.
    pub hypothesis: usize,
    /// What the scan gained.
    pub score: f64,
    /// What the fit gained of the sum of squares.
    pub gain: f64,
    /// What was gained on the halves of the records that fits had not seen.
    pub fold_gain: Option<f64>,
    /// By how much innovations tell less of its sizes than independent ones, after it.
    pub inflation: f64,
    /// Number of sizes and shapes fitted.
    pub freedoms: usize,
    /// A shape stands on a bound that is neither its declared value nor 0: of its kind, the effect is not this one. Or a size
    /// is larger than any that is usual.
    pub limited: bool,
    /// Why it was not taken in.
    pub rejected: Option<Rejection>,
    /// Sizes, then shapes, SI.
    pub values: Vec<f64>,
    names: Vec<String>,
    /// Numbers of the sizes among what its stage varies, and whether it is linear in them.
    own: Range<usize>,
    /// How many of them make it what it is ([`Hypothesis::essential`]).
    essential: usize,
    linear: bool,
    /// Whether it was fitted on by differences.
    refined: bool,
    pub(crate) stage: Stage,
}

impl Trial {
    /// The names of its sizes.
    pub(super) fn sizes(&self) -> impl Iterator<Item = &str> {
        let own = self.stage.varied[self.own.clone()].iter();
        own.map(|varied| varied.name.as_str())
    }

    /// Whether it passed every gate, or another one is merely ahead of it.
    pub(super) fn passed(&self) -> bool {
        matches!(self.rejected, None | Some(Rejection::Behind))
    }

    /// Whether it gained too little only for what else is missing, which inflates its gate.
    pub(super) fn would_pass(&self, gates: Gates) -> bool {
        let by_size = [Rejection::Score, Rejection::Gain, Rejection::Folds];
        let of_size = self.rejected.is_some_and(|own| by_size.contains(&own));
        of_size && self.gain >= gates.gain(self.freedoms)
    }

    /// What it has to gain.
    pub(super) fn gate(&self, gates: Gates) -> f64 {
        gates.gain(self.freedoms) * self.inflation
    }

    /// Whether its sizes are told from 0 beyond chance by the slopes too, its shapes held, where it is linear: a fit that was stuck before
    /// gains by every column that moves it on. Only what makes it what it is counts.
    pub(super) fn is_told(&self) -> bool {
        if !self.linear {
            return true;
        }
        let sizes = self.own.clone();
        let solution = &self.stage.solution;
        let covariance = covariance_of_first(solution, self.inflation, sizes.end);
        let count = self.essential.min(sizes.len());
        let essential = sizes.start..sizes.start + count;
        let varied = &self.stage.varied[essential.clone()];
        let pairs = varied.iter().zip(&solution.values[essential]);
        let values: Vec<f64> = pairs.map(|(own, value)| value / own.scale()).collect();
        let values = DVector::from_vec(values);
        let own = covariance.view((sizes.start, sizes.start), (count, count));
        let inverse = own.into_owned().try_inverse();
        inverse.is_some_and(|inverse| {
            (values.transpose() * inverse * values)[0] >= chi_squared(count, OUTSIDE)
        })
    }

    /// Whether the 95 % interval of one of its sizes at least leaves out 0, its shapes fitted beside them: a size and a shape
    /// that make up for each other without end say that the law has another form.
    pub(super) fn tells_a_size(&self) -> bool {
        let solution = &self.stage.solution;
        let covariance = covariance(solution, self.inflation);
        self.own.clone().any(|size| {
            let deviation = covariance[(size, size)].max(0.0).sqrt();
            (solution.values[size] / self.stage.varied[size].scale()).abs() > TWO_SIDED * deviation
        })
    }

    /// Fits on by differences of runs, as long as that gains and a goal is in reach; once.
    pub(super) fn refine(&mut self, ground: &Ground<'_>, stage: &Stage, goal: Goal<'_>) {
        if std::mem::replace(&mut self.refined, true) {
            return;
        }
        let own = &self.stage;
        let set = ground.set_in(&own.program, &own.kept);
        let problem = ground.problem(&own.program, &own.varied, &set, None);
        let Ok(solution) = problem.solve_for(
            Some(goal),
            &own.solution.values,
            LAST_STEPS,
            Slopes::Differences,
        ) else {
            return;
        };
        self.settle(solution, stage);
    }

    /// Ends at a solution.
    pub(super) fn settle(&mut self, solution: Solution, stage: &Stage) {
        self.gain = solution.gain_over(&stage.solution);
        self.inflation = inflation_of(&solution, self.own.clone());
        self.stage.solution = solution;
        self.values = values_of(&self.names, &self.stage);
    }
}

/// A hypothesis fitted in a few steps.
pub(crate) struct Begun<'s> {
    score: &'s Score,
    program: Program,
    effects: Vec<(usize, String)>,
    refit: Refit,
    /// What it gains so far.
    pub(crate) gain: f64,
}

impl Begun<'_> {
    /// Where it is after its few steps.
    pub(super) fn solution(&self) -> &Solution {
        &self.refit.0
    }
}

/// Fits a law from its best nodes; `None` where it cannot be run. It was chosen by slopes: where they lead astray it is none.
pub(crate) fn trial(
    ground: &Ground<'_>,
    stage: &Stage,
    hypotheses: &[Hypothesis],
    score: &Score,
    build: &Build<'_>,
) -> Option<Trial> {
    let begun = begin(ground, stage, hypotheses, score, build, false)?;
    finish(ground, stage, hypotheses, begun, true, None)
}

/// Fits a hypothesis in a few steps from each of its best nodes, and if it may begin `anew` and slopes at these lead astray,
/// from where there is no effect yet; `None` where it cannot be run.
pub(crate) fn begin<'s>(
    ground: &Ground<'_>,
    stage: &Stage,
    hypotheses: &[Hypothesis],
    score: &'s Score,
    build: &Build<'_>,
    anew: bool,
) -> Option<Begun<'s>> {
    let hypothesis = &hypotheses[score.hypothesis];
    let list = stage.numbers_with(&[score.hypothesis]);
    let Built { program, paths } = build(&list)?;
    let own_path = paths.last()?.clone();
    let from = |node: &Node| -> Option<Refit> {
        let mut unknowns = Unknowns::of(stage, &program);
        unknowns.add(&program, hypothesis, &own_path, node);
        unknowns.fitted(ground, &program, FIRST_STEPS)
    };
    let better = |known: Option<Refit>, other: Refit| match known {
        Some(known) if other.0.gain_over(&known.0) <= 0.0 => Some(known),
        Some(_) | None => Some(other),
    };
    // A few steps from every node, the rest from the best of them.
    let nodes = score.nodes.iter();
    let nodes = nodes.filter(|node| node.gain >= ground.thresholds.rival * score.gain());
    let mut best = nodes.filter_map(from).fold(None, better);
    let gains = |(own, ..): &Refit| own.gain_over(&stage.solution) > 0.0;
    if anew && !best.as_ref().is_some_and(gains) {
        let other = score.nodes.first().and_then(|node| from(&node.without()));
        best = other.into_iter().fold(best, better);
    }
    let refit = best?;
    Some(Begun {
        score,
        program,
        effects: list.into_iter().zip(paths).collect(),
        gain: refit.0.gain_over(&stage.solution),
        refit,
    })
}

/// The stage with hypotheses fitted together, each from a node; `None` where they cannot be run.
pub(crate) fn together(
    ground: &Ground<'_>,
    stage: &Stage,
    hypotheses: &[Hypothesis],
    nodes: &[(usize, Node)],
    build: &Build<'_>,
) -> Option<Stage> {
    let own: Vec<usize> = nodes.iter().map(|(own, _)| *own).collect();
    let list = stage.numbers_with(&own);
    let Built { program, paths } = build(&list)?;
    let mut unknowns = Unknowns::of(stage, &program);
    let own_paths = &paths[stage.effects.len()..];
    for ((number, node), path) in nodes.iter().zip(own_paths) {
        unknowns.add(&program, &hypotheses[*number], path, node);
    }
    let (solution, varied, kept) = unknowns.fitted(ground, &program, MAX_STEPS)?;
    Some(Stage {
        effects: list.into_iter().zip(paths).collect(),
        program,
        varied,
        kept,
        solution,
    })
}

/// Fits to the end what has begun, if it is worth it, and as long as a goal is in reach.
pub(crate) fn finish(
    ground: &Ground<'_>,
    stage: &Stage,
    hypotheses: &[Hypothesis],
    begun: Begun<'_>,
    worth: bool,
    goal: Option<Goal<'_>>,
) -> Option<Trial> {
    let Begun {
        score,
        program,
        effects,
        refit: (mut solution, mut varied, mut kept),
        ..
    } = begun;
    let hypothesis = &hypotheses[score.hypothesis];
    let own_path = effects.last()?.1.clone();
    let fit = |from: &[f64], varied: &[Varied], kept: &[(String, f64)], slopes: Slopes| {
        let set = ground.set_in(&program, kept);
        let steps = match slopes {
            Slopes::Tangents => MAX_STEPS,
            Slopes::Differences => LAST_STEPS,
        };
        let problem = ground.problem(&program, varied, &set, None);
        problem.solve_for(goal, from, steps, slopes).ok()
    };
    if worth && !solution.converged {
        solution = fit(&solution.values, &varied, &kept, Slopes::Tangents)?;
    }
    // What slopes along one run do not bring to its end, differences do.
    let reached = goal.is_none_or(|goal| goal.is_reached_by(&solution));
    if worth && reached && !solution.converged {
        let end = fit(&solution.values, &varied, &kept, Slopes::Differences);
        solution = end.unwrap_or(solution);
    }
    let mut own = stage.varied.len()..varied.len();
    let sizes = own.start..own.start + hypothesis.sizes.len().min(own.len());
    // A size may be larger than any that is usual, and is found then, though not without doubt.
    let large = worth
        && widen(
            &mut varied[sizes.clone()],
            &solution.values[sizes.clone()],
            ground.thresholds.room,
        );
    if large {
        solution = fit(&solution.values, &varied, &kept, Slopes::Tangents)?;
    }
    if worth {
        let (mut fewer, mut values) = (varied.clone(), solution.values.clone());
        let (shapes, all) = (&hypothesis.shapes, own.clone());
        let essential = sizes.start..sizes.end.min(sizes.start + hypothesis.essential());
        let undetermined =
            undetermined::held(&solution, &mut fewer, &mut values, shapes, all, essential);
        if !undetermined.is_empty() {
            let count = undetermined.len();
            let more = [kept.as_slice(), &undetermined].concat();
            let fitted = fit(&values, &fewer, &more, Slopes::Tangents)?;
            if fitted.cost() - solution.cost() <= undetermined::given_up(&solution, count) {
                (solution, varied, kept) = (fitted, fewer, more);
                own.end = varied.len();
            }
        }
    }
    let at_bound = sizes
        .clone()
        .any(|size| is_on_bound(solution.values[size], varied[size].bounds));
    let limited = large
        || (sizes.end..own.end).any(|number| {
            let mut shapes = hypothesis.shapes.iter();
            let name = &varied[number].name;
            let own = shapes.find(|shape| name.ends_with(&format!(".{}", shape.name)));
            own.is_some_and(|shape| shape.is_at_bound(solution.values[number]))
        });
    let gain = solution.gain_over(&stage.solution);
    let innovations = solution.innovations.iter().map(Innovations::count);
    let remainder = ground.thresholds.remainder * innovations.sum::<usize>() as f64;
    let rejected = if !worth {
        Some(Rejection::Behind)
    } else if at_bound {
        Some(Rejection::Bound)
    } else if score.linear && gain > ground.thresholds.too_good * score.gain() && gain < remainder {
        Some(Rejection::TooGood)
    } else {
        None
    };
    let inflation = inflation_of(&solution, sizes.clone());
    let names = [
        Hypothesis::names(&hypothesis.sizes, &own_path),
        Hypothesis::names(&hypothesis.shapes, &own_path),
    ]
    .concat();
    let new = Stage {
        program,
        effects,
        varied,
        kept,
        solution,
    };
    let twice = || {
        new.has_one_twice(hypotheses, ground.thresholds.alike)
            .then_some(Rejection::Twice)
    };
    Some(Trial {
        hypothesis: score.hypothesis,
        score: score.gain(),
        gain,
        fold_gain: None,
        inflation,
        freedoms: own.len(),
        limited,
        own: sizes,
        essential: hypothesis.essential(),
        linear: score.linear,
        refined: false,
        rejected: rejected.or_else(twice),
        values: values_of(&names, &new),
        names,
        stage: new,
    })
}

/// Gives sizes that stand on a bound other than 0 room beyond it, so many times as far; whether any does.
fn widen(sizes: &mut [Varied], values: &[f64], times: f64) -> bool {
    let mut any = false;
    for (size, &value) in sizes.iter_mut().zip(values) {
        if is_on_bound(value, size.bounds) && value != 0.0 {
            let (low, high) = size.bounds;
            size.bounds = match value > 0.0 {
                true => (low, times * high),
                false => (times * low, high),
            };
            any = true;
        }
    }
    any
}

/// What a stage has for some names.
fn values_of(names: &[String], stage: &Stage) -> Vec<f64> {
    let values = stage.values();
    let value = |name: &String| {
        let known = values.iter().rev().find(|(known, _)| known == name);
        known.map_or(f64::NAN, |(_, value)| *value)
    };
    names.iter().map(value).collect()
}

/// The costs on each half of the records after a fit to the other, together.
pub(crate) fn unseen(ground: &Ground<'_>, stage: &Stage) -> Option<f64> {
    let set = ground.set_in(&stage.program, &stage.kept);
    let half = |odd: bool| -> Option<f64> {
        let fold = Fold { odd };
        let seen = ground.problem(&stage.program, &stage.varied, &set, Some(fold));
        let solution = seen
            .solve_in(&stage.solution.values, 2 * FIRST_STEPS, Slopes::Tangents)
            .ok()?;
        let other = ground.problem(&stage.program, &stage.varied, &set, Some(fold.other()));
        let innovations = other.innovations(&solution.values).ok()?;
        Some(innovations.iter().map(Innovations::sum_of_squares).sum())
    };
    let (even, odd) = rayon::join(|| half(false), || half(true));
    Some(even? + odd?)
}
