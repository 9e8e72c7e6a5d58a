//! [`Texts`]: the texts of a column in one piece of memory. A record has millions of rows.

use std::ops::Index;

/// Texts row after row.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Texts {
    all: String,
    ends: Vec<usize>,
}

/// The length of an instant, about: `2026-11-25 14:03:07.123456` has 26 bytes, a number of seconds 5 to 15.
const USUAL: usize = 16;

impl Texts {
    /// Without rows, with room for about so many instants: what is not used of it is never touched.
    pub(crate) fn with_room(rows: usize) -> Self {
        Self {
            all: String::with_capacity(USUAL * rows),
            ends: Vec::with_capacity(rows),
        }
    }

    /// Appends a row.
    pub(crate) fn push(&mut self, text: &str) {
        self.all.push_str(text);
        self.ends.push(self.all.len());
    }

    /// Number of rows.
    pub(crate) fn len(&self) -> usize {
        self.ends.len()
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.ends.is_empty()
    }

    pub(crate) fn get(&self, row: usize) -> Option<&str> {
        (row < self.len()).then(|| &self[row])
    }

    pub(crate) fn first(&self) -> Option<&str> {
        self.get(0)
    }

    pub(crate) fn iter(&self) -> impl Iterator<Item = &str> {
        let mut start = 0;
        self.ends.iter().map(move |&end| {
            let text = &self.all[start..end];
            start = end;
            text
        })
    }
}

impl Index<usize> for Texts {
    type Output = str;

    fn index(&self, row: usize) -> &str {
        let start = row.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.all[start..self.ends[row]]
    }
}

impl<T: AsRef<str>> FromIterator<T> for Texts {
    fn from_iter<I: IntoIterator<Item = T>>(texts: I) -> Self {
        let mut all = Self::default();
        texts.into_iter().for_each(|text| all.push(text.as_ref()));
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_pushed_is_read() {
        let written = ["0", "", "0.25", "10:00:01 µ"];
        let texts: Texts = written.into_iter().collect();
        assert_eq!(texts.iter().collect::<Vec<_>>(), written);
        assert_eq!(&texts[2], "0.25");
        assert_eq!((texts.first(), texts.get(4)), (Some("0"), None));
        assert_eq!(texts.len(), 4);
        assert!(Texts::default().first().is_none());
    }
}
