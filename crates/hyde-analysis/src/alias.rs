//! Alias elimination: `a = b`, `a = -b`, `a + b = 0` and `a = p` (of parameters) make one of two variables.
//!
//! ```text
//! motor.phi = motor.shaft.phi;  bearing.a.phi = motor.shaft.phi      everything reads motor.phi
//! screw.b.tau + far.a.tau = 0                                        far.a.tau stands for -screw.b.tau
//! bearing.grip = bearing.T                                           grip stands for the parameter
//! ```
//!
//! Of a class of equal variables the one is kept that cannot go (held, column, discrete), else an element of an array
//! (its array needs it), else the one that was given a fixed start, else the first declared.

use crate::system::{Cell, System};
use hyde_ir::dae::Alias;
use hyde_ir::{BinaryOp, Expr, ExprId, StateChoice, UnaryOp};
use std::collections::BTreeMap;

/// What an equation says of two cells.
enum Fact {
    Equal(Cell, Cell, bool),
    Value(Cell, ExprId),
}

/// Eliminates what equations say to be equal; whether anything was.
pub(crate) fn eliminate(system: &mut System) -> bool {
    let mut merged: BTreeMap<Cell, Alias> = BTreeMap::new();
    let mut kept = Vec::new();
    for equation in std::mem::take(&mut system.equations) {
        let fact = if equation.range == hyde_ir::Range::SCALAR {
            fact(system, equation.lhs, equation.rhs)
        } else {
            None
        };
        let used = match fact {
            Some(Fact::Equal(a, b, negated)) => join(system, &mut merged, a, b, negated),
            Some(Fact::Value(cell, value)) => assign(system, &mut merged, cell, value),
            None => false,
        };
        if !used {
            kept.push(equation);
        }
    }
    system.equations = kept;
    if merged.is_empty() {
        return false;
    }
    let resolved: BTreeMap<Cell, Alias> = merged
        .keys()
        .map(|&cell| (cell, follow(system, &merged, cell)))
        .collect();
    for (&cell, alias) in &resolved {
        move_starts(system, cell, alias);
    }
    system.rewrite_all(None, |arena, expr| {
        let (var, index, derivative) = match expr {
            Expr::Var(var, index) => (var, index, false),
            Expr::Der(var, index) => (var, index, true),
            Expr::Const(_)
            | Expr::Time
            | Expr::Counter
            | Expr::Param(..)
            | Expr::Pre(..)
            | Expr::Relation(_)
            | Expr::InMode(..)
            | Expr::Unary(..)
            | Expr::Binary(..)
            | Expr::If(..)
            | Expr::NoEvent(_) => return None,
        };
        match resolved.get(&System::cell(var, index)?)? {
            Alias::Value(value) => Some(if derivative {
                arena.constant(0.0)
            } else {
                *value
            }),
            Alias::Of {
                var,
                element,
                negated,
            } => {
                let index = System::cell_index((*var, *element));
                let id = arena.add(if derivative {
                    Expr::Der(*var, index)
                } else {
                    Expr::Var(*var, index)
                });
                Some(if *negated { arena.negative(id) } else { id })
            }
        }
    });
    for alias in system.aliases.values_mut() {
        if let Alias::Of {
            var,
            element,
            negated,
        } = *alias
        {
            match resolved.get(&(var, element)) {
                Some(Alias::Of {
                    var,
                    element,
                    negated: again,
                }) => {
                    *alias = Alias::Of {
                        var: *var,
                        element: *element,
                        negated: negated != *again,
                    };
                }
                Some(Alias::Value(value)) => {
                    let value = if negated {
                        system.flat.exprs.negative(*value)
                    } else {
                        *value
                    };
                    *alias = Alias::Value(value);
                }
                None => {}
            }
        }
    }
    system.aliases.extend(resolved);
    true
}

/// The cell an expression is, up to its sign.
pub(crate) fn signed_cell(system: &System, id: ExprId) -> Option<(Cell, bool)> {
    if let Expr::Unary(UnaryOp::Neg, inner) = system.flat.exprs[id] {
        let (cell, negated) = signed_cell(system, inner)?;
        return Some((cell, !negated));
    }
    let Expr::Var(var, index) = system.flat.exprs[id] else {
        return None;
    };
    Some((System::cell(var, index)?, false))
}

fn fact(system: &System, lhs: ExprId, rhs: ExprId) -> Option<Fact> {
    let exprs = &system.flat.exprs;
    let (left, right) = (signed_cell(system, lhs), signed_cell(system, rhs));
    if let (Some((a, minus_a)), Some((b, minus_b))) = (left, right) {
        return Some(Fact::Equal(a, b, minus_a != minus_b));
    }
    for (cell, other) in [(left, rhs), (right, lhs)] {
        if let Some((cell, negated)) = cell {
            if !negated && system.is_parametric(other) {
                return Some(Fact::Value(cell, other));
            }
            if negated && exprs.as_constant(other) == Some(0.0) {
                return Some(Fact::Value(cell, other));
            }
        }
    }
    let sum = if exprs.as_constant(rhs) == Some(0.0) {
        lhs
    } else if exprs.as_constant(lhs) == Some(0.0) {
        rhs
    } else {
        return None;
    };
    let Expr::Binary(op @ (BinaryOp::Add | BinaryOp::Sub), a, b) = exprs[sum] else {
        return None;
    };
    let ((a, minus_a), (b, minus_b)) = (signed_cell(system, a)?, signed_cell(system, b)?);
    let negated = (minus_a != minus_b) != (op == BinaryOp::Add);
    Some(Fact::Equal(a, b, negated))
}

