//! [`Score`]: what an effect at a site gains at best, over its shapes and sizes, before anything is fitted.
//!
//! How innovations change with a small size is differentiated along one run ([`crate::tangent`]). Where the effect is
//! linear in its sizes the best ones follow at once; what is gained there is then tried by the model itself. An effect
//! that brings modes of its own, as play does, is nothing to begin with and is tried at sizes all over its range.

use super::hypothesis::{Build, Built, Hypothesis, Knob};
use super::projection::Projection;
use super::stage::{Ground, Stage, flat};
use crate::observer::Innovations;
use crate::tangent::{Direction, tangents};
use hyde_program::Program;
use nalgebra::{DMatrix, DVector};

/// A visible change of innovations: the sum of its squares.
const VISIBLE: f64 = 100.0;
/// The part of its range that a size is given to differentiate by it.
const SMALL: f64 = 1e-4;
/// Shapes scored at once.
const CHUNK: usize = 16;
/// Nodes kept of each effect: where it is fitted from.
const KEPT: usize = 3;
/// Nodes of a shape at most, of one that is a period or an order, and of a resonance.
const NODES: usize = 12;
const PERIODIC_NODES: usize = 96;
const RESONANT_NODES: usize = 24;
/// Sizes tried of an effect with modes of its own: halves of its range.
const HALVINGS: i32 = 9;

/// Where an effect gains, and how much.
#[derive(Clone, Debug)]
pub struct Node {
    /// Values of its shapes, SI.
    pub shapes: Vec<f64>,
    /// Values of its sizes, SI.
    pub sizes: Vec<f64>,
    /// Sizes that can just be seen, SI.
    pub(crate) visible: Vec<f64>,
    /// What is gained of the sum of squares.
    pub gain: f64,
}

/// What an effect at a site gains at best.
#[derive(Clone, Debug)]
pub struct Score {
    /// Number of the hypothesis.
    pub hypothesis: usize,
    /// Its best nodes, the best first.
    pub nodes: Vec<Node>,
    /// Number of nodes tried.
    pub tried: usize,
    /// Whether it is linear in its sizes.
    pub linear: bool,
    /// The least size that would have been seen, SI: of its first size, where it is linear.
    pub detectable: Option<f64>,
}

impl Score {
    /// What is gained at best.
    #[must_use]
    pub fn gain(&self) -> f64 {
        self.nodes.first().map_or(0.0, |node| node.gain)
    }
}

