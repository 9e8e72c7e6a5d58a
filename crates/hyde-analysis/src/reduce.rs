//! Index reduction: equations that constrain states to each other are differentiated until every equation determines
//! an unknown (Pantelides, SIAM J. Sci. Stat. Comput. 9 (1988) 213), and which states are states is chosen while running
//! (dummy derivatives: Mattsson and Söderlind, SIAM J. Sci. Comput. 14 (1993) 677).
//!
//! ```text
//! vx = der(x);  vy = der(y);  x^2 + y^2 = L^2        gains   2*x*vx + 2*y*vy = 0, and the same once more for ax, ay;
//!                                                    vx = der(x), vy = der(y) become one row
//! c1*der(x) + c2*der(y) = c1*vx + c2*vy              with (c1, c2) = (1, 0) or (0, 1)
//! ```
//! A group is k constraints between m variables of one order. All of them stay in the solver's vector with their rates as
//! variables of their own; m - k rows tie derivatives to rates, each to the variable that the run picks by the
//! constraints' Jacobian. A switch changes the c in the memory, neither layout nor sparsity (M1, M6).

use crate::derivatives::{by_rates, new_rate};
use crate::graph::Bipartite;
use crate::matching::{self, Node};
use crate::segments;
use crate::split;
use crate::system::{Cell, Equation, Group, System};
use hyde_diag::{MadeBy, Origin};
use hyde_ir::{Expr, ExprId, Index, Quantity, Range, VarId, Variable, VariableKind};
use std::collections::{BTreeMap, BTreeSet};

/// An equation is differentiated so often at most: three are needed where a motion is prescribed and its jerk is read.
const MAX_ORDER: u8 = 5;

/// Differentiates what constrains states. What cannot be treated so stays as it is, for the matching to report.
pub(crate) fn reduce(system: &mut System) {
    let (equations, variables, starts) = (
        system.equations.clone(),
        system.flat.variables.clone(),
        system.starts.clone(),
    );
    // Every round differentiates an equation, and none more than a few times.
    for _ in 0..usize::from(MAX_ORDER) * (equations.len() + 1) {
        match deficient(system) {
            Some(set) if set.is_empty() => return add_rows(system),
            Some(set) if differentiate(system, &set).is_some() => continue,
            Some(_) | None => break,
        }
    }
    system.equations = equations;
    system.flat.variables = variables;
    system.starts = starts;
    system.groups.clear();
}

/// The equations of which more are than unknowns in them: empty if there are none, `None` if the count alone is wrong.
fn deficient(system: &mut System) -> Option<Vec<usize>> {
    let mut unknowns = segments::segments(system).ok()?;
    unknowns.retain(|unknown| {
        unknown.first != unknown.last || system.rate_of((unknown.var, unknown.first)).is_none()
    });
    unknowns.sort_unstable();
    let nodes: Vec<Node> = (0..system.equations.len())
        .filter(|&number| !system.equations[number].constraint)
        .map(Node::Equation)
        .chain((0..system.slots.len()).map(Node::Slot))
        .collect();
    let edges = nodes
        .iter()
        .map(|&node| matching::edges(system, node, &unknowns))
        .collect();
    let graph = Bipartite {
        edges,
        n_right: unknowns.len(),
    };
    let matching = graph.maximum_matching();
    let open = matching.of_left.iter().position(Option::is_none);
    let unmatched = |list: &[Option<usize>]| list.iter().filter(|m| m.is_none()).count();
    if unmatched(&matching.of_left) != unmatched(&matching.of_right) {
        return None;
    }
    let Some(open) = open else {
        return Some(Vec::new());
    };
    let (lefts, _) = graph.over_determined(&matching, open);
    lefts
        .into_iter()
        .chain([open])
        .collect::<BTreeSet<_>>()
        .into_iter()
        .map(|left| match nodes[left] {
            Node::Equation(number) => Some(number),
            Node::Slot(_) => None,
        })
        .collect()
}

