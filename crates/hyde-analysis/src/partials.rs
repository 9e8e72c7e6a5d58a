//! Derivatives of every function by the solver's vector, its derivative, delayed values and time; by parameters on
//! request (S2).
//!
//! Explicit variables are replaced by their definitions first, shifted to the counter of the row that reads them, so the
//! result is the total derivative. One reverse pass a row gives all its entries; an array row gives array entries.

use hyde_ir::dae::{Dae, Definition, Function, InitialCondition, Partial, Space, Wrt};
use hyde_ir::{
    ClockId, Expr, ExprArena, ExprId, Id as _, Index, ParamId, Range, VarId, VariableKind,
};
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

/// Derivatives of the functions by chosen elements of parameters. The chosen ones are independent of each other; every
/// other parameter whose value uses them follows.
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
                let derivative = by_parameter(dae, value, (param, element), chosen);
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
            let value = dae.exprs.with_counter(value, at);
            let value = dae.exprs.rewrite(value, &mut HashMap::new(), |_, _, expr| {
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

fn by_parameter(
    dae: &mut Dae,
    value: ExprId,
    (param, element): (ParamId, usize),
    chosen: &[(ParamId, usize)],
) -> ExprId {
    let mut following: HashMap<ParamId, Vec<ExprId>> = HashMap::new();
    for id in dae.exprs.below(&[value]) {
        let Expr::Param(p, _) = dae.exprs[id] else {
            continue;
        };
        if following.contains_key(&p) || chosen.iter().any(|(other, _)| *other == p) {
            continue;
        }
        let values = dae.parameters[p].value.clone();
        let derivatives = values
            .into_iter()
            .map(|inner| by_parameter(dae, inner, (param, element), chosen))
            .collect();
        following.insert(p, derivatives);
    }
    let (zero, one) = (dae.exprs.constant(0.0), dae.exprs.constant(1.0));
    // An element that moves with the counter is the one of that number where the counter meets it.
    let at_element = |arena: &mut ExprArena, index: Index, number: usize, value, other| {
        let number = i32::try_from(number).unwrap_or(0);
        let counter = arena.add(Expr::Counter);
        let at = arena.constant(f64::from(number - index.offset) / f64::from(index.stride));
        let meets = arena.binary(hyde_ir::BinaryOp::Eq, counter, at);
        arena.if_else(meets, value, other)
    };
    dae.exprs.tangent(value, |arena, leaf| {
        let Expr::Param(p, index) = leaf else {
            return None;
        };
        if p == param {
            let fixed = Index::fixed(i32::try_from(element).unwrap_or(0));
            return match index.stride {
                0 => (index == fixed).then_some(one),
                _ => Some(at_element(arena, index, element, one, zero)),
            };
        }
        let values = following.get(&p)?;
        match (values.as_slice(), index.stride) {
            // One value serves all elements.
            ([all], _) => Some(*all),
            (values, 0) => values.get(usize::try_from(index.offset).ok()?).copied(),
            (values, _) => {
                let moving = values.iter().enumerate();
                let moving = moving.filter(|&(_, &value)| value != zero);
                moving.fold(None, |rest, (number, &value)| {
                    let other = rest.unwrap_or(zero);
                    Some(at_element(arena, index, number, value, other))
                })
            }
        }
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
        Some(arena.with_counter(definition.value, counter))
    })
}
