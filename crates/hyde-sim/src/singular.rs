//! Why the system of consistent values is singular at an instant: the equations that depend on each other there, and the
//! unknowns that nothing determines, by the singular vectors of the least singular value (Golub and Van Loan, Matrix
//! Computations, §5.4). It is for a message: dense, and up to a few hundred unknowns.

use crate::failure::{Failure, FailureKind};
use crate::moment::At;
use crate::norms::largest_of;
use crate::state::State;
use nalgebra::DMatrix;

/// Larger systems name the unknown where the elimination stopped.
const MAX_UNKNOWNS: usize = 300;

/// A singular value is zero below this times the largest, after rows and columns were scaled: rounding of the elimination.
const ZERO: f64 = 1e-13;

/// A component of a singular vector counts from this times the largest: what takes part does so in like measure.
const TAKES_PART: f64 = 1e-6;

/// The failure of a matrix that is singular at a moment; `stopped` is the unknown at which the elimination found nothing.
pub(crate) fn failure(
    state: &State<'_>,
    matrix: &[f64],
    stopped: usize,
    at: At<'_>,
    at_start: bool,
) -> Box<Failure> {
    let (rows, open) = dependent(state, matrix).unwrap_or((vec![stopped], vec![(stopped, 1.0)]));
    let columns: Vec<usize> = open.iter().map(|(column, _)| *column).collect();
    // The rates of states follow from the algebraic variables that are open.
    let algebraic = columns.iter().copied();
    let algebraic: Vec<usize> = algebraic
        .filter(|&column| !state.differential[column])
        .collect();
    let columns = if algebraic.is_empty() {
        columns
    } else {
        algebraic
    };
    let singular = columns
        .iter()
        .map(|&column| state.program.unknown_name(column));
    let kind = FailureKind::Inconsistent {
        singular: singular.collect(),
        at_start,
    };
    let mut failure = Failure::new(kind, at.t).in_modes(state.program, &state.z);
    let named = open
        .iter()
        .map(|&(column, change)| (solved_for(state, column), change));
    failure.null_space = named.collect();
    for row in rows {
        if let Some(block) = state.program.block(row) {
            failure.origins.extend(block.origins.iter().cloned());
        }
    }
    for column in columns {
        failure = failure.at_unknown(state.program, column, at.y);
    }
    failure
}

/// What the equations are solved for in a column: the rate of a state, else the unknown.
fn solved_for(state: &State<'_>, column: usize) -> String {
    let name = state.program.unknown_name(column);
    match state.differential[column] {
        true => format!("der({name})"),
        false => name,
    }
}

/// Whether the matrix is singular to rounding.
pub(crate) fn is_singular(state: &State<'_>, matrix: &[f64]) -> bool {
    dependent(state, matrix).is_some()
}

/// The rows that combine to zero, and the columns that do with their factors, the largest 1.
type Dependent = (Vec<usize>, Vec<(usize, f64)>);

/// What depends on each other in a matrix; `None` if nothing does, or the system is large.
fn dependent(state: &State<'_>, matrix: &[f64]) -> Option<Dependent> {
    let n = state.program.n_unknowns;
    if n == 0 || n > MAX_UNKNOWNS || matrix.iter().any(|value| !value.is_finite()) {
        return None;
    }
    let jacobian = state.program.jacobian();
    let mut dense = DMatrix::zeros(n, n);
    for column in 0..n {
        let entries = jacobian.column_starts[column]..jacobian.column_starts[column + 1];
        for entry in entries {
            let entry = usize::try_from(entry).ok()?;
            let row = usize::try_from(jacobian.rows[entry]).ok()?;
            dense[(row, column)] = matrix[entry];
        }
    }
    for mut row in dense.row_iter_mut() {
        let most = row.amax();
        if most > 0.0 {
            row /= most;
        }
    }
    let mut scales = vec![1.0; n];
    for (mut column, scale) in dense.column_iter_mut().zip(&mut scales) {
        let most = column.amax();
        if most > 0.0 {
            column /= most;
            *scale = most;
        }
    }
    let svd = dense.svd(true, true);
    let least = svd.singular_values.imin();
    if svd.singular_values[least] > ZERO * svd.singular_values.max() {
        return None;
    }
    let taking_part = |values: Vec<f64>| -> Vec<usize> {
        let most = largest_of(&values);
        let part = values.iter().enumerate();
        part.filter(|(_, v)| v.abs() > TAKES_PART * most)
            .map(|(number, _)| number)
            .collect()
    };
    let rows = taking_part(svd.u?.column(least).iter().copied().collect());
    let factors: Vec<f64> = svd.v_t?.row(least).iter().copied().collect();
    let columns = taking_part(factors.clone());
    let change = |column: &usize| factors[*column] / scales[*column];
    let largest = columns.iter().map(change);
    let largest = largest.fold(
        0.0,
        |most: f64, own| if own.abs() > most.abs() { own } else { most },
    );
    let open = columns
        .iter()
        .map(|column| (*column, change(column) / largest));
    Some((rows, open.collect()))
}
