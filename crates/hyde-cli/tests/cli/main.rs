//! The command line as its users meet it.

mod analyses;
mod command;
mod files;
mod printed;
mod settings;
mod status;