/// Differentiates a set of equations and makes a group of their variables.
fn differentiate(system: &mut System, set: &[usize]) -> Option<()> {
    for &number in set {
        let equation = &system.equations[number];
        if equation.range != Range::SCALAR || equation.order >= MAX_ORDER {
            return None;
        }
    }
    for &number in set {
        name_rates(system, number)?;
    }
    // They move to the end of the list.
    let constraints: Vec<Equation> = set
        .iter()
        .rev()
        .map(|&number| system.equations.remove(number))
        .collect();
    let mut candidates: Vec<Cell> = Vec::new();
    for equation in &constraints {
        for cell in highest(system, equation)? {
            if !candidates.contains(&cell) {
                candidates.push(cell);
            }
        }
    }
    let mut group = Group {
        constraints: constraints.len(),
        ..Group::default()
    };
    for cell in candidates {
        let rate = match system.rate_of(cell) {
            Some(rate) => rate,
            None => take_rate(system, cell)?,
        };
        group.candidates.push((cell, rate));
    }
    for mut equation in constraints {
        let derived = Equation {
            lhs: derivative(system, equation.lhs, &group)?,
            rhs: derivative(system, equation.rhs, &group)?,
            order: equation.order + 1,
            ..equation.clone()
        };
        equation.constraint = true;
        system.equations.push(equation);
        system.equations.push(derived);
    }
    // Groups that share a variable are one.
    let shares = |other: &Group| {
        let mut cells = other.candidates.iter().map(|(cell, _)| cell);
        cells.any(|cell| group.candidates.iter().any(|(own, _)| own == cell))
    };
    let (joined, apart): (Vec<Group>, Vec<Group>) = std::mem::take(&mut system.groups)
        .into_iter()
        .partition(shares);
    let mut whole = Group::default();
    for part in joined.into_iter().chain([group]) {
        whole.constraints += part.constraints;
        for candidate in part.candidates {
            if !whole.candidates.contains(&candidate) {
                whole.candidates.push(candidate);
            }
        }
    }
    let possible = whole.candidates.len() >= whole.constraints;
    system.groups = apart;
    system.groups.push(whole);
    possible.then_some(())
}

/// Gives every derivative in an equation a variable: `der(x)` becomes `dx`, with `dx = der(x)`.
fn name_rates(system: &mut System, number: usize) -> Option<()> {
    let equation = system.equations[number].clone();
    let mut derivatives: Vec<Cell> = Vec::new();
    for id in system.flat.exprs.below(&[equation.lhs, equation.rhs]) {
        if let Expr::Der(var, index) = system.flat.exprs[id] {
            // A recorded column has no derivative.
            if !system.is_continuous(var) {
                return None;
            }
            derivatives.push(System::cell(var, index)?);
        }
    }
    for cell in derivatives {
        let leaf = Expr::Der(cell.0, System::cell_index(cell));
        if system.flat.variables[cell.0].len.is_some() && !split::at_cell(system, cell) {
            return None;
        }
        let rate = new_rate(system, cell)?;
        let origin = equation.origin.made_by(MadeBy::Derivative);
        system.rewrite_all(None, |_, expr| (expr == leaf).then_some(rate));
        let derivative = system.exprs().add(leaf);
        system.equations.push(Equation {
            range: Range::SCALAR,
            lhs: rate,
            rhs: derivative,
            origin,
            order: 0,
            constraint: false,
        });
    }
    Some(())
}

/// The variables of an equation that are not the integral of another one in it.
fn highest(system: &System, equation: &Equation) -> Option<Vec<Cell>> {
    let mut cells: Vec<Cell> = Vec::new();
    for id in system.flat.exprs.below(&[equation.lhs, equation.rhs]) {
        let Expr::Var(var, index) = system.flat.exprs[id] else {
            continue;
        };
        match system.flat.variables[var].kind {
            VariableKind::Continuous => {
                let cell = System::cell(var, index)?;
                if !cells.contains(&cell) {
                    cells.push(cell);
                }
            }
            VariableKind::Discrete | VariableKind::Held(..) => {}
            VariableKind::Clocked(_)
            | VariableKind::Column(..)
            | VariableKind::Delayed(_)
            | VariableKind::Reduction(_) => {
                return None;
            }
        }
    }
    let rates = named_rates(system);
    let rate = |cell: Cell| {
        let chosen = system.rate_of(cell).and_then(|id| variable(system, id));
        chosen.or_else(|| rates.get(&cell).map(|(rate, _)| *rate))
    };
    let below = |cell: Cell| {
        let mut at = cell;
        while let Some(next) = rate(at) {
            if cells.contains(&next) {
                return true;
            }
            at = next;
        }
        false
    };
    Some(cells.iter().copied().filter(|&cell| !below(cell)).collect())
}

/// The group that a constraint is of.
pub(crate) fn group_of(system: &System, number: usize) -> Option<usize> {
    let equation = system.equations[number]
        .constraint
        .then(|| &system.equations[number])?;
    let cells = highest(system, equation)?;
    let has = |group: &Group, cell: Cell| group.candidates.iter().any(|(own, _)| *own == cell);
    cells
        .iter()
        .find_map(|&cell| system.groups.iter().position(|group| has(group, cell)))
}

/// The scalar equations `v = der(x)`: v and the equation's number by x.
fn named_rates(system: &System) -> BTreeMap<Cell, (Cell, usize)> {
    let mut found = BTreeMap::new();
    for (number, equation) in system.equations.iter().enumerate() {
        let exprs = &system.flat.exprs;
        for (v, d) in [(equation.lhs, equation.rhs), (equation.rhs, equation.lhs)] {
            if let (Some(rate), Expr::Der(var, index)) = (variable(system, v), exprs[d])
                && let Some(cell) = System::cell(var, index)
            {
                found.insert(cell, (rate, number));
            }
        }
    }
    found
}

