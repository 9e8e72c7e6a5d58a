//! Clocked parts that tick at events: `clocked tooth(event = flank > 0) … end tooth;`.
//!
//! They are written as others are, and are what a `when` is: each variable is discrete, the equations are set in the order in
//! which they read each other, `hold(x)` is the discrete variable itself, `interval()` the time since the last tick.
//!
//! ```text
//! when flank > 0 then  count = pre(count) + 1;  …;  last = time;  end when;
//! ```

use crate::dimension::Dim;
use crate::instance::{InstanceId, Scope, Setting};
use crate::model::Model;
use crate::refusals::equations as refused;
use hyde_diag::{Diagnostic, Diagnostics, MadeBy, Span};
use hyde_ir::flat::{Action, ClockedEquation, Equation, When};
use hyde_ir::{
    ClockId, Expr as Ir, ExprId, FlatModel, Id as _, Index, Memo, Range, VarId, VariableKind,
};
use hyde_syntax::ast;
use hyde_units::Dimension;
use std::collections::{BTreeMap, HashMap};

/// `x = e` at an event.
struct Assignment {
    var: VarId,
    index: Index,
    value: ExprId,
    origin: hyde_diag::Origin,
}

/// Whether a clocked part has `event = …`.
pub(crate) fn is_event_clock(clocked: &ast::Clocked) -> bool {
    let mut names = clocked.arguments.iter().flat_map(|argument| &argument.name);
    names.any(|name| name.text == "event")
}

/// Lowers the condition, and makes the variable that is the time of the last tick.
pub(crate) fn event_clock<'a>(
    model: &mut Model<'a, '_>,
    clocked: &'a ast::Clocked,
    (clock, part): (ClockId, InstanceId),
    outer: InstanceId,
) {
    let [argument] = clocked.arguments.as_slice() else {
        model.report(refused::event_clock_with_more(&clocked.name));
        return;
    };
    let scope = Scope::new(outer, Setting::Condition);
    let condition = model.truth(&argument.value, &scope);
    let name = format!("{}.last tick", model.flat.clocks[clock].name);
    let (time, span) = (Dim::known(Dimension::TIME), clocked.name.span);
    let kind = VariableKind::Clocked(clock);
    let last = model.add_variable(part, name, kind, time, span, MadeBy::Source);
    let now = model.flat.exprs.add(Ir::Time);
    let before = model.flat.exprs.add(Ir::Pre(last, Index::SCALAR));
    model.flat.clocks[clock].period = model.flat.exprs.minus(now, before);
    model.event_clocks.insert(clock, (condition, last));
}

/// Makes each of them a `when`; the other clocks are all that stay.
pub(crate) fn event_clocks(model: &mut Model<'_, '_>) {
    if model.event_clocks.is_empty() {
        return;
    }
    let clocks = std::mem::take(&mut model.event_clocks);
    for (&clock, &(condition, last)) in &clocks {
        let origin = model.flat.clocks[clock].origin.clone();
        let mut actions = actions_of(model, clock, last);
        let now = model.flat.exprs.add(Ir::Time);
        actions.push(Action::Assign(last, Index::SCALAR, now));
        model.flat.whens.push(When {
            branches: vec![(condition, actions)],
            origin,
        });
    }
    hold_as_they_are(&mut model.flat, &clocks.keys().copied().collect::<Vec<_>>());
    remove_clocks(model, &clocks.keys().copied().collect::<Vec<_>>());
}

/// What a clocked part sets, each variable behind those that it reads.
fn actions_of(model: &mut Model<'_, '_>, clock: ClockId, last: VarId) -> Vec<Action> {
    let all = std::mem::take(&mut model.flat.clocked_equations);
    let (own, others): (Vec<_>, Vec<_>) = all.into_iter().partition(|e| e.clock == clock);
    model.flat.clocked_equations = others;
    let mut waiting: Vec<Assignment> = Vec::new();
    for ClockedEquation { equation, .. } in own {
        for counter in equation.range.iter() {
            let lhs = model.flat.exprs.at_counter(equation.lhs, counter);
            let rhs = model.flat.exprs.at_counter(equation.rhs, counter);
            match assignment(model, clock, lhs, rhs, &equation) {
                Ok(assignment) => waiting.push(assignment),
                Err(diagnostic) => model.report(*diagnostic),
            }
        }
    }
    report_unset(&model.flat, model.diagnostics, (clock, last), &waiting);
    let mut actions = Vec::new();
    while !waiting.is_empty() {
        let free = waiting.iter().position(|own| {
            let reads = |var: VarId| waiting.iter().any(|other| other.var == var);
            let below = model.flat.exprs.below(&[own.value]);
            let mut read = below.iter().filter_map(|id| model.flat.exprs[*id].access());
            !read.any(|(var, ..)| reads(var))
        });
        let Some(free) = free else {
            report_circle(&model.flat, model.diagnostics, &waiting);
            return actions;
        };
        let Assignment {
            var, index, value, ..
        } = waiting.remove(free);
        actions.push(Action::Assign(var, index, value));
    }
    actions
}

