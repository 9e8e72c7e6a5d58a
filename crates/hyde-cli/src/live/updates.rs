//! What is sent to open pages: that the files were loaded anew, as events of the server.

use std::io::Write;
use std::sync::{Condvar, Mutex, PoisonError};
use std::time::Duration;

/// A sign of life, so that a page that is gone is noticed.
const ALIVE: Duration = Duration::from_secs(15);

/// The number of times that the files were loaded.
#[derive(Default)]
pub(super) struct Updates {
    loaded: Mutex<u64>,
    changed: Condvar,
}

impl Updates {
    /// The files were loaded anew.
    pub(super) fn loaded(&self) {
        *self.loaded.lock().unwrap_or_else(PoisonError::into_inner) += 1;
        self.changed.notify_all();
    }

    /// Writes an event for each time that the files are loaded, until the reader is gone.
    pub(super) fn follow(&self, mut writer: Box<dyn Write + Send>) {
        let head = "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\n\
                    Cache-Control: no-store\r\nConnection: close\r\n\r\n";
        let mut send = |text: &str| {
            writer
                .write_all(text.as_bytes())
                .and_then(|()| writer.flush())
        };
        let mut known = *self.loaded.lock().unwrap_or_else(PoisonError::into_inner);
        let mut open = send(&format!("{head}: begin\n\n")).is_ok();
        while open {
            let guard = self.loaded.lock().unwrap_or_else(PoisonError::into_inner);
            let wait = self
                .changed
                .wait_timeout_while(guard, ALIVE, |now| *now == known);
            let now = *wait.unwrap_or_else(PoisonError::into_inner).0;
            open = match now == known {
                true => send(": alive\n\n").is_ok(),
                false => send(&format!("data: {now}\n\n")).is_ok(),
            };
            known = now;
        }
    }
}
