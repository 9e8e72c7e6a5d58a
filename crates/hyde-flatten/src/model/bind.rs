//! Bindings: values of parameters, start values, `Real x = e`, and the times of clocked parts.

mod elements;

use crate::allowed::check_whole;
use crate::equation::make_traces_of_equations;
use crate::event_clock::{event_clock, is_event_clock};
use crate::instantiate::literal_unit;
use crate::words::short;
use crate::wrap::wrapped;
use crate::zero;
use elements::Elements;

use crate::dimension::Dim;
use crate::instance::{
    Binding, InstanceId, Lowering, Member, ParameterNotes, Scope, Setting, Typed,
};
use crate::model::Model;
use crate::refusals::values as refused;
use hyde_diag::{Diagnostic, MadeBy, Span};
use hyde_ir::flat::{ClockedEquation, Equation};
use hyde_ir::{Expr as Ir, ExprId, Id as _, Index, ParamId, Parameter, Range, VarId, VariableKind};
use hyde_syntax::ast::Element;
use hyde_units::{Allowed, Dimension, Kind};

impl<'a> Model<'a, '_> {
    /// Lowers every binding: parameters, clocks, start values, then the equations of bound variables.
    pub(crate) fn lower_bindings(&mut self) {
        for param in self.flat.parameters.ids() {
            self.lower_parameter(param);
        }
        for instance in self.tree.ids() {
            self.lower_clocks(instance);
        }
        for var in self.flat.variables.ids() {
            self.lower_start(var);
        }
        make_traces_of_equations(self);
        for var in self.flat.variables.ids().collect::<Vec<_>>() {
            self.lower_binding(var);
        }
    }

    /// Lowers the value of a parameter, once.
    pub(crate) fn lower_parameter(&mut self, param: ParamId) {
        let notes = &self.parameters[param.index()];
        let (state, binding) = (notes.state, notes.binding.clone());
        let name = self.flat.parameters[param].name.clone();
        let span = self.flat.parameters[param].origin.span;
        match state {
            Lowering::Done => return,
            Lowering::InProgress => {
                self.report(refused::uses_itself(&name, span));
                self.parameters[param.index()].state = Lowering::Done;
                return;
            }
            Lowering::Waiting => self.parameters[param.index()].state = Lowering::InProgress,
        }
        let Some(binding) = binding else {
            let diagnostic = self.no_value(&name, param);
            self.report(diagnostic);
            let zero = self.flat.exprs.constant(0.0);
            self.flat.parameters[param].value = vec![zero];
            self.parameters[param.index()].state = Lowering::Done;
            return;
        };
        let (dim, truth) = (
            self.parameters[param.index()].dim.clone(),
            self.parameters[param.index()].boolean,
        );
        let len = self.flat.parameters[param].len;
        let values = self.values(&binding, len, &dim, truth);
        self.flat.parameters[param].value = values;
        self.parameters[param.index()].state = Lowering::Done;
        let instance = self.parameters[param.index()].of;
        if let Some(range) = self.parameters[param.index()].within {
            self.flat.parameters[param].range = self.range_of(instance, range, &dim);
        }
        if let Some(prior) = self.parameters[param.index()].prior
            && !prior.percent
        {
            // An uncertainty without a unit would be one in SI units.
            let written = self.number(prior.value, prior.unit.as_ref(), prior.span);
            let declared = self.typed(written.id, dim, prior.span);
            let what = "the parameter and its uncertainty are";
            self.agree(&declared, &written, what, instance);
        }
    }

    /// The bounds that a parameter may have, SI; the unit behind the upper one is that of both (U2).
    fn range_of(
        &mut self,
        instance: InstanceId,
        range: &'a hyde_syntax::ast::Range,
        dim: &Dim,
    ) -> Option<(f64, f64)> {
        let scope = Scope::new(instance, Setting::Parameter);
        let (mut from, to) = (
            self.value(&range.from, &scope),
            self.value(&range.to, &scope),
        );
        let mut bounds = vec![to.clone()];
        if let (true, Some(unit)) = (from.bare, literal_unit(&range.to))
            && let (Ok(unit), Some(number)) = (
                hyde_units::NamedUnit::parse(&unit.text),
                self.flat.exprs.as_constant(from.id),
            )
        {
            from.id = self.flat.exprs.constant(unit.unit().to_si(number));
        } else {
            bounds.push(from.clone());
        }
        for bound in &bounds {
            let declared = self.typed(bound.id, dim.clone(), bound.span);
            self.agree(
                &declared,
                bound,
                "the parameter and its range are",
                instance,
            );
        }
        // A range is made of numbers: it makes no parameter structural.
        let number = |id| {
            let leaf = |_| Err(());
            self.flat.exprs.evaluate(id, leaf).ok()
        };
        Some((number(from.id)?, number(to.id)?))
    }

    fn no_value(&self, name: &str, param: ParamId) -> Diagnostic {
        let parameter = &self.flat.parameters[param];
        let unit = match &self.parameters[param.index()].dim.as_known() {
            Some(dimension) if !dimension.is_dimensionless() => {
                format!(" [{}]", parameter.quantity.unit.text())
            }
            _ => String::new(),
        };
        let (instance, declared) = (
            &self.tree[self.parameters[param.index()].of],
            &parameter.origin,
        );
        if instance.parent.is_none() {
            return refused::no_value_at_top(name, declared.span, &unit);
        }
        let part = (
            instance.span,
            instance.class.name.text.as_str(),
            short(declared.instance.as_str()),
        );
        refused::no_value_given(name, declared.span, &unit, part)
    }

    /// The values of a binding of parameters: one an element, or one for all elements.
    fn values(
        &mut self,
        binding: &Binding<'a>,
        len: Option<usize>,
        dim: &Dim,
        truth: bool,
    ) -> Vec<ExprId> {
        let items = match self.elements(binding, len, Setting::Parameter) {
            Elements::All(value) => vec![value],
            Elements::Each(values) => values,
        };
        for item in &items {
            if item.truth != truth && item.dim != Dim::Any {
                self.report(refused::wrong_kind(truth, (item.span, item.truth)));
            } else if !truth {
                let declared = Typed {
                    span: binding.span,
                    ..self.typed(item.id, dim.clone(), binding.span)
                };
                self.agree(
                    &declared,
                    item,
                    "the declared type and the value are",
                    binding.scope,
                );
            }
        }
        items.into_iter().map(|item| item.id).collect()
    }

    fn lower_clocks(&mut self, instance: InstanceId) {
        for (_, element) in self.tree[instance].elements.clone() {
            let Element::Clocked(clocked) = element else {
                continue;
            };
            let Some(Member::Instance(part)) =
                self.tree[instance].members.get(clocked.name.text.as_str())
            else {
                continue;
            };
            let part = *part;
            let Some(clock) = self.clock_of(part) else {
                continue;
            };
            if is_event_clock(clocked) {
                event_clock(self, clocked, (clock, part), instance);
                continue;
            }
            let scope = Scope::new(instance, Setting::Parameter);
            let mut period = None;
            for argument in &clocked.arguments {
                let value = self.value(&argument.value, &scope);
                let time = Typed {
                    dim: Dim::known(Dimension::TIME),
                    ..value.clone()
                };
                self.agree(&time, &value, "a clock is set in time, found", instance);
                match argument.name.as_ref().map(|name| name.text.as_str()) {
                    None => {
                        period = Some(value.id);
                        self.check_period(&value);
                    }
                    Some("delay") => {
                        self.flat.clocks[clock].delay = value.id;
                        self.check_delay(&value);
                    }
                    Some("phase") => self.flat.clocks[clock].phase = value.id,
                    Some(other) => {
                        self.report(refused::unknown_part_of_clock(other, argument.value.span))
                    }
                }
            }
            match period {
                Some(period) => self.flat.clocks[clock].period = period,
                None => self.report(refused::no_period(&clocked.name)),
            }
        }
    }

    /// A clock ticks after a time that goes on.
    fn check_period(&mut self, period: &Typed) {
        if let Some(value) = self.current_value(period.id)
            && value <= 0.0
        {
            let shown = hyde_units::engineering(value, Dimension::TIME);
            self.report(refused::bad_period(&shown, period.span));
        }
    }

    /// A clock gives out what it computed at a tick not before that tick.
    fn check_delay(&mut self, delay: &Typed) {
        if let Some(value) = self.current_value(delay.id)
            && value < 0.0
        {
            let shown = hyde_units::engineering(value, Dimension::TIME);
            self.report(refused::bad_delay(&shown, delay.span));
        }
    }

    fn lower_start(&mut self, var: VarId) {
        let Some(start) = self.notes(var).start.clone() else {
            self.free_start(var, self.flat.variables[var].origin.span);
            return;
        };
        let (dim, truth) = (self.dim(var), self.flat.variables[var].boolean);
        let len = self.flat.variables[var].len;
        if let Some(field) = self.notes(var).field {
            let index = Index::COUNTER;
            let place = if field.flux {
                crate::instance::FieldPlace::Cell(field.domain, index)
            } else {
                crate::instance::FieldPlace::Node(field.domain, index)
            };
            let (expr, unit, scope) = self.picked(&start, Setting::Parameter);
            let value = self.value(expr, &scope.at(place));
            let value = self.in_unit(value, unit);
            let declared = self.typed(value.id, dim, start.span);
            self.agree(
                &declared,
                &value,
                "the field and its start value are",
                start.scope,
            );
            self.flat.variables[var].start = vec![value.id];
            return;
        }
        self.flat.variables[var].start = self.values(&start, len, &dim, truth);
        self.free_start(var, start.span);
        self.fix_elements(var, start.span);
    }

    /// Where some elements are fixed and others are not, each that is has an initial equation.
    fn fix_elements(&mut self, var: VarId, span: Span) {
        let notes = self.notes(var);
        let (instance, fixed) = (notes.instance, notes.fixed_elements.clone());
        for (at, _) in (0_i32..).zip(fixed).filter(|(_, fixed)| *fixed) {
            let starts = &self.flat.variables[var].start;
            let own = usize::try_from(at).ok().filter(|_| starts.len() > 1);
            let Some(&start) = starts.get(own.unwrap_or(0)) else {
                continue;
            };
            let equation = Equation {
                range: Range::SCALAR,
                lhs: self.flat.exprs.add(Ir::Var(var, Index::fixed(at))),
                rhs: self.flat.exprs.at_counter(start, at),
                origin: self.tree.origin(instance, span),
            };
            self.flat.initial_equations.push(equation);
        }
    }

    /// A start value that is set from outside, as `NAME.start` or `NAME[2].start`, is a parameter of that name.
    fn free_start(&mut self, var: VarId, span: Span) {
        let variable = &self.flat.variables[var];
        if variable.boolean {
            return;
        }
        let Some(len) = variable.len else {
            let name = format!("{}.start", variable.name);
            let given = variable.start.first().copied();
            if let Some(free) = self.start_parameter(var, name, given, span) {
                self.flat.variables[var].start = vec![free];
            }
            return;
        };
        let first = format!("{}[", variable.name);
        let mut set = self.input.settings.range(first.clone()..);
        if !set.next().is_some_and(|(name, _)| name.starts_with(&first)) {
            return;
        }
        let starts = variable.start.clone();
        let nothing = self.flat.exprs.constant(0.0);
        let elements = (0_i32..).zip(0..len);
        let each = elements.map(|(counter, element)| match starts.as_slice() {
            [] => nothing,
            [all] => self.flat.exprs.at_counter(*all, counter),
            each => each.get(element).copied().unwrap_or(nothing),
        });
        let mut each: Vec<ExprId> = each.collect();
        for (element, start) in each.iter_mut().enumerate() {
            let name = format!("{}.start", self.flat.variables[var].element_name(element));
            if let Some(free) = self.start_parameter(var, name, Some(*start), span) {
                *start = free;
            }
        }
        self.flat.variables[var].start = each;
    }

    /// The parameter for a start value of a name, if that is set from outside; `given` is what the model says.
    fn start_parameter(
        &mut self,
        var: VarId,
        name: String,
        given: Option<ExprId>,
        span: Span,
    ) -> Option<ExprId> {
        if !self.input.settings.contains_key(&name) {
            return None;
        }
        let notes = self.notes(var);
        let (instance, dim) = (notes.instance, notes.dim.clone());
        let kind = if notes.integer {
            Kind::Integer
        } else {
            Kind::Real
        };
        let allowed = Allowed {
            kind,
            ..Allowed::default()
        };
        let quantity = self.flat.variables[var].quantity.clone();
        let value = given.unwrap_or_else(|| self.flat.exprs.constant(0.0));
        self.parameters.push(ParameterNotes::made(dim));
        let origin = self.tree.origin(instance, span);
        let param = self.flat.parameters.push(Parameter {
            allowed,
            ..Parameter::new(name, value, quantity, origin)
        });
        Some(self.flat.exprs.add(Ir::Param(param, Index::SCALAR)))
    }

    /// `Real x = e` as an equation of x.
    fn lower_binding(&mut self, var: VarId) {
        let notes = self.notes(var);
        let (binding, field) = (notes.binding.clone(), notes.field);
        let Some(binding) = binding else { return };
        let kind = self.flat.variables[var].kind;
        let setting = match kind {
            VariableKind::Clocked(_) => Setting::Clocked,
            VariableKind::Continuous
            | VariableKind::Discrete
            | VariableKind::Held(..)
            | VariableKind::Column(..)
            | VariableKind::Delayed(_)
            | VariableKind::Reduction(_) => Setting::Equation,
        };
        if let Some(field) = field {
            let (expr, _, scope) = self.picked(&binding, setting);
            self.field_binding(var, field, expr, &scope, binding.span);
            return;
        }
        let len = self.flat.variables[var].len;
        let origin = self
            .tree
            .origin(self.notes(var).instance, binding.span)
            .made_by(MadeBy::Binding);
        let list: Vec<(Range, Index, Typed)> = match (self.elements(&binding, len, setting), len) {
            (Elements::Each(values), _) => (0..)
                .zip(values)
                .map(|(element, value)| (Range::SCALAR, Index::fixed(element), value))
                .collect(),
            (Elements::All(value), Some(len)) => {
                let range = Range {
                    first: 0,
                    last: i32::try_from(len).unwrap_or(i32::MAX) - 1,
                };
                let index = Index::COUNTER;
                vec![(range, index, value)]
            }
            (Elements::All(value), None) => {
                let value = wrapped(self, var, value, setting);
                vec![(Range::SCALAR, Index::SCALAR, value)]
            }
        };
        for (range, index, value) in list {
            let lhs = self.flat.exprs.add(Ir::Var(var, index));
            let declared = Typed {
                truth: self.flat.variables[var].boolean,
                ..self.typed(lhs, self.dim(var), binding.span)
            };
            self.same_kind(&declared, &value);
            check_whole(self, &declared, &value);
            zero::show_difference(&mut self.flat, &mut self.variables, (&declared, &value));
            self.agree(
                &declared,
                &value,
                "the declared type and the value are",
                binding.scope,
            );
            let equation = Equation {
                range,
                lhs,
                rhs: value.id,
                origin: origin.clone(),
            };
            match kind {
                VariableKind::Clocked(clock) => self
                    .flat
                    .clocked_equations
                    .push(ClockedEquation { clock, equation }),
                VariableKind::Continuous
                | VariableKind::Discrete
                | VariableKind::Held(..)
                | VariableKind::Column(..)
                | VariableKind::Delayed(_)
                | VariableKind::Reduction(_) => self.flat.equations.push(equation),
            }
        }
    }
}
