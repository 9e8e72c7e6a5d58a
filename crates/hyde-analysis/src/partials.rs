//! Derivatives of every function by the solver's vector, its derivative, delayed values and time (S2).
//!
//! Explicit variables are replaced by their definitions first, shifted to the counter of the row that reads them, so the
//! result is the total derivative. One reverse pass a row gives all its entries; an array row gives array entries. Where a
//! row reads an array that is defined in several pieces, it has as many parts:
//! ```text
//! tau[0] = 2*q[0];  tau[i] = q[i] for i in 1..8;  row i: tau[i] - tau[i-1] for i in 1..8
//!     row 1: q[1] - 2*q[0];  row i: q[i] - q[i-1] for i in 2..8
//! ```

use crate::shapes::{define_slopes, is_leaf, through_shapes};
use crate::turning;
use hyde_ir::dae::{Dae, Definition, Function, InitialCondition, Partial, Space, Wrt};
use hyde_ir::{Expr, ExprArena, ExprId, Id as _, Index, Memo, Range, VarId, VariableKind};
use rustc_hash::FxHashMap;
use std::collections::{BTreeMap, BTreeSet};

/// Fills in the derivatives of the DAE's functions.
pub(crate) fn differentiate(dae: &mut Dae) {
    let all = expanded_definitions(dae, &|_| true);
    let slopes = define_slopes(dae, &all);
    let definitions = match slopes.is_empty() {
        true => all,
        false => expanded_definitions(dae, &|var| !slopes.contains_key(&var)),
    };
    for function in Function::ALL {
        let mut list = Vec::new();
        if function == Function::Angles {
            dae.partials.push((function, list));
            continue;
        }
        let rows = expanded_rows(dae, function, &definitions);
        if function == Function::Residual {
            let values: Vec<ExprId> = rows.iter().map(|(_, _, value)| *value).collect();
            turning::find(dae, &values);
        }
        if function == Function::Roots {
            let values: Vec<ExprId> = rows.iter().map(|(_, _, value)| *value).collect();
            turning::find_angles(dae, &values);
        }
        for (range, row, value) in rows {
            let gradient = dae.exprs.gradient(value, is_leaf);
            for (wrt, derivative) in through_shapes(dae, gradient, &slopes) {
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

/// The rows of a function with explicit variables replaced by their definitions.
pub(crate) fn expanded_rows(
    dae: &mut Dae,
    function: Function,
    definitions: &Pieces,
) -> Vec<(Range, Index, ExprId)> {
    let mut found = Vec::new();
    for (range, row, value) in rows(dae, function) {
        let parts = expand(&mut dae.exprs, range, value, definitions);
        found.extend(parts.into_iter().map(|(part, value)| (part, row, value)));
    }
    found
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
        Function::Angles => dae
            .angles
            .iter()
            .enumerate()
            .map(|(row, &value)| scalar(row, value))
            .collect(),
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

/// What the derivative by a leaf is by; none by what the solver does not change.
pub(crate) fn wrt(dae: &Dae, leaf: Expr) -> Option<Wrt> {
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

/// The definitions of each variable, with earlier ones put in: of an array in several pieces one for each, by the element it
/// begins with.
pub(crate) type Pieces = FxHashMap<VarId, BTreeMap<i32, Definition>>;

/// The definitions of some variables of the model with earlier ones put in.
pub(crate) fn expanded_definitions(dae: &mut Dae, of: &dyn Fn(VarId) -> bool) -> Pieces {
    let mut known = Pieces::default();
    let definitions = dae.definitions.clone().into_iter();
    for definition in definitions.filter(|own| !own.slope && of(own.var)) {
        for (range, value) in expand(&mut dae.exprs, definition.range, definition.value, &known) {
            let piece = Definition {
                range,
                value,
                ..definition.clone()
            };
            let ends = [range.first, range.last].map(|counter| piece.index.at(counter));
            let pieces = known.entry(definition.var).or_default();
            pieces.insert(ends[0].min(ends[1]), piece);
        }
    }
    known
}

/// An expression with explicit variables replaced by their definitions, for each part of the range: it ends where the
/// expression begins to read another piece of an array.
pub(crate) fn expand(
    arena: &mut ExprArena,
    range: Range,
    root: ExprId,
    definitions: &Pieces,
) -> Vec<(Range, ExprId)> {
    let parts = parts(arena, range, root, definitions);
    let replaced = parts.into_iter().map(|part| {
        let value = arena.rewrite(root, &mut Memo::default(), |arena, _, expr| {
            let Expr::Var(var, index) = expr else {
                return None;
            };
            let pieces = definitions.get(&var)?;
            let (_, definition) = pieces.range(..=index.at(part.first)).next_back()?;
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
        });
        // Of a single row the same element has the same index, wherever it is read.
        let value = match part.len() {
            1 => arena.with_counter(value, Index::fixed(part.first)),
            _ => value,
        };
        (part, value)
    });
    replaced.collect()
}

/// The parts of a range in each of which an expression reads one piece of every explicit array.
fn parts(arena: &ExprArena, range: Range, root: ExprId, definitions: &Pieces) -> Vec<Range> {
    let mut starts = BTreeSet::from([range.first]);
    for id in arena.below(&[root]) {
        let Expr::Var(var, index) = arena[id] else {
            continue;
        };
        let pieces = definitions.get(&var).into_iter().flatten();
        let begins = pieces.skip(1).map(|(&begin, _)| begin);
        let ends = begins.filter_map(|begin| first_beyond(index, begin));
        starts.extend(ends.filter(|&start| range.first < start && start <= range.last));
    }
    let starts: Vec<i32> = starts.into_iter().collect();
    let next = starts.iter().skip(1).map(|start| start - 1);
    let lasts = next.chain([range.last]);
    let parts = starts.iter().zip(lasts);
    parts.map(|(&first, last)| Range { first, last }).collect()
}

/// The first counter at which an index is on the other side of where a piece begins; none where it does not move.
fn first_beyond(index: Index, begin: i32) -> Option<i32> {
    let distance = match index.stride {
        0 => return None,
        1.. => begin - index.offset,
        _ => index.offset - begin + 1,
    };
    let stride = index.stride.abs();
    Some((distance + stride - 1).div_euclid(stride))
}
