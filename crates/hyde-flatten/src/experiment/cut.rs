//! `margins of x;`: the loop cut at a signal.
//!
//! ```text
//! tau = K*i                    with  margins of tau;        is  tau = K*i + d
//! motor.i_ref = hold(cnc.i)    with  margins of motor.i_ref;    c = cnc.i + d, ticking with cnc;  motor.i_ref = hold(c)
//! ```
//! The test signal d stands between what gives the signal and everything that reads it. It is a parameter of the value zero,
//! so the model is what it was; the linearised model is driven by it. A signal that is made of held values alone gets a sampled
//! test signal, which changes with them: so the response of the cut loop is the exact discrete one.

use super::bode::{chosen_modes, lower_band, moment};
use super::outer::outer_parameter;
use crate::input::FreeInputs;
use crate::instance::{InstanceId, Scope, Setting};
use crate::model::Model;
use crate::model::lower::Resolved;
use crate::refusals::experiment as refused;
use hyde_diag::MadeBy;
use hyde_ir::flat::{ClockedEquation, Cut, Equation};
use hyde_ir::{ClockId, Expr as Ir, ExprId, Index, Memo, Range, VarId, VariableKind};
use hyde_syntax::ast::{self, Reference};

/// The equation that gives a signal.
#[derive(Clone, Copy)]
enum Giver {
    /// A continuous equation, with the signal on its left side.
    Left(usize),
    /// A connection, with the signal on its right side.
    Right(usize),
    /// A clocked equation.
    Clocked(usize),
}

pub(super) fn lower_margins<'a>(
    model: &mut Model<'a, '_>,
    margins: &'a ast::Margins,
    root: InstanceId,
) {
    let band = margins
        .band
        .as_ref()
        .map(|band| lower_band(model, band, root));
    let at = moment(model, margins.at.as_ref(), root);
    let modes = chosen_modes(&model.flat, model.diagnostics, &margins.modes);
    for signal in &margins.signals {
        let Some((var, giver)) = giver_of(model, signal, root) else {
            continue;
        };
        // A run has no test signal.
        if model.input.free_inputs != FreeInputs::All {
            continue;
        }
        let (input, d) = test_signal(model, signal, var, root);
        let (back, clock) = cut(model, var, giver, d, root);
        let origin = model
            .tree
            .origin(root, signal.span)
            .made_by(MadeBy::Experiment);
        model.flat.experiment.cuts.push(Cut {
            signal: hyde_syntax::format_reference(signal),
            input,
            back,
            clock,
            band,
            at,
            modes: modes.clone(),
            origin,
        });
    }
}

/// The variable that is meant, and the one equation that gives it.
fn giver_of<'a>(
    model: &mut Model<'a, '_>,
    signal: &'a Reference,
    root: InstanceId,
) -> Option<(VarId, Giver)> {
    let scope = Scope::new(root, Setting::Report);
    let (var, index) = match model.resolve(signal, &scope)? {
        Resolved::Variable(var, index) => (var, index),
        Resolved::Parameter(..)
        | Resolved::Counter(_)
        | Resolved::Time
        | Resolved::Pi
        | Resolved::Value(_)
        | Resolved::Coordinate
        | Resolved::Instance(_) => {
            model.report(refused::cuts_no_signal(signal));
            return None;
        }
    };
    let len = model.flat.variables[var].len;
    let Some(index) = index.or(len.is_none().then_some(Index::SCALAR)) else {
        model.report(refused::cuts_array(signal));
        return None;
    };
    let leaf = model.flat.exprs.add(Ir::Var(var, index));
    let giver = given_by(model, var, leaf);
    if giver.is_none() {
        model.report(refused::cuts_no_equation(signal));
    }
    Some((var, giver?))
}

fn given_by(model: &Model<'_, '_>, var: VarId, leaf: ExprId) -> Option<Giver> {
    let clocked = &model.flat.clocked_equations;
    if let Some(at) = clocked.iter().position(|e| e.equation.lhs == leaf) {
        return Some(Giver::Clocked(at));
    }
    let written = |e: &Equation| e.lhs == leaf && e.origin.made_by != MadeBy::Connection;
    if let Some(at) = model.flat.equations.iter().position(written) {
        return Some(Giver::Left(at));
    }
    // A connection gives an input its value from outside the component, an output from inside.
    let own = &model.tree[model.notes(var).instance].path;
    let input = model.flat.variables[var].input;
    let gives = |e: &Equation| {
        e.origin.made_by == MadeBy::Connection && (e.origin.instance != *own) == input
    };
    let joined = |e: &Equation| gives(e) && (e.lhs == leaf || e.rhs == leaf);
    let at = model.flat.equations.iter().position(joined)?;
    let left = model.flat.equations[at].lhs == leaf;
    Some(if left {
        Giver::Left(at)
    } else {
        Giver::Right(at)
    })
}