/// The cell that an expression is, if it is one.
fn variable(system: &System, id: ExprId) -> Option<Cell> {
    let Expr::Var(var, index) = system.flat.exprs[id] else {
        return None;
    };
    System::cell(var, index)
}

/// The rate of a variable, no longer its derivative: what `v = der(x)` names, or a new variable.
fn take_rate(system: &mut System, cell: Cell) -> Option<ExprId> {
    let array = system.flat.variables[cell.0].len.is_some();
    if pinned(system, cell) || array && !split::at_cell(system, cell) {
        return None;
    }
    if let Some((rate, number)) = named_rates(system).get(&cell).copied() {
        system.equations.remove(number);
        let leaf = Expr::Der(cell.0, System::cell_index(cell));
        let rate = system
            .exprs()
            .add(Expr::Var(rate.0, System::cell_index(rate)));
        system.rewrite_all(None, |_, expr| (expr == leaf).then_some(rate));
        return Some(rate);
    }
    let leaf = Expr::Der(cell.0, System::cell_index(cell));
    let rate = new_rate(system, cell)?;
    system.rewrite_all(None, |_, expr| (expr == leaf).then_some(rate));
    Some(rate)
}

/// Whether a mode fixes the variable: its row is needed for that.
fn pinned(system: &System, cell: Cell) -> bool {
    let leaf = Expr::Var(cell.0, System::cell_index(cell));
    let branches = system.slots.iter().flat_map(|slot| &slot.branches);
    branches
        .flat_map(|branch| [(branch.lhs, branch.rhs), (branch.rhs, branch.lhs)])
        .any(|(side, value)| system.flat.exprs[side] == leaf && system.is_parametric(value))
}

/// The time derivative of an expression: of a variable with a rate that rate, of any other its derivative.
fn derivative(system: &mut System, id: ExprId, group: &Group) -> Option<ExprId> {
    let mut rates: BTreeMap<Cell, ExprId> = BTreeMap::new();
    let named = named_rates(system);
    let leaves: Vec<Expr> = system
        .flat
        .exprs
        .below(&[id])
        .into_iter()
        .map(|id| system.flat.exprs[id])
        .collect();
    for leaf in leaves {
        let Expr::Var(var, index) = leaf else {
            continue;
        };
        if !system.is_continuous(var) {
            continue;
        }
        let cell = System::cell(var, index)?;
        let own = group.candidates.iter().find(|(own, _)| *own == cell);
        let chosen = own.map(|(_, rate)| *rate).or_else(|| system.rate_of(cell));
        let rate = match (chosen, named.get(&cell)) {
            (Some(rate), _) => rate,
            (None, Some((rate, _))) => {
                let leaf = Expr::Var(rate.0, System::cell_index(*rate));
                system.exprs().add(leaf)
            }
            (None, None) => system.exprs().add(Expr::Der(var, index)),
        };
        rates.insert(cell, rate);
    }
    Some(by_rates(system, id, &rates))
}

/// The rows that tie derivatives to rates, once all groups are known.
fn add_rows(system: &mut System) {
    for number in 0..system.groups.len() {
        let Group {
            candidates,
            constraints,
            ..
        } = system.groups[number].clone();
        let rows = candidates.len() - constraints;
        if rows == 0 {
            continue;
        }
        let origin = system.flat.variables[candidates[0].0.0].origin.clone();
        let factors = factors(system, number, rows * candidates.len(), &origin);
        system.groups[number].factors = Some(factors);
        for row in 0..rows {
            let mut sides: [Option<ExprId>; 2] = [None, None];
            for (column, (cell, rate)) in candidates.iter().enumerate() {
                let at = i32::try_from(row * candidates.len() + column).unwrap_or(0);
                let arena = &mut system.flat.exprs;
                let factor = arena.add(Expr::Var(factors, Index::fixed(at)));
                let derivative = arena.add(Expr::Der(cell.0, System::cell_index(*cell)));
                for (side, value) in sides.iter_mut().zip([derivative, *rate]) {
                    let term = arena.times(factor, value);
                    *side = Some(side.map_or(term, |sum| arena.plus(sum, term)));
                }
            }
            if let [Some(lhs), Some(rhs)] = sides {
                system.equations.push(Equation {
                    range: Range::SCALAR,
                    lhs,
                    rhs,
                    origin: origin.made_by(MadeBy::Derivative),
                    order: 0,
                    constraint: false,
                });
            }
        }
    }
}

/// The memory of a group's factors; the run sets them before anything reads them.
fn factors(system: &mut System, number: usize, len: usize, origin: &Origin) -> VarId {
    let zero = system.exprs().constant(0.0);
    let name = format!("states[{}]", number + 1);
    let origin = origin.made_by(MadeBy::Derivative);
    system.flat.variables.push(Variable {
        len: Some(len),
        start: vec![zero],
        fixed: true,
        ..Variable::new(name, VariableKind::Discrete, Quantity::number(), origin)
    })
}
