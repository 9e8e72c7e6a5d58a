//! Sessions of a scripted editor with the server.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    clippy::cast_possible_truncation,
    reason = "tests open files, and unwrap what must be there"
)]

mod answers;
mod client;
mod edits;
mod examples;
mod numbers;
mod pieces;
mod renames;
mod runs;
