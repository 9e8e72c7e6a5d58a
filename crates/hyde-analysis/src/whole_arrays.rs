//! Constraints between whole arrays: `for i in 1:n loop x[i] = 2*y[i]; end for;` makes x explicit in y, and the derivative
//! of any of its elements that of its value, at whatever index it stands (F3).
//!
//! ```text
//! x[i] = 2*y[i] + l,  der(x[i]) = v[i],  der(x[3]) …        v[i] = 2*der(y[i]),  … 2*der(y[3])
//! ```
//! It is [`crate::derivatives`]'s index reduction for all elements at once: its time does not go with their number.

use crate::cells::Cells;
use crate::derivatives::differentiated;
use crate::solve::solve_for;
use crate::system::{Equation, System};
use hyde_ir::dae::Dependent;
use hyde_ir::flat;
use hyde_ir::{Expr, ExprId, Index, Range, StateChoice, VarId, VariableKind};

/// Makes one array explicit where an equation allows it; whether one was.
pub(crate) fn expand_one(system: &mut System, declared: &[Vec<f64>]) -> bool {
    let constraint = |equation: &Equation| {
        let derivative = |expr| matches!(expr, Expr::Der(..));
        let exprs = &system.flat.exprs;
        equation.range != Range::SCALAR
            && !exprs.any(equation.lhs, derivative)
            && !exprs.any(equation.rhs, derivative)
    };
    if !system.equations.iter().any(constraint) {
        return false;
    }
    let differentiated = &differentiated(system);
    for number in 0..system.equations.len() {
        let Equation {
            range, lhs, rhs, ..
        } = system.equations[number];
        if range == Range::SCALAR || states(system, range, [lhs, rhs], differentiated).is_none() {
            continue;
        }
        if joined_ends(system, number) {
            return true;
        }
    }
    for number in 0..system.equations.len() {
        let range = system.equations[number].range;
        if range == Range::SCALAR {
            continue;
        }
        let (lhs, rhs) = (system.equations[number].lhs, system.equations[number].rhs);
        let Some(mut arrays) = states(system, range, [lhs, rhs], differentiated) else {
            continue;
        };
        arrays.retain(|&(var, index)| is_whole(system, range, var, index));
        arrays.sort_by_key(|&(var, index)| {
            let variable = &system.flat.variables[var];
            let left = system.flat.exprs[lhs] == Expr::Var(var, index);
            (variable.state, variable.fixed, !left, var)
        });
        for (var, index) in arrays {
            let leaf = Expr::Var(var, index);
            let alone = |system: &System, id| {
                let of_it = |expr: Expr| expr.access().is_some_and(|(v, ..)| v == var);
                !system.flat.exprs.any(id, of_it)
            };
            let Some(value) = solve_for(&mut system.flat.exprs, lhs, rhs, leaf) else {
                continue;
            };
            if alone(system, value) && !system.divides_by_zero(declared, lhs, rhs, leaf) {
                make_explicit(system, number, (var, index), value);
                return true;
            }
        }
    }
    false
}

/// Takes what is said of the elements before and behind a range into it, if that is the same: the ends of a field have
/// equations of their own.
fn joined_ends(system: &mut System, number: usize) -> bool {
    let Equation {
        range, lhs, rhs, ..
    } = system.equations[number];
    for (counter, first, last) in [
        (range.first - 1, range.first - 1, range.last),
        (range.last + 1, range.first, range.last + 1),
    ] {
        if counter < 0 {
            continue;
        }
        let exprs = &mut system.flat.exprs;
        let sides = (
            exprs.at_counter(lhs, counter),
            exprs.at_counter(rhs, counter),
        );
        let same = |equation: &Equation| {
            equation.range == Range::SCALAR && (equation.lhs, equation.rhs) == sides
        };
        if let Some(end) = system.equations.iter().position(same) {
            system.equations[number].range = Range { first, last };
            system.equations.remove(end);
            return true;
        }
    }
    false
}