/// Scores a hypothesis beside what a stage has; `None` where it cannot be put on the model.
pub(crate) fn scan(
    ground: &Ground<'_>,
    stage: &Stage,
    projection: &Projection,
    hypotheses: &[Hypothesis],
    number: usize,
    build: &Build<'_>,
    gate: f64,
) -> Option<Score> {
    let hypothesis = &hypotheses[number];
    let mut list: Vec<usize> = stage.effects.iter().map(|(effect, _)| *effect).collect();
    list.push(number);
    let Built { program, paths } = build(&list)?;
    let path = paths.last()?;
    let runs = Runs {
        ground,
        program: &program,
        values: stage.values(),
        sizes: Hypothesis::names(&hypothesis.sizes, path),
        shapes: Hypothesis::names(&hypothesis.shapes, path),
        plain: DVector::zeros(0),
    };
    let zeros = vec![0.0; hypothesis.sizes.len()];
    let declared: Vec<f64> = hypothesis.shapes.iter().map(|shape| shape.value).collect();
    let plain = runs.innovations(&zeros, &declared)?;
    let runs = Runs { plain, ..runs };
    let own_modes = program.automata.len() > stage.program.automata.len()
        || program.relations.len() > stage.program.relations.len();
    let shapes = grid(hypothesis);
    let mut tried = 0;
    let mut detectable: Option<f64> = None;
    // What has states of its own moves by itself as its shapes say, also at size 0: each shape needs a run of its own.
    let chunk = if program.n_unknowns > stage.program.n_unknowns {
        1
    } else {
        CHUNK
    };
    let mut score = |shapes: &[Vec<f64>]| -> Option<Vec<Node>> {
        let mut nodes = Vec::new();
        for chunk in shapes.chunks(chunk) {
            let columns = runs.columns(hypothesis, chunk)?;
            let answers = projection.answers(&columns, hypothesis.sizes.len());
            for (shape, answer) in chunk.iter().zip(answers) {
                tried += 1;
                let seen = answer.reaches(gate, 0);
                detectable = Some(detectable.map_or(seen, |least: f64| least.min(seen)));
                let pairs = || hypothesis.sizes.iter().enumerate();
                let sizes: Vec<f64> = pairs()
                    .map(|(i, size)| inside(answer.sizes[i], size))
                    .collect();
                nodes.push(Node {
                    shapes: shape.clone(),
                    visible: pairs()
                        .map(|(i, size)| visible(answer.squares[i], size))
                        .collect(),
                    gain: answer.gain_of(&sizes),
                    sizes,
                });
            }
        }
        Some(nodes)
    };
    let mut nodes = score(&shapes)?;
    best_first(&mut nodes);
    if let Some(best) = nodes.first().filter(|node| node.gain > 0.25 * gate) {
        let between = between(hypothesis, &best.shapes.clone());
        nodes.extend(score(&between)?);
    }
    best_first(&mut nodes);
    nodes.truncate(KEPT);
    let mut linear = !own_modes;
    for node in &mut nodes {
        if node.gain < 0.25 * gate {
            continue;
        }
        let promised = node.gain;
        node.gain = f64::NEG_INFINITY;
        for factor in [1.0, 0.5, 2.0] {
            let sizes: Vec<f64> = node
                .sizes
                .iter()
                .zip(&hypothesis.sizes)
                .map(|(s, size)| (s * factor).clamp(size.range.0, size.range.1))
                .collect();
            let gain = projection.gain(&runs.change(&sizes, &node.shapes)?);
            tried += 1;
            if gain > node.gain {
                (node.gain, node.sizes) = (gain, sizes);
            }
            if node.gain > 0.7 * promised {
                break;
            }
            linear = false;
        }
    }
    if own_modes {
        let largest = largest(&hypothesis.sizes[0]);
        for halving in 0..HALVINGS {
            let mut sizes = zeros.clone();
            sizes[0] = largest * 0.5_f64.powi(halving);
            let gain = projection.gain(&runs.change(&sizes, &declared)?);
            tried += 1;
            nodes.push(Node {
                shapes: declared.clone(),
                visible: sizes.iter().map(|s| 0.1 * s.abs()).collect(),
                sizes,
                gain,
            });
        }
    }
    best_first(&mut nodes);
    nodes.truncate(KEPT);
    Some(Score {
        hypothesis: number,
        nodes,
        tried,
        linear,
        detectable: detectable.filter(|_| linear),
    })
}

/// Innovations of a model with the effect at some sizes.
struct Runs<'s> {
    ground: &'s Ground<'s>,
    program: &'s Program,
    values: Vec<(String, f64)>,
    sizes: Vec<String>,
    shapes: Vec<String>,
    plain: DVector<f64>,
}

impl Runs<'_> {
    fn innovations(&self, sizes: &[f64], shapes: &[f64]) -> Option<DVector<f64>> {
        let set = self.set(sizes, shapes);
        let each: Option<Vec<Innovations>> = self
            .ground
            .recordings
            .iter()
            .map(|recording| {
                Innovations::of(self.program, recording, self.ground.observer, &set).ok()
            })
            .collect();
        Some(DVector::from_vec(flat(&each?)))
    }

    fn change(&self, sizes: &[f64], shapes: &[f64]) -> Option<DVector<f64>> {
        Some(self.innovations(sizes, shapes)? - &self.plain)
    }

    /// The changes of innovations a unit of each size, for some shapes: a column each.
    fn columns(&self, hypothesis: &Hypothesis, shapes: &[Vec<f64>]) -> Option<DMatrix<f64>> {
        let count = hypothesis.sizes.len();
        let zeros = vec![0.0; count];
        let mut columns = DMatrix::zeros(self.plain.len(), shapes.len() * count);
        let mut first = 0;
        for recording in self.ground.recordings {
            let mut directions = Vec::new();
            for shape in shapes {
                for which in 0..count {
                    let mut sizes = zeros.clone();
                    sizes[which] = SMALL * largest(&hypothesis.sizes[which]);
                    directions.push(Direction {
                        p: recording.parameters(self.program, &self.set(&sizes, shape)),
                        step: sizes[which],
                    });
                }
            }
            let set = self.set(&zeros, shapes.first()?);
            let observer = self.ground.observer;
            let own = tangents(self.program, recording, observer, &set, &directions).ok()?;
            columns
                .rows_mut(first, own.change.nrows())
                .copy_from(&own.change);
            first += own.change.nrows();
        }
        Some(columns)
    }

    fn set(&self, sizes: &[f64], shapes: &[f64]) -> Vec<(usize, f64)> {
        let mut values = self.values.clone();
        let own = self.sizes.iter().zip(sizes);
        let own = own.chain(self.shapes.iter().zip(shapes));
        values.extend(own.map(|(name, &value)| (name.clone(), value)));
        self.ground.set_in(self.program, &values)
    }
}

