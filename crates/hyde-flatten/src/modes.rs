//! `modes` blocks: each becomes an automaton whose modes hold their equations and exits.

use crate::dimension::Dim;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::model::{Model, listed};
use crate::names::TypeName;
use hyde_diag::{Code, Diagnostic, MadeBy, Span};
use hyde_ir::flat::{Action, Automaton, Mode, Transition};
use hyde_ir::{Index, Range, VarId, VariableKind};
use hyde_syntax::ast::{self, Argument};

impl<'a> Model<'a, '_> {
    /// Lowers a `modes` block of an instance.
    pub(crate) fn modes(&mut self, modes: &'a ast::Modes, id: InstanceId) {
        if self.clock_of(id).is_some() {
            self.report(
                Diagnostic::error(Code::ClockBorder, "`modes` inside a clocked part")
                    .label(modes.span, "everything here happens at the tick")
                    .help("write `x = if … then … else pre(x);`"),
            );
            return;
        }
        let parameters: Vec<Vec<(&'a str, VarId)>> = modes
            .modes
            .iter()
            .map(|mode| self.mode_parameters(mode, modes.name.as_ref(), id))
            .collect();
        let mut list = Vec::new();
        for (from, (mode, own)) in modes.modes.iter().zip(&parameters).enumerate() {
            let scope = Scope {
                locals: own.clone(),
                ..Scope::new(id, Setting::Equation)
            };
            let equations: Vec<_> = mode
                .equations
                .iter()
                .flat_map(|e| self.equation(e, &scope))
                .collect();
            if let Some(array) = equations
                .iter()
                .find(|equation| equation.range != Range::SCALAR)
            {
                let span = array.origin.span;
                self.report(
                    Diagnostic::error(Code::ArrayEquation, "an array equation in a mode")
                        .label(span, "modes have scalar equations"),
                );
            }
            let exits = mode
                .exits
                .iter()
                .filter_map(|exit| self.exit(exit, from, modes, &parameters, &scope))
                .collect();
            let origin = self.tree.origin(id, mode.name.span);
            list.push(Mode {
                name: mode.name.text.clone(),
                equations,
                exits,
                origin,
            });
        }
        self.same_counts(modes, &list);
        let scope = Scope::new(id, Setting::Parameter);
        let Some(initial) = self.mode_named(modes, &modes.initial) else {
            return;
        };
        let initial_actions = self.mode_arguments(
            &modes.arguments,
            &parameters[initial],
            &modes.initial,
            &scope,
        );
        let origin = self.tree.origin(id, modes.span);
        let name = match &modes.name {
            Some(name) => self.tree[id].path.member(&name.text),
            None => self.tree[id].path.as_str().to_owned(),
        };
        self.flat.automata.push(Automaton {
            name,
            modes: list,
            initial,
            initial_actions,
            origin,
        });
    }

    /// The parameters of a mode are discrete variables that its entry sets.
    fn mode_parameters(
        &mut self,
        mode: &'a ast::Mode,
        block: Option<&ast::Name>,
        id: InstanceId,
    ) -> Vec<(&'a str, VarId)> {
        let file = self.tree[id].file;
        let mut found = Vec::new();
        for (type_name, name) in &mode.parameters {
            let (dim, boolean) = match self.names.quantity(file, type_name) {
                Some(TypeName::Boolean) => (Dim::NUMBER, true),
                Some(TypeName::Integer) => (Dim::NUMBER, false),
                Some(TypeName::Real) => (Dim::unknown(self.dimensions.fresh()), false),
                Some(TypeName::Quantity(file, item)) => {
                    let unit = self.type_unit(file, item);
                    (
                        unit.map_or(Dim::NUMBER, |unit| Dim::known(unit.unit().dimension)),
                        false,
                    )
                }
                None => {
                    let diagnostic = self.names.unknown(file, type_name);
                    self.report(diagnostic);
                    continue;
                }
            };
            let block = block.map_or(String::new(), |block| format!("{}.", block.text));
            let full = self.tree[id]
                .path
                .member(&format!("{block}{}.{}", mode.name.text, name.text));
            let var = self.add_variable(
                id,
                full,
                VariableKind::Discrete,
                dim,
                name.span,
                MadeBy::Source,
            );
            self.flat.variables[var].boolean = boolean;
            found.push((name.text.as_str(), var));
        }
        found
    }

    /// An exit of the mode of that number. It sets what leaving that mode does, the parameters of the mode entered, what it
    /// says itself, and what entering the other mode does, in this order.
    fn exit(
        &mut self,
        exit: &'a ast::Exit,
        from: usize,
        modes: &'a ast::Modes,
        parameters: &[Vec<(&'a str, VarId)>],
        scope: &Scope<'a>,
    ) -> Option<Transition> {
        let guard = self.truth(&exit.guard, &scope.with(Setting::Condition));
        let target = self.mode_named(modes, &exit.target)?;
        let at_event = scope.with(Setting::Action);
        let from = &modes.modes[from];
        let mut actions = self.actions(&from.leave, scope);
        actions.extend(self.mode_arguments(
            &exit.arguments,
            &parameters[target],
            &exit.target,
            &at_event,
        ));
        actions.extend(self.actions(&exit.actions, scope));
        let inside = Scope {
            locals: parameters[target].clone(),
            ..scope.clone()
        };
        actions.extend(self.actions(&modes.modes[target].enter, &inside));
        let reinits = actions
            .iter()
            .any(|action| matches!(action, Action::Reinit(..)));
        let origin = self.tree.origin(scope.instance, exit.span);
        Some(Transition {
            guard,
            target,
            actions,
            impact: exit.impact || reinits,
            origin,
        })
    }

    fn actions(&mut self, actions: &'a [ast::Equation], scope: &Scope<'a>) -> Vec<Action> {
        let lowered = actions
            .iter()
            .filter_map(|action| self.action(action, scope));
        lowered.collect()
    }

    /// The values an entry gives to a mode's parameters.
    fn mode_arguments(
        &mut self,
        arguments: &'a [Argument],
        parameters: &[(&'a str, VarId)],
        target: &ast::Name,
        scope: &Scope<'a>,
    ) -> Vec<Action> {
        if arguments.len() != parameters.len() {
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    format!(
                        "the mode `{}` takes {} values, not {}",
                        target.text,
                        parameters.len(),
                        arguments.len()
                    ),
                )
                .label(target.span, "entered here"),
            );
            return Vec::new();
        }
        let mut actions = Vec::new();
        for (argument, (name, var)) in arguments.iter().zip(parameters) {
            let value = self.lower(&argument.value, scope);
            let var = match &argument.name {
                None => *var,
                Some(named) => match parameters.iter().find(|(known, _)| *known == named.text) {
                    Some((_, var)) => *var,
                    None => {
                        let message = format!("the mode `{}` has no `{}`", target.text, named.text);
                        self.report(
                            Diagnostic::error(Code::BadArguments, message)
                                .label(named.span, "unknown")
                                .help(format!("it has `{name}`")),
                        );
                        continue;
                    }
                },
            };
            let lhs = self.flat.exprs.var(var);
            let declared = Typed {
                truth: value.truth,
                ..self.typed(lhs, self.dim(var), argument.value.span)
            };
            self.agree(
                &declared,
                &value,
                "the mode's parameter and its value are",
                scope.instance,
            );
            actions.push(Action::Assign(var, Index::SCALAR, value.id));
        }
        actions
    }

    fn mode_named(&mut self, modes: &'a ast::Modes, name: &ast::Name) -> Option<usize> {
        let found = modes
            .modes
            .iter()
            .position(|mode| mode.name.text == name.text);
        if found.is_none() {
            let known: Vec<&str> = modes
                .modes
                .iter()
                .map(|mode| mode.name.text.as_str())
                .collect();
            self.report(
                Diagnostic::error(
                    Code::UnknownName,
                    format!("there is no mode `{}` here", name.text),
                )
                .label(name.span, "not known")
                .help(format!("the modes are {}", listed(&known))),
            );
        }
        found
    }

    /// Every mode has the same number of equations (M1).
    fn same_counts(&mut self, modes: &'a ast::Modes, list: &[Mode]) {
        let Some(first) = list.first() else { return };
        let differing = list
            .iter()
            .zip(&modes.modes)
            .find(|(mode, _)| mode.equations.len() != first.equations.len());
        if let Some((mode, written)) = differing {
            let count = |n: usize| {
                if n == 1 {
                    "1 equation".to_owned()
                } else {
                    format!("{n} equations")
                }
            };
            let first_span: Span = modes.modes[0].name.span;
            self.report(
                Diagnostic::error(
                    Code::ModeEquations,
                    "the modes have different numbers of equations",
                )
                .label(
                    written.name.span,
                    format!("{} here", count(mode.equations.len())),
                )
                .label(first_span, format!("{} here", count(first.equations.len())))
                .note("the modes replace each other's equations: each must determine the same unknowns")
                .help("write an equation for the same variables in every mode: for a force that vanishes, `F = 0`"),
            );
        }
    }
}
