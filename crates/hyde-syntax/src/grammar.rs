//! The grammar as pest reads it: the names of its rules, and what was expected where a text does not match.
//!
//! The text itself is matched by [`crate::matcher`], which is written from the same file; pest is asked where that failed.

#![allow(missing_docs, reason = "generated code")]

use crate::words;
use pest::Parser as _;
use pest::error::{ErrorVariant, InputLocation};

#[derive(pest_derive::Parser)]
#[grammar = "../../grammar/hyde.pest"]
pub(crate) struct HydeParser;

/// How far a text that is not a `rule` was understood, and what was expected there in the user's words.
pub(crate) fn expected(rule: Rule, text: &str) -> (usize, String) {
    let Err(error) = HydeParser::parse(rule, text) else {
        return (0, words::expected(&[rule]));
    };
    let at = match error.location {
        InputLocation::Pos(at) | InputLocation::Span((at, _)) => at,
    };
    let expected = match &error.variant {
        ErrorVariant::ParsingError { positives, .. } => words::expected(positives),
        ErrorVariant::CustomError { message } => message.clone(),
    };
    (at, expected)
}
