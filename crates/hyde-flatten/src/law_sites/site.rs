//! [`LawSite`]: a site of a model where a law may act, with the variables that the law is a function of.

use hyde_ir::Quantity;
use hyde_syntax::{LawForm, LawTarget};
use hyde_units::Dimension;

/// A variable of which a law is a function, or its derivative.
#[derive(Clone, Debug, PartialEq)]
pub struct LawVariable {
    /// Its name as the host has it: `a.s`.
    pub name: String,
    /// Whether it is the derivative of that variable.
    pub derivative: bool,
    /// Of the variable that is named: its dimension, and the unit it is declared in.
    pub quantity: Quantity,
}

impl LawVariable {
    /// The dimension of the variable, or of its derivative.
    #[must_use]
    pub fn dimension(&self) -> Dimension {
        match self.derivative {
            true => self.quantity.dimension.divide(Dimension::TIME),
            false => self.quantity.dimension,
        }
    }

    pub(super) fn text(&self) -> String {
        match self.derivative {
            true => format!("der({})", self.name),
            false => self.name.clone(),
        }
    }
}

/// A site of a model where a law may act.
#[derive(Clone, Debug, PartialEq)]
pub struct LawSite {
    /// Path of the instance.
    pub path: String,
    /// Other connectors that are the same site.
    pub aliases: Vec<String>,
    /// The class that declares the site, as the model's file may name it: `Translational.Guide`.
    pub host: String,
    /// What a law is added to.
    pub target: LawTarget,
    /// The dimension of a law.
    pub dimension: Dimension,
    /// What a law is.
    pub form: LawForm,
    /// Place and speed, or what stands for them.
    pub over: [LawVariable; 2],
    /// What a law may go with as well: a current, a force.
    pub signal: Option<LawVariable>,
}
