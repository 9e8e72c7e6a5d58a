//! How far a long study is: a bar on a terminal, lines of JSON with `--json`.

use crate::project::print_output;
use hyde_study::Progress;
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::io::IsTerminal as _;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

/// Shows how far a study is.
pub(crate) struct Shown {
    json: bool,
    quiet: bool,
    begun: OnceLock<Begun>,
    failed: AtomicUsize,
}

/// What is known once work began.
struct Begun {
    bar: ProgressBar,
    total: usize,
    before: usize,
    start: Instant,
}

impl Shown {
    /// Nothing yet.
    pub(crate) fn new(json: bool, quiet: bool) -> Self {
        Self {
            json,
            quiet,
            begun: OnceLock::new(),
            failed: AtomicUsize::new(0),
        }
    }
}

impl Progress for Shown {
    #[allow(
        clippy::disallowed_methods,
        reason = "the command line tells how long a batch takes"
    )]
    fn begin(&self, total: usize, before: usize) {
        let shown = !self.json && !self.quiet && std::io::stderr().is_terminal();
        let bar = if shown {
            ProgressBar::new(total as u64)
        } else {
            ProgressBar::hidden()
        };
        let template = "{bar:30} {pos} of {len} cases, {msg}";
        bar.set_style(
            ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar()),
        );
        let start = Instant::now();
        let begun = Begun {
            bar,
            total,
            before,
            start,
        };
        if self.begun.set(begun).is_ok() && self.json {
            print_output(&json!({ "event": "start", "cases": total, "done": before }).to_string());
        }
    }

    fn failed(&self) {
        self.failed.fetch_add(1, Ordering::Relaxed);
    }

    fn at(&self, done: usize) {
        let Some(begun) = self.begun.get() else {
            return;
        };
        let seconds = begun.start.elapsed().as_secs_f64();
        let rate = (done - begun.before.min(done)) as f64 / seconds.max(1e-9);
        let left = if rate > 0.0 {
            (begun.total - done.min(begun.total)) as f64 / rate
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
        let text = format!("{failed} failed, {rate:.0} a second, {left}");
        begun.bar.set_message(text);
        begun.bar.set_position(done as u64);
    }

    fn finish(&self) {
        if let Some(begun) = self.begun.get() {
            begun.bar.finish_and_clear();
        }
    }
}
