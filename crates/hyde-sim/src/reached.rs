//! [`Reached`]: how far a long computation is, for another thread to show.

use std::sync::atomic::{AtomicU64, Ordering};

/// How far a computation is, and its end, in one unit: the time of a run in s, or a count. Both are 0 before it begins.
#[derive(Debug, Default)]
pub struct Reached {
    now: AtomicU64,
    end: AtomicU64,
}

impl Reached {
    /// How far it is, and its end.
    #[must_use]
    pub fn get(&self) -> (f64, f64) {
        let of = |number: &AtomicU64| f64::from_bits(number.load(Ordering::Relaxed));
        (of(&self.now), of(&self.end))
    }

    /// Says how far it is.
    pub fn set(&self, now: f64, end: f64) {
        self.now.store(now.to_bits(), Ordering::Relaxed);
        self.end.store(end.to_bits(), Ordering::Relaxed);
    }
}