/// An equation as `x = e`; columns of records are held in a clocked part.
fn assignment(
    model: &mut Model<'_, '_>,
    clock: ClockId,
    lhs: ExprId,
    rhs: ExprId,
    equation: &Equation,
) -> Result<Assignment, Box<Diagnostic>> {
    let own = |id: ExprId| {
        let (var, index, derivative) = model.flat.exprs[id].access()?;
        let clocked = model.flat.variables[var].kind == VariableKind::Clocked(clock);
        (clocked && !derivative).then_some((var, index))
    };
    let found = own(lhs)
        .map(|target| (target, rhs))
        .or_else(|| Some((own(rhs)?, lhs)));
    let Some(((var, index), value)) = found else {
        let refusal = refused::sets_nothing_at_event(equation.origin.span);
        return Err(Box::new(refusal));
    };
    let held: HashMap<VarId, VarId> = model.column_variables.values().copied().collect();
    let value = model
        .flat
        .exprs
        .rewrite(value, &mut Memo::default(), |exprs, _, leaf| {
            let Ir::Var(var, index) = leaf else {
                return None;
            };
            Some(exprs.add(Ir::Var(*held.get(&var)?, index)))
        });
    let origin = equation.origin.clone();
    Ok(Assignment {
        var,
        index,
        value,
        origin,
    })
}

fn report_unset(
    flat: &FlatModel,
    diagnostics: &mut Diagnostics,
    (clock, last): (ClockId, VarId),
    set: &[Assignment],
) {
    for var in flat.variables.ids().collect::<Vec<_>>() {
        let variable = &flat.variables[var];
        let own = variable.kind == VariableKind::Clocked(clock) && var != last;
        if !own || set.iter().any(|assignment| assignment.var == var) {
            continue;
        }
        let unset = match variable.input {
            true => refused::input_unset_at_ticks,
            false => refused::unset_at_ticks,
        };
        let tick = &flat.clocks[clock].name;
        diagnostics.push(unset(&variable.name, tick, variable.origin.span));
    }
}

fn report_circle(flat: &FlatModel, diagnostics: &mut Diagnostics, waiting: &[Assignment]) {
    let names: Vec<String> = waiting
        .iter()
        .map(|own| format!("`{}`", flat.variables[own.var].name))
        .collect();
    let places: Vec<Span> = waiting.iter().map(|own| own.origin.span).collect();
    diagnostics.push(refused::circle_at_tick(&names, &places));
}

/// `hold(x)` of them is x, which is discrete.
fn hold_as_they_are(flat: &mut FlatModel, clocks: &[ClockId]) {
    for var in flat.variables.ids().collect::<Vec<_>>() {
        match flat.variables[var].kind {
            VariableKind::Clocked(clock) if clocks.contains(&clock) => {
                flat.variables[var].kind = VariableKind::Discrete;
            }
            VariableKind::Held(clock, source) if clocks.contains(&clock) => {
                flat.variables[var].kind = VariableKind::Continuous;
                let lhs = flat.exprs.var(var);
                let rhs = flat.exprs.var(source);
                let origin = flat.variables[var].origin.clone();
                flat.equations.push(Equation {
                    range: Range::SCALAR,
                    lhs,
                    rhs,
                    origin,
                });
            }
            VariableKind::Clocked(_)
            | VariableKind::Held(..)
            | VariableKind::Continuous
            | VariableKind::Discrete
            | VariableKind::Column(..)
            | VariableKind::Delayed(_)
            | VariableKind::Reduction(_) => {}
        }
    }
}

/// Takes clocks out of the list; the others have new numbers then.
fn remove_clocks(model: &mut Model<'_, '_>, gone: &[ClockId]) {
    let mut numbers: BTreeMap<ClockId, ClockId> = BTreeMap::new();
    let mut kept = Vec::new();
    for (clock, known) in model.flat.clocks.enumerate() {
        if !gone.contains(&clock) {
            numbers.insert(clock, ClockId::from_index(kept.len()));
            kept.push(known.clone());
        }
    }
    model.flat.clocks = kept.into_iter().collect();
    for equation in &mut model.flat.clocked_equations {
        equation.clock = numbers[&equation.clock];
    }
    for var in model.flat.variables.ids().collect::<Vec<_>>() {
        let kind = &mut model.flat.variables[var].kind;
        if let VariableKind::Clocked(clock) | VariableKind::Held(clock, _) = kind {
            *clock = numbers[clock];
        }
    }
    let held = std::mem::take(&mut model.held).into_iter();
    let held =
        held.filter_map(|((clock, source), held)| Some(((*numbers.get(&clock)?, source), held)));
    model.held = held.collect();
    model.kept_clocks = Some(numbers);
}
