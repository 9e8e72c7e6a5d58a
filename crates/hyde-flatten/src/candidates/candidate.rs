//! [`Candidate`]: an effect at a site of a model where it fits, with its sizes and shapes.

use hyde_ir::Quantity;

/// An effect at a site of a model where it fits.
#[derive(Clone, Debug, PartialEq)]
pub struct Candidate {
    /// What is written after `with`: `Effects.Stribeck`; effects of the user's file by their name alone.
    pub effect: String,
    /// The package it is in.
    pub package: String,
    /// The type that it is for, as it is written there.
    pub host: String,
    /// The package of that type.
    pub host_package: String,
    /// What it is.
    pub doc: String,
    /// Path of the instance that it is put on.
    pub site: String,
    /// Other connectors that are the same site.
    pub aliases: Vec<String>,
    /// What its instance is called at the site: `Stribeck`, or `Stribeck2` where the model has one there already.
    pub instance: String,
    /// Where all of them are 0 it vanishes.
    pub sizes: Vec<Knob>,
    /// What says how it looks.
    pub shapes: Vec<Knob>,
    /// The marks it leaves, with the name of the shape that goes with each: `angle` of `N`.
    pub signature: Vec<(String, Option<String>)>,
    /// The names of effects it is easily taken for.
    pub confounds: Vec<String>,
    /// Components of its host that it exchanges: two effects cannot exchange the same one.
    pub replaces: Vec<String>,
}

/// A size or a shape of a candidate.
#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    /// Its name in the effect.
    pub name: String,
    /// Its value as declared, SI.
    pub value: f64,
    /// The values it may have, SI.
    pub range: Option<(f64, f64)>,
    /// Its dimension and the unit it is declared in.
    pub quantity: Quantity,
    /// Whether it counts something.
    pub integer: bool,
    /// What it is.
    pub doc: String,
}

impl Candidate {
    /// The effect's own name, without the package: its id in reports.
    #[must_use]
    pub fn name(&self) -> &str {
        self.effect.rsplit('.').next().unwrap_or(&self.effect)
    }
}