/// Joins two cells; whether the equation is used up by that.
fn join(
    system: &System,
    merged: &mut BTreeMap<Cell, Alias>,
    a: Cell,
    b: Cell,
    negated: bool,
) -> bool {
    let ((a, minus_a), (b, minus_b)) = match (root(merged, a), root(merged, b)) {
        (Ok(a), Ok(b)) => (a, b),
        (Ok((cell, minus)), Err(value)) | (Err(value), Ok((cell, minus))) => {
            // The value is only used where no sign stands between: the rest stays an equation.
            return !minus && !negated && assign(system, merged, cell, value);
        }
        (Err(_), Err(_)) => return false,
    };
    if a == b {
        return false;
    }
    let negated = negated != (minus_a != minus_b);
    let (kept, gone) = if rank(system, a) <= rank(system, b) {
        (a, b)
    } else {
        (b, a)
    };
    if !may_go(system, gone) {
        return false;
    }
    merged.insert(
        gone,
        Alias::Of {
            var: kept.0,
            element: kept.1,
            negated,
        },
    );
    true
}

fn assign(system: &System, merged: &mut BTreeMap<Cell, Alias>, cell: Cell, value: ExprId) -> bool {
    match root(merged, cell) {
        Ok((root, false)) if may_go(system, root) => {
            merged.insert(root, Alias::Value(value));
            true
        }
        Ok(_) | Err(_) => false,
    }
}

/// The cell (with sign) or value a cell stands for so far.
fn root(merged: &BTreeMap<Cell, Alias>, cell: Cell) -> Result<(Cell, bool), ExprId> {
    let (mut cell, mut negated) = (cell, false);
    loop {
        match merged.get(&cell) {
            None => return Ok((cell, negated)),
            Some(Alias::Value(value)) => return Err(*value),
            Some(Alias::Of {
                var,
                element,
                negated: minus,
            }) => {
                cell = (*var, *element);
                negated = negated != *minus;
            }
        }
    }
}

fn follow(system: &mut System, merged: &BTreeMap<Cell, Alias>, cell: Cell) -> Alias {
    let (mut at, mut negated) = (cell, false);
    loop {
        match merged.get(&at) {
            None => {
                return Alias::Of {
                    var: at.0,
                    element: at.1,
                    negated,
                };
            }
            Some(Alias::Value(value)) => {
                let value = if negated {
                    system.exprs().negative(*value)
                } else {
                    *value
                };
                return Alias::Value(value);
            }
            Some(Alias::Of {
                var,
                element,
                negated: minus,
            }) => {
                at = (*var, *element);
                negated = negated != *minus;
            }
        }
    }
}

/// Only scalars that the continuous equations determine may be eliminated.
fn may_go(system: &System, cell: Cell) -> bool {
    system.is_continuous(cell.0) && system.flat.variables[cell.0].len.is_none()
}

/// Smaller is kept.
fn rank(system: &System, cell: Cell) -> (u8, Cell) {
    let variable = &system.flat.variables[cell.0];
    let fixed = system
        .starts
        .get(&cell)
        .is_some_and(|list| list.iter().any(|(_, fixed, _)| *fixed));
    let class = if !system.is_continuous(cell.0) {
        0
    } else if variable.len.is_some() {
        1
    } else if variable.state >= StateChoice::Prefer {
        2
    } else if fixed {
        3
    } else if system.starts.contains_key(&cell) {
        4
    } else if variable.flow {
        6
    } else {
        5
    };
    (class, cell)
}

/// The start values of an eliminated variable go to the one kept, and what its author says of it as a state.
fn move_starts(system: &mut System, cell: Cell, alias: &Alias) {
    let said = system.flat.variables[cell.0].state;
    if let Alias::Of { var, .. } = *alias {
        let kept = &mut system.flat.variables[var].state;
        if *kept == StateChoice::Open {
            *kept = said;
        }
    }
    let Some(starts) = system.starts.remove(&cell) else {
        return;
    };
    let (var, element, negated) = match *alias {
        Alias::Of {
            var,
            element,
            negated,
        } => (var, element, negated),
        Alias::Value(value) => {
            let fixed = starts.into_iter().filter(|(_, fixed, _)| *fixed);
            let met = fixed.map(|(start, _, given_by)| (given_by, value, start));
            system.known_starts.extend(met);
            return;
        }
    };
    for (value, fixed, given_by) in starts {
        let value = if negated {
            system.exprs().negative(value)
        } else {
            value
        };
        system
            .starts
            .entry((var, element))
            .or_default()
            .push((value, fixed, given_by));
    }
}
