//! Derivatives of every function by the solver's vector, its derivative, and time; by parameters on request (S2).
//!
//! Explicit variables are replaced by their definitions first, shifted to the counter of the row that reads them, so the
//! result is the total derivative. One reverse pass a row gives all its entries; an array row gives array entries.

use hyde_ir::dae::{Dae, Definition, Function, InitialCondition, Partial, Space, Wrt};
use hyde_ir::{ClockId, Expr, ExprArena, ExprId, Id as _, Index, ParamId, Range, VarId};
use std::collections::HashMap;

/// Fills in the derivatives of the DAE's functions.
pub(crate) fn differentiate(dae: &mut Dae) {
    let definitions = expanded_definitions(dae);
    for function in Function::ALL {
        let mut list = Vec::new();
        for (range, row, value) in rows(dae, function) {
            let value = expand(&mut dae.exprs, value, &definitions);
            let gradient = dae.exprs.gradient(value, |expr| {
                matches!(expr, Expr::Var(..) | Expr::Der(..) | Expr::Time)
            });
            for (leaf, derivative) in gradient {
                let Some(wrt) = wrt(dae, leaf) else { continue };
                // The residual's derivatives are the entries of the Jacobian and nothing else.
                if function == Function::Residual && wrt == Wrt::Time {
                    continue;
                }
                list.push(Partial {
                    range,
                    row,
                    wrt,
                    value: derivative,
                });
            }
        }
        dae.partials.push((function, list));
    }
}

/// Derivatives of the functions by chosen elements of parameters, through what is derived from them alone. Parameters
/// whose values use others count as independent: the run knows which of them are set.
pub fn parameter_partials(
    dae: &mut Dae,
    chosen: &[(ParamId, usize)],
) -> Vec<(Function, Vec<Partial>)> {
    let definitions = expanded_definitions(dae);
    let mut found = Vec::new();
    for function in Function::ALL {
        let mut list = Vec::new();
        for (range, row, value) in rows(dae, function) {
            let value = expand(&mut dae.exprs, value, &definitions);
            for &(param, element) in chosen {
                let derivative = by_parameter(dae, value, param, element);
                if !dae.exprs.is_constant(derivative, 0.0) {
                    let position = dae.parameter_places[param] + element;
                    list.push(Partial {
                        range,
                        row,
                        wrt: Wrt::Parameter(position),
                        value: derivative,
                    });
                }
            }
        }
        found.push((function, list));
    }
    found
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
}

/// Derivatives of what a tick writes (by position in the memory), through the assignments before it and through explicit
/// variables. Quantisers count as the identity (S3).
pub fn tick_partials(dae: &mut Dae, clock: ClockId) -> Vec<(usize, TickWrt, ExprId)> {
    let definitions = expanded_definitions(dae);
    let mut assigned: HashMap<(VarId, i32), ExprId> = HashMap::new();
    let mut found = Vec::new();
    for assignment in dae.ticks[clock].assignments.clone() {
        for counter in assignment.range.iter() {
            let at = Index {
                stride: 0,
                offset: counter,
            };
            let value = expand(&mut dae.exprs, assignment.value, &definitions);
            let value = shift(&mut dae.exprs, value, at);
            let value = dae
                .exprs
                .rewrite(value, &mut HashMap::new(), |_, _, expr| match expr {
                    Expr::Var(var, index) => assigned.get(&(var, index.offset)).copied(),
                    _ => None,
                });
            let element = assignment.index.at(counter);
            assigned.insert((assignment.var, element), value);
            let Some(target) = dae.place(assignment.var) else {
                continue;
            };
            let row = target.base + usize::try_from(element).unwrap_or(0);
            let leaves = |expr| matches!(expr, Expr::Var(..) | Expr::Der(..) | Expr::Pre(..));
            for (leaf, derivative) in dae.exprs.gradient(value, leaves) {
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
                    (Space::Input | Space::Work | Space::Parameter, _) => continue,
                };
                found.push((row, wrt, derivative));
            }
        }
    }
    found
}

fn by_parameter(dae: &mut Dae, value: ExprId, param: ParamId, element: usize) -> ExprId {
    let mut derived: HashMap<ParamId, ExprId> = HashMap::new();
    let used: Vec<ParamId> = dae
        .exprs
        .below(&[value])
        .into_iter()
        .filter_map(|id| {
            if let Expr::Param(p, _) = dae.exprs[id] {
                Some(p)
            } else {
                None
            }
        })
        .filter(|&p| dae.parameters[p].derived)
        .collect();
    for p in used {
        let inner = dae.parameters[p].value[0];
        let derivative = by_parameter(dae, inner, param, element);
        derived.insert(p, derivative);
    }
    let one = dae.exprs.constant(1.0);
    let chosen = Index::fixed(i32::try_from(element).unwrap_or(0));
    dae.exprs.tangent(value, |arena, leaf| match leaf {
        Expr::Param(p, index) if p == param && index == chosen => Some(one),
        // An element that moves with the counter: 1 where the counter meets it.
        Expr::Param(p, index) if p == param && index.stride != 0 => {
            let counter = arena.add(Expr::Counter);
            let at =
                arena.constant(f64::from(chosen.offset - index.offset) / f64::from(index.stride));
            let meets = arena.binary(hyde_ir::BinaryOp::Eq, counter, at);
            let zero = arena.constant(0.0);
            Some(arena.if_else(meets, one, zero))
        }
        Expr::Param(p, _) => derived.get(&p).copied(),
        _ => None,
    })
}

