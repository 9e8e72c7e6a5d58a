//! Text to [`ast::File`]: the first stage. Names are still text here; every node knows its [`hyde_diag::Span`].
//!
//! [`parse`] reads a file element by element, so that one error does not hide the next, and refuses what is nested
//! too deeply before the parser's stack would. [`format()`] prints a tree as source text again; [`written()`] says how a text
//! is written, comments and digits included, for a formatter or an editor.

pub mod ast;

mod format;
mod forms;
mod grammar;
mod habits;
mod law;
mod lookup;
mod matcher;
mod nesting;
mod other_names;
mod parse;
mod recover;
mod refusals;
mod slips;
mod twice;
mod words;
mod written;

pub use format::{
    expression as format_expression, file as format, member, reference as format_reference,
};
pub use grammar::Rule;
pub use habits::{instead_of, instead_of_attribute};
pub use law::{LawForm, LawTarget};
pub use lookup::{FileIndex, Lookup, dotted};
pub use other_names::instead_of_function;
pub use parse::{parse, parse_record};
pub use recover::{comment_end, string_end};
pub use words::is_reserved;
pub use written::{Node, Part, Written, written};
