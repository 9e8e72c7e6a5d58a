//! [`Configuration`]: the model in one combination of modes, linearised once: what a fixed step is made of.
//!
//! With the states x and v = (rates of the states, algebraic variables) the model is F(t, x, v) = 0. The inverse of dF/dv
//! makes v from x by one product where F is linear in v, and dx'/dx = A is the linear part of the flow, which steps carry
//! exactly ([`crate::linear`]). What is not linear is added step by step, so a configuration is exact for no model
//! but a linear one, and needs to be near enough for every other. Most equations of a drive are linear: what follows from
//! them is carried along, and only the others are evaluated in a step ([`Bending`]).

use super::gains::Gains;
use super::leg::Instant;
use crate::linear::{Step, set_product, steps};
use hyde_program::{Function, Kernels, Point, Program, SomeRows, Workspace, Wrt};
use nalgebra::DMatrix;
use std::collections::BTreeSet;

/// How far from each other derivatives may be that are the same number.
const SAME: f64 = 1e-9;

/// The places of states and algebraic variables in the solver's vector.
pub(crate) struct Places {
    pub(crate) differential: Vec<bool>,
    pub(crate) states: Vec<usize>,
    pub(crate) algebraics: Vec<usize>,
}

/// The model in one combination of modes.
pub(crate) struct Configuration<'p> {
    /// The inverse of dF/dv.
    pub(crate) inverse: DMatrix<f64>,
    /// dF/dv is the same everywhere: v comes from one product.
    pub(crate) constant: bool,
    /// F is linear in everything and does not depend on time: a step needs no kernel.
    pub(crate) affine: bool,
    /// Derivatives by the states: of their rates, and below them of the algebraic variables.
    pub(crate) by_states: DMatrix<f64>,
    /// Steps of a row's time over 1, 2, 4, … .
    pub(crate) steps: Vec<Step>,
    /// What the same steps make of the rates where all is linear: how the states change, the rates after it, and how the
    /// algebraic variables change, one below the other.
    pub(crate) flows: Vec<DMatrix<f64>>,
    /// What is not linear.
    pub(crate) bending: Bending<'p>,
    /// The point at which it is linear.
    pub(crate) made: Instant,
    /// What an observer corrects it by ([`crate::observer::Observer::gain_in`]); empty until one has met it.
    pub(crate) gains: Gains,
}

/// The equations that are not linear, or read what is outside ([`Kernels::bending_rows`]): in a step, only these are evaluated.
pub(crate) struct Bending<'p> {
    residual: Box<dyn SomeRows + 'p>,
    pub(crate) count: usize,
    /// What a unit of their residuals changes: rates of the states, and below them the algebraic variables.
    by_residual: DMatrix<f64>,
    /// What it does to the states over a step of each length: as it is, and growing evenly from nothing.
    pub(crate) first: Vec<DMatrix<f64>>,
    pub(crate) second: Vec<DMatrix<f64>>,
}

impl Places {
    pub(crate) fn new(program: &Program, memory: &[f64]) -> Self {
        let differential = program.differential(memory);
        let chosen = |state: bool| {
            (0..program.n_unknowns)
                .filter(|&i| differential[i] == state)
                .collect()
        };
        Self {
            states: chosen(true),
            algebraics: chosen(false),
            differential,
        }
    }
}

impl Bending<'_> {
    /// The residuals of these equations.
    pub(crate) fn residual(&self, at: Point<'_>, workspace: &mut Workspace, residual: &mut [f64]) {
        self.residual.evaluate(at, workspace, residual);
    }

    /// What rates and algebraic variables change by to answer residuals.
    pub(crate) fn follow(&self, residual: &[f64], change: &mut [f64]) {
        set_product(&self.by_residual, &residual[..self.count], change);
    }
}

impl<'p> Configuration<'p> {
    /// Linearises at a point; `None` where the equations do not determine v there.
    pub(crate) fn new(
        program: &'p Program,
        places: &Places,
        at: Point<'_>,
        workspace: &mut Workspace,
        step_s: f64,
        levels: usize,
    ) -> Option<Self> {
        let here = partials(program, at, workspace);
        let inverse = consistent(program, places, &here).try_inverse()?;
        let by_state = arranged(program, &here, |wrt| x_column(places, wrt));
        let by_state = by_state.select_columns(&places.states);
        let (n, m) = (places.states.len(), places.algebraics.len());
        let ordered = [places.states.as_slice(), &places.algebraics].concat();
        let by_states = -(&inverse * by_state).select_rows(&ordered);
        let a = by_states.rows(0, n).into_owned();
        let algebraic = by_states.rows(n, m);
        let (constant, affine) = linearity(program, places, at, workspace, &here);
        let steps = steps(&a, step_s, levels);
        let flow = |step: &Step| {
            let mut all = DMatrix::zeros(2 * n + m, n);
            all.rows_mut(0, n).copy_from(&step.first);
            all.rows_mut(n, n).copy_from(&step.exp);
            all.rows_mut(2 * n, m).copy_from(&(algebraic * &step.first));
            all
        };
        let flows = steps.iter().map(flow).collect();
        let bending = program.kernels.bending_rows();
        let by_residual = -inverse.select_columns(bending).select_rows(&ordered);
        let rates = by_residual.rows(0, n);
        let bending = Bending {
            residual: program.kernels.some_rows(Function::Residual, bending),
            count: bending.len(),
            first: steps.iter().map(|step| &step.first * rates).collect(),
            second: steps.iter().map(|step| &step.second * rates).collect(),
            by_residual,
        };
        Some(Self {
            flows,
            steps,
            inverse,
            constant,
            affine,
            by_states,
            bending,
            made: Instant::of(at),
            gains: Gains::none(0, 0),
        })
    }

