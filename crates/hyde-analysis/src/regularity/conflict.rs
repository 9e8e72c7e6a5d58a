//! Equations that depend on each other and unknowns that nothing determines, as diagnostics: one cause, one message.

use super::pencil::Pencil;
use super::words::{Conflict, assigned, floating, generic, held_twice, loose, parameter};
use crate::matching::{self, Node, equation_for, missing_boundary, sides, unbound_input};
use crate::refusals::{place_of, unmatched as refused};
use crate::system::System;
use hyde_diag::{Diagnostic, Diagnostics, MadeBy, Span};
use hyde_ir::{Expr, VarId};
use std::collections::BTreeSet;

/// Reports sets of rows that depend on each other together with the unknowns that are open for it, then unknowns that lack
/// an equation.
pub(super) fn report(
    system: &System,
    pencil: &Pencil,
    dependent: &[Vec<usize>],
    open: &[Vec<usize>],
    diagnostics: &mut Diagnostics,
) {
    let mut open: Vec<Vec<VarId>> = open
        .iter()
        .map(|columns| unique(columns.iter().map(|&column| pencil.columns[column])))
        .collect();
    for rows in dependent {
        let equations = unique(rows.iter().map(|&row| pencil.nodes[row]));
        let mut conflict = Conflict::new(system, equations);
        let nearest = (0..open.len()).max_by_key(|&number| {
            let shared = open[number]
                .iter()
                .filter(|&&var| conflict.concerns(system, var));
            (shared.count(), usize::MAX - number)
        });
        if let Some(number) = nearest {
            conflict.open = open.remove(number);
        }
        let diagnostic = parameter(system, &conflict)
            .or_else(|| assigned(system, &conflict))
            .or_else(|| loose(system, &conflict))
            .or_else(|| floating(system, &conflict))
            .or_else(|| held_twice(system, &conflict))
            .unwrap_or_else(|| generic(system, &conflict));
        diagnostics.push(diagnostic);
    }
    for unknowns in open {
        diagnostics.push(missing(system, &unknowns));
    }
}

/// Unknowns for which an equation is missing: a boundary condition, something on an input, or an equation.
fn missing(system: &System, unknowns: &[VarId]) -> Diagnostic {
    let stencils_alone = |var: VarId| {
        mentioning(system, var)
            .iter()
            .all(|&node| matching::origin(system, node).made_by == MadeBy::Discretization)
    };
    let traces = unknowns
        .iter()
        .copied()
        .filter(|&var| system.flat.variables[var].trace.is_some());
    if let Some(trace) = traces.clone().find(|&var| stencils_alone(var)) {
        return missing_boundary(system, trace);
    }
    let unbound = |&&var: &&VarId| {
        let variable = &system.flat.variables[var];
        let outside = mentioning(system, var).into_iter().any(|node| {
            let origin = matching::origin(system, node);
            origin.made_by == MadeBy::Binding && gives(system, node, var)
                || origin.instance != variable.origin.instance
        });
        variable.input && !outside
    };
    if let Some(&input) = unknowns.iter().find(unbound) {
        return unbound_input(system, input);
    }
    if let Some(trace) = traces.into_iter().next() {
        return missing_boundary(system, trace);
    }
    // What no equation is written for, and few name, is most likely what one was forgotten for; the user's own names first.
    let likely = unknowns.iter().copied().min_by_key(|&var| {
        let variable = &system.flat.variables[var];
        let mentioning = mentioning(system, var);
        (
            mentioning.iter().any(|&node| gives(system, node, var)),
            mentioning.len(),
            !variable.origin.instance.as_str().is_empty(),
            variable.flow,
            var,
        )
    });
    let Some(likely) = likely else {
        return refused::missing_equation();
    };
    too_few(system, likely, unknowns)
}

fn too_few(system: &System, likely: VarId, unknowns: &[VarId]) -> Diagnostic {
    let variable = &system.flat.variables[likely];
    let mut containing: Vec<Span> = Vec::new();
    for node in mentioning(system, likely).into_iter().take(2) {
        let origin = matching::origin(system, node);
        if origin.made_by != MadeBy::Unconnected {
            containing.push(origin.span);
        }
    }
    let others: Vec<String> = unknowns
        .iter()
        .filter(|&&var| var != likely)
        .take(5)
        .map(|&var| system.flat.variables[var].name.clone())
        .collect();
    let repair = match variable.flow {
        true => "connect its connector, or give the force a law".to_owned(),
        false => equation_for(&variable.name),
    };
    let place = place_of(system, &variable.origin);
    let open = (others.as_slice(), unknowns.len() > 6);
    refused::likely_undetermined(&variable.name, place, &containing, open, &repair)
}

/// The equations that name a variable.
fn mentioning(system: &System, var: VarId) -> Vec<Node> {
    let nodes = (0..system.equations.len()).map(Node::Equation);
    nodes
        .chain((0..system.slots.len()).map(Node::Slot))
        .filter(|&node| {
            let named = |expr: Expr| expr.access().is_some_and(|(v, ..)| v == var);
            sides(system, node).iter().any(|&(_, lhs, rhs)| {
                system.flat.exprs.any(lhs, named) || system.flat.exprs.any(rhs, named)
            })
        })
        .collect()
}

/// Whether an equation says `var = …`.
fn gives(system: &System, node: Node, var: VarId) -> bool {
    sides(system, node)
        .iter()
        .any(|&(_, lhs, _)| matches!(system.flat.exprs[lhs], Expr::Var(v, _) if v == var))
}

fn unique<T: Ord + Copy>(list: impl Iterator<Item = T>) -> Vec<T> {
    list.collect::<BTreeSet<T>>().into_iter().collect()
}
