//! Derivatives of every function by the solver's vector, its derivative, delayed values and time (S2).
//!
//! Explicit variables are replaced by their definitions first, shifted to the counter of the row that reads them, so the
//! result is the total derivative. One reverse pass a row gives all its entries; an array row gives array entries.

use hyde_ir::dae::{Dae, Definition, Function, InitialCondition, Partial, Space, Wrt};
use hyde_ir::{Expr, ExprArena, ExprId, Id as _, Index, Memo, Range, VarId, VariableKind};
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
                // Nothing asks for the residual's derivative by the time.
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
        // Behind the others, which are the entries of the Jacobian.
        list.sort_by_key(|partial| matches!(partial.wrt, Wrt::Delayed(_)));
        dae.partials.push((function, list));
    }
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
        Function::Delayed => dae
            .delays
            .enumerate()
            .map(|(id, delay)| {
                let offset = i32::try_from(dae.delay_offset(id)).unwrap_or(0);
                let index = Index {
                    stride: i32::from(delay.range.len() > 1),
                    offset: offset - delay.range.first,
                };
                (delay.range, index, delay.value)
            })
            .collect(),
        Function::Initial => {
            let mut row = 0;
            let mut found = Vec::new();
            for condition in &dae.initial {
                match condition {
                    InitialCondition::Equation { range, value, .. } => {
                        let offset = i32::try_from(row).unwrap_or(0) - range.first;
                        let index = if range.len() == 1 {
                            Index::fixed(offset)
                        } else {
                            Index { stride: 1, offset }
                        };
                        found.push((*range, index, *value));
                        row += range.len();
                    }
                    InitialCondition::Check { value, start, .. } => {
                        for value in [*value, *start] {
                            let index = Index::fixed(i32::try_from(row).unwrap_or(0));
                            found.push((Range::SCALAR, index, value));
                            row += 1;
                        }
                    }
                    InitialCondition::Fixed { .. } => {}
                }
            }
            found
        }
    }
}

fn wrt(dae: &Dae, leaf: Expr) -> Option<Wrt> {
    if let Expr::Var(var, index) = leaf
        && let VariableKind::Delayed(delay) = dae.variables[var].kind
    {
        let offset = index.offset + i32::try_from(dae.delay_offset(delay)).ok()?;
        return Some(Wrt::Delayed(Index { offset, ..index }));
    }
    let in_vector = |var: VarId, index: Index| {
        let place = dae
            .place(var)
            .filter(|place| place.space == Space::Unknown)?;
        Some(Index {
            offset: index.offset + i32::try_from(place.base).ok()?,
            ..index
        })
    };
    if leaf == Expr::Time {
        return Some(Wrt::Time);
    }
    let (var, index, derivative) = leaf.access()?;
    let place = in_vector(var, index)?;
    Some(if derivative {
        Wrt::Derivative(place)
    } else {
        Wrt::Unknown(place)
    })
}

/// The definitions with earlier ones put in.
pub(crate) fn expanded_definitions(dae: &mut Dae) -> HashMap<VarId, Definition> {
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
pub(crate) fn expand(
    arena: &mut ExprArena,
    root: ExprId,
    definitions: &HashMap<VarId, Definition>,
) -> ExprId {
    arena.rewrite(root, &mut Memo::default(), |arena, _, expr| {
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
        Some(arena.with_counter(definition.value, counter))
    })
}
