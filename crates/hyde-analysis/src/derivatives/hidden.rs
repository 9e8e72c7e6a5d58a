//! Constraints between states that only several equations together show.
//!
//! ```text
//! a.v = n1 - n2;  b.v = n1 - n3;  c.v = n2 - n3      capacitors in a loop; n1, n2, n3 are no states
//! a.v - b.v + c.v = 0                                in the place of the last
//! ```
//! To the matching each of the three determines one of n1, n2 and n3, though only their differences are in them. An equation
//! that is a sum of variables is a row of numbers; where rows combine to zero in all that are no states, the combination
//! takes the place of one of them.

use super::differentiated;
use crate::regularity::{Residue, Row, combinations};
use crate::system::{Cell, System};
use hyde_ir::{BinaryOp, Expr, ExprArena, ExprId, Memo, Range, UnaryOp};
use rustc_hash::FxHashMap;
use std::collections::BTreeMap;

/// Larger factors are not counted exactly.
const LARGEST: f64 = 1e15;

/// The factors of the variables of a sum.
type Factors = BTreeMap<Cell, f64>;

/// Shows the constraints; whether there was one.
pub(super) fn expose(system: &mut System) -> bool {
    let states = differentiated(system);
    let mut sums: Vec<(usize, Factors)> = Vec::new();
    let mut columns: BTreeMap<Cell, usize> = BTreeMap::new();
    let mut rows: Vec<Row> = Vec::new();
    for number in 0..system.equations.len() {
        let Some(factors) = sum(system, number) else {
            continue;
        };
        let mut row = Row::new();
        for (cell, factor) in factors.iter().filter(|(cell, _)| !states.contains(cell)) {
            let next = columns.len();
            let column = *columns.entry(*cell).or_insert(next);
            row.extend(Residue::of(*factor).map(|factor| (column, factor)));
        }
        if !row.is_empty() {
            rows.push(row);
            sums.push((number, factors));
        }
    }
    let mut shown = false;
    for combination in combinations(&rows) {
        shown |= show(system, &sums, &combination).is_some();
    }
    shown
}

/// The factors of the variables of an equation, if it is a sum of them and of what is none.
fn sum(system: &System, number: usize) -> Option<Factors> {
    let equation = &system.equations[number];
    if equation.range != Range::SCALAR || equation.constraint {
        return None;
    }
    let exprs = &system.flat.exprs;
    let mut weights = FxHashMap::default();
    let mut factors = Factors::new();
    add(&mut weights, equation.lhs, 1.0);
    add(&mut weights, equation.rhs, -1.0);
    // Each sum before its parts, each once: parts are shared, and the ways to one may be without number.
    for id in exprs.below(&[equation.lhs, equation.rhs]).into_iter().rev() {
        let Some(&weight) = weights.get(&id) else {
            continue;
        };
        if let Expr::Binary(BinaryOp::Add, a, b) = exprs[id] {
            add(&mut weights, a, weight);
            add(&mut weights, b, weight);
        } else if let Expr::Binary(BinaryOp::Sub, a, b) = exprs[id] {
            add(&mut weights, a, weight);
            add(&mut weights, b, -weight);
        } else if let Expr::Unary(UnaryOp::Neg, a) = exprs[id] {
            add(&mut weights, a, -weight);
        } else if let Expr::Var(var, index) = exprs[id]
            && system.is_continuous(var)
        {
            *factors.entry(System::cell(var, index)?).or_default() += weight;
        } else if exprs.any(id, |leaf| is_variable(system, leaf)) {
            return None;
        }
    }
    factors.retain(|_, factor| *factor != 0.0);
    let exact = factors.values().all(|factor| factor.abs() < LARGEST);
    exact.then_some(factors)
}

fn add(weights: &mut FxHashMap<ExprId, f64>, part: ExprId, weight: f64) {
    *weights.entry(part).or_default() += weight;
}

fn is_variable(system: &System, leaf: Expr) -> bool {
    let access = leaf.access();
    access.is_some_and(|(var, ..)| system.is_continuous(var))
}

/// Puts a combination in the place of the last of its equations; none where its factors are not all 1 and -1 but for a common
/// one, or where no state is left.
fn show(system: &mut System, sums: &[(usize, Factors)], combination: &Row) -> Option<()> {
    let inverse = combination.values().next()?.inverse()?;
    let mut left = Factors::new();
    let mut sides: [Option<ExprId>; 2] = [None, None];
    let mut memo = Memo::default();
    for (&place, factor) in combination {
        let (number, factors) = &sums[place];
        let minus = match factor.times(inverse) {
            Residue::ONE => false,
            other if other.plus(Residue::ONE) == Residue::ZERO => true,
            _ => return None,
        };
        for (cell, factor) in factors {
            *left.entry(*cell).or_default() += if minus { -factor } else { *factor };
        }
        // What is no variable stays where it is.
        let equation = &system.equations[*number];
        let mut own = [equation.lhs, equation.rhs];
        if minus {
            own.reverse();
        }
        for (side, own) in sides.iter_mut().zip(own) {
            let rest = without_variables(system, own, &mut memo);
            let arena = system.exprs();
            *side = Some(side.map_or(rest, |sum| arena.plus(sum, rest)));
        }
    }
    left.retain(|_, factor| *factor != 0.0);
    let (&place, _) = combination.last_key_value()?;
    if left.is_empty() {
        return None;
    }
    let [Some(mut lhs), Some(rhs)] = sides else {
        return None;
    };
    for (cell, factor) in left {
        let arena = system.exprs();
        let leaf = arena.add(Expr::Var(cell.0, System::cell_index(cell)));
        let factor = arena.constant(factor);
        let term = arena.times(factor, leaf);
        lhs = arena.plus(term, lhs);
    }
    let equation = &mut system.equations[sums[place].0];
    (equation.lhs, equation.rhs) = (lhs, rhs);
    Some(())
}

/// A side of an equation with zeros for its variables.
fn without_variables(system: &mut System, side: ExprId, memo: &mut Memo) -> ExprId {
    let leaves = system.flat.exprs.below(&[side]).into_iter();
    let variables: Vec<Expr> = leaves
        .map(|id| system.flat.exprs[id])
        .filter(|leaf| is_variable(system, *leaf))
        .collect();
    let zero = |arena: &mut ExprArena, _, leaf: Expr| {
        variables.contains(&leaf).then(|| arena.constant(0.0))
    };
    system.flat.exprs.rewrite(side, memo, zero)
}
