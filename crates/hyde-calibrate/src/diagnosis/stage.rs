//! [`Stage`]: the model as far as the search has come: effects taken in, parameters calibrated with them.

use super::hypothesis::Hypothesis;
use super::profile::profiled;
use super::thresholds::Thresholds;
use crate::fit::{Fold, Linearised, MAX_STEPS, Objective, Problem, Slopes, Solution, Varied};
use crate::observer::{Innovations, Observer, Track};
use crate::plant::Unsupported;
use crate::records::Recording;
use hyde_program::Program;

/// What never changes in a diagnosis.
#[derive(Clone, Copy)]
pub(crate) struct Ground<'a> {
    pub(crate) recordings: &'a [Recording],
    pub(crate) observer: &'a Observer,
    /// Values set from outside, by name, SI.
    pub(crate) set: &'a [(String, f64)],
    pub(crate) thresholds: &'a Thresholds,
}

/// The model as far as the search has come.
#[derive(Clone)]
pub(crate) struct Stage {
    pub(crate) program: Program,
    /// Numbers of the hypotheses taken in, with the paths of their instances.
    pub(crate) effects: Vec<(usize, String)>,
    pub(crate) varied: Vec<Varied>,
    /// Values of parameters that stay as they are, by name: whole numbers among the shapes.
    pub(crate) kept: Vec<(String, f64)>,
    pub(crate) solution: Solution,
}

impl Ground<'_> {
    /// Values set in a program: from outside, and others by name.
    pub(crate) fn set_in(&self, program: &Program, more: &[(String, f64)]) -> Vec<(usize, f64)> {
        let all = self.set.iter().chain(more);
        all.filter_map(|(name, value)| {
            let (parameter, element) = program.parameter(name)?;
            (!parameter.structural).then_some((parameter.place + element, *value))
        })
        .collect()
    }

    pub(crate) fn problem<'s>(
        &'s self,
        program: &'s Program,
        varied: &'s [Varied],
        set: &'s [(usize, f64)],
        fold: Option<Fold>,
    ) -> Problem<'s> {
        Problem {
            program,
            recordings: self.recordings,
            observer: self.observer,
            varied,
            set,
            fold,
            reached: None,
        }
    }
}

