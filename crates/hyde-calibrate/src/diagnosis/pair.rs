//! [`pair`]: two effects that show only together, as each hides most of what the other does and neither passes its gate
//! alone.
//!
//! ```text
//! columns    how innovations change with the sizes of each hypothesis, at its best node    Scanner::columns
//! screen     what each two gain together in the linear answer, parameters projected out    Sums::beside
//! fit        the few that promise most, on the model itself, as one effect with the freedoms of both
//! ```

use super::evidence::Gates;
use super::projection::{Sums, change, common};
use super::scan::{Node, Scanner, Score};
use super::stage::Stage;
use super::trial::{together, unseen};
use crate::fit::{inflation, inflation_of};
use rayon::prelude::*;

/// A hypothesis at its best node.
struct Half<'s> {
    score: &'s Score,
    node: &'s Node,
    columns: Vec<Vec<f64>>,
    sums: Sums,
}

/// Two halves with what they promise together, and at which sizes.
struct Promise<'s> {
    halves: [&'s Half<'s>; 2],
    gain: f64,
    sizes: Vec<f64>,
}

/// The stage with the pair that gains most, if one passes the gates of a pair.
pub(crate) fn pair(scanner: &Scanner<'_>, scores: &[Score], gates: Gates) -> Option<Stage> {
    let (ground, stage) = (scanner.ground, scanner.stage);
    let half = |score| half(scanner, score);
    let halves: Vec<Half<'_>> = scores.par_iter().filter_map(half).collect();
    let count = halves.len() * halves.len().saturating_sub(1) / 2;
    let gates = Gates {
        tried: gates.tried + count,
        ..gates
    };
    let inflation = inflation(&stage.solution.innovations);
    let mut promises: Vec<Promise<'_>> = (0..halves.len())
        .into_par_iter()
        .flat_map_iter(|a| (0..a).map(move |b| (a, b)))
        .filter_map(|(a, b)| promise(scanner, &halves[a], &halves[b]))
        .filter(|promise| promise.gain >= gates.gain(2) * inflation)
        .collect();
    promises.sort_by(|a, b| b.gain.total_cmp(&a.gain));
    promises.truncate(gates.thresholds.few);
    let plain = (!promises.is_empty()).then(|| unseen(ground, stage))??;
    let fitted = promises.into_par_iter().filter_map(|promise| {
        let (a, b) = promise.sizes.split_at(promise.halves[0].node.sizes.len());
        let [first, second] = promise.halves;
        let columns = first.columns.iter().chain(&second.columns);
        let change = change(columns, &promise.sizes);
        let (_, both) = scanner.projection.answered(&change);
        let at = |half: &Half<'_>, sizes: &[f64], parameters: Vec<f64>| {
            let node = Node {
                sizes: sizes.to_vec(),
                parameters,
                ..half.node.clone()
            };
            (half.score.hypothesis, node)
        };
        let nodes = [at(first, a, both), at(second, b, Vec::new())];
        let fitted = together(ground, stage, scanner.hypotheses, &nodes, scanner.build)?;
        let own = stage.varied.len()..fitted.varied.len();
        let freedoms = own.len();
        let inflation = inflation_of(&fitted.solution, own).max(inflation);
        let gate = gates.gain(freedoms) * inflation;
        let unseen = plain - unseen(ground, &fitted)?;
        let gain = fitted.solution.gain_over(&stage.solution);
        let passes = gain >= gate && unseen >= gates.unseen(freedoms, inflation);
        passes.then_some((unseen, fitted))
    });
    let mut fitted: Vec<(f64, Stage)> = fitted.collect();
    fitted.sort_by(|a, b| b.0.total_cmp(&a.0));
    let (_, best) = fitted.into_iter().next()?;
    best.polished(ground).ok()
}

/// A hypothesis that is linear in its sizes, at its best node.
fn half<'s>(scanner: &Scanner<'_>, score: &'s Score) -> Option<Half<'s>> {
    let node = score.nodes.first().filter(|node| node.linear)?;
    let columns = scanner.columns(score.hypothesis, &node.shapes)?;
    Some(Half {
        score,
        node,
        sums: scanner.projection.sums(&columns),
        columns,
    })
}

/// What two promise together, their sizes within their ranges.
fn promise<'s>(scanner: &Scanner<'_>, a: &'s Half<'s>, b: &'s Half<'s>) -> Option<Promise<'s>> {
    let common = common(&a.columns, &b.columns);
    let answer = scanner
        .projection
        .answer_from(&a.sums.beside(&b.sums, &common));
    let knobs = [a, b]
        .into_iter()
        .flat_map(|half| &scanner.hypotheses[half.score.hypothesis].sizes);
    let sizes = answer.sizes.iter().zip(knobs);
    let sizes: Vec<f64> = sizes
        .map(|(size, knob)| size.clamp(knob.range.0, knob.range.1))
        .collect();
    let gain = answer.gain_of(&sizes);
    gain.is_finite().then_some(Promise {
        halves: [a, b],
        gain,
        sizes,
    })
}
