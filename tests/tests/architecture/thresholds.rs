//! Every number that decides an answer of a diagnosis is in one table, which the book shows.

use hyde_calibrate::TABLE;
use hyde_tests::ablation::{BEGIN, END, Results, in_book, outside_the_table};

#[test]
fn no_number_decides_outside_the_table() {
    let outside = outside_the_table().unwrap();
    assert!(
        outside.is_empty(),
        "add to `Thresholds`, or mark as `Numerics:` what only says how finely something is computed: {}",
        outside.join(", ")
    );
}

#[test]
fn every_threshold_has_a_reason_and_another_value_that_removes_it() {
    for threshold in TABLE {
        assert!(!threshold.meaning.trim().is_empty(), "{}", threshold.name);
        assert!(threshold.reason.len() > 10, "{}", threshold.name);
        let same = threshold.removed.to_bits() == threshold.value.to_bits();
        assert!(!same, "{}", threshold.name);
    }
}

#[test]
fn the_book_has_the_table() {
    let page = super::read(&super::top().join("book/src/how/diagnosis.md"));
    let (_, rest) = page.split_once(BEGIN).unwrap();
    let (table, _) = rest.split_once(END).unwrap();
    let results = Results::read().unwrap();
    assert_eq!(
        table.trim(),
        in_book(&results).trim(),
        "`./dev ablation --book` makes it"
    );
}
