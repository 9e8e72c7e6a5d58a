//! [`Separation`]: how well records would distinguish effects from each other (T-optimality; Atkinson and Fedorov, Biometrika
//! 62, 1975, 57).
//!
//! The axis has one effect at a size, the model the other one at any size. Of the innovations that the first makes, the
//! parameters answer to a part and the second to another; the sum of squares of the rest, in units of noise, is what the
//! right effect gains over the wrong one. All answers are linear.

use super::case::largest;
use super::expected::Reference;
use crate::diagnosis::{Author, Hypothesis};
use crate::fit::Varied;
use crate::plant::Unsupported;
use crate::records::Recording;
use hyde_program::Program;
use nalgebra::{Cholesky, DMatrix, DVector};

/// What effects gain, alone and over each other.
#[derive(Clone, Debug)]
pub struct Separation {
    /// What each gains over the model without it; `None` where the model with it cannot be observed.
    pub alone: Vec<Option<f64>>,
    /// What each, a row, gains over another one, a column.
    pub over: Vec<Vec<Option<f64>>>,
    /// What a gain has to reach for each to be reported.
    pub thresholds: Vec<f64>,
}

impl Separation {
    /// The least gain of an effect over another one, as a part of the threshold; `None` if a model cannot be observed.
    #[must_use]
    pub fn least(&self) -> Option<f64> {
        let mut least = f64::INFINITY;
        for (number, (row, threshold)) in self.over.iter().zip(&self.thresholds).enumerate() {
            for (other, gain) in row.iter().enumerate() {
                if other != number {
                    least = least.min((*gain)? / threshold);
                }
            }
        }
        least.is_finite().then_some(least)
    }
}

/// An effect at a size.
#[derive(Clone, Debug, PartialEq)]
pub struct Point {
    /// The number of its hypothesis.
    pub hypothesis: usize,
    /// Its sizes, SI.
    pub sizes: Vec<f64>,
    /// Its shapes, SI.
    pub shapes: Vec<f64>,
}

impl Point {
    /// A hypothesis, by number, at a part of its range, its shapes as declared.
    #[must_use]
    pub fn at_part(number: usize, hypothesis: &Hypothesis, part: f64) -> Self {
        let sizes = hypothesis.sizes.iter();
        Self {
            hypothesis: number,
            sizes: sizes.map(|knob| part * largest(knob)).collect(),
            shapes: hypothesis.shapes.iter().map(|knob| knob.value).collect(),
        }
    }
}

/// Records without any effect in them, linearised: asked how well they would distinguish effects.
pub struct Linearised {
    reference: Reference,
}

impl Linearised {
    /// Linearises the model along some records.
    ///
    /// # Errors
    /// The program has no fixed-step form.
    pub fn new(
        program: &Program,
        recordings: Vec<Recording>,
        varied: &[Varied],
        set: &[(String, f64)],
    ) -> Result<Self, Unsupported> {
        let reference = Reference::new(program, recordings, varied, set)?;
        Ok(Self { reference })
    }

    /// How well the records would distinguish effects, each at its size.
    #[must_use]
    pub fn separation(
        &self,
        hypotheses: &[Hypothesis],
        points: &[Point],
        author: &Author<'_>,
    ) -> Separation {
        let reference = &self.reference;
        let changes: Vec<Option<Vec<DVector<f64>>>> = points
            .iter()
            .map(|point| changes(reference, &hypotheses[point.hypothesis], point, author))
            .collect();
        let common = |a: &DVector<f64>, b: &DVector<f64>| reference.projection().common(a, b);
        let alone = |columns: &Option<Vec<DVector<f64>>>| {
            let own = whole(columns.as_ref()?)?;
            Some(common(&own, &own))
        };
        let over = |one: &Option<Vec<DVector<f64>>>, other: &Option<Vec<DVector<f64>>>| {
            let (own, columns) = (whole(one.as_ref()?)?, other.as_ref()?);
            let n = columns.len();
            let mut m = DMatrix::from_fn(n, n, |i, j| common(&columns[i], &columns[j]));
            let b = DVector::from_fn(n, |i, _| common(&own, &columns[i]));
            for i in 0..n {
                m[(i, i)] += 1e-9 * m[(i, i)] + 1e-300;
            }
            let answered = Cholesky::new(m).map_or(0.0, |factor| b.dot(&factor.solve(&b)));
            Some((common(&own, &own) - answered).max(0.0))
        };
        Separation {
            alone: changes.iter().map(alone).collect(),
            over: changes
                .iter()
                .map(|one| changes.iter().map(|other| over(one, other)).collect())
                .collect(),
            thresholds: points
                .iter()
                .map(|point| reference.gate(&hypotheses[point.hypothesis]))
                .collect(),
        }
    }
}

/// The sum of columns.
fn whole(columns: &[DVector<f64>]) -> Option<DVector<f64>> {
    let first = columns.first()?;
    let later = columns.iter().skip(1);
    Some(later.fold(first.clone(), |sum, own| sum + own))
}

/// The change of innovations by each size of an effect alone.
fn changes(
    reference: &Reference,
    hypothesis: &Hypothesis,
    point: &Point,
    author: &Author<'_>,
) -> Option<Vec<DVector<f64>>> {
    let effect = reference.effect(hypothesis, point.hypothesis, &point.shapes, author)?;
    let count = point.sizes.len();
    let each = (0..count).map(|which| {
        let mut sizes = vec![0.0; count];
        sizes[which] = point.sizes[which];
        effect.change(&sizes)
    });
    each.collect()
}
