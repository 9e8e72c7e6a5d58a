//! [`Finished`]: what the folder of a finished batch holds: its data set, its trajectories, its summary, its model.

use super::order::Order;
use crate::world::{World, read_text};
use crate::{Asked, Project, Records, load};
use hyde_signal::Frame;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// What a finished batch left.
pub struct Finished {
    /// One row a case.
    pub cases: Frame,
    /// What was kept over time, if anything was.
    pub trajectories: Option<Frame>,
    /// The summary.
    pub summary: Value,
    /// The model from the copies of its files, if it can still be loaded.
    pub project: Option<Project>,
}

/// Why a folder has no finished batch.
pub enum Unfinished {
    /// It holds no batch.
    NoBatch,
    /// Cases are missing.
    CasesMissing,
    /// A file of it cannot be read: one sentence.
    Unreadable(String),
}

impl Finished {
    /// Reads the folder of a batch.
    ///
    /// # Errors
    /// It has no finished batch.
    pub fn read(world: &Arc<dyn World>, folder: &Path) -> Result<Self, Unfinished> {
        if !Order::is_in(world.as_ref(), folder) {
            return Err(Unfinished::NoBatch);
        }
        let table = |name| read_table(world.as_ref(), folder, name).map_err(Unfinished::Unreadable);
        let summary = read_text(world.as_ref(), &folder.join("summary.json"));
        let (Some(cases), Ok(summary)) = (table("cases")?, summary) else {
            return Err(Unfinished::CasesMissing);
        };
        let summary: Value = serde_json::from_str(&summary).map_err(|error| {
            Unfinished::Unreadable(format!("`summary.json` of the batch: {error}"))
        })?;
        let experiment = summary["experiment"].as_str().unwrap_or_default();
        Ok(Self {
            project: project(world, folder, experiment),
            trajectories: table("trajectories")?,
            cases,
            summary,
        })
    }
}

/// The model and the experiment of a batch, from the copies of the model's files that its folder has.
fn project(world: &Arc<dyn World>, folder: &Path, experiment: &str) -> Option<Project> {
    let (order, inputs) = Order::read(world.as_ref(), folder).ok()?;
    let asked = Asked {
        experiment: Some(experiment.to_owned()),
        data: order.data.clone(),
        inputs: Some(Arc::new(inputs)),
        world: Arc::clone(world),
        ..Asked::of_file(&order.file)
    };
    load(&asked, Records::IfThere).ok()
}

/// Where a folder has a table called so, in whichever form: `cases` or `trajectories`.
pub fn table_in(world: &dyn World, folder: &Path, name: &str) -> Option<PathBuf> {
    let forms = ["parquet", "csv"].map(|form| folder.join(format!("{name}.{form}")));
    forms.into_iter().find(|path| world.is_file(path))
}

fn read_table(world: &dyn World, folder: &Path, name: &str) -> Result<Option<Frame>, String> {
    let Some(path) = table_in(world, folder, name) else {
        return Ok(None);
    };
    let frame = hyde_signal::read_frame(&world.read(&path)?);
    let frame = frame.map_err(|error| format!("`{}`: {error}", path.display()))?;
    Ok(Some(frame))
}
