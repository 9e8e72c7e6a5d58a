//! Functions that a file declares: `function drag … input Velocity v; output Force F = c*v^2; end drag;`
//!
//! A call is replaced by the function's expressions, its arguments for its inputs, so that derivatives, units and events
//! are those of the expression. A function sees its inputs and its own variables, nothing of the model.

use super::calls::Call;
use crate::instance::{Scope, Typed};
use crate::instantiate::quantity;
use crate::model::Model;
use crate::names::FileIndex;
use crate::refusals::calls as refused;
use hyde_diag::Span;
use hyde_syntax::ast::{
    Argument, Class, ClassBody, ClassKind, Declaration, Declarator, Element, Prefix, Reference,
};

/// Calls within calls at most: recursion needs stack.
const MAX_DEPTH: usize = 100;
/// Calls that one call may lead to: functions that call others twice double them at every level.
const MAX_CALLS: usize = 10_000;

impl<'a> Model<'a, '_> {
    /// The function of that name, seen from where the name is written.
    pub(crate) fn function_named(&self, name: &Reference) -> Option<(FileIndex, &'a Class)> {
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
        let declared = self.declarations_of(class);
        let value = declared.and_then(|declared| {
            let (given, rest) = self.given(&declared, arguments, scope);
            let goes_on = self.goes_on(class);
            self.calls.within.push(class);
            let value = goes_on
                .then(|| self.called((file, class), declared, given, rest, scope, span))
                .flatten();
            self.calls.within.pop();
            value
        });
        match value {
            Some(value) => Typed { span, ..value },
            None => self.poison(span),
        }
    }

    /// The values of the inputs that a call gives, and the arguments that are none.
    fn given(
        &mut self,
        declared: &[(&'a Declaration, &'a Declarator)],
        arguments: &'a [Argument],
        scope: &Scope<'a>,
    ) -> (Vec<Option<Typed>>, Vec<&'a Argument>) {
        let mut rest: Vec<&'a Argument> = arguments.iter().collect();
        let mut given = Vec::new();
        for (declaration, declarator) in declared {
            let argument = if declaration.prefixes.contains(&Prefix::Input) {
                take(&mut rest, &declarator.name.text)
            } else {
                None
            };
            given.push(argument.map(|argument| self.lower(&argument.value, scope)));
        }
        (given, rest)
    }

    /// Whether a function may be called where others are being replaced; reports why not.
    fn goes_on(&mut self, class: &'a Class) -> bool {
        let within = &self.calls.within;
        if within.is_empty() {
            self.calls.count = 0;
        }
        self.calls.count += 1;
        if within.iter().any(|&known| std::ptr::eq(known, class)) {
            self.report(refused::calls_itself(&class.name));
            return false;
        }
        if within.len() == MAX_DEPTH {
            self.report(refused::long_chain_of_calls(MAX_DEPTH, class.name.span));
            return false;
        }
        if self.calls.count == MAX_CALLS + 1 {
            let outermost = within.first().map_or("", |class| &class.name.text);
            self.report(refused::too_many_calls(
                outermost,
                MAX_CALLS,
                class.name.span,
            ));
        }
        self.calls.count <= MAX_CALLS
    }

    /// The value of a call with the values of its inputs.
    fn called(
        &mut self,
        (file, class): (FileIndex, &'a Class),
        declared: Vec<(&'a Declaration, &'a Declarator)>,
        given: Vec<Option<Typed>>,
        rest: Vec<&'a Argument>,
        scope: &Scope<'a>,
        span: Span,
    ) -> Option<Typed> {
        // A call that was replaced before is the same expression again.
        let ids = given.iter().flatten().map(|value| value.id).collect();
        let key = (class.name.span, scope.instance, ids);
        let kind_of = |value: &Typed| {
            (
                value.dim.clone(),
                value.truth,
                value.bare,
                value.turns,
                value.zero,
            )
        };
        let arguments = given.iter().map(|value| value.as_ref().map(kind_of));
        let call = Call {
            setting: scope.setting,
            place: scope.place,
            records: scope.records,
            arguments: arguments.collect(),
        };
        let known = self.calls.known.get(&key);
        let known = known.and_then(|known| known.iter().find(|(other, _)| *other == call));
        if let Some((_, value)) = known.filter(|_| rest.is_empty()) {
            return Some(value.clone());
        }
        let mut values: Vec<(&'a str, Typed)> = Vec::new();
        let outputs = declared
            .iter()
            .filter(|(d, _)| d.prefixes.contains(&Prefix::Output));
        let outputs: Vec<&Declarator> = outputs.map(|(_, declarator)| *declarator).collect();
        if let [first, second, ..] = outputs.as_slice() {
            let (name, both) = (&class.name.text, [first.name.span, second.name.span]);
            self.report(refused::several_outputs(name, span, outputs.len(), both));
            return None;
        }
        let mut output = None;
        for ((declaration, declarator), given) in declared.into_iter().zip(given) {
            let name = declarator.name.text.as_str();
            let has = |prefix| declaration.prefixes.contains(&prefix);
            let inner = Scope {
                values: Some(values.clone()),
                counters: Vec::new(),
                locals: Vec::new(),
                ..scope.clone()
            };
            let mut value = match (given, &declarator.binding) {
                (Some(argument), _) => argument,
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
                let (dim, _) = quantity(self, kind, declarator.binding.as_ref());
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
            let given = (argument.name.as_ref(), argument.value.span);
            self.report(refused::no_such_input(&class.name, given));
            return None;
        }
        if let Some(value) = &output {
            let known = self.calls.known.entry(key).or_default();
            known.push((call, value.clone()));
        } else {
            self.report(refused::no_output(&class.name));
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
            // Its mark says that laws are made of it.
            if matches!(element, Element::Signature(_)) {
                continue;
            }
            let Element::Declaration(declaration) = element else {
                self.report(refused::more_than_declarations(&class.name));
                return None;
            };
            found.extend(declaration.declarators.iter().map(|d| (declaration, d)));
        }
        Some(found)
    }

    fn no_value_in(&mut self, class: &Class, declarator: &Declarator, input: bool, span: Span) {
        let function = &class.name.text;
        self.report(match input {
            true => refused::input_not_given(function, declarator, span),
            false => refused::no_value_in_function(function, declarator),
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
