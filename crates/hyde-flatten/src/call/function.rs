//! Functions that a file declares: `function drag … input Velocity v; output Force F = c*v^2; end drag;`
//!
//! A call is replaced by the function's expressions, its arguments for its inputs, so that derivatives, units and events
//! are those of the expression. A function sees its inputs and its own variables, nothing of the model.

use crate::instance::{Scope, Typed};
use crate::model::Model;
use crate::names::FileIndex;
use hyde_diag::{Code, Diagnostic, Span};
use hyde_syntax::ast::{
    Argument, Class, ClassBody, ClassKind, Declaration, Declarator, Element, Prefix, Reference,
};

/// Calls within calls; more is a function that calls itself.
const MAX_DEPTH: usize = 30;

impl<'a> Model<'a, '_> {
    /// The function of that name, seen from where the name is written.
    pub(super) fn function_named(&self, name: &Reference) -> Option<(FileIndex, &'a Class)> {
        let file = self.names.file_of(name.span)?;
        let found = self.names.class(file, name);
        found.filter(|(_, class)| class.kind == ClassKind::Function)
    }

    /// The value of a call.
    pub(super) fn function(
        &mut self,
        (file, class): (FileIndex, &'a Class),
        arguments: &'a [Argument],
        scope: &Scope<'a>,
        span: Span,
    ) -> Typed {
        self.calls += 1;
        let value = if self.calls > MAX_DEPTH {
            self.report(
                Diagnostic::error(Code::Cycle, format!("`{}` calls itself", class.name.text))
                    .label(class.name.span, "called inside itself without end")
                    .help("a function is an expression: it cannot call itself"),
            );
            None
        } else {
            self.called(file, class, arguments, scope, span)
        };
        self.calls -= 1;
        match value {
            Some(value) => Typed { span, ..value },
            None => self.poison(span),
        }
    }

    fn called(
        &mut self,
        file: FileIndex,
        class: &'a Class,
        arguments: &'a [Argument],
        scope: &Scope<'a>,
        span: Span,
    ) -> Option<Typed> {
        let declared = self.declarations_of(class)?;
        let mut rest: Vec<&'a Argument> = arguments.iter().collect();
        let mut values: Vec<(&'a str, Typed)> = Vec::new();
        let mut output = None;
        for (declaration, declarator) in declared {
            let name = declarator.name.text.as_str();
            let has = |prefix| declaration.prefixes.contains(&prefix);
            let given = if has(Prefix::Input) {
                take(&mut rest, name)
            } else {
                None
            };
            let inner = Scope {
                values: Some(values.clone()),
                counters: Vec::new(),
                locals: Vec::new(),
                ..scope.clone()
            };
            let mut value = match (given, &declarator.binding) {
                (Some(argument), _) => self.lower(&argument.value, scope),
                (None, Some(binding)) => self.lower(binding, &inner),
                (None, None) => {
                    self.no_value_in(class, declarator, has(Prefix::Input), span);
                    return None;
                }
            };
            let kind = match self.names.quantity(file, &declaration.type_name) {
                Some(kind) => kind,
                None => {
                    let diagnostic = self.names.unknown(file, &declaration.type_name);
                    self.report(diagnostic);
                    return None;
                }
            };
            if !value.truth {
                let (dim, _) = self.quantity(kind, declarator.binding.as_ref());
                let declared = self.typed(value.id, dim, declarator.name.span);
                if has(Prefix::Input) {
                    let what = "the argument and its input are";
                    self.agree(&value, &declared, what, scope.instance);
                } else {
                    let what = "the declared type and the value are";
                    self.agree(&declared, &value, what, scope.instance);
                }
                if declared.dim.as_known().is_some() {
                    // A wrong argument is one mistake: the body is read as declared.
                    value.dim = declared.dim;
                    value.bare = false;
                }
            }
            if has(Prefix::Output) {
                output = Some(value.clone());
            }
            values.push((name, value));
        }
        if let Some(argument) = rest.first() {
            let name = &class.name.text;
            let message = match &argument.name {
                Some(word) => format!("`{name}` has no input `{}`", word.text),
                None => format!("`{name}` takes fewer arguments"),
            };
            self.report(
                Diagnostic::error(Code::BadArguments, message)
                    .label(argument.value.span, "not an input")
                    .label(class.name.span, "declared here"),
            );
            return None;
        }
        if output.is_none() {
            self.report(
                Diagnostic::error(
                    Code::BadArguments,
                    format!("the function `{}` has no output", class.name.text),
                )
                .label(class.name.span, "gives no value")
                .help("declare one: `output Force F = c*v^2;`"),
            );
        }
        output
    }

    /// The declarations of a function in their order; a function has nothing else.
    fn declarations_of(
        &mut self,
        class: &'a Class,
    ) -> Option<Vec<(&'a Declaration, &'a Declarator)>> {
        let ClassBody::Long { elements, .. } = &class.body else {
            return Some(Vec::new());
        };
        let mut found = Vec::new();
        for element in elements {
            let Element::Declaration(declaration) = element else {
                self.report(
                    Diagnostic::error(
                        Code::NotYet,
                        format!(
                            "the function `{}` has more than declarations",
                            class.name.text
                        ),
                    )
                    .label(
                        class.name.span,
                        "inputs, variables and an output, each with its value",
                    )
                    .help("give the value where it is declared: `output Force F = c*v^2;`"),
                );
                return None;
            };
            found.extend(declaration.declarators.iter().map(|d| (declaration, d)));
        }
        Some(found)
    }

    fn no_value_in(&mut self, class: &Class, declarator: &Declarator, input: bool, span: Span) {
        let (function, name) = (&class.name.text, &declarator.name.text);
        self.report(if input {
            Diagnostic::error(
                Code::BadArguments,
                format!("`{function}` needs its input `{name}`"),
            )
            .label(span, "not given")
            .label(declarator.name.span, "declared here")
        } else {
            Diagnostic::error(
                Code::NoValue,
                format!("`{name}` of `{function}` has no value"),
            )
            .label(declarator.name.span, "declared without one")
            .help(format!("write `{name} = …`"))
        });
    }
}

/// The argument of an input: that of its name, else the next without one.
fn take<'a>(rest: &mut Vec<&'a Argument>, name: &str) -> Option<&'a Argument> {
    let named = |argument: &&Argument| argument.name.as_ref().is_some_and(|word| word.text == name);
    let at = rest
        .iter()
        .position(named)
        .or_else(|| rest.iter().position(|argument| argument.name.is_none()))?;
    Some(rest.remove(at))
}
