//! The clock of the figures that are times.

use std::time::Instant;

/// The present instant.
#[allow(clippy::disallowed_methods, reason = "time is what is measured")]
pub(super) fn now() -> Instant {
    Instant::now()
}
