//! [`spread`]: intervals over all values that the records allow of shapes that they do not determine.
//!
//! A shape that the records do not determine stays as declared ([`super::undetermined`]), or where its fit ended. What is told
//! of everything else would then be true for that value alone, and for what is near. So the shape goes to either end of
//! what the records allow it, the rest is fitted there, and every interval takes in those that are found: of a drift that has
//! only begun, the size in the end goes with its time constant.

use super::finding::{Finding, Quantity, findings};
use super::hypothesis::{Hypothesis, Knob};
use super::stage::{Ground, Stage};
use super::undetermined::given_up;
use crate::fit::{MAX_STEPS, Objective, Slopes, covariance, inflation};
use crate::plant::Unsupported;
use hyde_signal::statistics::distributions::TWO_SIDED;

/// Numerics: bisections of the way to the end of a range, for the last value that the records allow.
const BISECTIONS: usize = 5;

/// Numerics: a shape whose interval reaches this part of its value is followed by fits: curvature knows what is near.
const LOOSE: f64 = 0.5;

/// What was found, its intervals those over all values that the records allow of shapes that they do not determine.
///
/// # Errors
/// The model has no fixed-step form.
pub(super) fn spread(
    ground: &Ground<'_>,
    hypotheses: &[Hypothesis],
    stage: &Stage,
    mut found: Vec<Finding>,
) -> Result<Vec<Finding>, Unsupported> {
    for (number, (effect, path)) in stage.effects.iter().enumerate() {
        let hypothesis = &hypotheses[*effect];
        for (place, shape) in hypothesis.shapes.iter().enumerate() {
            let name = format!("{path}.{}", shape.name);
            if shape.integer || hypothesis.periodic == Some(place) {
                continue;
            }
            let Some((base, kept)) = undetermined(ground, stage, shape, &name)? else {
                continue;
            };
            let (low, high) = rayon::join(
                || allowed(ground, &base, kept, shape.range.0),
                || allowed(ground, &base, kept, shape.range.1),
            );
            for end in [&low, &high] {
                let there = findings(end, hypotheses, found.iter().map(Finding::taken).collect());
                found = found.into_iter().zip(there).map(united).collect();
            }
            found[number].shapes[place].interval = (low.kept[kept].1, high.kept[kept].1);
        }
    }
    Ok(found)
}

/// The stage with a shape that its records do not determine among what is kept, and its number there; `None` where they do.
fn undetermined(
    ground: &Ground<'_>,
    stage: &Stage,
    shape: &Knob,
    name: &str,
) -> Result<Option<(Stage, usize)>, Unsupported> {
    if let Some(kept) = stage.kept.iter().position(|(own, _)| own == name) {
        let as_declared = stage.kept[kept].1.to_bits() == shape.value.to_bits();
        return Ok(as_declared.then(|| (stage.clone(), kept)));
    }
    let Some(number) = stage.varied.iter().position(|own| own.name == name) else {
        return Ok(None);
    };
    let solution = &stage.solution;
    let covariance = covariance(solution, inflation(&solution.innovations));
    let half = TWO_SIDED * covariance[(number, number)].max(0.0).sqrt();
    let value = solution.values[number];
    if half * stage.varied[number].scale() <= LOOSE * value.abs() {
        return Ok(None);
    }
    let mut base = stage.clone();
    base.varied.remove(number);
    base.kept.push((name.to_owned(), value));
    let mut start = solution.values.clone();
    start.remove(number);
    let set = ground.set_in(&base.program, &base.kept);
    let problem = ground.problem(&base.program, &base.varied, &set, None);
    base.solution = problem.solve_in(&start, MAX_STEPS, Slopes::Tangents)?;
    let kept = base.kept.len() - 1;
    Ok(Some((base, kept)))
}

/// The stage with a number that is kept as near to an end of its range as the records allow, everything else fitted. A value
/// with which the model cannot be run is not allowed.
fn allowed(ground: &Ground<'_>, stage: &Stage, kept: usize, end: f64) -> Stage {
    let most = stage.solution.cost() + given_up(&stage.solution, 1);
    let begin = stage.kept[kept].1;
    let mut best = stage.clone();
    // The part of the way that is known to be allowed, one that is not, and the one to look at: the end first.
    let (mut inside, mut outside, mut part) = (0.0, 1.0, 1.0);
    for _ in 0..=BISECTIONS {
        let mut other = best.clone();
        other.kept[kept].1 = between(begin, end, part);
        let set = ground.set_in(&other.program, &other.kept);
        let problem = ground.problem(&other.program, &other.varied, &set, None);
        let fitted = problem.solve_in(&best.solution.values, MAX_STEPS, Slopes::Tangents);
        match fitted {
            Ok(solution) if solution.cost() <= most => {
                other.solution = solution;
                (best, inside) = (other, part);
            }
            Ok(_) | Err(_) => outside = part,
        }
        if inside >= outside {
            break;
        }
        part = 0.5 * (inside + outside);
    }
    best
}

/// A value on the way from one to another: by ratios where both have the same sign.
fn between(from: f64, to: f64, part: f64) -> f64 {
    match from * to > 0.0 {
        true => from * (to / from).powf(part),
        false => from + part * (to - from),
    }
}

/// A finding with intervals that take in those of the same one elsewhere; shapes that stay there have none.
fn united((mut finding, there): (Finding, Finding)) -> Finding {
    let unite = |own: &mut Quantity, there: &Quantity| {
        own.interval.0 = own.interval.0.min(there.interval.0);
        own.interval.1 = own.interval.1.max(there.interval.1);
    };
    unite(&mut finding.size, &there.size);
    let sizes = finding.sizes.iter_mut().zip(&there.sizes);
    sizes.for_each(|(own, there)| unite(own, there));
    let shapes = finding.shapes.iter_mut().zip(&there.shapes);
    let fitted = shapes.filter(|(_, there)| there.interval.0 < there.interval.1);
    fitted.for_each(|(own, there)| unite(own, there));
    finding
}
