//! [`Making`]: what is noted while instances are made, of which later passes tell what nothing used.

use crate::instance::InstanceId;
use crate::names::FileIndex;
use hyde_diag::{InstancePath, Span};
use hyde_syntax::ast::{Change, Class, Element, Expr, Reference};
use std::collections::BTreeMap;

/// What is noted while instances are made.
#[derive(Default)]
pub(crate) struct Making<'a> {
    /// Modifications with whether anything used them.
    pub(super) modifications: Vec<(Span, String, bool)>,
    /// The instance that a modification with one word left was given to, by its number.
    pub(super) modified: BTreeMap<usize, InstanceId>,
    /// Effects to be put on instances, and what they replace.
    pub(crate) hooks: Vec<Hook<'a>>,
    pub(crate) replacements: Vec<Replacement<'a>>,
    /// Whether effects are offered to what they fit on, and those that were.
    pub(crate) offering: bool,
    pub(crate) offers: Vec<Offer<'a>>,
    /// Classes that contain themselves, once reported.
    pub(super) endless: Vec<&'a Class>,
    /// The classes that the instance being made extends, by whatever way.
    pub(super) extended: usize,
}

/// An effect to be put on an instance once that is made.
pub(crate) struct Hook<'a> {
    pub(super) host: InstancePath,
    pub(crate) site: &'a Reference,
    pub(super) file: FileIndex,
    pub(super) class: &'a Class,
    pub(super) changes: &'a [Change],
    /// The model that uses the effect: its changes stand in its scope.
    pub(crate) scope: InstanceId,
    /// What its instance is called below its host.
    pub(super) name: &'a str,
    /// Neutral sizes do not leave it out.
    pub(super) keep: bool,
    pub(crate) used: bool,
}

/// `replace c by M(…);`
pub(crate) struct Replacement<'a> {
    pub(crate) host: InstanceId,
    pub(crate) component: &'a Reference,
    pub(super) class: (FileIndex, &'a Class),
    pub(super) changes: &'a [Change],
    pub(super) effect: InstanceId,
    pub(crate) used: bool,
}

/// `wrap x by e;`
pub(crate) struct Wrap<'a> {
    pub(crate) host: InstanceId,
    pub(crate) site: &'a Reference,
    pub(crate) value: &'a Expr,
    pub(crate) effect: InstanceId,
    pub(crate) used: bool,
}

/// An effect that fits on a host: there are its parameters alone.
pub(crate) struct Offer<'a> {
    pub(crate) host: InstanceId,
    pub(crate) effect: InstanceId,
    /// The package of its file; none for the user's own.
    pub(crate) package: Option<String>,
    /// What its instance would be called below its host.
    pub(crate) name: String,
    /// Everything that is written in it.
    pub(crate) elements: Vec<&'a Element>,
}
