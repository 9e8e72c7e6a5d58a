//! Events without end: a ball that bounces ever lower meets infinitely many in a finite time.

/// Events that follow each other faster and faster.
#[derive(Default)]
pub(crate) struct Hurry {
    /// Time of the last event in s.
    last: f64,
    /// The first interval of the run of ever shorter ones, the latest, and their number.
    first: f64,
    interval: f64,
    count: u64,
}

impl Hurry {
    /// Takes note of an event; whether a long run of ever shorter intervals has come down to nothing.
    pub(crate) fn no_end(&mut self, t: f64) -> bool {
        let interval = t - self.last;
        if interval < self.interval {
            self.count += 1;
        } else {
            (self.first, self.count) = (interval, 0);
        }
        (self.last, self.interval) = (t, interval);
        self.count >= 12 && interval < 1e-4 * self.first
    }
}
