//! [`Batch`]: several messages in one line, whose answers are one list. One version of the protocol has them,
//! [`WITH_BATCHES`]; later ones removed them.

use serde_json::Value;
use std::sync::{Mutex, PoisonError};

/// The version of the protocol that has batches.
pub(crate) const WITH_BATCHES: &str = "2025-03-26";

/// The answers to the messages of a line until all are there.
pub(crate) struct Batch(Mutex<Answers>);

/// What there is of the answers, and how many messages are not worked off.
struct Answers {
    there: Vec<Value>,
    missing: usize,
}

impl Batch {
    /// Of so many messages.
    pub(crate) fn of(messages: usize) -> Self {
        Self(Mutex::new(Answers {
            there: Vec::new(),
            missing: messages,
        }))
    }

    /// Takes the answer to one message, or that it has none; gives back the list after the last one, unless it is empty.
    pub(crate) fn take(&self, answer: Option<Value>) -> Option<Value> {
        let mut own = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        own.there.extend(answer);
        own.missing = own.missing.saturating_sub(1);
        let is_whole = own.missing == 0 && !own.there.is_empty();
        is_whole.then(|| Value::Array(std::mem::take(&mut own.there)))
    }
}
