//! `replay x = column;`: a cut. The recorded column takes the place of what the model says of x (C4).
//!
//! ```text
//! motor.i_ref = hold(cnc.control.i_ref)     with  replay motor.i_ref = file.i_ref;
//!                                           is    motor.i_ref = held(file.i_ref)
//! ```
//! A run keeps the loop closed. Calibration and diagnosis ask for the observed form, in which cuts are made: their
//! columns were measured with the true axis in the loop, so nothing that stands before a cut has to be known. Effects
//! that wrap the variable stay: they act on the column.

mod target;

pub(crate) use target::Replay;

use super::measured::recorded;
use super::stimulus::noise_of_column;
use crate::input::Form;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::model::Model;
use crate::model::call::clocks_of;
use crate::model::lower::Resolved;
use crate::refusals::records as refused;
use hyde_diag::{MadeBy, Origin};
use hyde_ir::flat::{Equation, Measured, Replayed};
use hyde_ir::{ColumnId, Expr as Ir, ExprId, FlatModel, Interpolation, Memo, VarId, VariableKind};
use hyde_syntax::ast::ExperimentItem;
use std::collections::BTreeSet;

/// A clock ticks several times between two rows if its period is at most this part of their distance.
const SEVERAL: f64 = 0.6;

/// Finds the variables that the experiment replays.
pub(crate) fn find_replays(model: &mut Model<'_, '_>, root: InstanceId) {
    let experiment = model.input.experiment;
    let Some(experiment) = experiment.and_then(|name| model.names.own_experiment(name)) else {
        return;
    };
    for item in &experiment.items {
        let ExperimentItem::Replay(drives) = item else {
            continue;
        };
        for drive in drives {
            let scope = Scope::new(root, Setting::Report);
            let target = &drive.target;
            let var = match model.resolve(target, &scope) {
                None => continue,
                Some(Resolved::Variable(var, None)) => var,
                Some(Resolved::Variable(..)) => {
                    model.report(refused::replays_array(target));
                    continue;
                }
                Some(_) => {
                    model.report(refused::nothing_to_replay(target));
                    continue;
                }
            };
            if model.flat.variables[var].len.is_some() {
                model.report(refused::replays_array(target));
                continue;
            }
            model.replays.push(Replay {
                drive,
                var,
                root,
                used: false,
                value: None,
                recorded: None,
            });
        }
    }
}

/// What a variable's equation says, or the column that takes its place.
pub(crate) fn replayed(model: &mut Model<'_, '_>, var: VarId, value: Typed) -> Typed {
    let Some(number) = model.replays.iter().position(|replay| replay.var == var) else {
        return value;
    };
    model.replays[number].used = true;
    model.replays[number].value = Some(value.id);
    let Replay { drive, root, .. } = model.replays[number];
    if model.input.form != Form::Observed {
        return value;
    }
    let scope = Scope {
        records: true,
        ..Scope::new(root, Setting::Equation)
    };
    let mut column = model.value(&drive.value, &scope);
    let declared = model.typed(value.id, model.dim(var), drive.target.span);
    model.agree(&declared, &column, "the variable and its record are", root);
    noise_of_column(model, drive, (&declared, column.id), root);
    if is_held(&model.flat, var, value.id) {
        note_ticks_between_rows(model, var, value.id, column.id);
        column.id = with_held_columns(model, column.id);
    }
    model.replays[number].recorded = Some(column.id);
    column
}

