//! Source texts, spans, origins and diagnostics: how every stage says where something was written.
//!
//! A [`Span`] points into one of the [`Sources`]; an [`Origin`] adds the instance path and who made the thing, and is
//! carried by every equation, relation and variable to run time. What is wrong with a model is a [`Diagnostic`] with
//! a [`Code`], declared with [`diagnostics!`] and collected in [`Diagnostics`]; rendering it is the business of the command
//! line.

mod code;
mod declared;
mod diagnostic;
mod origin;
mod sink;
mod source;
mod span;

pub use code::Code;
pub use diagnostic::{Diagnostic, Label, Severity};
pub use origin::{InstancePath, MadeBy, Origin};
pub use sink::Diagnostics;
pub use source::{FileId, Source, Sources};
pub use span::Span;
