//! Values that decide the structure: numbers of cells, dimensions of arrays, subscripts, positions on a mesh.
//!
//! The parameters such a value uses become structural: a change of one of them compiles anew. Every other parameter
//! stays plain.

use crate::instance::{InstanceId, Lowering, Scope, Setting, Typed};
use crate::model::Model;
use crate::model::call::delay::moves_with_counter;
use crate::refusals::values as refused;
use hyde_ir::{Expr as Ir, ExprId, Id as _, ParamId};
use hyde_syntax::ast::Expr;

impl<'a> Model<'a, '_> {
    /// The whole number an expression of parameters has.
    pub(crate) fn structural_integer(
        &mut self,
        instance: InstanceId,
        expr: &'a Expr,
    ) -> Option<i64> {
        self.structural_integer_in(&Scope::new(instance, Setting::Parameter), expr)
    }

    /// The same in a given scope.
    pub(crate) fn structural_integer_in(
        &mut self,
        scope: &Scope<'a>,
        expr: &'a Expr,
    ) -> Option<i64> {
        let value = self.structural_number(scope, expr)?;
        if value.fract() != 0.0 || value.abs() > 1e15 {
            self.report(refused::not_an_integer(value, expr.span));
            return None;
        }
        Some(value as i64)
    }

    /// The number an expression of parameters has, SI.
    pub(crate) fn structural_number(&mut self, scope: &Scope<'a>, expr: &'a Expr) -> Option<f64> {
        let errors = self.diagnostics.error_count();
        let typed = self.lower(expr, &scope.with(Setting::Parameter));
        if self.diagnostics.error_count() > errors {
            return None;
        }
        self.constant_of(&typed)
    }

    /// The number that a lowered expression is; one that is not constant is reported.
    pub(crate) fn constant_of(&mut self, typed: &Typed) -> Option<f64> {
        if self.differs_along(typed.id) {
            return None;
        }
        let errors = self.diagnostics.error_count();
        let value = self.evaluate(typed.id);
        if value.is_none() && self.diagnostics.error_count() == errors {
            self.report(refused::expression_not_constant(typed.span));
        }
        value
    }

    /// Whether each of the elements that are lowered together has a value of its own: they are unrolled then.
    pub(crate) fn differs_along(&mut self, id: ExprId) -> bool {
        self.flat.exprs.any(id, moves_with_counter) && self.unroll()
    }

    /// The value of a lowered expression of parameters, which become structural.
    pub(crate) fn evaluate(&mut self, id: ExprId) -> Option<f64> {
        self.value_of(id, true)
    }

    /// The value that a lowered expression of parameters has now; they stay as they are.
    pub(crate) fn current_value(&mut self, id: ExprId) -> Option<f64> {
        self.value_of(id, false)
    }

    fn value_of(&mut self, id: ExprId, structural: bool) -> Option<f64> {
        let leaves: Vec<Ir> = self
            .flat
            .exprs
            .below(&[id])
            .into_iter()
            .map(|id| self.flat.exprs[id])
            .collect();
        if leaves.iter().any(|&leaf| moves_with_counter(leaf)) {
            return None;
        }
        let mut values = Vec::new();
        for leaf in leaves {
            if let Ir::Param(param, index) = leaf {
                let element = usize::try_from(index.offset).unwrap_or(0);
                values.push((leaf, self.parameter_value(param, element, structural)?));
            }
        }
        let leaf = |expr: Ir| {
            values
                .iter()
                .find(|(known, _)| *known == expr)
                .map(|(_, value)| *value)
                .ok_or(())
        };
        self.flat.exprs.evaluate(id, leaf).ok()
    }

    fn parameter_value(&mut self, param: ParamId, element: usize, structural: bool) -> Option<f64> {
        if !structural && let Some(&known) = self.current_values.get(&(param, element)) {
            return Some(known);
        }
        let value = self.value_of_parameter(param, element, structural)?;
        self.current_values.insert((param, element), value);
        Some(value)
    }

    fn value_of_parameter(
        &mut self,
        param: ParamId,
        element: usize,
        structural: bool,
    ) -> Option<f64> {
        let parameter = &mut self.flat.parameters[param];
        if structural && parameter.found {
            let (name, span) = (parameter.name.clone(), parameter.origin.span);
            self.report(refused::found_at_start(&name, span));
            return None;
        }
        parameter.structural |= structural;
        if self.parameters[param.index()].state != Lowering::Done {
            self.lower_parameter(param);
        }
        let settings = self.input.settings;
        if let Some(value) = self.flat.parameters[param].setting(element, settings) {
            if structural {
                // What else uses the parameter sees the value that is set as well.
                let exprs = &mut self.flat.exprs;
                let constant = exprs.constant(value);
                self.flat.parameters[param].set(element, constant, exprs);
            }
            return Some(value);
        }
        let parameter = &self.flat.parameters[param];
        let value = match (parameter.value.as_slice(), i32::try_from(element)) {
            ([all], Ok(counter)) if parameter.len.is_some() => {
                let all = *all;
                self.flat.exprs.at_counter(all, counter)
            }
            (each, _) => *each.get(element)?,
        };
        self.value_of(value, structural)
    }
}
