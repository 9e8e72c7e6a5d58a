//! The table of the paper in the book: every row's component and test exist and the test passes, and nothing of the drive
//! library or of the tests is without a row.

use hyde_tests::paper;
use std::collections::BTreeSet;

#[test]
fn every_row_of_the_table_passes() {
    let verdicts = paper::verdicts().unwrap();
    let wrong: Vec<String> = verdicts
        .iter()
        .filter_map(|verdict| {
            let told = verdict.outcome.as_ref().err()?;
            Some(format!("{}: {told}", verdict.row.element))
        })
        .collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(verdicts.len(), paper::ROWS);
}

#[test]
fn every_component_and_every_test_has_a_row() {
    let rows = paper::rows().unwrap();
    let in_rows: BTreeSet<&str> = rows
        .iter()
        .flat_map(|row| row.components.iter().chain(&row.tests))
        .map(String::as_str)
        .collect();
    let tests = paper::tests().unwrap();
    let all = tests.into_iter().map(|test| test.name);
    let all = all.chain(paper::drives().unwrap());
    let missing: Vec<String> = all
        .filter(|name| !in_rows.contains(name.as_str()))
        .collect();
    assert!(missing.is_empty(), "without a row: {}", missing.join(", "));
}
