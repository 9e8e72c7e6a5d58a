//! [`Series`]: the values of a quantity row after row, in which a value that stays takes a bit.
//!
//! A run under a clock has two rows at each tick, and most quantities jump at none of them; others change at ticks alone, or
//! never.

use std::borrow::Cow;

/// Bits in a word.
const WORD: usize = u64::BITS as usize;

/// Values are kept in pieces of so many: a piece that is full stays where it is.
const PIECE: usize = 1 << 16;

/// Values of rows; those equal to the row before to the last bit are not kept again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// The values that differ from those before: full pieces, and the last one.
    full: Vec<Vec<f64>>,
    last: Vec<f64>,
    /// A bit for each row: whether its value is another than that of the row before.
    new: Vec<u64>,
    rows: usize,
}

impl Series {
    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Appends a row.
    pub fn push(&mut self, value: f64) {
        let same = |last: &f64| last.to_bits() == value.to_bits();
        if self.last.len() == PIECE && !self.last.last().is_some_and(same) {
            self.full.push(std::mem::take(&mut self.last));
        }
        if self.rows.is_multiple_of(WORD) {
            self.new.push(0);
        }
        if !self.last.last().is_some_and(same) {
            self.last.push(value);
            if let Some(word) = self.new.last_mut() {
                *word |= 1 << (self.rows % WORD);
            }
        }
        self.rows += 1;
    }

    /// The values of all rows; nothing is copied of a short run in which each differs from the one before.
    #[must_use]
    pub fn values(&self) -> Cow<'_, [f64]> {
        match self.last.len() == self.rows {
            true => Cow::Borrowed(&self.last),
            false => self.iter().collect(),
        }
    }

    /// The values row after row.
    pub fn iter(&self) -> impl Iterator<Item = f64> {
        let (mut steps, mut value) = (self.steps(), f64::NAN);
        (0..self.rows).map(move |_| {
            value = steps.step().unwrap_or(value);
            value
        })
    }

    /// What is new in the rows, row after row.
    pub(crate) fn steps(&self) -> Steps<'_> {
        Steps {
            new: self.new.iter(),
            word: 0,
            left: 0,
            piece: [].iter(),
            others: self.full.iter(),
            last: Some(&self.last),
        }
    }

    /// Takes all rows out.
    pub fn clear(&mut self) {
        *self = Self::default();
    }
}

/// A series on its way from the first row to the last.
pub(crate) struct Steps<'s> {
    new: std::slice::Iter<'s, u64>,
    /// Bits of the rows to come, and how many these are.
    word: u64,
    left: usize,
    piece: std::slice::Iter<'s, f64>,
    others: std::slice::Iter<'s, Vec<f64>>,
    last: Option<&'s [f64]>,
}

impl Steps<'_> {
    /// The value of the next row, if it is another than that of the row before.
    pub(crate) fn step(&mut self) -> Option<f64> {
        if self.left == 0 {
            (self.word, self.left) = (*self.new.next()?, WORD);
        }
        let new = self.word & 1 == 1;
        self.word >>= 1;
        self.left -= 1;
        new.then(|| self.value()).flatten()
    }

    fn value(&mut self) -> Option<f64> {
        if self.piece.as_slice().is_empty() {
            let next = self.others.next().map(Vec::as_slice);
            self.piece = next.or_else(|| self.last.take())?.iter();
        }
        self.piece.next().copied()
    }
}

impl FromIterator<f64> for Series {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut series = Self::default();
        values.into_iter().for_each(|value| series.push(value));
        series
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_pushed_is_read() {
        for values in [
            vec![],
            vec![1.0, 2.0, 3.0],
            vec![0.0; 200],
            (0..300).map(|row| f64::from(row / 2)).collect(),
            (0..400_000).map(|row| f64::from(row / 3)).collect(),
            vec![0.0, -0.0, f64::NAN, f64::NAN, 1.0, 1.0, 0.0],
        ] {
            let series: Series = values.iter().copied().collect();
            let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(&series.values()), bits(&values));
            assert_eq!(series.len(), values.len());
        }
        let moving: Series = [1.0, 2.0].into_iter().collect();
        assert!(matches!(moving.values(), Cow::Borrowed(_)));
    }
}
