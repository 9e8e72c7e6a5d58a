//! [`Draft`]: a shape while it is read, with what its names stand for.

use crate::effect_words::MARKS;
use crate::instance::{InstanceId, Scope, Setting, Typed};
use crate::law_roles::{Refusal, wrong};
use crate::names::FileIndex;
use crate::refusals::laws as refused;
use crate::words::nearest;
use hyde_ir::{
    ExprId, Id as _, LawAxis, LawInput, LawRole, LawShape, LawState, LawText, LawUnit, VarId,
};
use hyde_syntax::ast::{Argument, Class, Declarator, Equation, Expr, ExprKind, Name};
use hyde_units::{Dimension, NamedUnit};

/// The instance in which shapes are read: the model; they see nothing of it.
pub(super) const READ_IN: InstanceId = 0;

/// A shape while it is read.
pub(super) struct Draft<'a> {
    pub(super) file: FileIndex,
    pub(super) class: &'a Class,
    pub(super) shape: LawShape,
    /// The variables that stand for its inputs.
    pub(super) variables: Vec<VarId>,
    /// What its names stand for.
    pub(super) names: Vec<(&'a str, Typed)>,
    /// The values of names that are not inputs.
    pub(super) locals: Vec<(&'a str, &'a Expr)>,
    /// The dimension of each variable of a site.
    pub(super) axes: Vec<(LawAxis, Dimension)>,
    /// Its constants as they are declared.
    pub(super) declared: Vec<&'a Declarator>,
    pub(super) equations: Vec<&'a Equation>,
}

/// A mark as written: its name and what stands in parentheses.
pub(super) type Mark = (Name, Vec<Argument>);

impl<'a> Draft<'a> {
    pub(super) fn scope(&self) -> Scope<'a> {
        Scope {
            values: Some(self.names.clone()),
            ..Scope::new(READ_IN, Setting::Report)
        }
    }

    /// The number of the input of that name.
    pub(super) fn input(&self, name: &str) -> Option<usize> {
        let named = self.names.iter().filter(|(own, _)| {
            let mut locals = self.locals.iter();
            !locals.any(|(local, _)| local == own)
        });
        let mut inputs = named.map(|(own, _)| *own);
        inputs.position(|own| own == name)
    }

    /// The unit of a quantity at a site: that of the variable with its dimension.
    pub(super) fn unit(&self, dimension: Dimension) -> LawUnit {
        let mut axes = self.axes.iter();
        match axes.find(|(_, own)| *own == dimension) {
            Some((axis, _)) => LawUnit::Of(*axis),
            None => LawUnit::Own(NamedUnit::usual(dimension)),
        }
    }

    /// Adds what a filter gives; its equation is read later.
    pub(super) fn state(&mut self, declarator: &'a Declarator, dimension: Dimension) -> LawInput {
        let nothing = || LawText {
            value: ExprId::from_index(0),
            pieces: Vec::new(),
            is_sum: false,
        };
        self.shape.states.push(LawState {
            name: declarator.name.text.clone(),
            doc: declarator.doc.clone().unwrap_or_default(),
            unit: self.unit(dimension),
            time_constant: nothing(),
            input: nothing(),
        });
        LawInput::State(self.shape.states.len() - 1)
    }

    /// Reads the roles behind `over`.
    pub(super) fn roles(&mut self, declarator: &Declarator) -> Result<(), Refusal> {
        for argument in &declarator.over {
            let word = word(argument).filter(|_| argument.name.is_none());
            let words = LawRole::ALL.iter().map(|(_, word)| *word);
            let known = LawRole::ALL.iter();
            let Some((role, _)) = known.into_iter().find(|(_, own)| Some(*own) == word) else {
                let near = nearest(word.unwrap_or_default(), words);
                return Err(wrong(refused::unknown_role_of_shape(
                    argument.value.span,
                    near,
                    &every_role(),
                )));
            };
            self.shape.roles.push(*role);
        }
        Ok(())
    }

    /// The mark that a shape leaves.
    pub(super) fn mark(&self, marks: &[Mark]) -> Result<(String, Option<usize>), Refusal> {
        let [(name, arguments)] = marks else {
            return Err(wrong(refused::several_signatures(&self.class.name)));
        };
        let marks: Vec<&str> = MARKS.iter().map(|(mark, _)| *mark).collect();
        if !marks.contains(&name.text.as_str()) {
            return Err(wrong(refused::unknown_signature(name, &marks)));
        }
        let Some(argument) = arguments.first() else {
            return Ok((name.text.clone(), None));
        };
        let word = word(argument);
        let mut constants = self.shape.constants.iter();
        match constants.position(|constant| Some(constant.name.as_str()) == word) {
            Some(number) => Ok((name.text.clone(), Some(number))),
            None => Err(wrong(refused::signature_of_no_constant(
                &self.class.name,
                argument.value.span,
            ))),
        }
    }
}

/// The word that an argument is.
fn word(argument: &Argument) -> Option<&str> {
    if let ExprKind::Reference(name) = &argument.value.kind {
        name.as_word()
    } else {
        None
    }
}

pub(super) fn every_role() -> String {
    let words = LawRole::ALL.map(|(_, word)| format!("`{word}`"));
    format!("the roles are {}", words.join(", "))
}
