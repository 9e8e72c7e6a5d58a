//! Exits of modes, `when` clauses and asserts become reactions: a condition over truths, and what is set when it fires.

use crate::layout::alias;
use crate::refusals::states as refused;
use crate::system::System;
use hyde_diag::{Diagnostics, Origin};
use hyde_ir::dae::{Alias, Assignment, Dae, Reaction, ReactionKind, Space, Target};
use hyde_ir::flat::Action;
use hyde_ir::print::Names;
use hyde_ir::{AutomatonId, Expr, ExprId, Id as _, Index, Memo, UnaryOp, VarId, VariableKind};

/// Fills in the reactions of the DAE.
pub(crate) fn react(dae: &mut Dae, system: &mut System, diagnostics: &mut Diagnostics) {
    for (automaton, block) in system.flat.automata.enumerate() {
        for (from, mode) in block.modes.iter().enumerate() {
            for exit in &mode.exits {
                let kind = ReactionKind::Transition {
                    automaton: automaton.index(),
                    from,
                    to: exit.target,
                    impact: exit.impact,
                };
                add(
                    dae,
                    system,
                    exit.guard,
                    kind,
                    &exit.actions,
                    &exit.origin,
                    diagnostics,
                );
            }
        }
    }
    for (clause, when) in system.flat.whens.iter().enumerate() {
        for (condition, actions) in &when.branches {
            add(
                dae,
                system,
                *condition,
                ReactionKind::When { clause },
                actions,
                &when.origin,
                diagnostics,
            );
        }
    }
    for edge in &system.flat.edges {
        let place = dae.places[edge.var].map_or(0, |place| place.base);
        let kind = ReactionKind::Edge(place);
        add(
            dae,
            system,
            edge.condition,
            kind,
            &[],
            &edge.origin,
            diagnostics,
        );
    }
    for assert in &system.flat.asserts {
        let failed = dae.exprs.unary(UnaryOp::Not, assert.condition);
        let kind = ReactionKind::Assert(assert.message.clone());
        add(dae, system, failed, kind, &[], &assert.origin, diagnostics);
    }
}

fn add(
    dae: &mut Dae,
    system: &System,
    condition: ExprId,
    kind: ReactionKind,
    actions: &[Action],
    origin: &Origin,
    diagnostics: &mut Diagnostics,
) {
    let first = dae.assignments.len();
    let mut set: Vec<(VarId, Index, ExprId)> = Vec::new();
    for action in actions {
        let (var, index, value) = match action {
            Action::Reinit(var, index, value) | Action::Assign(var, index, value) => {
                (*var, *index, *value)
            }
        };
        let value = before_the_event(dae, value, &set);
        if let Action::Assign(..) = action {
            set.push((var, index, value));
        }
        let target = match action {
            Action::Reinit(..) => state_target(dae, var, index, value),
            Action::Assign(..) => dae.places[var].map(|place| {
                let element = usize::try_from(index.offset).unwrap_or(0);
                (Target::Memory(place.base + element), value)
            }),
        };
        match target {
            Some((target, value)) => dae.assignments.push(Assignment {
                target,
                value,
                origin: origin.clone(),
            }),
            None => {
                let states = states_behind(dae, var);
                let name = &system.flat.variables[var].name;
                diagnostics.push(refused::reinit_of_no_state(name, origin.span, &states));
            }
        }
    }
    let text = text(dae, condition);
    dae.reactions.push(Reaction {
        condition,
        kind,
        assignments: first..dae.assignments.len(),
        text,
        origin: origin.clone(),
    });
}

/// In an event `pre(x)` is what every variable still has; a discrete variable set before in the same clause has its new
/// value.
fn before_the_event(dae: &mut Dae, value: ExprId, set: &[(VarId, Index, ExprId)]) -> ExprId {
    dae.exprs
        .rewrite(value, &mut Memo::default(), |arena, _, expr| {
            if let Expr::Pre(var, index) = expr {
                return Some(arena.add(Expr::Var(var, index)));
            }
            let Expr::Var(var, index) = expr else {
                return None;
            };
            let mut latest = set.iter().rev();
            let (.., new) = latest.find(|(v, i, _)| *v == var && *i == index)?;
            Some(*new)
        })
}

/// The place of a state that is reinitialised, through its aliases.
fn state_target(
    dae: &mut Dae,
    var: VarId,
    index: Index,
    value: ExprId,
) -> Option<(Target, ExprId)> {
    let element = usize::try_from(index.offset).unwrap_or(0);
    let (var, element, value) = match alias(dae, var) {
        Some(Alias::Of {
            var,
            element,
            negated,
        }) => {
            let value = if negated {
                dae.exprs.negative(value)
            } else {
                value
            };
            (var, element, value)
        }
        Some(Alias::Value(_)) => return None,
        None => (var, element, value),
    };
    let place = dae.places[var].filter(|place| place.space == Space::Unknown)?;
    let position = place.base + element;
    let differential = dae.unknowns.iter().any(|block| {
        block.differential && (block.offset..block.offset + block.len).contains(&position)
    });
    let continuous = dae.variables[var].kind == VariableKind::Continuous;
    (differential && continuous).then_some((Target::State(position), value))
}

/// The states that a variable is computed from, by name.
fn states_behind(dae: &Dae, var: VarId) -> Vec<String> {
    let (mut states, mut seen, mut open) = (Vec::new(), Vec::new(), vec![var]);
    while let Some(var) = open.pop() {
        if seen.contains(&var) {
            continue;
        }
        seen.push(var);
        if let Some(Alias::Of { var, .. }) = alias(dae, var) {
            open.push(var);
        }
        let own = dae.unknowns.iter().find(|block| block.var == var);
        if own.is_some_and(|block| block.differential) {
            states.push(dae.variables[var].name.clone());
            continue;
        }
        let definitions = dae.definitions.iter();
        for definition in definitions.filter(|definition| definition.var == var) {
            for id in dae.exprs.below(&[definition.value]) {
                if let Expr::Var(read, _) = dae.exprs[id] {
                    open.push(read);
                }
            }
        }
    }
    states.sort();
    states
}

fn text(dae: &Dae, id: ExprId) -> String {
    let mode = |automaton: AutomatonId, mode: u32| {
        let automaton = &dae.automata[automaton];
        format!(
            "{}.{}",
            automaton.name,
            automaton
                .modes
                .get(mode as usize)
                .map_or("?", String::as_str)
        )
    };
    let names = Names {
        exprs: &dae.exprs,
        variables: &dae.variables,
        parameters: &dae.parameters,
        mode: &mode,
        relation: &|relation| dae.relations[relation].text.clone(),
    };
    names.expr(id).replace(['«', '»'], "")
}
