//! Reads a sampled signal between its rows.

/// Values over instants: one column of a record.
///
/// All readings are right-continuous: at an instant that has a row they give that row, and of several rows at one
/// instant the last. Before the first row they give the first, after the last row the last. Times are finite.
#[derive(Clone, Copy, Debug)]
pub struct Signal<'a> {
    time: &'a [f64],
    values: &'a [f64],
}

/// Remembers the row last read, so that reading along a run does not search. All signals of a table may share one.
///
/// Reading forwards costs a step or two on average, jumping costs a bisection. Every cursor gives the same answers.
#[derive(Clone, Copy, Debug, Default)]
pub struct Cursor {
    row: usize,
}

impl<'a> Signal<'a> {
    /// The signal with these values at these instants (s, never running back); none if the lengths differ or are 0.
    #[must_use]
    pub fn new(time: &'a [f64], values: &'a [f64]) -> Option<Self> {
        (time.len() == values.len() && !time.is_empty()).then_some(Self { time, values })
    }

    /// The value held since the last row at or before `t` (s).
    #[must_use]
    pub fn held(&self, t: f64, cursor: &mut Cursor) -> f64 {
        self.values[cursor.seek(self.time, t).unwrap_or(0)]
    }

    /// The value one row ahead of the row that [`held`](Self::held) reads at `t` (s); the last one at the end.
    #[must_use]
    pub fn next(&self, t: f64, cursor: &mut Cursor) -> f64 {
        let row = cursor.seek(self.time, t).unwrap_or(0);
        self.values[(row + 1).min(self.values.len() - 1)]
    }

    /// The value on the straight line between the rows round `t` (s).
    #[must_use]
    pub fn linear(&self, t: f64, cursor: &mut Cursor) -> f64 {
        let Some(row) = cursor.seek(self.time, t) else {
            return self.values[0];
        };
        let Some(&after) = self.values.get(row + 1) else {
            return self.values[row];
        };
        // The row is the last at or before t, so the next one is later and the division is safe.
        let (start, end) = (self.time[row], self.time[row + 1]);
        self.values[row] + (after - self.values[row]) * ((t - start) / (end - start))
    }

    /// The first instant of a row after `t` (s): where a held signal may change next. None from the last row on.
    #[must_use]
    pub fn next_instant(&self, t: f64, cursor: &mut Cursor) -> Option<f64> {
        let next = cursor.seek(self.time, t).map_or(0, |row| row + 1);
        self.time.get(next).copied()
    }

    /// The instants that have several rows with different values: where a linear signal jumps.
    pub fn jumps(&self) -> impl Iterator<Item = f64> + 'a {
        let Self { time, values } = *self;
        let is_jump = move |row: &usize| {
            let same_instant = time[*row].total_cmp(&time[row - 1]).is_eq();
            same_instant && values[*row].total_cmp(&values[row - 1]).is_ne()
        };
        (1..time.len()).filter(is_jump).map(move |row| time[row])
    }
}

impl Cursor {
    /// The last row at or before `t` in `time`; none if `t` is before the first.
    pub fn seek(&mut self, time: &[f64], t: f64) -> Option<usize> {
        let from = self.row.min(time.len());
        let near = time.len().min(from + NEAR);
        let later = if from > 0 && time[from - 1] > t {
            time[..from].partition_point(|&instant| instant <= t)
        } else if let Some(ahead) = time[from..near].iter().position(|&instant| instant > t) {
            from + ahead
        } else {
            near + time[near..].partition_point(|&instant| instant <= t)
        };
        self.row = later;
        later.checked_sub(1)
    }
}

/// Rows to look at ahead of the cursor before bisecting.
const NEAR: usize = 4;

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "rows are read as they are")]
mod tests {
    use super::*;

    /// A step at 1 s: two rows.
    const TIME: [f64; 5] = [0.0, 0.5, 1.0, 1.0, 3.0];
    const VALUES: [f64; 5] = [10.0, 20.0, 30.0, 50.0, 70.0];

    type Read = fn(&Signal<'_>, f64, &mut Cursor) -> f64;

    fn check(read: Read, expected: &[(f64, f64)]) {
        let signal = Signal::new(&TIME, &VALUES).unwrap();
        let mut cursor = Cursor::default();
        for (t, value) in expected {
            assert_eq!(read(&signal, *t, &mut cursor), *value, "forwards at {t}");
        }
        for (t, value) in expected.iter().rev() {
            assert_eq!(read(&signal, *t, &mut cursor), *value, "backwards at {t}");
            assert_eq!(
                read(&signal, *t, &mut Cursor::default()),
                *value,
                "afresh at {t}"
            );
        }
    }

    #[test]
    fn held_reads_the_row_at_the_instant() {
        check(
            |signal, t, cursor| signal.held(t, cursor),
            &[
                (-1.0, 10.0),
                (0.0, 10.0),
                (0.4, 10.0),
                (0.5, 20.0),
                (0.9, 20.0),
                (1.0, 50.0),
                (3.0, 70.0),
                (9.0, 70.0),
            ],
        );
    }

    #[test]
    fn next_is_one_row_ahead_and_held_at_the_end() {
        check(
            |signal, t, cursor| signal.next(t, cursor),
            &[
                (-1.0, 20.0),
                (0.0, 20.0),
                (0.4, 20.0),
                (0.5, 30.0),
                (1.0, 70.0),
                (2.9, 70.0),
                (3.0, 70.0),
                (9.0, 70.0),
            ],
        );
    }

    #[test]
    fn linear_runs_between_rows_and_jumps_at_a_repeated_one() {
        check(
            |signal, t, cursor| signal.linear(t, cursor),
            &[
                (-1.0, 10.0),
                (0.0, 10.0),
                (0.25, 15.0),
                (0.75, 25.0),
                (1.0, 50.0),
                (2.0, 60.0),
                (3.0, 70.0),
                (9.0, 70.0),
            ],
        );
        let signal = Signal::new(&TIME, &VALUES).unwrap();
        let before = signal.linear(1.0 - 1e-12, &mut Cursor::default());
        // The slope there is 20 per second.
        assert!((before - 30.0).abs() < 1e-10);
        assert_eq!(signal.jumps().collect::<Vec<_>>(), [1.0]);
    }

    #[test]
    fn the_next_instant_skips_repeated_rows() {
        let signal = Signal::new(&TIME, &VALUES).unwrap();
        let next = |t| signal.next_instant(t, &mut Cursor::default());
        assert_eq!(next(-1.0), Some(0.0));
        assert_eq!(next(0.0), Some(0.5));
        assert_eq!(next(0.7), Some(1.0));
        assert_eq!(next(1.0), Some(3.0));
        assert_eq!(next(3.0), None);
    }

    #[test]
    fn any_cursor_gives_the_same_row() {
        let time: Vec<f64> = (0..200).map(|k| f64::from(k / 3)).collect();
        let mut cursor = Cursor::default();
        for k in 0..2000_u32 {
            // Jumps all over the record, half of them on rows.
            let t = f64::from(k * 7919 % 150) / 2.0 - 2.0;
            let plain = time.iter().rposition(|&instant| instant <= t);
            assert_eq!(cursor.seek(&time, t), plain, "at {t}");
        }
    }

    #[test]
    fn a_cursor_of_a_longer_record_is_no_danger() {
        let mut cursor = Cursor { row: 1000 };
        assert_eq!(cursor.seek(&TIME, 0.6), Some(1));
        assert!(Signal::new(&[], &[]).is_none());
        assert!(Signal::new(&TIME, &VALUES[1..]).is_none());
    }
}
