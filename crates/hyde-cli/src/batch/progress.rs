//! How far a batch is: a bar on a terminal, lines of JSON with `--json`.

use crate::project::print_output;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::io::IsTerminal as _;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Shows how far a batch is.
pub(crate) struct Progress {
    bar: ProgressBar,
    json: bool,
    total: usize,
    before: usize,
    start: Instant,
    failed: AtomicUsize,
}

impl Progress {
    /// Of `total` cases `before` were there already.
    #[allow(
        clippy::disallowed_methods,
        reason = "the command line tells how long a batch takes"
    )]
    pub(crate) fn new(total: usize, before: usize, json: bool, quiet: bool) -> Self {
        let shown = !json && !quiet && std::io::stderr().is_terminal();
        let bar = if shown {
            ProgressBar::new(total as u64)
        } else {
            ProgressBar::hidden()
        };
        let template = "{bar:30} {pos} of {len} cases, {msg}";
        bar.set_style(
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()),
        );
        let progress = Self {
            bar,
            json,
            total,
            before,
            start: Instant::now(),
            failed: AtomicUsize::new(0),
        };
        if json {
            print_output(&json!({ "event": "start", "cases": total, "done": before }).to_string());
        }
        progress
    }

    /// Counts a case that failed.
    pub(crate) fn failed(&self) {
        self.failed.fetch_add(1, Ordering::Relaxed);
    }

    /// Shows that so many cases are on the disk.
    pub(crate) fn at(&self, done: usize) {
        let seconds = self.start.elapsed().as_secs_f64();
        let rate = (done - self.before.min(done)) as f64 / seconds.max(1e-9);
        let left = if rate > 0.0 {
            (self.total - done.min(self.total)) as f64 / rate
        } else {
            f64::NAN
        };
        let failed = self.failed.load(Ordering::Relaxed);
        if self.json {
            let line = json!({ "event": "progress", "done": done, "failed": failed, "rate": rate, "left_s": left });
            print_output(&line.to_string());
            return;
        }
        let left = if left.is_finite() {
            format!(
                "{} left",
                indicatif::HumanDuration(Duration::from_secs_f64(left.min(1e9)))
            )
        } else {
            String::new()
        };
        self.bar
            .set_message(format!("{failed} failed, {rate:.0} a second, {left}"));
        self.bar.set_position(done as u64);
    }

    /// Takes the bar away.
    pub(crate) fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
