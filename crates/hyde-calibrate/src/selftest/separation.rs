//! [`Separation`]: how well records would distinguish effects from each other (T-optimality; Atkinson and Fedorov, Biometrika
//! 62, 1975, 57).
//!
//! The axis has one effect at a size, the model the other one at any size. Of the innovations that the first makes, the
//! parameters answer to a part and the second to another; the sum of squares of the rest, in units of noise, is what the
//! right effect gains over the wrong one. All answers are linear.

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

/// How well records without any effect in them would distinguish hypotheses, by number, each at a part of its range.
///
/// # Errors
/// The program has no fixed-step form.
pub fn separation(
    program: &Program,
    recordings: Vec<Recording>,
    (varied, set): (&[Varied], &[(String, f64)]),
    hypotheses: &[Hypothesis],
    numbers: &[usize],
    part: f64,
    author: &Author<'_>,
) -> Result<Separation, Unsupported> {
    let reference = Reference::new(program, recordings, varied, set)?;
    let changes: Vec<Option<Vec<DVector<f64>>>> = numbers
        .iter()
        .map(|&number| changes(&reference, &hypotheses[number], number, part, author))
        .collect();
    let whole = |columns: &[DVector<f64>]| {
        let first = columns.first()?;
        Some(
            columns
                .iter()
                .skip(1)
                .fold(first.clone(), |sum, own| sum + own),
        )
    };
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
    Ok(Separation {
        alone: changes.iter().map(alone).collect(),
        over: changes
            .iter()
            .map(|one| changes.iter().map(|other| over(one, other)).collect())
            .collect(),
        thresholds: numbers
            .iter()
            .map(|&number| reference.gate(&hypotheses[number]))
            .collect(),
    })
}

/// The change of innovations by each size of an effect at a part of its range, its shapes as declared.
fn changes(
    reference: &Reference,
    hypothesis: &Hypothesis,
    number: usize,
    part: f64,
    author: &Author<'_>,
) -> Option<Vec<DVector<f64>>> {
    let shapes: Vec<f64> = hypothesis.shapes.iter().map(|knob| knob.value).collect();
    let effect = reference.effect(hypothesis, number, &shapes, author)?;
    let count = hypothesis.sizes.len();
    let each = (0..count).map(|which| {
        let mut sizes = vec![0.0; count];
        sizes[which] = part * super::case::largest(&hypothesis.sizes[which]);
        effect.change(&sizes)
    });
    each.collect()
}
