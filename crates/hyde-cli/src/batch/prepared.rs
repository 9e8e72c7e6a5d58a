//! A batch that is prepared from its order; what is wrong with it is printed.

use crate::args::{ModelArgs, SweepArgs};
use crate::exit::Exit;
use crate::project::{self, Records, Told as _};
use crate::sandbox;
use hyde_study::sweep::{Order, Prepared};
use hyde_study::{Asked, Inputs};
use std::path::Path;
use std::sync::Arc;

/// Prepares an order; what is wrong with it is printed, and warnings are.
pub(crate) fn prepared(
    order: &Order,
    inputs: &Arc<Inputs>,
    needed: Records,
    model: &ModelArgs,
) -> Result<Option<Prepared>, Exit> {
    let base = Asked {
        inputs: Some(Arc::clone(inputs)),
        fmu_host: sandbox::host(model.sandbox),
        ..Asked::of_file(&order.file)
    };
    let batch = Prepared::new(order, &base, needed).map_err(|own| project::refused(model, &own))?;
    if let Some(batch) = &batch {
        batch.project.print_warnings(model);
    }
    Ok(batch)
}

/// The arguments of a model for the file of a batch.
pub(crate) fn model_args(file: &Path, args: &SweepArgs) -> ModelArgs {
    ModelArgs {
        sandbox: args.fmus.sandbox,
        json: args.json,
        quiet: args.quiet,
        ..ModelArgs::of_file(file)
    }
}