/// Notes of a column how often what it replays changes, if that is several times between two rows of its record, which
/// does not have all of it.
fn note_ticks_between_rows(model: &mut Model<'_, '_>, var: VarId, value: ExprId, column: ExprId) {
    let mut kinds = vec![model.flat.variables[var].kind];
    for id in model.flat.exprs.below(&[value]) {
        if let Ir::Var(read, _) = model.flat.exprs[id] {
            kinds.push(model.flat.variables[read].kind);
        }
    }
    let clocks = kinds.into_iter().filter_map(|kind| match kind {
        VariableKind::Clocked(clock) | VariableKind::Held(clock, _) => Some(clock),
        VariableKind::Continuous
        | VariableKind::Discrete
        | VariableKind::Column(..)
        | VariableKind::Delayed(_)
        | VariableKind::Reduction(_) => None,
    });
    let periods: Vec<ExprId> = clocks
        .map(|clock| model.flat.clocks[clock].period)
        .collect();
    let periods: Vec<f64> = periods
        .into_iter()
        .filter_map(|period| model.current_value(period))
        .collect();
    let Some(period) = periods.into_iter().reduce(f64::min) else {
        return;
    };
    for id in model.flat.exprs.below(&[column]) {
        if let Ir::Var(read, _) = model.flat.exprs[id]
            && let VariableKind::Column(column, _) = model.flat.variables[read].kind
        {
            let column = &mut model.flat.columns[column];
            let header = model.input.records.get(&column.record);
            let step_s = header.and_then(|header| header.step_s);
            if step_s.is_some_and(|step_s| period <= SEVERAL * step_s) {
                column.ticks_s = Some(period);
            }
        }
    }
}

/// Puts columns in the place of equations that no effect wraps, those of connections last.
pub(crate) fn replay_equations(model: &mut Model<'_, '_>, connections_made: bool) {
    for number in 0..model.replays.len() {
        if model.replays[number].used {
            continue;
        }
        let var = model.replays[number].var;
        let leaf = model.flat.exprs.var(var);
        if let Some(at) = model.flat.equations.iter().position(|e| e.lhs == leaf) {
            let value = model.typed(
                model.flat.equations[at].rhs,
                model.dim(var),
                span_of(model, number),
            );
            model.flat.equations[at].rhs = replayed(model, var, value).id;
            continue;
        }
        let clocked = &model.flat.clocked_equations;
        if let Some(at) = clocked.iter().position(|e| e.equation.lhs == leaf) {
            let rhs = clocked[at].equation.rhs;
            let value = model.typed(rhs, model.dim(var), span_of(model, number));
            model.flat.clocked_equations[at].equation.rhs = replayed(model, var, value).id;
            continue;
        }
        // An input that is connected: the equation of the connection has it on either side.
        let input = model.flat.variables[var].input;
        let connected = model.flat.equations.iter().position(|e| e.rhs == leaf);
        if let Some(at) = connected.filter(|_| input) {
            let value = model.typed(
                model.flat.equations[at].lhs,
                model.dim(var),
                span_of(model, number),
            );
            let column = replayed(model, var, value).id;
            let equation = &mut model.flat.equations[at];
            if model.input.form == Form::Observed {
                (equation.lhs, equation.rhs) = (leaf, column);
            }
            continue;
        }
        if connections_made {
            no_equation_to_replay(model, number);
        }
    }
}

/// Makes a channel of each replayed column: what an axis would have recorded there.
pub(super) fn record_replays(model: &mut Model<'_, '_>) {
    for number in 0..model.replays.len() {
        let Replay {
            drive,
            var,
            root,
            value,
            ..
        } = model.replays[number];
        let mut preparation = Vec::new();
        let column = recorded(model, &drive.value, root, false, &mut preparation);
        let (Some((column, _)), Some(value)) = (column, value) else {
            continue;
        };
        let origin = model.tree.origin(root, drive.target.span);
        let clocked = is_held(&model.flat, var, value) || !clocks_of(&model.flat, value).is_empty();
        model.flat.experiment.measured.push(Measured {
            name: hyde_syntax::format_reference(&drive.target),
            column,
            preparation,
            value,
            clocked,
            noise: None,
            rounding: None,
            late: None,
            period: None,
            quantity: model.flat.variables[var].quantity.clone(),
            origin: origin.made_by(MadeBy::Experiment),
        });
    }
}

