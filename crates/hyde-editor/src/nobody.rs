//! A host without a machine behind it: for a server that answers what texts alone tell, as tests and fuzz targets need it.

use crate::lens::Order;
use crate::outcome::Outcome;
use crate::server::Host;
use hyde_diag::Code;
use std::path::PathBuf;

/// Writes no file of the library, explains a code by its title, and refuses to run anything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Nobody;

impl Host for Nobody {
    fn library_file(&self, _: &str, _: &str) -> Option<PathBuf> {
        None
    }

    fn explanation(&self, code: Code) -> String {
        code.title().to_owned()
    }

    fn start(&self, _: Order, done: Box<dyn FnOnce(Outcome) + Send>) {
        done(Outcome::from(Err("nobody runs it".to_owned())));
    }
}
