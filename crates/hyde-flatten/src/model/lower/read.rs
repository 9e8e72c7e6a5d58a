//! References: the value of what a name stands for.

use super::resolve::Resolved;
use crate::dimension::Dim;
use crate::instance::{Counter, InstanceId, Member, Scope, Setting, Typed};
use crate::model::Model;
use crate::zero::Zero;
use hyde_diag::{Code, Diagnostic, Span};
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
        let (what, connect) = match connector {
            true => (
                "connector",
                format!("connect it, `connect({path}, …);`, or "),
            ),
            false => ("component", String::new()),
        };
        let diagnostic = Diagnostic::error(
            Code::WrongType,
            format!("`{path}` is a {what} ({name}), not a value"),
        )
        .label(span, format!("a {what}"));
        let variable = variable.map(|(variable, _)| format!("{path}.{variable}"));
        self.report(match variable {
            Some(variable) => {
                diagnostic.help(format!("{connect}name one of its variables: `{variable}`"))
            }
            None => diagnostic.help(format!("{connect}name a variable of one of its parts")),
        });
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
            let name = self.flat.variables[var].name.clone();
            self.not_constant(&format!("`{name}`"), span);
            return self.poison(span);
        }
        if scope.setting == Setting::Measure {
            let name = self.flat.variables[var].name.clone();
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    format!("`{name}` changes during the run, but one number is needed"),
                )
                .label(span, "expected one number, found a signal")
                .help(format!(
                    "reduce it to one number: `last({name})`, `max({name})`, `rms({name})`, …"
                )),
            );
            return self.poison(span);
        }
        if let (Some(field), None) = (self.notes(var).field, index) {
            return self.field_value(var, field, scope, span);
        }
        let len = self.flat.variables[var].len;
        let Some(index) = self.whole(index, len, scope, span) else {
            return self.poison(span);
        };
        self.check_border(var, scope, span);
        let id = self.flat.exprs.add(Ir::Var(var, index));
        let truth = self.flat.variables[var].boolean;
        Typed {
            truth,
            zero: Zero::of_name(&self.flat, &self.variables, id),
            ..self.typed(id, self.dim(var), span)
        }
    }

    fn check_border(&mut self, var: VarId, scope: &Scope<'a>, span: Span) {
        let name = self.flat.variables[var].name.clone();
        match (self.flat.variables[var].kind, scope.setting) {
            (
                VariableKind::Clocked(_),
                Setting::Equation | Setting::Condition | Setting::Action,
            ) => self.report(
                Diagnostic::error(
                    Code::ClockBorder,
                    format!("`{name}` belongs to a clocked part"),
                )
                .label(span, "read by a continuous equation")
                .help(format!("hold it between ticks: `hold({name})`")),
            ),
            (
                VariableKind::Continuous
                | VariableKind::Discrete
                | VariableKind::Held(..)
                | VariableKind::Column(..)
                | VariableKind::Delayed(_),
                Setting::Clocked,
            ) => self.report(
                Diagnostic::error(Code::ClockBorder, format!("`{name}` is continuous"))
                    .label(span, "read in a clocked part")
                    .help(format!("read it at the tick: `sample({name})`")),
            ),
            _ => {}
        }
    }
}