/// Keeps what the model itself has for a continuous variable where a column takes its place: a command that clocked parts put
/// out is to agree with it along the measured motion.
pub(super) fn keep_commands(model: &mut Model<'_, '_>) {
    for number in 0..model.replays.len() {
        let replay = model.replays[number];
        let Replay { drive, var, .. } = replay;
        let (Some(value), Some(recorded)) = (replay.value, replay.recorded) else {
            continue;
        };
        if model.flat.variables[var].kind != VariableKind::Continuous {
            continue;
        }
        let origin = model.tree.origin(replay.root, drive.target.span);
        model.flat.experiment.replayed.push(Replayed {
            name: hyde_syntax::format_reference(&drive.target),
            column: only_column(&model.flat, recorded),
            recorded,
            value,
            register: register(&model.flat, value).cloned(),
            quantity: model.flat.variables[var].quantity.clone(),
            origin: origin.made_by(MadeBy::Experiment),
        });
    }
}

/// The column that an expression reads, if it is one alone.
fn only_column(flat: &FlatModel, id: ExprId) -> Option<ColumnId> {
    let below = flat.exprs.below(&[id]).into_iter();
    let columns = below.filter_map(|id| {
        let Ir::Var(read, _) = flat.exprs[id] else {
            return None;
        };
        match flat.variables[read].kind {
            VariableKind::Column(column, _) => Some(column),
            VariableKind::Continuous
            | VariableKind::Discrete
            | VariableKind::Clocked(_)
            | VariableKind::Held(..)
            | VariableKind::Delayed(_)
            | VariableKind::Reduction(_) => None,
        }
    });
    let columns: BTreeSet<ColumnId> = columns.collect();
    match columns.len() {
        1 => columns.first().copied(),
        _ => None,
    }
}

/// The equation `u = pre(w)` that alone decides what is held, by way of variables that are equal.
fn register(flat: &FlatModel, value: ExprId) -> Option<&Origin> {
    let Ir::Var(mut var, _) = flat.exprs[value] else {
        return None;
    };
    for _ in 0..flat.variables.len() {
        if let VariableKind::Held(_, source) = flat.variables[var].kind {
            var = source;
        }
        let clocked = flat.clocked_equations.iter();
        let clocked = clocked.map(|own| &own.equation);
        let is_lhs = |own: &&Equation| matches!(flat.exprs[own.lhs], Ir::Var(of, _) if of == var);
        let equation = flat.equations.iter().chain(clocked).find(is_lhs)?;
        if matches!(flat.exprs[equation.rhs], Ir::Pre(..)) {
            return Some(&equation.origin);
        }
        let Ir::Var(next, _) = flat.exprs[equation.rhs] else {
            return None;
        };
        var = next;
    }
    None
}

fn span_of(model: &Model<'_, '_>, replay: usize) -> hyde_diag::Span {
    model.replays[replay].drive.target.span
}

fn no_equation_to_replay(model: &mut Model<'_, '_>, number: usize) {
    let Replay { drive, .. } = model.replays[number];
    model.report(refused::nothing_to_replay(&drive.target));
}

/// Whether a variable changes at instants only: clocked, or made of held values.
fn is_held(flat: &FlatModel, var: VarId, value: ExprId) -> bool {
    let held = |kind: VariableKind| {
        matches!(
            kind,
            VariableKind::Clocked(_)
                | VariableKind::Held(..)
                | VariableKind::Column(_, Interpolation::Held)
        )
    };
    held(flat.variables[var].kind)
        || flat.exprs.any(value, |expr| match expr {
            Ir::Var(read, _) => held(flat.variables[read].kind),
            Ir::Const(_)
            | Ir::Time
            | Ir::Counter
            | Ir::Param(..)
            | Ir::Der(..)
            | Ir::Pre(..)
            | Ir::Relation(_)
            | Ir::InMode(..)
            | Ir::Unary(..)
            | Ir::Binary(..)
            | Ir::If(..)
            | Ir::NoEvent(_) => false,
        })
}

/// The same with columns held between their rows.
fn with_held_columns(model: &mut Model<'_, '_>, id: ExprId) -> ExprId {
    let mut memo = Memo::default();
    for below in model.flat.exprs.below(&[id]) {
        if let Ir::Var(var, _) = model.flat.exprs[below]
            && let VariableKind::Column(column, Interpolation::Linear) =
                model.flat.variables[var].kind
        {
            let held = model.column_variables[&column].1;
            memo.insert(below, model.flat.exprs.var(held));
        }
    }
    model.flat.exprs.rewrite(id, &mut memo, |_, _, _| None)
}
