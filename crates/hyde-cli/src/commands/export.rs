//! `hyde export`: a model for other tools.

mod fmu;

use crate::args::{ExportArgs, ExportKind};
use crate::exit::Exit;

/// Exports a model.
pub(crate) fn export(args: &ExportArgs) -> Exit {
    match &args.kind {
        ExportKind::Fmu(args) => fmu::fmu(args),
    }
}
