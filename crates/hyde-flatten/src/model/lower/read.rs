//! References: the value of what a name stands for.

use super::resolved::Resolved;
use crate::dimension::Dim;
use crate::instance::{Counter, InstanceId, Member, Scope, Setting, Typed};
use crate::model::Model;
use crate::refusals::values as refused;
use crate::zero::Zero;
use hyde_diag::Span;
use hyde_ir::{Expr as Ir, Id as _, Index, VarId, VariableKind};
use hyde_syntax::ast::{ClassKind, Reference};

impl<'a> Model<'a, '_> {
    pub(super) fn reference(&mut self, reference: &'a Reference, scope: &Scope<'a>) -> Typed {
        let span = reference.span;
        let Some(resolved) = self.resolve(reference, scope) else {
            return self.poison(span);
        };
        match resolved {
            Resolved::Variable(var, index) => self.read(var, index, scope, span),
            Resolved::Parameter(param, index) => {
                let len = self.flat.parameters[param].len;
                let Some(index) = self.whole(index, len, scope, span) else {
                    return self.poison(span);
                };
                let notes = &self.parameters[param.index()];
                let (dim, truth) = (notes.dim.clone(), notes.boolean);
                let id = self.flat.exprs.add(Ir::Param(param, index));
                Typed {
                    truth,
                    zero: Zero::of_name(&self.flat, &self.variables, id),
                    ..self.typed(id, dim, span)
                }
            }
            Resolved::Counter(Counter::Symbolic) => {
                let id = self.flat.exprs.add(Ir::Counter);
                self.typed(id, Dim::NUMBER, span)
            }
            Resolved::Counter(Counter::Fixed(value)) => {
                let id = self.flat.exprs.constant(f64::from(value));
                Typed {
                    bare: true,
                    ..self.typed(id, Dim::NUMBER, span)
                }
            }
            Resolved::Time => {
                if scope.setting == Setting::Parameter {
                    self.not_constant("time", span);
                }
                let id = self.flat.exprs.add(Ir::Time);
                self.typed(id, Dim::known(hyde_units::Dimension::TIME), span)
            }
            Resolved::Pi => {
                let id = self.flat.exprs.constant(std::f64::consts::PI);
                Typed {
                    bare: true,
                    ..self.typed(id, Dim::neutral_number(), span)
                }
            }
            Resolved::Value(value) => Typed { span, ..value },
            Resolved::Coordinate => self.coordinate_value(scope, span),
            Resolved::Instance(instance) => {
                self.not_a_value(instance, reference, span);
                self.poison(span)
            }
        }
    }

    /// A component or a connector stands where a value is needed.
    fn not_a_value(&mut self, instance: InstanceId, reference: &Reference, span: Span) {
        let part = &self.tree[instance];
        let name = &part.class.name.text;
        let path = reference.dotted();
        let connector = part.class.kind == ClassKind::Connector;
        let mut members = part.members.iter();
        let variable = members.find(|(_, member)| matches!(member, Member::Variable(_)));
        let variable = variable.map(|(variable, _)| *variable);
        let class = (name.as_str(), connector);
        let diagnostic = refused::part_as_value(&path, span, class, variable);
        self.report(diagnostic);
    }

    /// A variable's value, with the borders of clocked parts checked.
    pub(crate) fn read(
        &mut self,
        var: VarId,
        index: Option<Index>,
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        if scope.setting == Setting::Parameter {
            let name = self.name_of(var, index);
            self.not_constant(&format!("`{name}`"), span);
            return self.poison(span);
        }
        if scope.setting == Setting::Measure {
            let name = self.name_of(var, index);
            self.report(refused::signal_for_number(&name, span));
            return self.poison(span);
        }
        if let (Some(field), None) = (self.notes(var).field, index) {
            return self.field_value(var, field, scope, span);
        }
        let len = self.flat.variables[var].len;
        let Some(index) = self.whole(index, len, scope, span) else {
            return self.poison(span);
        };
        self.check_border((var, index), scope, span);
        let id = self.flat.exprs.add(Ir::Var(var, index));
        let truth = self.flat.variables[var].boolean;
        Typed {
            truth,
            zero: Zero::of_name(&self.flat, &self.variables, id),
            ..self.typed(id, self.dim(var), span)
        }
    }

    /// The name of a variable, or of the element of it that is meant.
    fn name_of(&self, var: VarId, index: Option<Index>) -> String {
        let variable = &self.flat.variables[var];
        let element = index.filter(|index| index.stride == 0);
        let element = element.and_then(|index| usize::try_from(index.offset).ok());
        match element {
            Some(element) => variable.element_name(element),
            None => variable.name.clone(),
        }
    }

    fn check_border(&mut self, (var, index): (VarId, Index), scope: &Scope<'a>, span: Span) {
        if self.misplaced.contains(&var) {
            return;
        }
        let name = self.name_of(var, Some(index));
        match (self.flat.variables[var].kind, scope.setting) {
            (
                VariableKind::Clocked(_),
                Setting::Equation | Setting::Condition | Setting::Action,
            ) => self.report(refused::clocked_in_continuous(&name, span)),
            (
                VariableKind::Continuous
                | VariableKind::Discrete
                | VariableKind::Held(..)
                | VariableKind::Column(..)
                | VariableKind::Delayed(_),
                Setting::Clocked,
            ) => self.report(refused::continuous_in_clocked(&name, span)),
            _ => {}
        }
    }
}
