//! The present, for pages that say when they were made.

use chrono::DateTime;
use std::time::{SystemTime, UNIX_EPOCH};

/// The present minute in UTC.
#[allow(clippy::disallowed_methods, reason = "a page says when it was made")]
pub(crate) fn now() -> String {
    let since = SystemTime::now().duration_since(UNIX_EPOCH);
    let seconds = since
        .ok()
        .and_then(|since| i64::try_from(since.as_secs()).ok());
    let date = seconds.and_then(|seconds| DateTime::from_timestamp(seconds, 0));
    date.map_or(String::new(), |date| {
        date.naive_utc().format("%Y-%m-%d %H:%M UTC").to_string()
    })
}
