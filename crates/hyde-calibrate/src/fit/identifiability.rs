//! [`Identifiability`]: which parameters the records determine, before anything is fitted to them.
//!
//! The derivatives J of the innovations by the parameters, at the declared values and in units of their scales, say which
//! parameters a record moves at all. A direction in which `J'J` has an eigenvalue below 1 is known better beforehand than by
//! the records (Cui, Martin, Marzouk, Solonen and Spantini, Inverse Problems 30, 2014, 114015); the projector onto all of them
//! shows which parameters are left open, and two separate pairs in it stay two pairs. A parameter that is left open belongs
//! together with those that move the innovations as it does.

use super::descent::Objective;
use super::joint::Joint;
use super::linearised::Slopes;
use super::standstill::SILENT;
use crate::plant::Unsupported;
use nalgebra::{DMatrix, SymmetricEigen};

/// A direction is open if its eigenvalue is below this: records that leave twice what is known beforehand.
const OPEN: f64 = 0.25;
/// Or this part of the largest one: columns that are the same but for rounding.
const ROUNDING: f64 = 1e-10;
/// A parameter is open, and two parameters are open together, from this share of the projector on.
const SHARE: f64 = 0.15;
/// Two parameters move innovations in the same way from this correlation of their columns on.
const ALIKE: f64 = 0.95;

/// Parameters that records only determine together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Together {
    /// Their numbers.
    pub parameters: Vec<usize>,
    /// How many combinations of them the records determine.
    pub determined: usize,
}

/// Which parameters records determine.
#[derive(Clone, Debug)]
pub struct Identifiability {
    /// Numbers of parameters on which no innovation depends.
    pub unmoved: Vec<usize>,
    /// Parameters that records move, but determine less than their scales do.
    pub weak: Vec<usize>,
    /// Parameters that are only determined together.
    pub together: Vec<Together>,
    /// Standard deviation of each parameter that the records would leave if all others were known and the model were right,
    /// SI; infinite of those that are not moved.
    pub alone: Vec<f64>,
}

impl Identifiability {
    /// Whether there is nothing to tell.
    #[must_use]
    pub fn is_clear(&self) -> bool {
        self.unmoved.is_empty() && self.weak.is_empty() && self.together.is_empty()
    }
}

impl Joint<'_> {
    /// Which parameters the records determine, at some values.
    ///
    /// # Errors
    /// A program has no fixed-step form.
    pub fn identifiability(&self, values: &[f64]) -> Result<Identifiability, Unsupported> {
        let (_, normal) = self.normal(values, Slopes::Tangents)?;
        let length = |number: usize| normal.matrix[(number, number)].max(0.0).sqrt();
        let (moved, unmoved): (Vec<usize>, Vec<usize>) =
            (0..self.varied.len()).partition(|&number| length(number).powi(2) >= SILENT);
        let alone = (0..self.varied.len()).map(|number| match unmoved.contains(&number) {
            true => f64::INFINITY,
            false => self.varied[number].scale() / length(number),
        });
        let n = moved.len();
        let matrix = DMatrix::from_fn(n, n, |i, j| normal.matrix[(moved[i], moved[j])]);
        let (weak, together) = open(&matrix, &moved);
        Ok(Identifiability {
            weak,
            together,
            alone: alone.collect(),
            unmoved,
        })
    }
}

