//! `hyde lsp`: the language server, on standard input and output.

mod commands;
mod ran;
mod stdio;

use super::explain;
use crate::exit::Exit;
use crate::files;
use crate::output::print_error;
use commands::Commands;
use hyde_diag::Code;
use hyde_editor::{Ended, Host, Order, Outcome};
use hyde_study::world::Disk;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Serves one editor until it ends the session.
pub(crate) fn lsp() -> Exit {
    let (connection, threads) = stdio::connection();
    let served = hyde_editor::serve(&connection, Arc::new(Disk), Box::<Machine>::default());
    // The threads end when nobody can send any more.
    drop(connection);
    let joined = match &served {
        // The editor may still write, to nobody.
        Ok(Ended::Exit) => Ok(()),
        Ok(Ended::ShutDown | Ended::Gone) | Err(_) => threads.join(),
    };
    match joined.and(served) {
        Ok(Ended::ShutDown | Ended::Gone) => Exit::Done,
        Ok(Ended::Exit) => Exit::Model,
        Err(reason) => {
            print_error(&format!("error: {reason}"));
            Exit::CommandLine
        }
    }
}

/// What the server needs of the machine.
#[derive(Default)]
struct Machine {
    commands: Commands,
}

impl Host for Machine {
    fn library_file(&self, name: &str, text: &str) -> Option<PathBuf> {
        let path = cache()?
            .join("library")
            .join(env!("CARGO_PKG_VERSION"))
            .join(Path::new(name));
        let there = files::read(&path).is_ok_and(|own| own == text.as_bytes());
        if !there {
            files::make_folder(path.parent()?).ok()?;
            files::write(&path, text.as_bytes()).ok()?;
        }
        Some(path)
    }

    fn explanation(&self, code: Code) -> String {
        let page = explain::page(code);
        // What stands before the first example.
        let words = page.split("```").next().unwrap_or(page);
        words.trim_start_matches("# ").trim_end().to_owned()
    }

    fn start(&self, order: Order, done: Box<dyn FnOnce(Outcome) + Send>) {
        match cache() {
            Some(cache) => self.commands.start(&cache, order, done),
            None => {
                let reason =
                    "there is no folder for the page: neither XDG_CACHE_HOME nor HOME is set";
                done(Err(reason.to_owned()).into());
            }
        }
    }
}

/// The folder for what can be made again.
fn cache() -> Option<PathBuf> {
    let named = std::env::var_os("XDG_CACHE_HOME").map(PathBuf::from);
    let home = || Some(PathBuf::from(std::env::var_os("HOME")?).join(".cache"));
    let folder = named.filter(|own| own.is_absolute()).or_else(home)?;
    Some(folder.join("hyde"))
}