fn inside(value: f64, size: &Knob) -> f64 {
    value.clamp(size.range.0, size.range.1)
}

/// The size at which a change of innovations can be seen.
fn visible(squares: f64, size: &Knob) -> f64 {
    let seen = (VISIBLE / squares.max(1e-300)).sqrt();
    seen.min(0.5 * largest(size).abs())
}

fn best_first(nodes: &mut [Node]) {
    nodes.sort_by(|a, b| b.gain.total_cmp(&a.gain));
}

fn largest(size: &Knob) -> f64 {
    // The positive side, where there is one: many sizes cannot be negative.
    if size.range.1 > 0.0 {
        size.range.1
    } else {
        size.range.0
    }
}

/// The shape that is varied: a period, an order or a resonance, else the first.
fn axis(hypothesis: &Hypothesis) -> Option<usize> {
    hypothesis
        .periodic
        .or(hypothesis.resonant)
        .or((!hypothesis.shapes.is_empty()).then_some(0))
}

/// The values of shapes that are tried: a grid of the one that is varied, fine for a period or an order; of the others
/// their declared values.
fn grid(hypothesis: &Hypothesis) -> Vec<Vec<f64>> {
    let declared: Vec<f64> = hypothesis.shapes.iter().map(|shape| shape.value).collect();
    let Some(axis) = axis(hypothesis) else {
        return vec![declared];
    };
    let values = axis_values(&hypothesis.shapes[axis], count(hypothesis));
    values
        .into_iter()
        .map(|value| with(&declared, axis, value))
        .collect()
}

/// Values between the best node of the grid and its neighbours.
fn between(hypothesis: &Hypothesis, best: &[f64]) -> Vec<Vec<f64>> {
    let Some(axis) = axis(hypothesis).filter(|&axis| !hypothesis.shapes[axis].integer) else {
        return Vec::new();
    };
    let shape = &hypothesis.shapes[axis];
    let (low, high) = shape.range;
    let steps = count(hypothesis) as f64;
    let at = |part: f64| {
        let value = if by_ratio(shape) {
            best[axis] * (high / low).powf(part / steps)
        } else {
            best[axis] + (high - low) * part / steps
        };
        with(best, axis, value.clamp(low, high))
    };
    [-0.75, -0.5, -0.25, 0.25, 0.5, 0.75].map(at).to_vec()
}

fn with(shapes: &[f64], axis: usize, value: f64) -> Vec<f64> {
    let mut shapes = shapes.to_vec();
    shapes[axis] = value;
    shapes
}

fn count(hypothesis: &Hypothesis) -> usize {
    match (hypothesis.periodic, hypothesis.resonant) {
        (Some(_), _) => PERIODIC_NODES,
        (None, Some(_)) => RESONANT_NODES,
        (None, None) => NODES,
    }
}

/// Whether nodes follow each other by a ratio.
fn by_ratio(shape: &Knob) -> bool {
    let (low, high) = shape.range;
    low > 0.0 && high / low > 4.0
}

fn axis_values(shape: &Knob, most: usize) -> Vec<f64> {
    let (low, high) = shape.range;
    if shape.integer && high - low < most as f64 {
        let count = (high - low).round().max(0.0) as usize + 1;
        return (0..count).map(|k| low + k as f64).collect();
    }
    let parts = (0..most).map(|k| (k as f64 + 0.5) / most as f64);
    let mut values: Vec<f64> = if by_ratio(shape) {
        parts.map(|part| low * (high / low).powf(part)).collect()
    } else {
        parts.map(|part| low + (high - low) * part).collect()
    };
    if shape.integer {
        values.push(shape.value);
        values.iter_mut().for_each(|value| *value = value.round());
        values.sort_by(f64::total_cmp);
        values.dedup();
    }
    values
}
