//! Tests as a table.

use hyde_study::experiment_tests::Tested;

/// The tests of a file, one a line.
#[must_use]
pub fn table(place: &str, tests: &[Tested]) -> String {
    let width = tests.iter().map(|test| test.name.chars().count()).max();
    let width = width.unwrap_or(0).max(20);
    let lines: Vec<String> = tests
        .iter()
        .map(|test| {
            format!(
                "  {:<8}{:<width$}  {}",
                test.verdict.word(),
                test.name,
                test.found
            )
        })
        .collect();
    format!("{place}\n{}", lines.join("\n"))
}