/// The arrays in an equation that has no derivative and of which every variable has one.
fn states(
    system: &System,
    range: Range,
    sides: [ExprId; 2],
    differentiated: &Cells,
) -> Option<Vec<(VarId, Index)>> {
    let mut found = Vec::new();
    for id in system.flat.exprs.below(&sides) {
        let Some((var, index, derivative)) = system.flat.exprs[id].access() else {
            continue;
        };
        match system.flat.variables[var].kind {
            _ if derivative => return None,
            VariableKind::Continuous => {
                let (first, last) = System::interval(index, range);
                if !differentiated.contains_all(var, first, last) {
                    return None;
                }
                if index.stride == 1 {
                    found.push((var, index));
                }
            }
            VariableKind::Discrete | VariableKind::Held(..) => {}
            VariableKind::Clocked(_)
            | VariableKind::Delayed(_)
            | VariableKind::Column(..)
            | VariableKind::Reduction(_) => {
                return None;
            }
        }
    }
    Some(found)
}

/// Whether an access over a range reaches every element of its array.
fn is_whole(system: &System, range: Range, var: VarId, index: Index) -> bool {
    System::interval(index, range) == (0, system.flat.variables[var].size() - 1)
}

fn make_explicit(system: &mut System, number: usize, (var, index): (VarId, Index), value: ExprId) {
    system.note_differentiated(value);
    let one = system.exprs().constant(1.0);
    let continuous: Vec<bool> = system
        .flat
        .variables
        .iter()
        .map(|v| v.kind == VariableKind::Continuous)
        .collect();
    let rate = system.flat.exprs.tangent(value, |arena, leaf| match leaf {
        Expr::Time => Some(one),
        Expr::Var(var, index) if continuous[hyde_ir::Id::index(var)] => {
            Some(arena.add(Expr::Der(var, index)))
        }
        Expr::Var(..)
        | Expr::Const(_)
        | Expr::Counter
        | Expr::Param(..)
        | Expr::Der(..)
        | Expr::Pre(..)
        | Expr::Relation(_)
        | Expr::InMode(..)
        | Expr::Unary(..)
        | Expr::Binary(..)
        | Expr::If(..)
        | Expr::NoEvent(_) => None,
    });
    let leaf = system.exprs().add(Expr::Var(var, index));
    let equation = &mut system.equations[number];
    (equation.lhs, equation.rhs) = (leaf, value);
    let (range, origin) = (equation.range, equation.origin.clone());
    system.rewrite_all(None, |arena, expr| match expr {
        // The element j is given where the counter is j less the offset.
        Expr::Der(of, at) if of == var => {
            let counter = Index {
                offset: at.offset - index.offset,
                ..at
            };
            Some(arena.with_counter(rate, counter))
        }
        Expr::Der(..)
        | Expr::Var(..)
        | Expr::Const(_)
        | Expr::Time
        | Expr::Counter
        | Expr::Param(..)
        | Expr::Pre(..)
        | Expr::Relation(_)
        | Expr::InMode(..)
        | Expr::Unary(..)
        | Expr::Binary(..)
        | Expr::If(..)
        | Expr::NoEvent(_) => None,
    });
    // Its start values, where they are conditions, are conditions of what it is made of.
    let variable = &system.flat.variables[var];
    let open = !others_fixed(system, value);
    if let (true, true, [start]) = (variable.fixed, open, variable.start.as_slice()) {
        let start = *start;
        // A start value counts its elements from 0.
        let start = system.flat.exprs.with_counter(
            start,
            Index {
                stride: 1,
                offset: index.offset,
            },
        );
        system.flat.initial_equations.push(flat::Equation {
            range,
            lhs: leaf,
            rhs: start,
            origin: origin.clone(),
        });
    }
    system.flat.variables[var].fixed = false;
    system.flat.variables[var].state = match system.flat.variables[var].state {
        StateChoice::Never | StateChoice::Avoid => StateChoice::Open,
        said @ (StateChoice::Open | StateChoice::Prefer | StateChoice::Always) => said,
    };
    let len = system.flat.variables[var].size();
    system.dependent.push(Dependent {
        var,
        element: 0,
        len,
        origin,
    });
}

/// Whether all arrays of an expression start at fixed values.
fn others_fixed(system: &System, value: ExprId) -> bool {
    system.flat.exprs.below(&[value]).into_iter().all(|id| {
        let access = system.flat.exprs[id].access();
        access
            .is_none_or(|(var, ..)| system.flat.variables[var].fixed || !system.is_continuous(var))
    })
}
