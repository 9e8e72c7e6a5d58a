//! The choice of states among variables that constraints tie to each other (dummy derivatives: Mattsson and Söderlind,
//! SIAM J. Sci. Comput. 14 (1993) 677).
//!
//! With k constraints between m variables the k that the constraints determine best are not states: the columns that a
//! QR factorisation with column pivoting takes first (Golub and Van Loan, Matrix Computations, §5.4).

use crate::moment::{At, Moment};
use crate::state::State;
use hyde_program::{Firmness, Function, InitialCondition, Selection, Wrt};
use nalgebra::{DMatrix, DVector};

/// The choice is changed when another one is better by this factor.
const WORTH_A_CHANGE: f64 = 5.0;

/// How little the column of a variable counts whose value is given: it is determined only where nothing else can be.
const GIVEN: f64 = 1e-6;

/// Steps to the constraints at most.
const MAX_STEPS_TO_CONSTRAINTS: usize = 30;

/// Chooses at the start: variables with a fixed start value stay states where the constraints allow it. States keep their
/// start values; what the constraints determine gets a first value.
pub(crate) fn choose_at_start(state: &mut State<'_>, now: &mut Moment) {
    let mut fixed = vec![false; now.y.len()];
    for condition in &state.program.initial {
        if let InitialCondition::Fixed {
            state: first,
            len,
            firmness: Firmness::Default | Firmness::Given,
            ..
        } = condition
        {
            fixed[*first..*first + *len]
                .iter_mut()
                .for_each(|flag| *flag = true);
        }
    }
    let start = now.y.clone();
    meet_constraints(state, now, &fixed);
    for selection in &state.program.selections {
        let mut jacobian = weighted(jacobian(state, selection, now.at()), selection);
        for (column, &candidate) in selection.candidates.iter().enumerate() {
            if fixed[candidate] {
                jacobian.column_mut(column).scale_mut(GIVEN);
            }
        }
        let determined = best(&jacobian);
        set(state, selection, &determined);
    }
    for selection in &state.program.selections {
        for &candidate in &selection.candidates {
            if state.differential[candidate] {
                now.y[candidate] = start[candidate];
            }
        }
    }
}

/// Moves what is not fixed to the constraints, as little as possible: Gauss-Newton steps of least norm (Golub and Van Loan,
/// §5.5). The constraints' Jacobian at bare start values can be singular: a motion that is prescribed has none.
fn meet_constraints(state: &mut State<'_>, now: &mut Moment, fixed: &[bool]) {
    let mut residual = vec![0.0; now.y.len()];
    for _ in 0..MAX_STEPS_TO_CONSTRAINTS {
        let mut moved = false;
        for selection in &state.program.selections {
            state.evaluate(Function::Residual, now.at(), &mut residual);
            let mut jacobian = jacobian(state, selection, now.at());
            for (column, &candidate) in selection.candidates.iter().enumerate() {
                if fixed[candidate] {
                    jacobian.column_mut(column).fill(0.0);
                }
            }
            let rows = selection.constraints.iter().map(|&row| residual[row]);
            let right = DVector::from_iterator(selection.constraints.len(), rows);
            let finite = |values: &[f64]| values.iter().all(|value| value.is_finite());
            if !finite(jacobian.as_slice()) || !finite(right.as_slice()) {
                return;
            }
            let least = 1e-10 * jacobian.amax();
            let Ok(step) = jacobian.svd(true, true).solve(&right, least) else {
                return;
            };
            for (&candidate, step) in selection.candidates.iter().zip(step.iter()) {
                now.y[candidate] -= step;
                moved |= step.abs() > 1e-10 * (1e-3 + now.y[candidate].abs());
            }
        }
        if !moved {
            return;
        }
    }
}

/// Chooses anew where another choice has become much better; whether anything changed.
pub(crate) fn choose_again(state: &mut State<'_>, at: At<'_>) -> bool {
    let mut changed = false;
    for selection in &state.program.selections {
        let jacobian = weighted(jacobian(state, selection, at), selection);
        let candidates = 0..selection.candidates.len();
        let now: Vec<usize> = candidates
            .filter(|&column| !state.differential[selection.candidates[column]])
            .collect();
        let better = best(&jacobian);
        if quality(&jacobian, &better) > WORTH_A_CHANGE * quality(&jacobian, &now) {
            set(state, selection, &better);
            changed = true;
        }
    }
    changed
}

/// Makes states of the variables that an event `struck`, as far as the constraints allow: the others follow from them.
pub(crate) fn choose_struck(state: &mut State<'_>, at: At<'_>, struck: &[usize]) {
    for selection in &state.program.selections {
        let candidates = selection.candidates.iter().enumerate();
        let given = candidates.filter(|(_, candidate)| struck.contains(candidate));
        let given: Vec<usize> = given.map(|(column, _)| column).collect();
        let is_state = |&column: &usize| state.differential[selection.candidates[column]];
        if given.iter().all(is_state) {
            continue;
        }
        let mut jacobian = weighted(jacobian(state, selection, at), selection);
        for column in given {
            jacobian.column_mut(column).scale_mut(GIVEN);
        }
        let determined = best(&jacobian);
        set(state, selection, &determined);
    }
}

/// The derivatives of the constraints by the variables.
fn jacobian(state: &mut State<'_>, selection: &Selection, at: At<'_>) -> DMatrix<f64> {
    let values = state.partials(Function::Residual, at);
    let mut found = DMatrix::zeros(selection.constraints.len(), selection.candidates.len());
    let entries = state.program.partials(Function::Residual);
    for (entry, value) in entries.iter().zip(values) {
        let row = selection
            .constraints
            .iter()
            .position(|&row| row == entry.row);
        let Wrt::Unknown(unknown) = entry.wrt else {
            continue;
        };
        let column = selection
            .candidates
            .iter()
            .position(|&candidate| candidate == unknown);
        if let (Some(row), Some(column)) = (row, column) {
            found[(row, column)] += value;
        }
    }
    found
}

/// The same with each column multiplied by its weight, for the choice.
fn weighted(mut jacobian: DMatrix<f64>, selection: &Selection) -> DMatrix<f64> {
    for (column, weight) in selection.weights.iter().enumerate() {
        jacobian.column_mut(column).scale_mut(*weight);
    }
    jacobian
}

/// The columns that determine the constraints best.
fn best(jacobian: &DMatrix<f64>) -> Vec<usize> {
    let mut order = DMatrix::from_fn(1, jacobian.ncols(), |_, column| column);
    jacobian
        .clone()
        .col_piv_qr()
        .p()
        .permute_columns(&mut order);
    let mut found: Vec<usize> = order.iter().take(jacobian.nrows()).copied().collect();
    found.sort_unstable();
    found
}

/// How far a choice is from singular: the least diagonal element of its factor.
fn quality(jacobian: &DMatrix<f64>, columns: &[usize]) -> f64 {
    let r = jacobian.select_columns(columns).col_piv_qr().r();
    r.diagonal()
        .iter()
        .fold(f64::INFINITY, |least, value| least.min(value.abs()))
}

/// Writes a choice into the memory.
fn set(state: &mut State<'_>, selection: &Selection, determined: &[usize]) {
    let m = selection.candidates.len();
    let states = (0..m).filter(|column| !determined.contains(column));
    let rows = m - selection.constraints.len();
    state.z[selection.factors..][..rows * m].fill(0.0);
    for (row, column) in states.enumerate() {
        state.z[selection.factors + row * m + column] = 1.0;
    }
    state.differential = state.program.differential(&state.z);
}
