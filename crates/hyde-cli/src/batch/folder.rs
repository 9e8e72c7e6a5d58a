//! The folder of a batch: what it is, who works in it, and the data set that is made there in the end.

use crate::batch::store::Journals;
use crate::files;
use hyde_experiment::batch::Summary;
use hyde_study::Inputs;
use hyde_study::sweep::{self, Order, Prepared, TableForm};
use hyde_study::world::Disk;
use std::path::Path;

/// Makes a folder the one of this batch.
pub(crate) fn keep(
    order: &Order,
    batch: &Prepared,
    inputs: &Inputs,
    folder: &Path,
) -> Result<(), String> {
    let identity = (&batch.parts, batch.plan.count());
    for (path, content) in order.files(&Disk, folder, identity, inputs)? {
        files::make_folder(path.parent().unwrap_or(folder))?;
        files::write(&path, &content)?;
    }
    Ok(())
}

/// One process has the folder, or any number of shards do. Where files cannot be locked the journals suffice.
pub(crate) fn locked(folder: &Path, shared: bool) -> Result<Option<std::fs::File>, String> {
    let file = files::open_lock(&folder.join("lock"))?;
    let locked = if shared {
        file.try_lock_shared()
    } else {
        file.try_lock()
    };
    match locked {
        Ok(()) => Ok(Some(file)),
        Err(std::fs::TryLockError::WouldBlock) => Err(format!(
            "another process is working in `{}`: wait for it, or end it",
            folder.display()
        )),
        Err(std::fs::TryLockError::Error(_)) => Ok(None),
    }
}

/// Makes the data set of a batch whose store has every case. A file is there whole or not at all.
pub(crate) fn merge(
    batch: &Prepared,
    store: &Journals,
    folder: &Path,
    form: TableForm,
) -> Result<Summary, String> {
    let mut summary = None;
    files::write_with(&folder.join(form.file("cases")), |file| {
        summary = Some(sweep::cases(batch, store, form, file)?);
        Ok(())
    })?;
    if !batch.dataset.kept.is_empty() {
        files::write_with(&folder.join(form.file("trajectories")), |file| {
            sweep::trajectories(batch, store, form, file)
        })?;
    }
    Ok(summary.unwrap_or_default())
}
