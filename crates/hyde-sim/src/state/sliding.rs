//! Sliding: the equations on a surface where both flows point at it (Filippov).
//!
//! A switch takes the residual from F- to F+ where its root function g passes zero. If both flows lead to g = 0, the
//! solution stays there, and the equations are a mean of the two sides:
//!
//! ```text
//! 0 = F- + lambda*(F+ - F-),  0 = g(t, y)        lambda in [0, 1], one for each switch
//! ```
//! The lambdas are no unknowns of the solver. One of the rows that differ between the sides gives lambda; it is replaced by
//! g = 0, and the other rows lose their share of it: the same exchange that fixes a state in a mode (M3). For consistent
//! values, where states are given and rates are unknown, the row is dg/dt = 0 instead. Layout and pattern stay as they are.
//!
//! A. F. Filippov: Differential Equations with Discontinuous Righthand Sides (1988), §4; several switches at once add
//! their differences, which is his solution where they act on the equations independently of each other.

use super::State;
use crate::moment::At;
use crate::slide::{Slide, Surface};
use hyde_program::{Function, Jacobian, Wrt};

/// A difference of the sides below this part of the row counts as none.
const NONE: f64 = 1e-12;

impl State<'_> {
    /// Whether an automaton is in a mode: while it slides, in either of two.
    pub(crate) fn in_mode(&self, automaton: usize, mode: usize) -> bool {
        let mut pairs = self.slides.iter().filter_map(|slide| slide.modes);
        let pair = pairs.find(|pair| pair.automaton == automaton);
        pair.map_or_else(
            || self.program.mode(&self.z, automaton) == mode,
            |pair| pair.modes.contains(&mode),
        )
    }

    /// Writes the side of a slide to the memory.
    pub(crate) fn set_side(&mut self, slide: &Slide, side: usize) {
        let settings: Vec<(usize, f64)> = slide.settings(self.program, side).collect();
        for (place, value) in settings {
            self.z[place] = value;
        }
    }

    /// Values of a kernel on the lower sides of all slides, and by how much each upper side differs.
    fn sides(
        &mut self,
        values: &mut dyn FnMut(&mut Self) -> Vec<f64>,
    ) -> (Vec<f64>, Vec<Vec<f64>>) {
        let memory = self.z.clone();
        let slides = std::mem::take(&mut self.slides);
        slides.iter().for_each(|slide| self.set_side(slide, 0));
        let lower = values(self);
        let mut differences = Vec::with_capacity(slides.len());
        for slide in &slides {
            self.set_side(slide, 1);
            let mut upper = values(self);
            for (upper, lower) in upper.iter_mut().zip(&lower) {
                // The same where both are infinite, or not a number.
                *upper = if upper.to_bits() == lower.to_bits() {
                    0.0
                } else {
                    *upper - lower
                };
            }
            differences.push(upper);
            self.set_side(slide, 0);
        }
        self.slides = slides;
        self.z = memory;
        (lower, differences)
    }

    /// The mean of both sides of every slide, by its weight.
    pub(crate) fn mean(
        &mut self,
        weights: &[f64],
        values: &mut dyn FnMut(&mut Self) -> Vec<f64>,
    ) -> Vec<f64> {
        let (mut mean, differences) = self.sides(values);
        for (weight, difference) in weights.iter().zip(&differences) {
            for (mean, difference) in mean.iter_mut().zip(difference) {
                *mean += weight * difference;
            }
        }
        mean
    }

    /// The weight of the upper side of every slide: what its row says of it.
    pub(crate) fn weights(&mut self, at: At<'_>) -> Vec<f64> {
        let (lower, differences) = self.residual_sides(at);
        self.weights_of(&lower, &differences)
    }

    fn weights_of(&self, lower: &[f64], differences: &[Vec<f64>]) -> Vec<f64> {
        let right = self.slides.iter().map(|slide| -lower[slide.row]).collect();
        let rows: Vec<usize> = self.slides.iter().map(|slide| slide.row).collect();
        let matrix = rows
            .iter()
            .map(|&row| differences.iter().map(|d| d[row]).collect())
            .collect();
        solve_small(matrix, right)
    }

    fn residual_sides(&mut self, at: At<'_>) -> (Vec<f64>, Vec<Vec<f64>>) {
        let n = at.y.len();
        self.sides(&mut |state| {
            let mut out = vec![0.0; n];
            state.evaluate_side(Function::Residual, at, &mut out);
            out
        })
    }

    /// The residual while sliding.
    pub(crate) fn sliding_residual(&mut self, at: At<'_>, surface: Surface, out: &mut [f64]) {
        let (lower, differences) = self.residual_sides(at);
        let weights = self.weights_of(&lower, &differences);
        out.copy_from_slice(&lower);
        for (weight, difference) in weights.iter().zip(&differences) {
            for (out, difference) in out.iter_mut().zip(difference) {
                *out += weight * difference;
            }
        }
        let surfaces: Vec<usize> = self.slides.iter().map(|slide| slide.surface).collect();
        let values = match surface {
            Surface::Place => {
                let heights = self.heights(at);
                surfaces.iter().map(|&relation| heights[relation]).collect()
            }
            Surface::Rate => self.height_rates(&surfaces, at),
        };
        for ((slide, value), weight) in self.slides.iter().zip(values).zip(weights) {
            // A weight that cannot be had makes the step fail.
            out[slide.row] = value + 0.0 * weight;
        }
    }

    /// The derivatives of the residual while sliding, before rows are added to each other.
    pub(crate) fn sliding_partials(&mut self, at: At<'_>) -> Vec<f64> {
        let weights = self.weights(at);
        self.mean(&weights, &mut |state| {
            state.residual_partials(at);
            state.partials.values().to_vec()
        })
    }

    /// Adds the rows of an assembled matrix to each other, and puts the surfaces' gradients in their rows.
    pub(crate) fn exchange_rows(&mut self, at: At<'_>, matrix: &mut [f64]) {
        let jacobian: &Jacobian = self.program.jacobian();
        let (rows, shares) = self.shares(at);
        let entries: Vec<Vec<(usize, usize)>> = rows.iter().map(|&row| jacobian.row(row)).collect();
        for (row, share) in &shares {
            for (entries, share) in entries.iter().zip(share) {
                for &(column, position) in entries {
                    if let Some(target) = jacobian.position(*row, column) {
                        matrix[target] -= share * matrix[position];
                    }
                }
            }
        }
        for (slide, entries) in self.slides.clone().iter().zip(&entries) {
            for &(_, position) in entries {
                matrix[position] = 0.0;
            }
            for (column, value) in self.gradient(slide.surface, at) {
                if let Some(position) = jacobian.position(slide.row, column) {
                    matrix[position] += value;
                }
            }
        }
    }

    /// The same for a directional derivative of the residual, whose rows of surfaces are those of dg/dt.
    pub(crate) fn exchange_in(&mut self, at: At<'_>, dy: &[f64], out: &mut [f64]) {
        let At { t, y, yp } = at;
        let (rows, shares) = self.shares(at);
        for (row, share) in &shares {
            for (&from, share) in rows.iter().zip(share) {
                out[*row] -= share * out[from];
            }
        }
        let step = 1e-7 * (1e-3 + t.abs());
        let later: Vec<f64> = y.iter().zip(dy).map(|(y, dy)| y + step * dy).collect();
        for slide in self.slides.clone() {
            let rate = |gradient: Vec<(usize, f64)>| -> f64 {
                gradient
                    .iter()
                    .map(|(column, value)| value * yp[*column])
                    .sum()
            };
            let now = rate(self.gradient(slide.surface, at));
            let then = rate(self.gradient(slide.surface, At { y: &later, ..at }));
            out[slide.row] = (then - now) / step;
        }
    }

    /// The replaced rows, and of every other row that switches how much of each it loses.
    fn shares(&mut self, at: At<'_>) -> (Vec<usize>, Vec<(usize, Vec<f64>)>) {
        let (_, differences) = self.residual_sides(at);
        let rows: Vec<usize> = self.slides.iter().map(|slide| slide.row).collect();
        let transposed: Vec<Vec<f64>> = differences
            .iter()
            .map(|d| rows.iter().map(|&row| d[row]).collect())
            .collect();
        let switching = |row: &usize| {
            !rows.contains(row) && differences.iter().any(|difference| difference[*row] != 0.0)
        };
        let shares = (0..at.y.len())
            .filter(switching)
            .map(|row| {
                let right = differences.iter().map(|d| d[row]).collect();
                (row, solve_small(transposed.clone(), right))
            })
            .collect();
        (rows, shares)
    }

    /// Chooses the row that each slide replaces: where its sides differ most, over the size of the row. Returns whether
    /// there is one for each with room for the surface.
    pub(crate) fn choose_rows(&mut self, at: At<'_>) -> bool {
        let program = self.program;
        let (_, mut differences) = self.residual_sides(at);
        let sizes = self.row_sizes(at);
        for difference in &mut differences {
            for (difference, size) in difference.iter_mut().zip(&sizes) {
                *difference /= size;
            }
        }
        let mut free: Vec<usize> = (0..self.slides.len()).collect();
        while !free.is_empty() {
            // Complete pivoting over the rows and the slides that are left.
            let mut best: Option<(f64, usize, usize)> = None;
            for &slide in &free {
                let columns = self.gradient(self.slides[slide].surface, at);
                for (row, difference) in differences[slide].iter().enumerate() {
                    let size = difference.abs();
                    let room = || {
                        let mut columns = columns.iter();
                        columns
                            .all(|&(column, _)| program.jacobian().position(row, column).is_some())
                    };
                    if size > best.map_or(NONE, |(size, ..)| size) && room() {
                        best = Some((size, slide, row));
                    }
                }
            }
            let Some((_, slide, row)) = best else {
                return false;
            };
            self.slides[slide].row = row;
            free.retain(|other| *other != slide);
            let pivot = differences[slide].clone();
            for &other in &free {
                let share = differences[other][row] / pivot[row];
                for (value, pivot) in differences[other].iter_mut().zip(&pivot) {
                    *value -= share * pivot;
                }
            }
        }
        true
    }

    /// The largest entry of each row of the matrix of consistent values, both sides taken as they are.
    fn row_sizes(&mut self, at: At<'_>) -> Vec<f64> {
        let mut sizes = vec![f64::MIN_POSITIVE; at.y.len()];
        self.residual_partials(at);
        let entries = self.program.partials(Function::Residual);
        for (entry, value) in entries.iter().zip(self.partials.values()) {
            let counts = match entry.wrt {
                Wrt::Unknown(column) => !self.differential[column],
                Wrt::Derivative(column) => self.differential[column],
                Wrt::Delayed(_) | Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Time => false,
            };
            if counts {
                sizes[entry.row] = sizes[entry.row].max(value.abs());
            }
        }
        sizes
    }
}

