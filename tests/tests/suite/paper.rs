//! The table of the paper in the book: every row's component and test exist and the test passes, and nothing of the drive
//! library or of the tests is without a row.

use hyde_tests::{paper, root};
use std::collections::BTreeSet;

#[test]
fn every_row_of_the_table_passes() {
    let verdicts = paper::verdicts().unwrap();
    let wrong: Vec<String> = verdicts
        .iter()
        .filter_map(|(row, verdict)| {
            let told = verdict.as_ref().err()?;
            Some(format!("{}: {told}", row.element))
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
    let mut missing = Vec::new();
    for test in paper::tests().unwrap() {
        if !in_rows.contains(test.name.as_str()) {
            missing.push(test.name);
        }
    }
    let folder = root().join("crates/hyde-library/models/Drives");
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let package = path.file_stem().unwrap().to_string_lossy().into_owned();
        let text = std::fs::read_to_string(&path).unwrap();
        for name in paper::models(&text) {
            let name = format!("Drives.{package}.{name}");
            if !in_rows.contains(name.as_str()) {
                missing.push(name);
            }
        }
    }
    assert!(missing.is_empty(), "without a row: {}", missing.join(", "));
}
