//! A measured channel that shows what was: in the observed form its readings move, not the model.
//!
//! ```text
//! measured log.x = delay(axis.x, T)        log.x(t + T0) = axis.x - (T - T0)*der(axis.x)
//! ```
//! An observer has no past. It compares each reading with the model at the instant that the reading is of: T0 before its
//! own, T as it is declared. How readings change as a fit varies T is the first term of the Taylor series.

use hyde_diag::MadeBy;
use hyde_ir::flat::Equation;
use hyde_ir::{
    DelayId, Expr as Ir, ExprArena, ExprId, FlatModel, Id as _, Index, VarId, VariableKind,
};
use std::collections::BTreeMap;

/// A value that is read before the delay that was made for it.
pub(super) struct Early {
    /// How late it is shown.
    pub(super) time: ExprId,
    /// The same as declared, s.
    pub(super) by_s: f64,
    /// The parameters that decide how late.
    pub(super) by: Vec<String>,
}

/// Takes the delay off a value that is made of variables with one delay; `first` is the first delay that was made for it.
/// `None` of any other. The variables are in `delayed` no more.
pub(super) fn undelay(
    flat: &mut FlatModel,
    delayed: &mut BTreeMap<(ExprId, ExprId), VarId>,
    value: ExprId,
    first: usize,
) -> Option<Early> {
    let read = variables_read_by(flat, value);
    let number = |var: &VarId| {
        let VariableKind::Delayed(delay) = flat.variables[*var].kind else {
            return None;
        };
        Some(delay.index())
    };
    let numbers: Vec<usize> = read.iter().map(number).collect::<Option<_>>()?;
    let made = flat.delays.len().checked_sub(first)?;
    let known = DelayId::from_index(*numbers.first()?);
    let (time, by_s) = (flat.delays[known].time, flat.delays[known].time_s);
    let one = |number: &usize| flat.delays[DelayId::from_index(*number)].time == time;
    // All delays behind the first are this channel's: none stands within another, and nothing else reads them.
    if numbers.len() != made || !numbers.iter().all(|own| *own >= first && one(own)) {
        return None;
    }
    for (var, number) in read.iter().zip(&numbers) {
        let delay = &flat.delays[DelayId::from_index(*number)];
        let (range, rhs) = (delay.range, delay.value);
        let whole = Index::COUNTER;
        let index = match flat.variables[*var].len {
            Some(_) => whole,
            None => Index::SCALAR,
        };
        let lhs = flat.exprs.add(Ir::Var(*var, index));
        let origin = delay.origin.clone().made_by(MadeBy::Experiment);
        flat.variables[*var].kind = VariableKind::Continuous;
        delayed.retain(|_, known| known != var);
        flat.equations.push(Equation {
            range,
            lhs,
            rhs,
            origin,
        });
    }
    flat.delays.truncate(first);
    let by = parameters_of(flat, time);
    Some(Early { time, by_s, by })
}

/// What the readings of a channel are compared with, if they come later than declared: the value less what it changes
/// meanwhile; `slope` is its derivative by the time.
pub(super) fn moved(exprs: &mut ExprArena, value: ExprId, slope: ExprId, late: &Early) -> ExprId {
    let declared = exprs.constant(late.by_s);
    let later = exprs.minus(late.time, declared);
    let moved = exprs.times(later, slope);
    exprs.minus(value, moved)
}

/// The names of the parameters that a value is made of, and of those that these are made of.
fn parameters_of(flat: &FlatModel, value: ExprId) -> Vec<String> {
    let mut found: Vec<String> = Vec::new();
    let mut next = vec![value];
    while let Some(value) = next.pop() {
        for below in flat.exprs.below(&[value]) {
            let Ir::Param(parameter, _) = flat.exprs[below] else {
                continue;
            };
            let parameter = &flat.parameters[parameter];
            if !found.contains(&parameter.name) {
                found.push(parameter.name.clone());
                next.extend(&parameter.value);
            }
        }
    }
    found
}

/// The variables that a value reads, each once.
fn variables_read_by(flat: &FlatModel, value: ExprId) -> Vec<VarId> {
    let mut found = Vec::new();
    for below in flat.exprs.below(&[value]) {
        if let Ir::Var(var, _) = flat.exprs[below]
            && !found.contains(&var)
        {
            found.push(var);
        }
    }
    found
}
