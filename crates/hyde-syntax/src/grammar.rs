//! The generated parser of `grammar/hyde.pest`.

#![allow(missing_docs, reason = "generated code")]

#[derive(pest_derive::Parser)]
#[grammar = "../../grammar/hyde.pest"]
pub(crate) struct HydeParser;
