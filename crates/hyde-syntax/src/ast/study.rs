//! Studies: calibrations, diagnoses and sweeps.

use super::{EffectUse, Expr, Name, Range, Reference};
use hyde_diag::Span;

/// What kind of study.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StudyKind {
    /// `calibrate`
    Calibrate,
    /// `diagnose`
    Diagnose,
    /// `sweep`
    Sweep,
}

impl StudyKind {
    /// The word as written.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Self::Calibrate => "calibrate",
            Self::Diagnose => "diagnose",
            Self::Sweep => "sweep",
        }
    }
}

/// `calibrate bench of Axis … end bench;`
#[derive(Clone, Debug, PartialEq)]
pub struct Study {
    /// Which.
    pub kind: StudyKind,
    /// Its name.
    pub name: Name,
    /// The model, experiment or calibration it is of.
    pub of: Reference,
    /// Further models of a calibration: `calibrate both of Slide, Bench`.
    pub also: Vec<Reference>,
    /// Its documentation.
    pub doc: Option<String>,
    /// What is in it.
    pub items: Vec<StudyItem>,
    /// From the keyword to the end.
    pub span: Span,
}

/// An element of a study.
#[derive(Clone, Debug, PartialEq)]
pub enum StudyItem {
    /// `vary saddle.M in 200 .. 400 [kg];`
    Vary(Vec<Variation>),
    /// `vary effect Stribeck(dF = 150 [N]) on guide;`: without each and with it.
    VaryEffects(Vec<EffectUse>),
    /// `max_effects 3;`, `fit bench("fit-*.csv") at load = 200 [kg];`
    Setting(Name, Vec<SettingValue>, Vec<Label>),
}

/// `load = 200 [kg]`: a fact about records.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// What the fact is about.
    pub name: Name,
    /// A number, a text or a name.
    pub value: Expr,
}

/// What is varied, and how.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation {
    /// Of what kind the target is.
    pub what: Varied,
    /// A parameter, a start value, a component, or the word `uncertain`; a stimulus, a record, or the word `model`.
    pub target: Reference,
    /// `in a .. b`
    pub within: Option<Range>,
    /// `= {…}`
    pub values: Option<Expr>,
    /// `per load`: a value of its own for each value of a label.
    pub per: Option<Name>,
}

/// What a variation is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Varied {
    /// A value or a component of the model.
    Part,
    /// `vary stimulus r = {…}`: what drives an input.
    Stimulus,
    /// `vary record file = {"a.csv", …}`: the file of a record.
    Record,
    /// `vary model = {A, B}`: the model itself.
    Model,
}

/// The value of a setting.
#[derive(Clone, Debug, PartialEq)]
pub enum SettingValue {
    /// `Effects.*`
    Everything(Reference),
    /// Any expression.
    Expr(Expr),
}