/// The parameter that is the test signal, by its name.
fn test_signal(
    model: &mut Model<'_, '_>,
    signal: &Reference,
    var: VarId,
    root: InstanceId,
) -> (String, ExprId) {
    let number = model.flat.experiment.cuts.len() + 1;
    let name = format!(
        "test signal {number} at {}",
        hyde_syntax::format_reference(signal)
    );
    let quantity = model.flat.variables[var].quantity.clone();
    let origin = model
        .tree
        .origin(root, signal.span)
        .made_by(MadeBy::Experiment);
    let zero = model.flat.exprs.constant(0.0);
    let d = outer_parameter(model, name.clone(), model.dim(var), quantity, zero, &origin);
    (name, d)
}

/// Adds the test signal; what comes back, and the clock by which the signal is sampled.
fn cut(
    model: &mut Model<'_, '_>,
    var: VarId,
    giver: Giver,
    d: ExprId,
    root: InstanceId,
) -> (ExprId, Option<ClockId>) {
    let (at, from) = match giver {
        Giver::Clocked(at) => {
            let ClockedEquation { clock, equation } = &model.flat.clocked_equations[at];
            let (clock, lhs, rhs) = (*clock, equation.lhs, equation.rhs);
            let cut = model.flat.exprs.plus(rhs, d);
            model.flat.clocked_equations[at].equation.rhs = cut;
            return (lhs, Some(clock));
        }
        Giver::Left(at) => (at, model.flat.equations[at].rhs),
        Giver::Right(at) => {
            let equation = &mut model.flat.equations[at];
            std::mem::swap(&mut equation.lhs, &mut equation.rhs);
            (at, equation.rhs)
        }
    };
    let Some((clock, sampled)) = of_held_values(model, from, &mut vec![var]) else {
        model.flat.equations[at].rhs = model.flat.exprs.plus(from, d);
        return (from, None);
    };
    let name = &model.flat.variables[var].name;
    let (name, held) = (format!("{name}, cut"), format!("hold({name}, cut)"));
    let (dim, span) = (model.dim(var), model.flat.equations[at].origin.span);
    let mut variable =
        |name, kind| model.add_variable(root, name, kind, dim.clone(), span, MadeBy::Experiment);
    let source = variable(name, VariableKind::Clocked(clock));
    let held = variable(held, VariableKind::Held(clock, source));
    let (lhs, rhs) = (
        model.flat.exprs.var(source),
        model.flat.exprs.plus(sampled, d),
    );
    let origin = model.flat.equations[at].origin.clone();
    let equation = Equation {
        range: Range::SCALAR,
        lhs,
        rhs,
        origin,
    };
    let clocked = ClockedEquation { clock, equation };
    model.flat.clocked_equations.push(clocked);
    model.flat.equations[at].rhs = model.flat.exprs.var(held);
    (lhs, Some(clock))
}

/// Of an expression that is made of the held values of one clock alone, or of variables that are: the same of what they
/// hold, and the clock. `seen` are the variables on the way there: one that comes again is in a loop.
fn of_held_values(
    model: &mut Model<'_, '_>,
    id: ExprId,
    seen: &mut Vec<VarId>,
) -> Option<(ClockId, ExprId)> {
    let mut memo = Memo::default();
    let mut found = None;
    for below in model.flat.exprs.below(&[id]) {
        match model.flat.exprs[below] {
            Ir::Var(var, Index::SCALAR) => {
                let (clock, sampled) = match model.flat.variables[var].kind {
                    VariableKind::Held(clock, source) => (clock, model.flat.exprs.var(source)),
                    VariableKind::Continuous if !seen.contains(&var) => {
                        seen.push(var);
                        let given = match given_by(model, var, below)? {
                            Giver::Left(at) => model.flat.equations[at].rhs,
                            Giver::Right(at) => model.flat.equations[at].lhs,
                            Giver::Clocked(_) => return None,
                        };
                        let found = of_held_values(model, given, seen);
                        seen.pop();
                        found?
                    }
                    VariableKind::Continuous
                    | VariableKind::Discrete
                    | VariableKind::Clocked(_)
                    | VariableKind::Column(..)
                    | VariableKind::Delayed(_)
                    | VariableKind::Reduction(_) => return None,
                };
                if found.is_some_and(|known| known != clock) {
                    return None;
                }
                found = Some(clock);
                memo.insert(below, sampled);
            }
            Ir::Const(_)
            | Ir::Param(..)
            | Ir::Unary(..)
            | Ir::Binary(..)
            | Ir::If(..)
            | Ir::NoEvent(_) => {}
            Ir::Var(..)
            | Ir::Time
            | Ir::Counter
            | Ir::Der(..)
            | Ir::Pre(..)
            | Ir::Relation(_)
            | Ir::InMode(..) => return None,
        }
    }
    let clock = found?;
    let sampled = model.flat.exprs.rewrite(id, &mut memo, |_, _, _| None);
    Some((clock, sampled))
}
