//! A measured channel that shows what was: in the observed form its readings move, not the model.
//!
//! ```text
//! measured log.x = delay(axis.x, T)        log.x(t + T0) = axis.x - (T - T0)*der(axis.x)
//! ```
//! An observer has no past. It compares each reading with the model at the instant that the reading is of: T0 before its
//! own, T as it is declared. How readings change as a fit varies T is the first term of the Taylor series.

use crate::model::Model;
use hyde_diag::{MadeBy, Span};
use hyde_ir::flat::Equation;
use hyde_ir::{DelayId, Expr as Ir, ExprId, Id as _, Index, VarId, VariableKind};

/// What a channel shows as it is now, and how late it shows it, s.
pub(super) struct Late {
    pub(super) value: ExprId,
    pub(super) by_s: f64,
    /// The parameters that decide how late.
    pub(super) by: Vec<String>,
}

impl Model<'_, '_> {
    /// Takes the delay off a value that is made of variables with one delay; `first` is the first delay that was made for it.
    /// `None` of any other.
    pub(super) fn undelayed(&mut self, value: ExprId, first: usize, span: Span) -> Option<Late> {
        let read = self.variables_read_by(value);
        let number = |var: &VarId| {
            let VariableKind::Delayed(delay) = self.flat.variables[*var].kind else {
                return None;
            };
            Some(delay.index())
        };
        let numbers: Vec<usize> = read.iter().map(number).collect::<Option<_>>()?;
        let made = self.flat.delays.len().checked_sub(first)?;
        let known = DelayId::from_index(*numbers.first()?);
        let (time, by_s) = (self.flat.delays[known].time, self.flat.delays[known].time_s);
        let one = |number: &usize| self.flat.delays[DelayId::from_index(*number)].time == time;
        // All delays behind the first are this channel's: none stands within another, and nothing else reads them.
        if numbers.len() != made || !numbers.iter().all(|own| *own >= first && one(own)) {
            return None;
        }
        for (var, number) in read.iter().zip(&numbers) {
            let delay = &self.flat.delays[DelayId::from_index(*number)];
            let (range, rhs) = (delay.range, delay.value);
            let whole = Index::COUNTER;
            let index = match self.flat.variables[*var].len {
                Some(_) => whole,
                None => Index::SCALAR,
            };
            let lhs = self.flat.exprs.add(Ir::Var(*var, index));
            let origin = delay.origin.clone().made_by(MadeBy::Experiment);
            self.flat.variables[*var].kind = VariableKind::Continuous;
            self.delayed.retain(|_, known| known != var);
            self.flat.equations.push(Equation {
                range,
                lhs,
                rhs,
                origin,
            });
        }
        self.flat.delays.truncate(first);
        let by = self.parameters_of(time);
        if by.is_empty() {
            return Some(Late { value, by_s, by });
        }
        let slope = self.time_derivative(value, span);
        let exprs = &mut self.flat.exprs;
        let declared = exprs.constant(by_s);
        let later = exprs.minus(time, declared);
        let moved = exprs.times(later, slope);
        let value = exprs.minus(value, moved);
        Some(Late { value, by_s, by })
    }

    /// The names of the parameters that a value is made of, and of those that these are made of.
    fn parameters_of(&self, value: ExprId) -> Vec<String> {
        let mut found: Vec<String> = Vec::new();
        let mut next = vec![value];
        while let Some(value) = next.pop() {
            for below in self.flat.exprs.below(&[value]) {
                let Ir::Param(parameter, _) = self.flat.exprs[below] else {
                    continue;
                };
                let parameter = &self.flat.parameters[parameter];
                if !found.contains(&parameter.name) {
                    found.push(parameter.name.clone());
                    next.extend(&parameter.value);
                }
            }
        }
        found
    }

    /// The variables that a value reads, each once.
    fn variables_read_by(&self, value: ExprId) -> Vec<VarId> {
        let mut found = Vec::new();
        for below in self.flat.exprs.below(&[value]) {
            if let Ir::Var(var, _) = self.flat.exprs[below]
                && !found.contains(&var)
            {
                found.push(var);
            }
        }
        found
    }
}
