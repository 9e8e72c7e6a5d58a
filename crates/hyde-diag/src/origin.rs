//! Where an equation, relation or variable comes from: kept to run time, so that a failure names the model's words.

use crate::Span;
use std::fmt;
use std::sync::Arc;

/// Path of an instance from the top of the model: `screw.contact`. Empty at the top.
#[derive(Clone, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct InstancePath(Arc<str>);

impl InstancePath {
    /// The top of the model.
    #[must_use]
    pub fn root() -> Self {
        Self(Arc::from(""))
    }

    /// The instance `name` inside this one.
    #[must_use]
    pub fn child(&self, name: &str) -> Self {
        Self(Arc::from(self.member(name)))
    }

    /// The full name of a member of this instance.
    #[must_use]
    pub fn member(&self, name: &str) -> String {
        if self.0.is_empty() {
            name.to_owned()
        } else {
            format!("{}.{name}", self.0)
        }
    }

    /// The path as text; empty at the top.
    #[must_use]
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for InstancePath {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

/// Who wrote a thing: the user, or a rule of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum MadeBy {
    /// Written in the source.
    Source,
    /// Equality of potentials or sum of flows of a connection set.
    Connection,
    /// Zero flow of a connector that is in no connection.
    Unconnected,
    /// Binding of a declaration, `Real x = e`.
    Binding,
    /// Discretisation of a field equation or boundary.
    Discretization,
    /// The derivative of an equation.
    Derivative,
    /// A mode fixes a state.
    Pin,
    /// Start value used as an initial condition.
    Start,
    /// A name for an expression that `delay` or `edge` takes.
    Expression,
    /// The experiment: stimulus, measured, expect.
    Experiment,
}

/// Source span and instance path of an equation, relation or variable.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Where it is written.
    pub span: Span,
    /// In which instance.
    pub instance: InstancePath,
    /// By whom.
    pub made_by: MadeBy,
}

impl Origin {
    /// Written in the source, in the instance given.
    #[must_use]
    pub fn source(span: Span, instance: &InstancePath) -> Self {
        Self {
            span,
            instance: instance.clone(),
            made_by: MadeBy::Source,
        }
    }

    /// The same place, made by a rule.
    #[must_use]
    pub fn made_by(&self, made_by: MadeBy) -> Self {
        Self {
            made_by,
            ..self.clone()
        }
    }
}
