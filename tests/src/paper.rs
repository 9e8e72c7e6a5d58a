//! The paper that Hyde's drives come from, as a table of the book: `book/src/paper.md` has a row for every element and
//! equation, with the components of the library that are it and the experiments of `tests/models/paper` that test them.
//!
//! An experiment there passes where all it `expect`s holds. One may have natural frequencies instead, in a comment:
//! ```text
//! // modes of middle: 34.69 87.84 180.00 Hz within 0.05 %
//! ```

mod experiment;
mod table;

pub use experiment::{Test, tests};
pub use table::{Row, drives, rows};

use std::collections::BTreeMap;

/// How many rows the table has.
pub const ROWS: usize = 51;

/// A row and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// The row.
    pub row: Row,
    /// What is wrong with it.
    pub outcome: Result<(), String>,
}

/// Every row with what came of it, in the order of the table. Each experiment runs once.
///
/// # Errors
/// The table or a model file cannot be read.
pub fn verdicts() -> Result<Vec<Verdict>, String> {
    let mut outcomes: BTreeMap<String, Result<(), String>> = BTreeMap::new();
    let tests = tests()?;
    let mut verdicts = Vec::new();
    for row in rows()? {
        let mut outcome = row.components_are_there();
        for name in &row.tests {
            let Some(test) = tests.iter().find(|test| test.name == *name) else {
                outcome = outcome.and(Err(format!("there is no test `{name}`")));
                continue;
            };
            let passes = outcomes
                .entry(name.clone())
                .or_insert_with(|| test.passes());
            outcome = outcome.and(passes.clone());
        }
        let text = |test: &&Test| row.tests.contains(&test.name);
        let texts: Vec<&str> = tests.iter().filter(text).map(|test| test.text()).collect();
        outcome = outcome.and(row.components_are_used(&texts));
        verdicts.push(Verdict { row, outcome });
    }
    Ok(verdicts)
}
