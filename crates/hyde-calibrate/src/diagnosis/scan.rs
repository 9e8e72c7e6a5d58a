//! [`Score`]: what an effect at a site gains at best, over its shapes and sizes, before anything is fitted.
//!
//! How innovations change with a small size is differentiated along one run ([`crate::observer::changes`]). Where the effect is
//! linear in its sizes the best ones follow at once; what is gained there is then tried by the model itself. An effect
//! that brings modes of its own, as play does, is nothing to begin with and is tried at sizes all over its range.

use super::grid::Grid;
use super::hypothesis::{Build, Built, Hypothesis, Knob, brings_modes};
use super::projection::Projection;
use super::runs::{Runs, largest};
use super::stage::{Ground, Stage};
use crate::observer::Track;
use crate::plant::past_differs;
use hyde_program::Program;
use nalgebra::DVector;
use rayon::prelude::*;

/// Numerics: the sum of squares of a visible change of innovations, by which sizes are scaled in a fit.
pub(crate) const VISIBLE: f64 = 100.0;
/// Numerics: shapes scored at once.
const CHUNK: usize = 96;
/// Numerics: sizes tried of an effect with modes of its own: halves of its range.
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
    /// How far the parameters go to answer it, in units of their scales; empty where no run tells.
    pub(crate) parameters: Vec<f64>,
    /// Whether its sizes are those of a linear answer.
    pub(crate) linear: bool,
}

impl Node {
    /// The same shapes where there is no effect, and parameters have nothing to answer.
    pub(crate) fn without(&self) -> Self {
        Self {
            sizes: vec![0.0; self.sizes.len()],
            parameters: Vec::new(),
            ..self.clone()
        }
    }
}

/// What an effect at a site gains at best.
#[derive(Clone, Debug)]
pub struct Score {
    /// Number of the hypothesis.
    pub hypothesis: usize,
    /// Its best nodes, the best first.
    pub nodes: Vec<Node>,
    /// Number of nodes of its grid.
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

/// What is scanned: a stage, and what is known of its innovations.
pub(crate) struct Scanner<'s> {
    pub(crate) ground: &'s Ground<'s>,
    pub(crate) stage: &'s Stage,
    pub(crate) projection: &'s Projection,
    pub(crate) hypotheses: &'s [Hypothesis],
    pub(crate) build: &'s Build<'s>,
    /// Where the stage takes the observer, record by record.
    pub(crate) tracks: &'s [Track<'s>],
    /// What a gain has to reach at least.
    pub(crate) gate: f64,
    /// So many are fitted at most.
    pub(crate) fitted: usize,
}

/// A hypothesis with what tangents promise of it.
struct Promised {
    number: usize,
    program: Program,
    path: String,
    plain: DVector<f64>,
    nodes: Vec<Node>,
    tried: usize,
    own_modes: bool,
    detectable: f64,
}

/// What tangents show of some shapes.
struct Look {
    nodes: Vec<Node>,
    /// What each would gain if parts of a second had sizes of their own, beyond what chance makes of so many.
    apart: Vec<f64>,
    /// The least value of the first size that would be seen, SI.
    seen: f64,
    /// Innovations without the effect.
    plain: DVector<f64>,
}

impl Promised {
    fn gain(&self) -> f64 {
        self.nodes.first().map_or(0.0, |node| node.gain)
    }

    fn score(self, linear: bool) -> Score {
        Score {
            hypothesis: self.number,
            nodes: self.nodes,
            tried: self.tried,
            linear,
            detectable: Some(self.detectable).filter(|seen| linear && seen.is_finite()),
        }
    }
}

