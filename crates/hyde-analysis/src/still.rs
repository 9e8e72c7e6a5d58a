//! Derivatives by what is constant between events: the parameters and the memory. A gradient of a run needs them (S1, S2),
//! nothing else does, so they are made when first asked for.
//!
//! Every number of the parameter vector counts on its own here, derived ones too; [`parameter_slopes`] tell how derived
//! ones follow from the others.

use crate::partials::{expand, expanded_definitions, expanded_rows};
use hyde_ir::dae::{Dae, Function, Partial, Space, Wrt};
use hyde_ir::{ClockId, Expr, ExprId, Index, Memo, Range, VarId};
use rustc_hash::FxHashMap;

/// Derivatives of a function by parameters and by the memory, in the order of its rows.
pub fn still_partials(dae: &mut Dae, function: Function) -> Vec<Partial> {
    let definitions = expanded_definitions(dae, &|_| true);
    let mut list = Vec::new();
    for row in expanded_rows(dae, function, &definitions) {
        slopes(dae, row, &mut list);
    }
    list
}

/// Derivatives of the parameter vector by itself, each number after those it follows from.
pub fn parameter_slopes(dae: &mut Dae) -> Vec<Partial> {
    let mut list = Vec::new();
    for param in dae.parameter_order.clone() {
        let place = i32::try_from(dae.parameter_places[param]).unwrap_or(0);
        for row in dae.parameters[param].rows(place) {
            slopes(dae, row, &mut list);
        }
    }
    list
}

/// Derivatives of the start values by parameters: rows of the solver's vector, then those of the memory.
pub fn start_slopes(dae: &mut Dae) -> Vec<Partial> {
    let n = dae.n_unknowns;
    let mut list = Vec::new();
    for start in dae.starts.clone() {
        let in_memory = start.place.space == Space::Memory;
        let base = start.place.base + if in_memory { n } else { 0 };
        let row = Index {
            offset: start.index.offset + i32::try_from(base).unwrap_or(0),
            ..start.index
        };
        slopes(dae, (start.range, row, start.value), &mut list);
    }
    list
}

/// Derivatives of a number that is made of parameters alone.
pub fn number_slopes(dae: &mut Dae, value: ExprId) -> Vec<Partial> {
    let mut list = Vec::new();
    slopes(dae, (Range::SCALAR, Index::SCALAR, value), &mut list);
    list
}

/// The derivatives of one row, or of a range of rows.
fn slopes(dae: &mut Dae, (range, row, value): (Range, Index, ExprId), list: &mut Vec<Partial>) {
    let leaves = |expr| matches!(expr, Expr::Param(..) | Expr::Var(..) | Expr::Pre(..));
    for (leaf, value) in dae.exprs.gradient(value, leaves) {
        let shifted = |index: Index, base: usize| Index {
            offset: index.offset + i32::try_from(base).unwrap_or(0),
            ..index
        };
        let wrt = match leaf {
            Expr::Param(param, index) => {
                Wrt::Parameter(shifted(index, dae.parameter_places[param]))
            }
            Expr::Var(var, index) | Expr::Pre(var, index) => match dae.place(var) {
                Some(place) if place.space == Space::Memory => {
                    Wrt::Memory(shifted(index, place.base))
                }
                Some(_) | None => continue,
            },
            Expr::Const(_)
            | Expr::Time
            | Expr::Counter
            | Expr::Der(..)
            | Expr::Relation(_)
            | Expr::InMode(..)
            | Expr::Unary(..)
            | Expr::Binary(..)
            | Expr::If(..)
            | Expr::NoEvent(_) => continue,
        };
        list.push(Partial {
            range,
            row,
            wrt,
            value,
        });
    }
}

/// By what an assignment of a tick is differentiated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TickWrt {
    /// The memory before the tick, by position.
    Memory(usize),
    /// An unknown.
    Unknown(usize),
    /// The derivative of an unknown.
    Derivative(usize),
    /// A delayed value, by its number.
    Delayed(usize),
    /// A parameter, by position.
    Parameter(usize),
}

/// Derivatives of what a tick writes (by position in the memory), through the assignments before it and through explicit
/// variables. Quantisers count as the identity (S3).
pub fn tick_partials(dae: &mut Dae, clock: ClockId) -> Vec<(usize, TickWrt, ExprId)> {
    let definitions = expanded_definitions(dae, &|_| true);
    let mut assigned: FxHashMap<(VarId, i32), ExprId> = FxHashMap::default();
    let mut found = Vec::new();
    for assignment in dae.ticks[clock].assignments.clone() {
        let (range, value) = (assignment.range, assignment.value);
        let parts = expand(&mut dae.exprs, range, value, &definitions);
        let values = parts
            .into_iter()
            .flat_map(|(part, value)| part.iter().map(move |at| (at, value)));
        for (counter, value) in values {
            let at = Index {
                stride: 0,
                offset: counter,
            };
            let value = dae.exprs.with_counter(value, at);
            let value = dae
                .exprs
                .rewrite(value, &mut Memo::default(), |_, _, expr| {
                    let Expr::Var(var, index) = expr else {
                        return None;
                    };
                    assigned.get(&(var, index.offset)).copied()
                });
            let element = assignment.index.at(counter);
            assigned.insert((assignment.var, element), value);
            let Some(target) = dae.place(assignment.var) else {
                continue;
            };
            let row = target.base + usize::try_from(element).unwrap_or(0);
            let leaves = |expr| {
                matches!(
                    expr,
                    Expr::Var(..) | Expr::Der(..) | Expr::Pre(..) | Expr::Param(..)
                )
            };
            for (leaf, derivative) in dae.exprs.gradient(value, leaves) {
                if let Expr::Param(param, index) = leaf {
                    let offset = usize::try_from(index.offset).unwrap_or(0);
                    let wrt = TickWrt::Parameter(dae.parameter_places[param] + offset);
                    found.push((row, wrt, derivative));
                    continue;
                }
                let (Expr::Var(var, index) | Expr::Der(var, index) | Expr::Pre(var, index)) = leaf
                else {
                    continue;
                };
                let Some(place) = dae.place(var) else {
                    continue;
                };
                let position = place.base + usize::try_from(index.offset).unwrap_or(0);
                let wrt = match (place.space, leaf) {
                    (Space::Unknown, Expr::Der(..)) => TickWrt::Derivative(position),
                    (Space::Unknown, _) => TickWrt::Unknown(position),
                    (Space::Memory, _) => TickWrt::Memory(position),
                    (Space::Input, _) if position >= 2 * dae.columns.len() => {
                        TickWrt::Delayed(position - 2 * dae.columns.len())
                    }
                    (Space::Input | Space::Work | Space::Parameter, _) => continue,
                };
                found.push((row, wrt, derivative));
            }
        }
    }
    found
}
