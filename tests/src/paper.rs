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
pub use table::{Row, models, rows};

use std::collections::BTreeMap;

/// How many rows the table has.
pub const ROWS: usize = 50;

/// Every row with what is wrong with it, in the order of the table. Each experiment runs once.
///
/// # Errors
/// The table or a model file cannot be read.
pub fn verdicts() -> Result<Vec<(Row, Result<(), String>)>, String> {
    let mut outcomes: BTreeMap<String, Result<(), String>> = BTreeMap::new();
    let tests = tests()?;
    let mut verdicts = Vec::new();
    for row in rows()? {
        let mut verdict = row.components_are_there();
        for name in &row.tests {
            let Some(test) = tests.iter().find(|test| test.name == *name) else {
                verdict = verdict.and(Err(format!("there is no test `{name}`")));
                continue;
            };
            let outcome = outcomes
                .entry(name.clone())
                .or_insert_with(|| test.passes());
            verdict = verdict.and(outcome.clone());
        }
        let text = |test: &&Test| row.tests.contains(&test.name);
        let texts: Vec<&str> = tests.iter().filter(text).map(|test| test.text()).collect();
        verdict = verdict.and(row.components_are_used(&texts));
        verdicts.push((row, verdict));
    }
    Ok(verdicts)
}