/// The rows of a function: range, row, value.
#[must_use]
pub fn rows(dae: &Dae, function: Function) -> Vec<(Range, Index, ExprId)> {
    let scalar = |row: usize, value: ExprId| {
        (
            Range::SCALAR,
            Index::fixed(i32::try_from(row).unwrap_or(0)),
            value,
        )
    };
    match function {
        Function::Residual => dae
            .residuals
            .iter()
            .map(|r| (r.range, r.row, r.value))
            .collect(),
        Function::Roots => dae
            .relations
            .enumerate()
            .map(|(id, relation)| scalar(id.index(), relation.root))
            .collect(),
        Function::Assignments => {
            let values = dae.assignments.iter().map(|assignment| assignment.value);
            let pins = dae.pins.iter().map(|pin| pin.value);
            values
                .chain(pins)
                .enumerate()
                .map(|(row, value)| scalar(row, value))
                .collect()
        }
        Function::Outputs => {
            let mut row = 0;
            let mut found = Vec::new();
            for output in &dae.outputs {
                let offset = i32::try_from(row).unwrap_or(0) - output.range.first;
                let index = if output.range.len() == 1 {
                    Index::fixed(offset)
                } else {
                    Index { stride: 1, offset }
                };
                found.push((output.range, index, output.value));
                row += output.range.len();
            }
            found
        }
        Function::Initial => {
            let mut row = 0;
            let mut found = Vec::new();
            for condition in &dae.initial {
                if let InitialCondition::Equation { range, value, .. } = condition {
                    let offset = i32::try_from(row).unwrap_or(0) - range.first;
                    let index = if range.len() == 1 {
                        Index::fixed(offset)
                    } else {
                        Index { stride: 1, offset }
                    };
                    found.push((*range, index, *value));
                    row += range.len();
                }
            }
            found
        }
    }
}

fn wrt(dae: &Dae, leaf: Expr) -> Option<Wrt> {
    let in_vector = |var: VarId, index: Index| {
        let place = dae
            .place(var)
            .filter(|place| place.space == Space::Unknown)?;
        Some(Index {
            offset: index.offset + i32::try_from(place.base).ok()?,
            ..index
        })
    };
    match leaf {
        Expr::Var(var, index) => Some(Wrt::Unknown(in_vector(var, index)?)),
        Expr::Der(var, index) => Some(Wrt::Derivative(in_vector(var, index)?)),
        Expr::Time => Some(Wrt::Time),
        _ => None,
    }
}

/// The definitions with earlier ones put in.
fn expanded_definitions(dae: &mut Dae) -> HashMap<VarId, Definition> {
    let mut known: HashMap<VarId, Definition> = HashMap::new();
    for definition in dae.definitions.clone() {
        let value = expand(&mut dae.exprs, definition.value, &known);
        known.insert(
            definition.var,
            Definition {
                value,
                ..definition
            },
        );
    }
    known
}

/// An expression with explicit variables replaced by their definitions.
fn expand(arena: &mut ExprArena, root: ExprId, definitions: &HashMap<VarId, Definition>) -> ExprId {
    arena.rewrite(root, &mut HashMap::new(), |arena, _, expr| {
        let Expr::Var(var, index) = expr else {
            return None;
        };
        let definition = definitions.get(&var)?;
        if definition.index.stride == 0 {
            return Some(definition.value);
        }
        // The definition's counter j in the reader's counter i: index(j) = stride_d*j + offset_d, stride_d = ±1.
        let sign = definition.index.stride;
        let counter = Index {
            stride: sign * index.stride,
            offset: sign * (index.offset - definition.index.offset),
        };
        Some(shift(arena, definition.value, counter))
    })
}

/// An expression with its counter replaced by `stride*i + offset`.
fn shift(arena: &mut ExprArena, root: ExprId, counter: Index) -> ExprId {
    if counter
        == (Index {
            stride: 1,
            offset: 0,
        })
    {
        return root;
    }
    let moved = |index: Index| Index {
        stride: index.stride * counter.stride,
        offset: index.stride * counter.offset + index.offset,
    };
    arena.rewrite(root, &mut HashMap::new(), |arena, _, expr| match expr {
        Expr::Var(var, index) if index.stride != 0 => Some(arena.add(Expr::Var(var, moved(index)))),
        Expr::Der(var, index) if index.stride != 0 => Some(arena.add(Expr::Der(var, moved(index)))),
        Expr::Param(param, index) if index.stride != 0 => {
            Some(arena.add(Expr::Param(param, moved(index))))
        }
        Expr::Counter => {
            let i = arena.add(Expr::Counter);
            let (stride, offset) = (
                arena.constant(f64::from(counter.stride)),
                arena.constant(f64::from(counter.offset)),
            );
            let scaled = arena.times(stride, i);
            Some(arena.plus(scaled, offset))
        }
        _ => None,
    })
}
