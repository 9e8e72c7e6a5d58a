//! What the page asks for, one after the other on one thread. Of several runs that wait only the newest is made.

use super::session::{Moved, Session};
use super::updates::Updates;
use super::watched::{EVERY, Watched};
use serde_json::{Value, json};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::time::Duration;

/// How long the beginning of a run may take, so that a slider moves a curve at once.
const MOMENT: Duration = Duration::from_millis(60);

/// A wish of the page.
pub(super) enum Wish {
    /// Name, sliders, warnings.
    State,
    /// A run with these values.
    Run(Moved),
    /// Its beginning, as far as it comes in a moment.
    Begin(Moved),
    /// The natural frequencies with these values.
    Frequencies(Moved),
    /// These values in the file.
    Write(Moved),
}

/// Where the answer goes.
pub(super) type Answer = Box<dyn FnOnce(Value) + Send>;

/// The thread that owns the session.
#[derive(Clone)]
pub(super) struct Worker {
    wishes: Sender<(Wish, Answer)>,
    /// Ends a run that nobody waits for any more.
    interrupted: Arc<AtomicBool>,
}

impl Worker {
    /// Starts it.
    pub(super) fn start(session: Session, updates: Arc<Updates>) -> Self {
        let (wishes, asked) = channel();
        let interrupted: Arc<AtomicBool> = Arc::default();
        let flag = Arc::clone(&interrupted);
        std::thread::spawn(move || work(session, &asked, &flag, &updates));
        Self {
            wishes,
            interrupted,
        }
    }

    /// Asks for something; a run that is under way and would be followed by another one ends.
    pub(super) fn ask(&self, wish: Wish, answer: Answer) {
        if matches!(wish, Wish::Run(_) | Wish::Begin(_)) {
            self.interrupted.store(true, Ordering::Relaxed);
        }
        drop(self.wishes.send((wish, answer)));
    }
}

/// Answers a run that nobody waits for any more.
fn supersede(old: Option<(Moved, Option<Duration>, Answer)>) {
    if let Some((.., answer)) = old {
        answer(json!({ "ok": false, "superseded": true }));
    }
}

fn work(
    mut session: Session,
    wishes: &Receiver<(Wish, Answer)>,
    interrupted: &Arc<AtomicBool>,
    updates: &Updates,
) {
    let mut watched: Watched = session.watched();
    loop {
        let first = match wishes.recv_timeout(EVERY) {
            Ok(wish) => Some(wish),
            Err(RecvTimeoutError::Timeout) => None,
            Err(RecvTimeoutError::Disconnected) => return,
        };
        if watched.have_changed() {
            session.reload();
            watched = session.watched().before_reading(&watched);
            updates.loaded();
        }
        let mut newest: Option<(Moved, Option<Duration>, Answer)> = None;
        for (wish, answer) in first.into_iter().chain(wishes.try_iter()) {
            match wish {
                Wish::State => answer(session.state()),
                Wish::Frequencies(moved) => answer(session.frequencies(&moved)),
                Wish::Write(moved) => answer(session.write(&moved)),
                Wish::Run(moved) => supersede(newest.replace((moved, None, answer))),
                Wish::Begin(moved) => supersede(newest.replace((moved, Some(MOMENT), answer))),
            }
        }
        if let Some((moved, limit, answer)) = newest {
            interrupted.store(false, Ordering::Relaxed);
            let found = session.run(&moved, interrupted, limit);
            match interrupted.load(Ordering::Relaxed) {
                true => answer(json!({ "ok": false, "superseded": true })),
                false => answer(found),
            }
        }
    }
}
