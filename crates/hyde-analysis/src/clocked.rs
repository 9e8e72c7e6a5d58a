//! Clocked parts: their equations become assignments in the order of computation (C2).
//!
//! Each equation is solved for the clocked variable it determines; `pre(x)` and what is sampled are known. A circle among
//! the rest is an error. Inside a clocked part every record column is held (C4).

use crate::graph::{Bipartite, strongly_connected_components};
use crate::refusals::clocked as refused;
use crate::solve::solve_for;
use crate::system::System;
use hyde_diag::{Diagnostics, Span};
use hyde_ir::dae::{ClockedAssignment, Dae, Hold, Tick};
use hyde_ir::flat::ClockedEquation;
use hyde_ir::{ClockId, Expr, ExprId, Id as _, Index, Interpolation, Memo, VarId, VariableKind};

/// Sorts the equations of every clocked part.
pub(crate) fn sort(dae: &mut Dae, system: &mut System, diagnostics: &mut Diagnostics) {
    read_columns_held(dae, system);
    for (clock, info) in system.flat.clocks.enumerate() {
        dae.ticks.push(Tick {
            name: info.name.clone(),
            period: info.period,
            delay: info.delay,
            phase: info.phase,
            assignments: Vec::new(),
            origin: info.origin.clone(),
        });
        let equations: Vec<ClockedEquation> = system
            .flat
            .clocked_equations
            .iter()
            .filter(|item| item.clock == clock)
            .cloned()
            .collect();
        if let Some(assignments) = assignments(dae, clock, &equations, diagnostics) {
            dae.ticks[clock].assignments = assignments;
        }
    }
    order_clocks(dae, diagnostics);
    holds(dae);
}

fn assignments(
    dae: &mut Dae,
    clock: ClockId,
    equations: &[ClockedEquation],
    diagnostics: &mut Diagnostics,
) -> Option<Vec<ClockedAssignment>> {
    let unknowns: Vec<VarId> = dae
        .variables
        .enumerate()
        .filter(|(_, v)| v.kind == VariableKind::Clocked(clock))
        .map(|(id, _)| id)
        .collect();
    // One node an element of a scalar or whole array; elements of arrays set one by one are not mixed with ranges.
    let unknown = |dae: &Dae, id: ExprId| {
        let Expr::Var(var, index) = dae.exprs[id] else {
            return None;
        };
        unknowns.contains(&var).then_some((var, index))
    };
    let mut nodes: Vec<(VarId, Index)> = Vec::new();
    let mut edges = Vec::new();
    for item in equations {
        let mut own = Vec::new();
        let mut add = |node: (VarId, Index)| {
            let number = nodes
                .iter()
                .position(|known| *known == node)
                .unwrap_or_else(|| {
                    nodes.push(node);
                    nodes.len() - 1
                });
            if !own.contains(&number) {
                own.push(number);
            }
        };
        if let Some(node) = unknown(dae, item.equation.lhs) {
            add(node);
        }
        for id in dae.exprs.below(&[item.equation.lhs, item.equation.rhs]) {
            if let Some(node) = unknown(dae, id) {
                add(node);
            }
        }
        edges.push(own);
    }
    let graph = Bipartite {
        edges,
        n_right: nodes.len(),
    };
    let matching = graph.maximum_matching();
    let before = diagnostics.error_count();
    report_unmatched(
        dae,
        clock,
        equations,
        &nodes,
        &unknowns,
        &matching.of_left,
        diagnostics,
    );
    if diagnostics.error_count() > before {
        return None;
    }
    let mut solved = Vec::new();
    for (item, right) in equations.iter().zip(&matching.of_left) {
        let (var, index) = nodes[(*right)?];
        let Some(value) = solve_for(
            &mut dae.exprs,
            item.equation.lhs,
            item.equation.rhs,
            Expr::Var(var, index),
        ) else {
            diagnostics.push(refused::not_explicit(
                &dae.variables[var].name,
                item.equation.origin.span,
            ));
            return None;
        };
        let origin = item.equation.origin.clone();
        solved.push(ClockedAssignment {
            var,
            range: item.equation.range,
            index,
            value,
            origin,
        });
    }
    let reads: Vec<Vec<usize>> = solved
        .iter()
        .map(|assignment| {
            let leaves = dae.exprs.below(&[assignment.value]);
            let read = |other: &ClockedAssignment| {
                leaves
                    .iter()
                    .any(|&id| matches!(dae.exprs[id], Expr::Var(var, _) if var == other.var))
            };
            (0..solved.len())
                .filter(|&number| read(&solved[number]))
                .collect()
        })
        .collect();
    let mut order = Vec::new();
    for component in strongly_connected_components(&reads) {
        let node = component[0];
        if component.len() > 1 || reads[node].contains(&node) {
            let names: Vec<String> = component
                .iter()
                .map(|&n| dae.variables[solved[n].var].name.clone())
                .collect();
            let place = |&number: &usize| solved[number].origin.span;
            let places: Vec<Span> = component.iter().map(place).collect();
            diagnostics.push(refused::loop_at_tick(&names, &places));
            return None;
        }
        order.push(node);
    }
    let mut list: Vec<Option<ClockedAssignment>> = solved.into_iter().map(Some).collect();
    Some(
        order
            .into_iter()
            .filter_map(|number| list[number].take())
            .collect(),
    )
}

