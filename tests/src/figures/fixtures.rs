//! `diagnostic_fixtures`: the wrong files of which the message is known.

use super::promise::{Figure, Measured, Promise, Session};
use crate::root;

pub(super) const FIGURE: Figure = Figure {
    name: "diagnostic_fixtures",
    unit: "files",
    promise: Promise::AtLeast(60.0),
    measure,
};

/// Files below `tests/fixtures/errors`; that each gives what its snapshot says is a test.
#[allow(clippy::disallowed_methods, reason = "a folder is counted")]
fn measure(_: &Session) -> Result<Measured, String> {
    let folder = root().join("tests/fixtures/errors");
    let entries = std::fs::read_dir(&folder).map_err(|error| error.to_string())?;
    let models = entries
        .flatten()
        .filter(|entry| entry.path().extension().is_some_and(|e| e == "hyde"));
    let count = u32::try_from(models.count()).unwrap_or(u32::MAX);
    Ok(Measured::Value(f64::from(count)))
}
