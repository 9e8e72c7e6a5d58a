//! Where the records are that are not shipped.

use std::path::PathBuf;

/// What names the folder.
const DATA: &str = "HYDE_DATA";

/// The folder of the records that are not shipped: what `HYDE_DATA` names, `shared/data` beside the project without it.
#[must_use]
#[allow(
    clippy::disallowed_methods,
    reason = "the one setting of tests and figures"
)]
pub fn data() -> PathBuf {
    std::env::var(DATA).map_or_else(|_| crate::root().join("../shared/data"), PathBuf::from)
}