/// Of some parameters with this `J'J`: those that are open alone, and those that are open together.
fn open(matrix: &DMatrix<f64>, names: &[usize]) -> (Vec<usize>, Vec<Together>) {
    let n = names.len();
    if n == 0 || matrix.iter().any(|value| !value.is_finite()) {
        return (Vec::new(), Vec::new());
    }
    let axes = SymmetricEigen::new(matrix.clone());
    let limit = f64::max(OPEN, ROUNDING * axes.eigenvalues.max());
    let mut onto = DMatrix::<f64>::zeros(n, n);
    for (value, axis) in axes.eigenvalues.iter().zip(axes.eigenvectors.column_iter()) {
        if *value < limit {
            onto += axis * axis.transpose();
        }
    }
    let is_open = |i: usize| onto[(i, i)] > SHARE;
    let alike = |i: usize, j: usize| {
        matrix[(i, j)].abs() > ALIKE * (matrix[(i, i)] * matrix[(j, j)]).sqrt()
    };
    let mut group: Vec<usize> = (0..n).collect();
    for i in 0..n {
        for j in 0..i {
            let both = is_open(i) && is_open(j) && onto[(i, j)].abs() > SHARE;
            let same = (is_open(i) || is_open(j)) && alike(i, j);
            let (from, to) = (group[i], group[j]);
            if (both || same) && from != to {
                let own = group.iter_mut().filter(|own| **own == from);
                own.for_each(|own| *own = to);
            }
        }
    }
    let (mut weak, mut together) = (Vec::new(), Vec::new());
    for first in 0..n {
        let members: Vec<usize> = (0..n).filter(|&i| group[i] == first).collect();
        let lost: f64 = members.iter().map(|&i| onto[(i, i)]).sum();
        let lost = (lost.round() as usize).clamp(1, members.len().max(1));
        match members.as_slice() {
            [only] if is_open(*only) => weak.push(names[*only]),
            [] | [_] => {}
            // All of them are open: none is known by the others.
            all if lost == all.len() => weak.extend(all.iter().map(|&i| names[i])),
            all => together.push(Together {
                determined: all.len() - lost,
                parameters: all.iter().map(|&i| names[i]).collect(),
            }),
        }
    }
    weak.sort_unstable();
    together
        .iter_mut()
        .for_each(|own| own.parameters.sort_unstable());
    together.sort_by(|a, b| a.parameters.cmp(&b.parameters));
    (weak, together)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair(a: usize, b: usize) -> Together {
        Together {
            parameters: vec![a, b],
            determined: 1,
        }
    }

    #[test]
    fn two_pairs_of_equal_columns_stay_two_pairs() {
        let columns = DMatrix::from_row_slice(
            4,
            5,
            &[
                1.0, 0.0, 2.0, 0.0, 0.0, //
                0.0, 1.0, 0.0, 3.0, 0.0, //
                1.0, 0.0, 2.0, 0.0, 1.0, //
                0.0, 1.0, 0.0, 3.0, -1.0,
            ],
        ) * 100.0;
        let found = open(&columns.tr_mul(&columns), &[0, 1, 2, 3, 4]);
        assert_eq!(found, (vec![], vec![pair(0, 2), pair(1, 3)]));
    }

    #[test]
    fn three_columns_in_a_plane_determine_two_combinations() {
        let columns = DMatrix::from_row_slice(2, 3, &[1.0, 0.0, 1.0, 0.0, 1.0, 1.0]) * 10.0;
        let all = Together {
            parameters: vec![4, 7, 9],
            determined: 2,
        };
        assert_eq!(
            open(&columns.tr_mul(&columns), &[4, 7, 9]),
            (vec![], vec![all])
        );
    }

    #[test]
    fn a_parameter_known_well_beforehand_is_open_with_the_one_that_compensates_it() {
        // A sum is measured; the second summand has a spread a thousand times smaller.
        let columns = DMatrix::from_row_slice(1, 2, &[1000.0, 1.0]);
        assert_eq!(
            open(&columns.tr_mul(&columns), &[0, 1]),
            (vec![], vec![pair(0, 1)])
        );
    }

    #[test]
    fn similar_columns_of_strong_records_are_determined_and_weak_ones_are_not() {
        // Eigenvalues 1.9 and 0.1, times the strength of the record.
        let matrix = DMatrix::from_row_slice(2, 2, &[1.0, 0.9, 0.9, 1.0]);
        assert_eq!(open(&(&matrix * 100.0), &[0, 1]), (vec![], vec![]));
        assert_eq!(open(&(&matrix * 2.0), &[0, 1]), (vec![], vec![pair(0, 1)]));
        assert_eq!(open(&(&matrix * 0.1), &[0, 1]), (vec![0, 1], vec![]));
    }
}
