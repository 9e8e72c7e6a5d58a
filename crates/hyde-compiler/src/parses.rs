//! [`parses`]: how often this process parsed each file. That a command parses each file once is a promise, which is measured.

use hyde_diag::{Diagnostics, FileId, Sources};
use hyde_syntax::ast;
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// By the place of a file, or the name of a package of the library.
static PARSES: Mutex<BTreeMap<String, usize>> = Mutex::new(BTreeMap::new());

/// Parses a text that was loaded, and counts it.
pub(crate) fn counted(sources: &Sources, id: FileId, diagnostics: &mut Diagnostics) -> ast::File {
    let mut parses = PARSES.lock().unwrap_or_else(PoisonError::into_inner);
    *parses.entry(sources.get(id).name.clone()).or_default() += 1;
    drop(parses);
    hyde_syntax::parse(sources, id, diagnostics)
}

/// How often each file was parsed since the process began, by its place; packages of the library by their names.
#[must_use]
pub fn parses() -> BTreeMap<String, usize> {
    PARSES
        .lock()
        .unwrap_or_else(PoisonError::into_inner)
        .clone()
}
