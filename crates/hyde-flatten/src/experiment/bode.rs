//! Frequency responses.

use super::stepped::stepped;
use super::time::agree_time;
use crate::dimension::Dim;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::model::Model;
use crate::model::lower::Resolved;
use crate::refusals::experiment as refused;
use crate::shown::quantity_of;
use hyde_diag::{Diagnostics, MadeBy};
use hyde_ir::flat::{Bode, Moment};
use hyde_ir::{ExprId, FlatModel, Index, Quantity, VarId};
use hyde_syntax::ast::{self, Reference};
use hyde_units::Dimension;

pub(super) fn lower_bode<'a>(model: &mut Model<'a, '_>, bode: &'a ast::Bode, root: InstanceId) {
    let (input, outputs, band) = (&bode.input, &bode.outputs, &bode.band);
    let scope = Scope::new(root, Setting::Report);
    let Some(driven) = driven_input(model, input, &scope) else {
        model.report(refused::response_of_no_input(&input.dotted(), input.span));
        return;
    };
    let mut list = Vec::new();
    for output in outputs {
        let typed = model.value(output, &scope);
        let quantity = shown_quantity(model, &typed);
        list.push((hyde_syntax::format_expression(output), typed.id, quantity));
    }
    let band = Some(lower_band(model, band, root));
    let at = moment(model, bode.at.as_ref(), root);
    let modes = chosen_modes(&model.flat, model.diagnostics, &bode.modes);
    let origin = model
        .tree
        .origin(root, input.span)
        .made_by(MadeBy::Experiment);
    let names: Vec<&str> = list.iter().map(|(name, ..)| name.as_str()).collect();
    let stepped = bode
        .steps
        .as_ref()
        .and_then(|(method, arguments)| stepped(model, driven, method, arguments, &names, root));
    model.flat.experiment.bodes.push(Bode {
        input: driven,
        outputs: list,
        band,
        stepped,
        at,
        modes,
        origin,
    });
}

/// The input at which a response starts, and which element of it, from 0.
pub(super) fn driven_input<'a>(
    model: &mut Model<'a, '_>,
    input: &'a Reference,
    scope: &Scope<'a>,
) -> Option<(VarId, usize)> {
    let Some(Resolved::Variable(var, index)) = model.resolve(input, scope) else {
        return None;
    };
    let variable = &model.flat.variables[var];
    let index = index.or(variable.len.is_none().then_some(Index::SCALAR))?;
    let element = usize::try_from(index.offset).ok()?;
    variable.input.then_some((var, element))
}

/// Where the run is when it is linearised: `at 0.3 [s]`, `at start`, `at steady`.
pub(super) fn moment<'a>(
    model: &mut Model<'a, '_>,
    at: Option<&'a ast::Expr>,
    root: InstanceId,
) -> Moment {
    let Some(at) = at else {
        return Moment::Start;
    };
    if let ast::ExprKind::Reference(reference) = &at.kind {
        match reference.as_word() {
            Some("start") => return Moment::Start,
            Some("steady") => return Moment::Steady,
            Some(_) | None => {}
        }
    }
    let time = model.value(at, &Scope::new(root, Setting::Parameter));
    agree_time(model, &time, "a run is linearised at a time, found", root);
    Moment::At(time.id)
}

/// How a value is shown: what stands alone in the unit that it is declared with.
pub(super) fn shown_quantity(model: &mut Model<'_, '_>, typed: &Typed) -> Quantity {
    let dimension = model.dimension_until_now(&typed.dim);
    let usual = Quantity::usual(dimension.unwrap_or(Dimension::DIMENSIONLESS));
    let declared = quantity_of(&model.flat, typed.id).cloned();
    let known = declared.filter(|known| known.unit.text() != "1");
    known.unwrap_or(usual)
}

/// The ends of a band of frequencies in Hz.
pub(super) fn lower_band<'a>(
    model: &mut Model<'a, '_>,
    band: &'a ast::Range,
    root: InstanceId,
) -> (ExprId, ExprId) {
    let parameter = Scope::new(root, Setting::Parameter);
    let (from, to) = (
        model.value(&band.from, &parameter),
        model.value(&band.to, &parameter),
    );
    let rate = Typed {
        dim: Dim::NUMBER.divide(&Dim::known(Dimension::TIME)),
        ..from.clone()
    };
    model.agree(
        &rate,
        &from,
        "the ends of a band are frequencies, found",
        root,
    );
    let rate = Typed {
        span: to.span,
        ..rate
    };
    model.agree(
        &rate,
        &to,
        "the ends of a band are frequencies, found",
        root,
    );
    (from.id, to.id)
}

/// `in guide = slip, …`: the modes in which the linearised system is taken.
pub(super) fn chosen_modes(
    flat: &FlatModel,
    diagnostics: &mut Diagnostics,
    modes: &[(Reference, ast::Name)],
) -> Vec<(hyde_ir::AutomatonId, usize)> {
    let chosen = modes.iter();
    chosen
        .filter_map(|(name, mode)| mode_of(flat, diagnostics, name, mode))
        .collect()
}

/// An automaton by the name of its instance, and one of its modes.
fn mode_of(
    flat: &FlatModel,
    diagnostics: &mut Diagnostics,
    name: &Reference,
    mode: &ast::Name,
) -> Option<(hyde_ir::AutomatonId, usize)> {
    let path = hyde_syntax::format_reference(name);
    let found = flat
        .automata
        .enumerate()
        .find(|(_, automaton)| automaton.name == path);
    let Some((id, automaton)) = found else {
        let known: Vec<&str> = flat
            .automata
            .iter()
            .map(|automaton| automaton.name.as_str())
            .collect();
        diagnostics.push(refused::no_modes(name, &known));
        return None;
    };
    let number = automaton
        .modes
        .iter()
        .position(|known| known.name == mode.text);
    if number.is_none() {
        let known: Vec<&str> = automaton
            .modes
            .iter()
            .map(|mode| mode.name.as_str())
            .collect();
        diagnostics.push(refused::no_mode(&path, mode, &known));
    }
    Some((id, number?))
}
