//! A server of the Model Context Protocol on standard input and output, for programs that act on their own.
//!
//! ```text
//! server      JSON-RPC, one message a line: what is asked and answered        server.rs
//! batch       several messages in a line                                   batch.rs
//! tools       the tools with their arguments, as command lines                tools.rs
//! digest      an answer without samples                                       digest.rs
//! components  the component library                                           components.rs
//! ```
//! A tool runs the command of its name in a process of its own ([`Host::run`]), which prints JSON. Long lists of numbers
//! become their count and range, and the whole answer goes to a file whose path is told: samples never enter a conversation.
//!
//! Protocol: <https://modelcontextprotocol.io/specification>, versions with `initialize`; one JSON object a line.

mod batch;
mod components;
mod digest;
mod server;
mod tools;

pub use digest::digest;
pub use server::serve;

use std::sync::atomic::AtomicBool;

/// What a command left.
#[derive(Clone, Debug, Default)]
pub struct Ran {
    /// Standard output.
    pub stdout: String,
    /// Standard error.
    pub stderr: String,
    /// The exit status.
    pub status: i32,
}

/// What the server needs of the machine.
pub trait Host {
    /// Runs the command with arguments; ends it when it is `cancelled`.
    ///
    /// # Errors
    /// It could not be started.
    fn run(&self, arguments: &[String], cancelled: &AtomicBool) -> Result<Ran, String>;

    /// Writes a text to a file of a folder, and makes the folder; gives back the path.
    ///
    /// # Errors
    /// It cannot be written.
    fn write(&self, folder: &str, name: &str, text: &str) -> Result<String, String>;

    /// The folder for what a call of a tool writes if its arguments name none: one of its own for each call, counted from 1.
    fn folder(&self, call: usize) -> String;
}
