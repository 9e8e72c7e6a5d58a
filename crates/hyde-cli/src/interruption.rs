//! Ctrl-C: a command that keeps what is finished asks for it and ends by itself; any other ends at once, with the same status.

use crate::exit::Exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// Set by Ctrl-C while a command holds it. A process has one handler of signals, and this is what it knows.
static ASKED: Mutex<Weak<AtomicBool>> = Mutex::new(Weak::new());

/// From here on Ctrl-C ends the process with the status of an interrupted command, unless a command has [asked](interrupted)
/// for it; a second Ctrl-C ends it whatever it does.
#[allow(
    clippy::exit,
    reason = "a command that did not ask is in the middle of something"
)]
pub(crate) fn watch() {
    // Without a handler the signal ends the process, as ever.
    let _handled = ctrlc::set_handler(|| {
        let asked = ASKED.lock().unwrap_or_else(PoisonError::into_inner);
        match asked.upgrade() {
            Some(asked) if !asked.swap(true, Ordering::Relaxed) => {}
            Some(_) | None => std::process::exit(i32::from(Exit::Interrupted as u8)),
        }
    });
}

/// The flag that Ctrl-C sets as long as somebody holds it.
pub(crate) fn interrupted() -> Arc<AtomicBool> {
    let mut asked = ASKED.lock().unwrap_or_else(PoisonError::into_inner);
    asked.upgrade().unwrap_or_else(|| {
        let flag = Arc::default();
        *asked = Arc::downgrade(&flag);
        flag
    })
}
