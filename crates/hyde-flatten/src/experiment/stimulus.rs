//! Free inputs: driven by stimuli, made parameters for linearisation, or reported.

use super::measured::recorded;
use super::outer::outer_parameter;
use super::stepped::is_stepped;
use crate::allowed::check_whole;
use crate::input::FreeInputs;
use crate::instance::{Elementwise, InstanceId, Member, Position, Scope, Setting, Typed};
use crate::model::Model;
use crate::model::lower::Resolved;
use crate::refusals::{experiment as refused, values};
use hyde_diag::MadeBy;
use hyde_ir::flat::{Equation, Preparation};
use hyde_ir::{Expr as Ir, ExprId, FlatModel, Id as _, Index, Range, VarId, VariableKind};
use hyde_syntax::ast::{Drive, Reference};
use hyde_units::Kind;

/// `stimulus r = e`: drives a free input; of an array all elements, by a list or by one value, or one element,
/// `stimulus F[2] = e`.
pub(super) fn stimulus<'a>(model: &mut Model<'a, '_>, drive: &'a Drive, root: InstanceId) {
    let (word, subscripts) = match drive.target.parts.as_slice() {
        [part] => (part.name.text.as_str(), part.subscripts.as_slice()),
        _ => ("", &[][..]),
    };
    let member = model.tree[root].members.get(word).cloned();
    let is_input = |var: VarId| model.flat.variables[var].input;
    let is_bound = |var: VarId| model.notes(var).binding.is_some();
    let input = match member {
        Some(Member::Variable(var)) => is_input(var).then_some(var),
        _ => None,
    };
    let Some(var) = input.filter(|&var| !is_bound(var)) else {
        // A declaration that is not understood is reported there.
        if model.undeclared.contains(drive.target.dotted().as_str()) {
            return;
        }
        let inputs: Vec<&str> = model.tree[root]
            .members
            .iter()
            .filter(|(_, member)| matches!(member, Member::Variable(var) if is_input(*var) && !is_bound(*var)))
            .map(|(name, _)| *name)
            .collect();
        model.report(refused::not_a_free_input(
            &drive.target,
            input.is_some(),
            &inputs,
        ));
        return;
    };
    // A stepped sine takes its place.
    if is_stepped(model, word) {
        return;
    }
    let scope = Scope {
        records: true,
        ..Scope::new(root, Setting::Equation)
    };
    let len = model.flat.variables[var].len;
    let Some(len) = len.filter(|_| subscripts.is_empty()) else {
        let index = match subscripts {
            [] => Some(Index::SCALAR),
            _ => element_of(model, &drive.target, &scope),
        };
        if let Some(index) = index {
            drive_by(model, drive, (var, index), &scope);
        }
        return;
    };
    let given = model.array_length(&drive.value, &scope);
    let misfit = given.filter(|&found| found != len);
    if let Some(found) = misfit {
        model.report(values::not_as_many(found, len, drive.value.span));
    }
    for (at, index) in (0..len).zip(0..) {
        let index = Index::fixed(index);
        let one = scope.elements(Elementwise::One(Position { at, of: len }));
        match misfit {
            None => drive_by(model, drive, (var, index), &one),
            // It is driven, though nobody knows by what: no other message.
            Some(_) => {
                let value = model.poison(drive.value.span);
                drives(model, drive, (var, index), value.id, root);
            }
        }
    }
}

/// The element that is meant, where it is one.
fn element_of<'a>(
    model: &mut Model<'a, '_>,
    target: &'a Reference,
    scope: &Scope<'a>,
) -> Option<Index> {
    let resolved = model.resolve(target, scope)?;
    if let Resolved::Variable(_, Some(index)) = resolved
        && index.stride == 0
    {
        return Some(index);
    }
    model.report(refused::drives_no_element(target));
    None
}

/// Drives an input, or an element of one.
fn drive_by<'a>(
    model: &mut Model<'a, '_>,
    drive: &'a Drive,
    (var, index): (VarId, Index),
    scope: &Scope<'a>,
) {
    let root = scope.instance;
    let element = usize::try_from(index.offset).unwrap_or(0);
    let word = model.flat.variables[var].element_name(element);
    let boolean = model.flat.variables[var].boolean;
    let mut value = model.lower(&drive.value, scope);
    if boolean && !value.truth {
        value = counted_column(model, value, Kind::Boolean, &word);
    } else if model.notes(var).integer {
        value = counted_column(model, value, Kind::Integer, &word);
    }
    let lhs = model.flat.exprs.add(Ir::Var(var, index));
    let left = Typed {
        truth: boolean,
        ..model.typed(lhs, model.dim(var), drive.target.span)
    };
    model.same_kind(&left, &value);
    check_whole(model, &left, &value);
    model.agree(&left, &value, "the input and its stimulus are", root);
    noise_of_column(model, drive, (&left, value.id), root);
    drives(model, drive, (var, index), value.id, root);
}

/// Adds the equation by which a value drives an input, or an element of one.
fn drives(
    model: &mut Model<'_, '_>,
    drive: &Drive,
    (var, index): (VarId, Index),
    value: ExprId,
    root: InstanceId,
) {
    let origin = model.tree.origin(root, drive.target.span);
    let lhs = model.flat.exprs.add(Ir::Var(var, index));
    model.flat.equations.push(Equation {
        range: Range::SCALAR,
        lhs,
        rhs: value,
        origin: origin.made_by(MadeBy::Experiment),
    });
}

/// The places of an input: one, or one an element; each with its name.
fn places(flat: &FlatModel, input: VarId) -> Vec<(Index, String)> {
    let variable = &flat.variables[input];
    let elements = (0..variable.size()).zip(0..);
    elements
        .map(|(element, offset)| (Index::fixed(offset), variable.element_name(element)))
        .collect()
}

