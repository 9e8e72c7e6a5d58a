//! Every diagnostic of analysis, as data: a file for each group of passes, and `words` with what several of them say. A pass
//! reports what a function of its file makes.

pub(crate) mod clocked;
pub(crate) mod conflicts;
pub(crate) mod states;
pub(crate) mod unmatched;
pub(crate) mod words;

use crate::system::System;
use hyde_diag::{Origin, Span};

/// Where something stands, and before it the declaration of the component that has it: that is in the user's own file. At the
/// top of the model there is none.
pub(crate) type Place = (Option<Span>, Span);

/// The place of what has this origin.
pub(crate) fn place_of(system: &System, origin: &Origin) -> Place {
    (system.component(origin).map(|(_, span)| span), origin.span)
}

/// A component with its declaration.
type Part = (String, Span);