impl Stage {
    /// Innovations with their derivatives where the stage is, its tracks being known.
    pub(crate) fn linearise_on(
        &self,
        tracks: &[Track<'_>],
        ground: &Ground<'_>,
    ) -> Result<Linearised, Unsupported> {
        let set = ground.set_in(&self.program, &self.kept);
        ground
            .problem(&self.program, &self.varied, &set, None)
            .linearise_on(tracks, &self.solution.values)
    }

    /// Where it takes the observer, record by record.
    pub(crate) fn tracks<'s>(&'s self, ground: &Ground<'s>) -> Result<Vec<Track<'s>>, Unsupported> {
        let set = ground.set_in(&self.program, &self.values());
        Track::all(&self.program, ground.recordings, ground.observer, &set)
    }

    /// The stage fitted to the end, once from where it is and once from what was declared: without the effect the
    /// parameters stood in for it, and may have been led into a minimum of their own. Numbers of effects end at the bottom
    /// of their profiles.
    pub(crate) fn polished(&self, ground: &Ground<'_>) -> Result<Self, Unsupported> {
        let set = ground.set_in(&self.program, &self.kept);
        let problem = ground.problem(&self.program, &self.varied, &set, None);
        let pairs = self.varied.iter().zip(&self.solution.values);
        let declared: Vec<f64> = pairs
            .map(|(varied, &value)| varied.prior.map_or(value, |_| varied.nominal))
            .collect();
        let again = problem.solve_in(&declared, MAX_STEPS, Slopes::Tangents)?;
        let start = if again.gain_over(&self.solution) > 0.0 {
            &again.values
        } else {
            &self.solution.values
        };
        let own = self.varied.iter().enumerate();
        let of_effects = own.filter(|(_, varied)| self.is_of_effect(&varied.name));
        let solution = problem.solve(start)?;
        let solution = profiled(
            &problem,
            solution,
            of_effects.map(|(number, _)| number),
            ground.thresholds.grown,
        )?;
        Ok(Self {
            solution,
            ..self.clone()
        })
    }

    /// The numbers of the hypotheses taken in.
    pub(crate) fn numbers(&self) -> Vec<usize> {
        self.effects.iter().map(|(number, _)| *number).collect()
    }

    /// The same, and others behind them.
    pub(crate) fn numbers_with(&self, others: &[usize]) -> Vec<usize> {
        [self.numbers().as_slice(), others].concat()
    }

    /// Whether an effect is there twice with nearly the same period, order or frequency: one of another course, not two.
    pub(crate) fn has_one_twice(&self, hypotheses: &[Hypothesis], near: f64) -> bool {
        let values = self.values();
        let recurring = |(number, path): &(usize, String)| -> Option<(usize, f64)> {
            let hypothesis = hypotheses.get(*number)?;
            let shape = hypothesis.periodic.or(hypothesis.resonant)?;
            let name = format!("{path}.{}", hypothesis.shapes[shape].name);
            let (_, value) = values.iter().rev().find(|(known, _)| *known == name)?;
            Some((*number, value.abs()))
        };
        let each: Vec<(usize, f64)> = self.effects.iter().filter_map(recurring).collect();
        let alike = |(one, a): (usize, f64), (other, b): (usize, f64)| {
            one == other && (a - b).abs() <= near * a.max(b)
        };
        (0..each.len()).any(|i| each[..i].iter().any(|&other| alike(each[i], other)))
    }

    /// Whether a hypothesis is among those taken in.
    pub(crate) fn has(&self, hypothesis: usize) -> bool {
        self.effects.iter().any(|(number, _)| *number == hypothesis)
    }

    /// Numbers of the sizes of an effect among what is varied, by the path of its instance.
    pub(crate) fn sizes_of(&self, path: &str) -> Vec<usize> {
        let is_size = |number: &usize| {
            let name = &self.varied[*number].name;
            let known = self.program.parameter(name);
            below(name, path).is_some() && known.is_some_and(|(parameter, _)| parameter.is_size)
        };
        (0..self.varied.len()).filter(is_size).collect()
    }

    /// Whether a parameter is one of an effect.
    fn is_of_effect(&self, name: &str) -> bool {
        let mut paths = self.effects.iter();
        paths.any(|(_, path)| below(name, path).is_some())
    }

    /// The parameters of the stage in another program.
    pub(crate) fn varied_in(&self, program: &Program) -> Vec<Varied> {
        let each = self.varied.iter().filter_map(|varied| {
            let (parameter, element) = program.parameter(&varied.name)?;
            let place = parameter.place + element;
            Some(Varied {
                place,
                ..varied.clone()
            })
        });
        each.collect()
    }

    /// Everything that the stage sets, by name.
    pub(crate) fn values(&self) -> Vec<(String, f64)> {
        let varied = self.varied.iter().zip(&self.solution.values);
        let mut all: Vec<(String, f64)> = varied
            .map(|(varied, &value)| (varied.name.clone(), value))
            .collect();
        all.extend(self.kept.iter().cloned());
        all
    }
}

/// The rest of a name below a path: `dF` of `guide.stribeck.dF` below `guide.stribeck`.
pub(crate) fn below<'n>(name: &'n str, path: &str) -> Option<&'n str> {
    name.strip_prefix(path)?.strip_prefix('.')
}

/// Innovations of all records below each other.
pub(crate) fn flat(innovations: &[Innovations]) -> Vec<f64> {
    innovations
        .iter()
        .flat_map(|i| &i.channels)
        .flatten()
        .copied()
        .collect()
}