/// `~ sd` of a stimulus or a replay, in the unit of what is driven: what its column is not known to.
pub(super) fn noise_of_column<'a>(
    model: &mut Model<'a, '_>,
    drive: &'a Drive,
    by: (&Typed, ExprId),
    root: InstanceId,
) {
    let Some(noise) = &drive.noise else {
        return;
    };
    let (driven, value) = by;
    let sd = model.width(noise, &Scope::new(root, Setting::Parameter));
    model.agree(&sd, driven, "the noise and what is driven are", root);
    let mut steps = Vec::new();
    let column = match reads_a_column(&model.flat, value) {
        true => recorded(model, &drive.value, root, false, &mut steps),
        false => None,
    };
    let factor = |step: &Preparation| match step {
        Preparation::Scale(factor) => Some(*factor),
        Preparation::Lowpass(_) | Preparation::Slope => None,
    };
    let factors: Option<Vec<f64>> = steps.iter().map(factor).collect();
    let (Some((column, _)), Some(factors)) = (column, factors) else {
        model.report(refused::noise_without_column(
            &drive.target,
            drive.value.span,
        ));
        return;
    };
    let scale: f64 = factors.into_iter().product();
    if let Some(sd) = model.current_value(sd.id) {
        model.flat.columns[column].noise = (sd / scale).abs();
    }
}

fn reads_a_column(flat: &FlatModel, value: ExprId) -> bool {
    let column = |id: ExprId| {
        let read = flat.exprs[id].access();
        let kind = read.map(|(var, ..)| flat.variables[var].kind);
        matches!(kind, Some(VariableKind::Column(..)))
    };
    flat.exprs.below(&[value]).into_iter().any(column)
}

/// A column that drives a Boolean or an Integer is held between its rows; the run looks at the value of each.
fn counted_column(model: &mut Model<'_, '_>, value: Typed, kind: Kind, input: &str) -> Typed {
    let Ir::Var(var, index) = model.flat.exprs[value.id] else {
        return value;
    };
    let VariableKind::Column(column, _) = model.flat.variables[var].kind else {
        return value;
    };
    let (_, held) = model.column_variables[&column];
    model.flat.columns[column].drives = Some((kind, input.to_owned(), value.span));
    let number = model.flat.exprs.add(Ir::Var(held, index));
    if kind == Kind::Integer {
        model.variables[held.index()].integer = true;
        return Typed {
            id: number,
            ..value
        };
    }
    let half = model.flat.exprs.constant(0.5);
    Typed {
        id: model.flat.exprs.binary(hyde_ir::BinaryOp::Gt, number, half),
        truth: true,
        ..value
    }
}

/// Makes free inputs parameters of their names with the value zero: what a linearised model is driven by, or what another
/// tool sets. A stimulus is what such a parameter is added to; one of a truth stays alone.
pub(crate) fn free_inputs(model: &mut Model<'_, '_>, root: InstanceId) {
    let free = model.input.free_inputs;
    if free == FreeInputs::None {
        return;
    }
    let members: Vec<VarId> = model.tree[root]
        .members
        .values()
        .filter_map(|member| {
            if let Member::Variable(var) = member {
                Some(*var)
            } else {
                None
            }
        })
        .filter(|&var| model.flat.variables[var].input && model.notes(var).binding.is_none())
        .collect();
    let all = members.into_iter().flat_map(|var| {
        let places = places(&model.flat, var).into_iter();
        places.map(move |(index, name)| (var, index, name))
    });
    for (var, index, name) in all.collect::<Vec<_>>() {
        let stimulus = stimulus_of(&model.flat, var, index);
        let variable = &model.flat.variables[var];
        if stimulus.is_some() && (variable.boolean || free == FreeInputs::Undriven) {
            continue;
        }
        let origin = variable.origin.clone().made_by(MadeBy::Experiment);
        let quantity = variable.quantity.clone();
        let zero = model.flat.exprs.constant(0.0);
        let free = outer_parameter(model, name, model.dim(var), quantity, zero, &origin);
        if let Some(number) = stimulus {
            let equation = &mut model.flat.equations[number];
            equation.rhs = model.flat.exprs.plus(equation.rhs, free);
            continue;
        }
        let lhs = model.flat.exprs.add(Ir::Var(var, index));
        model.flat.equations.push(Equation {
            range: Range::SCALAR,
            lhs,
            rhs: free,
            origin,
        });
    }
}

/// The number of the equation by which a stimulus drives an input, or an element of one.
fn stimulus_of(flat: &FlatModel, input: VarId, index: Index) -> Option<usize> {
    let target = Ir::Var(input, index);
    let mut equations = flat.equations.iter();
    equations.position(|equation| flat.exprs[equation.lhs] == target)
}

/// The free inputs of the model that nothing drives.
pub(crate) fn report_undriven(model: &mut Model<'_, '_>) {
    let mut undriven = Vec::new();
    for (id, variable) in model.flat.variables.enumerate() {
        let notes = &model.variables[id.index()];
        let top = model.tree[notes.instance].parent.is_none();
        if !variable.input || !top || notes.binding.is_some() {
            continue;
        }
        let mut open = places(&model.flat, id);
        open.retain(|(index, _)| stimulus_of(&model.flat, id, *index).is_none());
        let span = variable.origin.span;
        // Of an array that nothing drives, one message.
        if !open.is_empty() && open.len() == variable.size() {
            open = vec![(Index::SCALAR, variable.name.clone())];
        }
        undriven.extend(open.into_iter().map(|(_, name)| (name, span)));
    }
    for (name, span) in undriven {
        model.report(refused::not_driven(&name, span, model.input.experiment));
    }
}
