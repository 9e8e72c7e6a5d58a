//! Comparisons in continuous equations and conditions become relations: a root function and a frozen truth.
//!
//! `a > b` gives the root function `a - b`, true where it is positive; `a < b` gives `b - a`. What cannot change between
//! events (discrete against discrete) stays a comparison, and so does what stands below `noEvent`. A relation between
//! the time and parameters is scheduled instead of searched for.

use crate::system::System;
use hyde_diag::Origin;
use hyde_ir::dae::{Relation, RelationUse};
use hyde_ir::print::Names;
use hyde_ir::{AutomatonId, BinaryOp, Expr, ExprId, Id as _, Memo, RelationId, VariableKind};
use rustc_hash::FxHashMap;

/// Extracts the relations of equations, exits, `when` conditions and asserts.
pub(crate) fn extract(system: &mut System) {
    let mut known = Known::default();
    for number in 0..system.equations.len() {
        let origin = system.equations[number].origin.clone();
        let scalar = system.equations[number].range == hyde_ir::Range::SCALAR;
        if !scalar {
            // An `if` in an array equation switches cell by cell; it is evaluated as it is, without events.
            continue;
        }
        let mut memo = Memo::default();
        let (lhs, rhs) = (system.equations[number].lhs, system.equations[number].rhs);
        system.equations[number].lhs =
            known.replace(system, lhs, RelationUse::Equation, &origin, &mut memo);
        system.equations[number].rhs =
            known.replace(system, rhs, RelationUse::Equation, &origin, &mut memo);
    }
    for slot in 0..system.slots.len() {
        for branch in 0..system.slots[slot].branches.len() {
            let old = system.slots[slot].branches[branch].clone();
            let mut memo = Memo::default();
            let lhs = known.replace(
                system,
                old.lhs,
                RelationUse::Equation,
                &old.origin,
                &mut memo,
            );
            let rhs = known.replace(
                system,
                old.rhs,
                RelationUse::Equation,
                &old.origin,
                &mut memo,
            );
            let branch = &mut system.slots[slot].branches[branch];
            branch.lhs = lhs;
            branch.rhs = rhs;
        }
    }
    for automaton in 0..system.flat.automata.len() {
        let id = AutomatonId::from_index(automaton);
        for mode in 0..system.flat.automata[id].modes.len() {
            for exit in 0..system.flat.automata[id].modes[mode].exits.len() {
                let (guard, origin) = {
                    let exit = &system.flat.automata[id].modes[mode].exits[exit];
                    (exit.guard, exit.origin.clone())
                };
                let used = RelationUse::Exit(automaton, mode);
                let guard = known.replace(system, guard, used, &origin, &mut Memo::default());
                system.flat.automata[id].modes[mode].exits[exit].guard = guard;
            }
        }
    }
    for when in 0..system.flat.whens.len() {
        let origin = system.flat.whens[when].origin.clone();
        for branch in 0..system.flat.whens[when].branches.len() {
            let condition = system.flat.whens[when].branches[branch].0;
            let condition = known.replace(
                system,
                condition,
                RelationUse::When,
                &origin,
                &mut Memo::default(),
            );
            system.flat.whens[when].branches[branch].0 = condition;
        }
    }
    for edge in 0..system.flat.edges.len() {
        let (condition, origin) = (
            system.flat.edges[edge].condition,
            system.flat.edges[edge].origin.clone(),
        );
        let used = RelationUse::When;
        let condition = known.replace(system, condition, used, &origin, &mut Memo::default());
        system.flat.edges[edge].condition = condition;
    }
    for assert in 0..system.flat.asserts.len() {
        let (condition, origin) = (
            system.flat.asserts[assert].condition,
            system.flat.asserts[assert].origin.clone(),
        );
        let condition = known.replace(
            system,
            condition,
            RelationUse::Assert,
            &origin,
            &mut Memo::default(),
        );
        system.flat.asserts[assert].condition = condition;
    }
}

/// The relations found so far.
#[derive(Default)]
struct Known {
    of_roots: FxHashMap<ExprId, Vec<RelationId>>,
}