impl Scanner<'_> {
    /// The scores of those of some hypotheses that can be put on the model, the best first. What promises too little beside the best, or
    /// less than as many as are fitted have gained, is not tried by runs of its own: its score is what tangents promise.
    pub(crate) fn scores(&self, hypotheses: &[usize]) -> Vec<Score> {
        let each = hypotheses.par_iter();
        let mut promised: Vec<Promised> =
            each.filter_map(|&number| self.promised(number)).collect();
        promised.sort_by(|a, b| b.gain().total_cmp(&a.gain()));
        let mut rest = promised.into_iter().peekable();
        let thresholds = self.ground.thresholds;
        let mut scores: Vec<Score> = Vec::new();
        let mut best = 0.0;
        while let Some(next) = rest.peek() {
            let ahead = scores.iter().filter(|score| score.gain() > next.gain());
            let enough = ahead.count() >= self.fitted;
            if enough
                || next.gain() < (thresholds.negligible * best).max(thresholds.passable * self.gate)
            {
                break;
            }
            let few: Vec<Promised> = rest.by_ref().take(2 * thresholds.few).collect();
            let tried = few.into_par_iter().map(|promised| self.tried(promised));
            scores.extend(tried.collect::<Vec<Score>>());
            best = scores.iter().map(Score::gain).fold(best, f64::max);
        }
        scores.extend(rest.map(|promised| {
            let linear = !promised.own_modes;
            promised.score(linear)
        }));
        scores.sort_by(|a, b| b.gain().total_cmp(&a.gain()));
        scores
    }

    /// What tangents promise of a hypothesis, over the grid of its shapes; `None` where it cannot be put on the model.
    fn promised(&self, number: usize) -> Option<Promised> {
        let hypothesis = &self.hypotheses[number];
        if !hypothesis.repeats() && self.stage.has(number) {
            return None;
        }
        let Built { program, paths } = (self.build)(&self.stage.numbers_with(&[number]))?;
        let before = &self.stage.program;
        let path = paths.last()?.clone();
        let sizes = Hypothesis::names(&hypothesis.sizes, &path);
        let mut promised = Promised {
            number,
            own_modes: brings_modes(&program, before) || self.delays(&program, &sizes[0]),
            path,
            program,
            plain: DVector::zeros(0),
            nodes: Vec::new(),
            tried: 0,
            detectable: f64::INFINITY,
        };
        let grid = Grid::new(hypothesis);
        let coarse = self.look(&promised, &grid.shapes())?;
        // What lies between the nodes of the grid is no other try: neighbours gain or fail together.
        promised.tried = coarse.nodes.len();
        promised.plain = coarse.plain;
        promised.nodes = coarse.nodes;
        promised.detectable = coarse.seen;
        // The peak of a period is the narrower, the further the axis goes; over a part of a second it is wide.
        let fine = grid.fine(&coarse.apart, self.ground.thresholds.few, self.gate);
        if !fine.is_empty() {
            let fine = self.look(&promised, &fine)?;
            promised.nodes.extend(fine.nodes);
            promised.detectable = promised.detectable.min(fine.seen);
        }
        if promised.own_modes {
            self.try_sizes(&mut promised);
        }
        promised.nodes = peaks(&grid, promised.nodes, self.ground.thresholds.few);
        Some(promised)
    }

    /// Whether a parameter says how late something comes, of which tangents show nothing.
    fn delays(&self, program: &Program, parameter: &str) -> bool {
        let set = |value| {
            self.ground
                .set_in(program, &[(parameter.to_owned(), value)])
        };
        let mut each = self.ground.recordings.iter();
        each.next().is_some_and(|first| {
            let p = |value| first.parameters(program, &set(value));
            past_differs(program, &p(0.0), &p(1.0))
        })
    }

    /// Looks at some shapes by tangents; `None` where there are none, or the model cannot be run.
    fn look(&self, promised: &Promised, shapes: &[Vec<f64>]) -> Option<Look> {
        let hypothesis = &self.hypotheses[promised.number];
        let runs = self.runs(promised);
        let (mut nodes, mut apart) = (Vec::new(), Vec::new());
        let mut seen = f64::INFINITY;
        let mut plain = None;
        for chunk in shapes.chunks(CHUNK) {
            let (products, innovations) = runs.products(hypothesis, self.projection, chunk)?;
            let answers = self.projection.answers(&products);
            for (number, (shape, answer)) in chunk.iter().zip(answers).enumerate() {
                let pairs = || hypothesis.sizes.iter().enumerate();
                let sizes: Vec<f64> = pairs()
                    .map(|(i, size)| inside(answer.sizes[i], size))
                    .collect();
                let gain = answer.gain_of(&sizes);
                let node = Node {
                    shapes: shape.clone(),
                    visible: pairs()
                        .map(|(i, size)| visible(answer.squares[i], size))
                        .collect(),
                    // Errors that grow out of all numbers along the track promise nothing, and tell nothing.
                    gain: if gain.is_nan() {
                        f64::NEG_INFINITY
                    } else {
                        gain
                    },
                    sizes,
                    parameters: Vec::new(),
                    linear: true,
                };
                nodes.push(node);
                apart.push(products.apart(number));
                let reaches = answer.reaches(self.gate, 0);
                if reaches < self.ground.thresholds.room * largest(&hypothesis.sizes[0]).abs() {
                    seen = seen.min(reaches);
                }
            }
            plain = plain.or(Some(innovations));
        }
        Some(Look {
            nodes,
            apart,
            seen,
            plain: plain?,
        })
    }

    /// How innovations change a unit of each size of a hypothesis, by tangents; `None` where it cannot be put on the model.
    pub(crate) fn columns(&self, number: usize, shapes: &[f64]) -> Option<Vec<Vec<f64>>> {
        let Built { program, paths } = (self.build)(&self.stage.numbers_with(&[number]))?;
        let runs = self.runs_of(number, &program, paths.last()?);
        runs.columns(&self.hypotheses[number], shapes)
    }

    /// Tries sizes all over the range of what has modes of its own: tangents tell little of it.
    fn try_sizes(&self, promised: &mut Promised) {
        let hypothesis = &self.hypotheses[promised.number];
        let declared: Vec<f64> = hypothesis.shapes.iter().map(|shape| shape.value).collect();
        let largest = largest(&hypothesis.sizes[0]);
        for halving in 0..HALVINGS {
            let mut sizes = vec![0.0; hypothesis.sizes.len()];
            sizes[0] = largest * 0.5_f64.powi(halving);
            let (gain, parameters) = self.gain(promised, &sizes, &declared);
            promised.tried += 1;
            promised.nodes.push(Node {
                shapes: declared.clone(),
                visible: sizes.iter().map(|s| 0.1 * s.abs()).collect(),
                sizes,
                gain,
                parameters,
                linear: false,
            });
        }
    }

    /// Looks between the nodes of the grid, and tries by the model itself what tangents promise of the best.
    fn tried(&self, mut promised: Promised) -> Score {
        let hypothesis = &self.hypotheses[promised.number];
        let grid = Grid::new(hypothesis);
        let best = promised.nodes.first().map(|best| best.shapes.clone());
        if let Some(best) = best {
            let between = grid.between(&best);
            if let Some(found) = self.look(&promised, &between) {
                promised.nodes.extend(found.nodes);
            }
        }
        promised.nodes = peaks(&grid, promised.nodes, self.ground.thresholds.few);
        let thresholds = self.ground.thresholds;
        let mut linear = !promised.own_modes;
        let mut nodes = std::mem::take(&mut promised.nodes);
        for node in &mut nodes {
            if node.gain < thresholds.passable * self.gate {
                continue;
            }
            node.gain = f64::NEG_INFINITY;
            for factor in [1.0, 0.5, 2.0] {
                let pairs = node.sizes.iter().zip(&hypothesis.sizes);
                let sizes: Vec<f64> = pairs.map(|(s, size)| inside(s * factor, size)).collect();
                let (gain, parameters) = self.gain(&promised, &sizes, &node.shapes);
                if gain > node.gain {
                    (node.gain, node.sizes, node.parameters) = (gain, sizes, parameters);
                }
                if node.gain > 0.0 {
                    break;
                }
                linear = false;
            }
        }
        best_first(&mut nodes);
        promised.nodes = nodes;
        promised.score(linear)
    }

    /// What a run with some sizes and shapes gains, and how far the parameters go to answer it.
    fn gain(&self, promised: &Promised, sizes: &[f64], shapes: &[f64]) -> (f64, Vec<f64>) {
        let change = self.runs(promised).change(sizes, shapes, &promised.plain);
        change.map_or((f64::NEG_INFINITY, Vec::new()), |change| {
            self.projection.answered(&change)
        })
    }

    fn runs<'r>(&'r self, promised: &'r Promised) -> Runs<'r> {
        self.runs_of(promised.number, &promised.program, &promised.path)
    }

    /// Runs of a hypothesis whose instance in a program has a path.
    fn runs_of<'r>(&'r self, number: usize, program: &'r Program, path: &str) -> Runs<'r> {
        let hypothesis = &self.hypotheses[number];
        Runs {
            ground: self.ground,
            program,
            tracks: self.tracks,
            values: self.stage.values(),
            sizes: Hypothesis::names(&hypothesis.sizes, path),
            shapes: Hypothesis::names(&hypothesis.shapes, path),
        }
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

/// So many of the best nodes, without those that lie beside a better one: fits from there end at the same place.
fn peaks(grid: &Grid<'_>, mut nodes: Vec<Node>, most: usize) -> Vec<Node> {
    best_first(&mut nodes);
    let mut kept: Vec<Node> = Vec::new();
    for node in nodes {
        // Where nothing is linear, sizes lead to places of their own.
        let beside = |better: &Node| {
            better.linear && node.linear && grid.beside(&better.shapes, &node.shapes)
        };
        if kept.len() < most && !kept.iter().any(beside) {
            kept.push(node);
        }
    }
    kept
}
