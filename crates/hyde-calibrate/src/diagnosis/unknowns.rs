//! [`Unknowns`]: what the fit of a hypothesis varies: the parameters of the stage, and its sizes and shapes from a node.

use super::hypothesis::{Hypothesis, Knob};
use super::scan::Node;
use super::stage::{Ground, Stage};
use crate::fit::{Objective, Slopes, Solution, Varied};
use hyde_program::Program;

/// Numerics: a shape is visibly another by this part of its value or its range.
const VISIBLE_SHAPE: f64 = 0.03;

/// A refit, what it varied, and the shapes it kept fixed.
pub(super) type Refit = (Solution, Vec<Varied>, Vec<(String, f64)>);

/// What is varied in a fit, with its start, and what stays.
pub(super) struct Unknowns {
    varied: Vec<Varied>,
    start: Vec<f64>,
    kept: Vec<(String, f64)>,
}

impl Unknowns {
    /// The parameters of a stage.
    pub(super) fn of(stage: &Stage, program: &Program) -> Self {
        Self {
            varied: stage.varied_in(program),
            start: stage.solution.values.clone(),
            kept: stage.kept.clone(),
        }
    }

    /// Adds the sizes of an effect and its shapes, from a node, and lets the parameters answer it; whole numbers stay.
    pub(super) fn add(
        &mut self,
        program: &Program,
        hypothesis: &Hypothesis,
        path: &str,
        node: &Node,
    ) {
        let parameters = self.start.iter_mut().zip(&self.varied);
        for ((value, varied), step) in parameters.zip(&node.parameters) {
            *value = (*value + step * varied.scale()).clamp(varied.bounds.0, varied.bounds.1);
        }
        let sizes = Hypothesis::names(&hypothesis.sizes, path)
            .into_iter()
            .zip(&hypothesis.sizes);
        for ((name, knob), (&value, &visible)) in sizes.zip(node.sizes.iter().zip(&node.visible)) {
            let visible = visible.abs().max(1e-6 * value.abs()).max(f64::MIN_POSITIVE);
            self.vary(program, name, knob, value, visible);
        }
        let shapes = Hypothesis::names(&hypothesis.shapes, path)
            .into_iter()
            .zip(&hypothesis.shapes);
        for ((name, knob), &value) in shapes.zip(&node.shapes) {
            let structural = program
                .parameter(&name)
                .is_none_or(|(parameter, _)| parameter.structural);
            if knob.integer || structural {
                self.kept.push((name, value));
            } else {
                let range = knob.range.1 - knob.range.0;
                let visible = VISIBLE_SHAPE * if value == 0.0 { range } else { value.abs() };
                self.vary(program, name, knob, value, visible);
            }
        }
    }

    /// Fits them in so many steps at most; `None` where the model cannot be run.
    pub(super) fn fitted(
        self,
        ground: &Ground<'_>,
        program: &Program,
        steps: usize,
    ) -> Option<Refit> {
        let set = ground.set_in(program, &self.kept);
        let problem = ground.problem(program, &self.varied, &set, None);
        let solution = problem
            .solve_in(&self.start, steps, Slopes::Tangents)
            .ok()?;
        Some((solution, self.varied, self.kept))
    }

    fn vary(&mut self, program: &Program, name: String, knob: &Knob, value: f64, visible: f64) {
        let Some((parameter, element)) = program.parameter(&name) else {
            return;
        };
        self.varied.push(Varied {
            name,
            place: parameter.place + element,
            nominal: value,
            prior: None,
            bounds: knob.range,
            visible: Some(visible),
        });
        self.start.push(value);
    }
}
