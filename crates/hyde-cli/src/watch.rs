//! How far a command is: a line on standard error of a terminal after two seconds, gone when the command is done.

use hyde_sim::Reached;
use hyde_units::significant;
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal as _;
use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

/// A command that takes less time shows nothing.
const QUIET: Duration = Duration::from_secs(2);
const EVERY: Duration = Duration::from_millis(200);

/// The line, until this is dropped.
pub(crate) struct Watch {
    drawing: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Watch {
    /// Shows how far a run is: to its end, or behind it where it goes on until nothing changes.
    pub(crate) fn of_run(silent: bool, reached: &Arc<Reached>) -> Self {
        let reached = Arc::clone(reached);
        Self::new(silent, move || {
            let (now, end) = reached.get();
            let [at, until] = [now, end].map(|time| significant(time, 4));
            if now > end {
                format!("simulated {at} s, not yet steady")
            } else {
                format!("simulated {at} s of {until} s")
            }
        })
    }

    /// Shows what `text` returns, unless it is to be silent or nobody reads it.
    pub(crate) fn new(silent: bool, text: impl Fn() -> String + Send + 'static) -> Self {
        if silent || !std::io::stderr().is_terminal() {
            return Self { drawing: None };
        }
        let (end, ended) = channel::<()>();
        let goes_on = move |time| ended.recv_timeout(time) == Err(RecvTimeoutError::Timeout);
        let draw = move || {
            if !goes_on(QUIET) {
                return;
            }
            let bar = ProgressBar::new_spinner();
            let style = ProgressStyle::with_template("{spinner} {msg}, {elapsed}");
            bar.set_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner()));
            bar.set_elapsed(QUIET);
            loop {
                bar.set_message(text());
                bar.tick();
                if !goes_on(EVERY) {
                    break;
                }
            }
            bar.finish_and_clear();
        };
        Self {
            drawing: Some((end, std::thread::spawn(draw))),
        }
    }
}

impl Drop for Watch {
    fn drop(&mut self) {
        if let Some((end, thread)) = self.drawing.take() {
            drop(end);
            // If it panicked, there is no line to take away.
            drop(thread.join());
        }
    }
}
