//! The sweeps of a file that is checked: each is laid out, and none of its cases is solved.

use crate::args::ModelArgs;
use crate::batch::prepared::prepared;
use crate::exit::Exit;
use crate::project::{Project, Records};
use hyde_study::Inputs;
use hyde_study::sweep::Order;
use hyde_syntax::ast::StudyKind;
use hyde_units::counted;
use std::sync::Arc;

/// The sweeps of a file, each laid out.
pub(super) fn sweeps(args: &ModelArgs, project: &Project) -> Result<Vec<String>, Exit> {
    let mut names = Vec::new();
    let quiet = ModelArgs {
        quiet: true,
        ..args.clone()
    };
    for study in project
        .file
        .studies()
        .filter(|study| study.kind == StudyKind::Sweep)
    {
        let order = Order {
            file: args.file.clone(),
            sweep: study.name.text.clone(),
            settings: args.settings.clone(),
            records: args.records.clone(),
            data: args.data.clone(),
            seed: None,
            keep: Vec::new(),
        };
        let inputs = Arc::new(Inputs::recording());
        if let Some(batch) = prepared(&order, &inputs, Records::IfThere, &quiet)? {
            let cases = counted(batch.plan.count(), "case");
            names.push(format!("sweep {} ({cases})", order.sweep));
        }
    }
    Ok(names)
}
