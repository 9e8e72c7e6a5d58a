//! The names in modes, equations and expressions.

use super::{Frame, Walk};
use crate::scope::{Definition, Inside, Thing, mode_of};
use hyde_syntax::ast::{
    Argument, Equation, EquationKind, Expr, ExprKind, Modes, Name, Range, Reference,
};

impl<'a> Walk<'a> {
    pub(super) fn modes(&mut self, modes: &'a Modes) {
        let file = self.file;
        if let Some(name) = &modes.name {
            self.declare(Definition {
                file,
                name,
                thing: Thing::Modes(modes),
            });
        }
        let mode = |name: &Name| mode_of(file, modes, &name.text);
        self.add(&modes.initial, mode(&modes.initial));
        self.arguments(&modes.arguments);
        for own in &modes.modes {
            if let Some(definition) = mode(&own.name) {
                self.declare(definition);
            }
            let parameters = own.parameters.iter();
            let parameters = parameters.map(|(type_name, name)| Definition {
                file,
                name,
                thing: Thing::ModeParameter(type_name),
            });
            let parameters: Vec<Definition<'a>> = parameters.collect();
            for (type_name, _) in &own.parameters {
                self.type_name(type_name);
            }
            parameters.iter().for_each(|own| self.declare(*own));
            self.within(Frame::Local(parameters), |walk| {
                for list in [&own.equations, &own.enter, &own.leave] {
                    list.iter().for_each(|equation| walk.equation(equation));
                }
                for exit in &own.exits {
                    walk.expression(&exit.guard);
                    walk.add(&exit.target, mode(&exit.target));
                    walk.arguments(&exit.arguments);
                    exit.actions.iter().for_each(|action| walk.equation(action));
                }
            });
        }
    }

    pub(super) fn equation(&mut self, equation: &'a Equation) {
        match &equation.kind {
            EquationKind::Equality { lhs, rhs, place } => {
                self.expression(lhs);
                self.expression(rhs);
                if let Some(place) = place {
                    self.word(&place.domain);
                    for (position, force) in &place.loads {
                        self.expression(position);
                        self.expression(force);
                    }
                }
            }
            EquationKind::Connect(ends) => ends.iter().for_each(|end| self.reference(end)),
            EquationKind::For {
                counter,
                first,
                last,
                equations,
            } => {
                self.expression(first);
                self.expression(last);
                self.counted(counter, |walk| {
                    equations.iter().for_each(|own| walk.equation(own));
                });
            }
            EquationKind::If {
                branches,
                otherwise,
            } => {
                self.branches(branches);
                otherwise.iter().for_each(|own| self.equation(own));
            }
            EquationKind::When(branches) => self.branches(branches),
            EquationKind::Assert(condition, _) => self.expression(condition),
            EquationKind::Reinit(target, value) => {
                self.reference(target);
                self.expression(value);
            }
        }
    }

    fn branches(&mut self, branches: &'a [(Expr, Vec<Equation>)]) {
        for (condition, equations) in branches {
            self.expression(condition);
            equations.iter().for_each(|own| self.equation(own));
        }
    }

    /// A counter, known in what `inner` walks.
    fn counted(&mut self, counter: &'a Name, inner: impl FnOnce(&mut Self)) {
        let definition = Definition {
            file: self.file,
            name: counter,
            thing: Thing::Counter,
        };
        self.declare(definition);
        self.within(Frame::Local(vec![definition]), inner);
    }

    pub(super) fn expressions(&mut self, list: &'a [Expr]) {
        list.iter().for_each(|expr| self.expression(expr));
    }

    pub(super) fn expression(&mut self, expr: &'a Expr) {
        match &expr.kind {
            ExprKind::Reference(name) => self.reference(name),
            ExprKind::Call(name, arguments) => self.call(name, arguments),
            ExprKind::Comprehension(list) => {
                self.expression(&list.first);
                self.expression(&list.last);
                self.counted(&list.counter, |walk| walk.expression(&list.value));
            }
            ExprKind::Number(..)
            | ExprKind::String(_)
            | ExprKind::Boolean(_)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::If(..)
            | ExprKind::Array(..)
            | ExprKind::Slice(..) => {
                for child in expr.children() {
                    self.expression(child);
                }
            }
        }
    }

    /// A function of a file; one of the language is declared nowhere.
    fn call(&mut self, name: &'a Reference, arguments: &'a [Argument]) {
        let function = self.files.class(self.file, name);
        if function.is_some() {
            self.class_name(name);
        }
        for argument in arguments {
            if let (Some(own), Some((file, class))) = (&argument.name, function) {
                let meaning = self.files.member(Inside::Class(file, class), &own.text);
                self.add(own, meaning);
            }
            self.expression(&argument.value);
        }
    }

    pub(super) fn arguments(&mut self, arguments: &'a [Argument]) {
        for argument in arguments {
            self.expression(&argument.value);
        }
    }

    pub(super) fn range(&mut self, range: &'a Range) {
        self.expression(&range.from);
        self.expression(&range.to);
    }
}
