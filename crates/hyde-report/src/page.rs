//! A page of sections: texts, verdicts, tables and figures, whatever the report is about.

use crate::{Diagram, Figure};

/// What one HTML file shows.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Page {
    /// Heading of the page.
    pub title: String,
    /// Pairs of name and value under the heading: model, experiment.
    pub facts: Vec<(String, String)>,
    /// In this order, each in the table of contents.
    pub sections: Vec<Section>,
    /// Last line: by what the page was made.
    pub footer: String,
}

/// A heading and what stands under it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// The heading.
    pub heading: String,
    /// From top to bottom.
    pub blocks: Vec<Block>,
}

impl Section {
    /// Sections by their headings, in this order; those without anything under them are left out.
    pub(crate) fn all<'a>(headings: impl IntoIterator<Item = (&'a str, Vec<Block>)>) -> Vec<Self> {
        headings
            .into_iter()
            .filter(|(_, blocks)| !blocks.is_empty())
            .map(|(heading, blocks)| Self {
                heading: heading.to_owned(),
                blocks,
            })
            .collect()
    }
}

/// One thing in a section.
#[derive(Clone, Debug, PartialEq)]
pub enum Block {
    /// A paragraph.
    Text(String),
    /// Text as it is written in a file.
    Code(String),
    /// Lines that say what held and what did not.
    Verdicts(Vec<Verdict>),
    /// A table.
    Table(Table),
    /// A figure; figures that follow each other stand side by side where there is room.
    Figure(Figure),
    /// Components and their connections.
    Diagram(Diagram),
}

/// A statement that was checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// How it came out.
    pub outcome: Outcome,
    /// The statement, with what was found.
    pub text: String,
}

/// How a [`Verdict`] came out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// It held.
    Passed,
    /// It did not.
    Failed,
    /// It was not checked; worth knowing.
    Note,
}

/// Rows under column heads.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    /// From left to right.
    pub columns: Vec<Column>,
    /// Cells as printed; a missing one is empty.
    pub rows: Vec<Vec<String>>,
    /// Printed below: how many rows were left out, what a column means.
    pub note: Option<String>,
}

/// A column of a [`Table`].
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its head.
    pub head: String,
    /// Where its cells stand.
    pub align: Align,
}

/// Where the cells of a column stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// Texts.
    Left,
    /// Numbers, in figures of one width.
    Right,
}

impl Table {
    /// A table without rows; a head that begins with `>` is a column of numbers: `["channel", ">rms"]`.
    #[must_use]
    pub fn with_columns(heads: &[&str]) -> Self {
        let column = |head: &&str| match head.strip_prefix('>') {
            Some(head) => Column {
                head: head.to_owned(),
                align: Align::Right,
            },
            None => Column {
                head: (*head).to_owned(),
                align: Align::Left,
            },
        };
        Self {
            columns: heads.iter().map(column).collect(),
            ..Self::default()
        }
    }
}