fn report_unmatched(
    dae: &Dae,
    clock: ClockId,
    equations: &[ClockedEquation],
    nodes: &[(VarId, Index)],
    unknowns: &[VarId],
    of_left: &[Option<usize>],
    diagnostics: &mut Diagnostics,
) {
    for (item, right) in equations.iter().zip(of_left) {
        if right.is_none() {
            diagnostics.push(refused::redundant_at_tick(item.equation.origin.span));
        }
    }
    for &var in unknowns {
        let determined = of_left.iter().flatten().any(|&right| nodes[right].0 == var);
        let variable = &dae.variables[var];
        // An array without an element needs no equation.
        if determined || variable.size() == 0 {
            continue;
        }
        let unset = match variable.input {
            true => refused::input_unset_at_ticks,
            false => refused::unset_at_ticks,
        };
        let tick = &dae.ticks[clock].name;
        diagnostics.push(unset(&variable.name, tick, variable.origin.span));
    }
}

/// Partitions that tick together run after those they read.
fn order_clocks(dae: &mut Dae, diagnostics: &mut Diagnostics) {
    let clocks: Vec<ClockId> = dae.ticks.ids().collect();
    let reads: Vec<Vec<usize>> = clocks
        .iter()
        .map(|&clock| {
            let values: Vec<_> = dae.ticks[clock]
                .assignments
                .iter()
                .map(|assignment| assignment.value)
                .collect();
            let mut found = Vec::new();
            for id in dae.exprs.below(&values) {
                if let Expr::Var(var, _) = dae.exprs[id]
                    && let VariableKind::Clocked(other) = dae.variables[var].kind
                    && other != clock
                    && !found.contains(&other.index())
                {
                    found.push(other.index());
                }
            }
            found
        })
        .collect();
    for component in strongly_connected_components(&reads) {
        if component.len() > 1 {
            let place = |&number: &usize| dae.ticks[clocks[number]].origin.span;
            let places: Vec<Span> = component.iter().map(place).collect();
            diagnostics.push(refused::loop_of_clocks(&places));
        }
        dae.tick_order
            .extend(component.into_iter().map(|number| clocks[number]));
    }
}

fn holds(dae: &mut Dae) {
    let mut values = dae.equation_values();
    values.extend(dae.delays.iter().map(|delay| delay.value));
    let read: Vec<VarId> = dae
        .exprs
        .below(&values)
        .into_iter()
        .filter_map(|id| {
            if let Expr::Var(var, _) = dae.exprs[id] {
                Some(var)
            } else {
                None
            }
        })
        .collect();
    for (id, variable) in dae.variables.enumerate() {
        let VariableKind::Held(clock, source) = variable.kind else {
            continue;
        };
        let (Some(target), Some(from)) = (dae.places[id], dae.places[source]) else {
            continue;
        };
        dae.holds.push(Hold {
            clock: clock.index(),
            source: from.base,
            target: target.base,
            len: variable.size(),
            read: read.contains(&id),
        });
    }
}

fn read_columns_held(dae: &mut Dae, system: &mut System) {
    let twins: Vec<(VarId, VarId)> = dae
        .variables
        .enumerate()
        .filter_map(|(id, variable)| {
            let VariableKind::Column(column, Interpolation::Linear) = variable.kind else {
                return None;
            };
            let held = VariableKind::Column(column, Interpolation::Held);
            let (twin, _) = dae
                .variables
                .enumerate()
                .find(|(_, other)| other.kind == held)?;
            Some((id, twin))
        })
        .collect();
    let mut memo = Memo::default();
    for item in &mut system.flat.clocked_equations {
        for side in [&mut item.equation.lhs, &mut item.equation.rhs] {
            *side = dae.exprs.rewrite(*side, &mut memo, |arena, _, expr| {
                let Expr::Var(var, index) = expr else {
                    return None;
                };
                let (_, twin) = twins.iter().find(|(linear, _)| *linear == var)?;
                Some(arena.add(Expr::Var(*twin, index)))
            });
        }
    }
}