    /// What rates and algebraic variables change by with a unit of a state.
    pub(crate) fn by_state(&self, state: usize) -> &[f64] {
        let rows = self.by_states.nrows();
        &self.by_states.as_slice()[state * rows..][..rows]
    }
}

/// The derivatives of the residual at a point.
pub(crate) fn partials(program: &Program, at: Point<'_>, workspace: &mut Workspace) -> Vec<f64> {
    let mut values = vec![0.0; program.partials(Function::Residual).len()];
    let kernels: &dyn Kernels = program.kernels.as_ref();
    kernels.partials(Function::Residual, at, workspace, &mut values);
    values
}

/// dF/dv: by the rates of states, by the values of the others.
fn consistent(program: &Program, places: &Places, partials: &[f64]) -> DMatrix<f64> {
    arranged(program, partials, |wrt| v_column(places, wrt))
}

/// Derivatives of the residual, a row an equation, a column an unknown: those of a kind that says which column each has.
pub(crate) fn arranged(
    program: &Program,
    partials: &[f64],
    column: impl Fn(Wrt) -> Option<usize>,
) -> DMatrix<f64> {
    let n = program.n_unknowns;
    let mut matrix = DMatrix::zeros(n, n);
    for (entry, &value) in program.partials(Function::Residual).iter().zip(partials) {
        if let Some(column) = column(entry.wrt) {
            matrix[(entry.row, column)] += value;
        }
    }
    matrix
}

/// The unknown of a derivative by v: by the rate of a state, or by an algebraic variable.
pub(crate) fn v_column(places: &Places, wrt: Wrt) -> Option<usize> {
    match wrt {
        Wrt::Derivative(column) if places.differential[column] => Some(column),
        Wrt::Unknown(column) if !places.differential[column] => Some(column),
        Wrt::Derivative(_)
        | Wrt::Unknown(_)
        | Wrt::Parameter(_)
        | Wrt::Memory(_)
        | Wrt::Delayed(_)
        | Wrt::Time => None,
    }
}

/// The state of a derivative by x.
pub(crate) fn x_column(places: &Places, wrt: Wrt) -> Option<usize> {
    match wrt {
        Wrt::Unknown(column) => places.differential[column].then_some(column),
        Wrt::Derivative(_) | Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Delayed(_) | Wrt::Time => {
            None
        }
    }
}

/// The numbers of those derivatives of the residual that are not the same at points near and far.
pub(crate) fn uneven(
    program: &Program,
    at: Point<'_>,
    workspace: &mut Workspace,
    here: &[f64],
) -> BTreeSet<usize> {
    let mut found = BTreeSet::new();
    for (number, size) in [1e-3, 0.3, 1.0, 30.0, 1e3].into_iter().enumerate() {
        // Any numbers without relation to each other.
        let moved = |values: &[f64], shift: usize| -> Vec<f64> {
            let pairs = values.iter().enumerate();
            pairs
                .map(|(i, &value)| {
                    let part = (12.9898 * (i + shift) as f64 + 78.233 * number as f64).sin();
                    value + size * part * (1.0 + value.abs())
                })
                .collect()
        };
        let (y, yp) = (&moved(at.y, 1), &moved(at.yp, 1000));
        let there = partials(program, Point { y, yp, ..at }, workspace);
        let pairs = here.iter().zip(&there).enumerate();
        let other = |&(_, (&a, &b)): &(usize, (&f64, &f64))| {
            let same = (a - b).abs() <= SAME * a.abs().max(b.abs());
            !same
        };
        found.extend(pairs.filter(other).map(|(entry, _)| entry));
    }
    found
}

/// Whether dF/dv, and whether everything, is the same at points near and far, at other times and between rows.
fn linearity(
    program: &Program,
    places: &Places,
    at: Point<'_>,
    workspace: &mut Workspace,
    here: &[f64],
) -> (bool, bool) {
    let entries = program.partials(Function::Residual);
    let uneven = uneven(program, at, workspace, here);
    let of_v = |number: &usize| v_column(places, entries[*number].wrt).is_some();
    let (constant, affine) = (!uneven.iter().any(of_v), uneven.is_empty());
    let residual = |at: Point<'_>, workspace: &mut Workspace| {
        let mut out = vec![0.0; program.n_unknowns];
        program
            .kernels
            .evaluate(Function::Residual, at, workspace, &mut out);
        out
    };
    let before = residual(at, workspace);
    let later = residual(
        Point {
            t: at.t + 0.377,
            ..at
        },
        workspace,
    );
    let columns = 2 * program.columns.len();
    let linear: Vec<f64> =
        at.u.iter()
            .enumerate()
            .map(|(i, u)| u + f64::from(u8::from(i < columns && i % 2 == 0)))
            .collect();
    let between = residual(Point { u: &linear, ..at }, workspace);
    let same = |before: &[f64], other: &[f64]| {
        before
            .iter()
            .zip(other)
            .all(|(a, b)| a.to_bits() == b.to_bits())
    };
    let delayed = |u: &[f64], workspace: &mut Workspace| {
        let mut out = vec![0.0; program.delays.len()];
        program
            .kernels
            .evaluate(Function::Delayed, Point { u, ..at }, workspace, &mut out);
        out
    };
    let held = same(&delayed(at.u, workspace), &delayed(&linear, workspace));
    (
        constant,
        affine && same(&before, &later) && same(&before, &between) && held,
    )
}
