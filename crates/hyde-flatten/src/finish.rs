//! The end of flatten: dimensions that are still unknown, quantities for printing, parameters in order.

use crate::dimension::Dim;
use crate::dimension::constraints::Dimensions;
use crate::instance::{Lowering, ParameterNotes, VariableNotes};
use crate::refusals::allowed as refused;
use hyde_diag::{Diagnostic, Diagnostics, Span};
use hyde_ir::{
    Expr as Ir, ExprId, FlatModel, Id as _, IdVec, Index, ParamId, Parameter, Quantity, Range,
    VarId, Variable, VariableKind, flat,
};
use hyde_units::Dimension;

/// Gives every variable the quantity that it is printed in.
pub(crate) fn settle_variables(
    variables: &mut IdVec<VarId, Variable>,
    notes: &[VariableNotes<'_>],
    dimensions: &Dimensions,
) {
    for (variable, notes) in variables.iter_mut().zip(notes) {
        let dimension = dimension(&notes.dim, dimensions);
        variable.quantity = settled(variable.quantity.clone(), dimension);
    }
}

/// Gives every parameter the quantity that it is printed in.
pub(crate) fn settle_parameters(
    parameters: &mut IdVec<ParamId, Parameter>,
    notes: &[ParameterNotes<'_>],
    dimensions: &Dimensions,
) {
    for (parameter, notes) in parameters.iter_mut().zip(notes) {
        let dimension = dimension(&notes.dim, dimensions);
        parameter.quantity = settled(parameter.quantity.clone(), dimension);
    }
}

fn dimension(dim: &Dim, dimensions: &Dimensions) -> Dimension {
    let Dim::Of(known, unknowns) = dim else {
        return Dimension::DIMENSIONLESS;
    };
    unknowns
        .iter()
        .fold(*known, |product, &(unknown, exponent)| {
            let factor = dimensions.solution(unknown).power(exponent);
            product.multiply(factor.unwrap_or(Dimension::DIMENSIONLESS))
        })
}

/// Drops the equations of arrays that have no element.
pub(crate) fn drop_empty_equations(flat: &mut FlatModel) {
    flat.equations.retain(|equation| !equation.range.is_empty());
    flat.initial_equations
        .retain(|equation| !equation.range.is_empty());
    flat.clocked_equations
        .retain(|clocked| !clocked.equation.range.is_empty());
}

/// Makes the equation of an array of one element that of the element: a range from 0 to 0 is what no range is, and its counter
/// would remain in it.
pub(crate) fn single_elements(flat: &mut FlatModel) {
    let exprs = &mut flat.exprs;
    let clocked = flat.clocked_equations.iter_mut();
    let clocked = clocked.map(|clocked| &mut clocked.equation);
    let all = flat.equations.iter_mut().chain(&mut flat.initial_equations);
    for equation in all.chain(clocked) {
        if equation.range.len() != 1 {
            continue;
        }
        for side in [&mut equation.lhs, &mut equation.rhs] {
            *side = exprs.at_counter(*side, equation.range.first);
        }
        equation.range = Range::SCALAR;
    }
}

/// Orders parameters so that each comes after those its value uses.
pub(crate) fn order_parameters(flat: &mut FlatModel, diagnostics: &mut Diagnostics) {
    let mut state = vec![Lowering::Waiting; flat.parameters.len()];
    for id in flat.parameters.ids().collect::<Vec<_>>() {
        visit(flat, id, &mut state, diagnostics);
    }
}

/// Makes fixed starts that read a parameter which the start finds conditions of their own: what is to be found cannot give a
/// start before it is found.
pub(crate) fn starts_of_found(flat: &mut FlatModel) {
    let mut found: Vec<bool> = flat.parameters.iter().map(|own| own.found).collect();
    // Without an initial equation nothing finds it, and it keeps its guess.
    if !found.contains(&true) || flat.initial_equations.is_empty() {
        return;
    }
    let reads = |flat: &FlatModel, found: &[bool], values: &[ExprId]| {
        let mut below = flat.exprs.below(values).into_iter();
        below.any(|id| matches!(flat.exprs[id], Ir::Param(used, _) if found[used.index()]))
    };
    for &id in &flat.parameter_order {
        found[id.index()] |= reads(flat, &found, &flat.parameters[id].value);
    }
    for id in flat.variables.ids().collect::<Vec<_>>() {
        let variable = &flat.variables[id];
        let continuous = variable.kind == VariableKind::Continuous;
        if !continuous || !variable.fixed || !reads(flat, &found, &variable.start) {
            continue;
        }
        let (starts, origin) = (variable.start.clone(), variable.origin.clone());
        let size = i32::try_from(variable.size()).unwrap_or(i32::MAX);
        for at in 0..size {
            let own = usize::try_from(at).ok().filter(|_| starts.len() > 1);
            let Some(&start) = starts.get(own.unwrap_or(0)) else {
                continue;
            };
            let equation = flat::Equation {
                range: Range::SCALAR,
                lhs: flat.exprs.add(Ir::Var(id, Index::fixed(at))),
                rhs: flat.exprs.at_counter(start, at),
                origin: origin.clone(),
            };
            flat.initial_equations.push(equation);
        }
        flat.variables[id].fixed = false;
    }
}

fn refuse_circle(flat: &FlatModel, circle: &[ParamId]) -> Diagnostic {
    let names: Vec<String> = circle
        .iter()
        .map(|&id| format!("`{}`", flat.parameters[id].name))
        .collect();
    let place = |&id: &ParamId| flat.parameters[id].origin.span;
    let places: Vec<Span> = circle.iter().map(place).collect();
    refused::circle_of_parameters(&names, &places)
}

fn visit(
    flat: &mut FlatModel,
    root: ParamId,
    state: &mut [Lowering],
    diagnostics: &mut Diagnostics,
) {
    let mut stack = vec![(root, false)];
    while let Some((id, left)) = stack.pop() {
        if left {
            state[id.index()] = Lowering::Done;
            flat.parameter_order.push(id);
            continue;
        }
        match state[id.index()] {
            Lowering::Done => continue,
            Lowering::InProgress => {
                let circle = stack
                    .iter()
                    .filter(|(_, entered)| *entered)
                    .map(|(id, _)| *id)
                    .skip_while(|&on_the_way| on_the_way != id);
                let diagnostic = refuse_circle(flat, &circle.collect::<Vec<_>>());
                diagnostics.push(diagnostic);
                continue;
            }
            Lowering::Waiting => state[id.index()] = Lowering::InProgress,
        }
        stack.push((id, true));
        let values = flat.parameters[id].value.clone();
        for below in flat.exprs.below(&values) {
            if let Ir::Param(used, _) = flat.exprs[below]
                && state[used.index()] != Lowering::Done
            {
                stack.push((used, false));
            }
        }
    }
}

/// The quantity chosen for printing if it fits the dimension, else the usual unit.
fn settled(known: Quantity, dimension: Dimension) -> Quantity {
    let agrees = known.dimension.agreement(dimension) != hyde_units::Agreement::Different;
    if agrees && known.unit.text() != "1" {
        known
    } else {
        Quantity::usual(dimension)
    }
}