/// Solves a system of a few equations by Gaussian elimination with partial pivoting; not a number where it is singular.
fn solve_small(mut matrix: Vec<Vec<f64>>, mut right: Vec<f64>) -> Vec<f64> {
    let n = right.len();
    for column in 0..n {
        let size = |row: &usize| matrix[*row][column].abs();
        let pivot = (column..n)
            .max_by(|a, b| size(a).total_cmp(&size(b)))
            .unwrap_or(column);
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        let (above, below) = matrix.split_at_mut(column + 1);
        let pivot = &above[column];
        for (row, line) in below.iter_mut().enumerate() {
            let share = line[column] / pivot[column];
            if share != 0.0 {
                for (value, pivot) in line.iter_mut().zip(pivot) {
                    *value -= share * pivot;
                }
                right[column + 1 + row] -= share * right[column];
            }
        }
    }
    for row in (0..n).rev() {
        let known: f64 = (row + 1..n).map(|k| matrix[row][k] * right[k]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_system_is_solved_and_a_singular_one_is_told() {
        let matrix = vec![vec![0.0, 2.0], vec![4.0, 1.0]];
        assert_eq!(solve_small(matrix, vec![2.0, 9.0]), vec![2.0, 1.0]);
        let singular = vec![vec![1.0, 1.0], vec![1.0, 1.0]];
        assert!(
            solve_small(singular, vec![1.0, 2.0])
                .iter()
                .any(|x| !x.is_finite())
        );
    }
}