impl Known {
    fn replace(
        &mut self,
        system: &mut System,
        root: ExprId,
        used: RelationUse,
        origin: &Origin,
        memo: &mut Memo,
    ) -> ExprId {
        // What stands below noEvent keeps its comparisons: those nodes map to themselves.
        for id in system.flat.exprs.below(&[root]) {
            if let Expr::NoEvent(inner) = system.flat.exprs[id] {
                for kept in system.flat.exprs.below(&[inner]) {
                    memo.insert(kept, kept);
                }
            }
        }
        for id in system.flat.exprs.below(&[root]) {
            let Expr::Binary(op, a, b) = system.flat.exprs[id] else {
                continue;
            };
            if memo.contains_key(&id)
                || !op.is_comparison()
                || matches!(op, BinaryOp::Eq | BinaryOp::Ne)
            {
                continue;
            }
            if !varies(system, a) && !varies(system, b) {
                continue;
            }
            let text = text(system, id);
            let (a, b) = (
                system.flat.exprs.rewrite(a, memo, |_, _, _| None),
                system.flat.exprs.rewrite(b, memo, |_, _, _| None),
            );
            let (above, below) = if matches!(op, BinaryOp::Gt | BinaryOp::Ge) {
                (a, b)
            } else {
                (b, a)
            };
            let root = system.flat.exprs.minus(above, below);
            let inclusive = matches!(op, BinaryOp::Ge | BinaryOp::Le);
            let relation = self.find_or_add(system, root, inclusive, used, text, origin);
            let leaf = system.flat.exprs.add(Expr::Relation(relation));
            memo.insert(id, leaf);
        }
        system.flat.exprs.rewrite(root, memo, |_, _, _| None)
    }

    fn find_or_add(
        &mut self,
        system: &mut System,
        root: ExprId,
        inclusive: bool,
        used: RelationUse,
        text: String,
        origin: &Origin,
    ) -> RelationId {
        let same = self.of_roots.get(&root).into_iter().flatten().find(|id| {
            let known = &system.relations[**id];
            known.inclusive == inclusive && known.used == used
        });
        if let Some(id) = same {
            return *id;
        }
        let time_event = time_event(system, root);
        let relation = system.relations.push(Relation {
            root,
            inclusive,
            time_event,
            used,
            text,
            origin: origin.clone(),
        });
        self.of_roots.entry(root).or_default().push(relation);
        relation
    }
}

/// `time - e` or `e - time` with e of parameters alone changes its sign at e.
fn time_event(system: &mut System, root: ExprId) -> Option<ExprId> {
    let only_time = !system.flat.exprs.any(root, |expr| {
        matches!(
            expr,
            Expr::Var(..)
                | Expr::Der(..)
                | Expr::Pre(..)
                | Expr::Relation(_)
                | Expr::InMode(..)
                | Expr::Counter
        )
    });
    if !only_time {
        return None;
    }
    let zero = system.flat.exprs.constant(0.0);
    crate::solve::solve_for(&mut system.flat.exprs, root, zero, Expr::Time)
}

/// Whether an expression changes between events.
fn varies(system: &System, id: ExprId) -> bool {
    system.flat.exprs.any(id, |expr| {
        expr == Expr::Time
            || expr.access().is_some_and(|(var, _, derivative)| {
                let kind = system.flat.variables[var].kind;
                derivative
                    || matches!(
                        kind,
                        VariableKind::Continuous
                            | VariableKind::Column(..)
                            | VariableKind::Delayed(_)
                    )
            })
    })
}

fn text(system: &System, id: ExprId) -> String {
    let flat = &system.flat;
    let mode = |automaton: AutomatonId, _: u32| flat.automata[automaton].name.clone();
    let relations = &system.relations;
    let names = Names {
        exprs: &flat.exprs,
        variables: &flat.variables,
        parameters: &flat.parameters,
        mode: &mode,
        relation: &|relation| relations[relation].text.clone(),
    };
    names.expr(id)
}
