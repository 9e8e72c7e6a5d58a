//! The table of thresholds in the book: [`in_book`] makes it of the table in the sources and of what was measured.

use super::change::Change;
use super::results::{Result as Row, Results};
use hyde_calibrate::{TABLE, Threshold};
use std::fmt::Write as _;

/// The line of the book before the table.
pub const BEGIN: &str = "<!-- The table is made by `./dev ablation --book`. -->";
/// The line behind it.
pub const END: &str = "<!-- End of the table. -->";

/// The table.
#[must_use]
pub fn in_book(results: &Results) -> String {
    let mut text = "| Threshold | Value | Meaning | Reason for the value | Without it |\n|---|---|---|---|---|\n".to_owned();
    for threshold in TABLE {
        let _ = writeln!(
            text,
            "| `{}` | {} | {} | {} | {} |",
            threshold.name,
            number(threshold.value),
            sentence(threshold.meaning),
            sentence(threshold.reason),
            effect(threshold, results)
        );
    }
    text
}

/// Thresholds without a reason, or whose removal was never measured.
#[must_use]
pub fn unreasoned(results: &Results) -> Vec<&'static str> {
    let lacks = |threshold: &&Threshold| {
        threshold.reason.trim().is_empty() || pairs(threshold, results).is_empty()
    };
    TABLE.iter().filter(lacks).map(|own| own.name).collect()
}

/// What was measured without a threshold, each beside what the method has on the same suite.
fn pairs<'r>(threshold: &Threshold, results: &'r Results) -> Vec<(&'r Row, &'r Row)> {
    let own = results.rows.iter();
    let own = own.filter(|row| row.change == threshold.name);
    own.filter_map(|row| Some((row, results.of(Change::METHOD, &row.suite)?)))
        .collect()
}

/// What the removal of a threshold does, in words.
fn effect(threshold: &Threshold, results: &Results) -> String {
    let pairs = pairs(threshold, results);
    if pairs.is_empty() {
        return "not measured".to_owned();
    }
    let sum = |of: &dyn Fn(&Row) -> usize| {
        let without: usize = pairs.iter().map(|(row, _)| of(row)).sum();
        let with: usize = pairs.iter().map(|(_, row)| of(row)).sum();
        (without, with)
    };
    let (cases, _) = sum(&|row| row.cases);
    let (right, right_before) = sum(&|row| row.right);
    let (alarms, alarms_before) = sum(&|row| row.false_alarms);
    let seconds = |row: fn(&(&Row, &Row)) -> f64| -> f64 { pairs.iter().map(row).sum() };
    let times = seconds(|pair| pair.0.seconds) / seconds(|pair| pair.1.seconds);
    let same = pairs.iter().all(|(a, b)| a.answers == b.answers);
    let answers = match same {
        true => format!("the same answers in {cases} cases"),
        false => format!(
            "right {right} instead of {right_before} of {cases}, false alarms {alarms} instead of {alarms_before}"
        ),
    };
    format!(
        "at {}: {answers}, {} times the time",
        number(threshold.removed),
        hyde_units::significant(times, 2)
    )
}

/// A number as the book writes it.
fn number(value: f64) -> String {
    match value.is_infinite() {
        true => "∞".to_owned(),
        false => hyde_units::significant(value, 4),
    }
}

/// The first letter large, no stop at the end.
fn sentence(text: &str) -> String {
    let text = text.trim().trim_end_matches('.');
    let mut letters = text.chars();
    match letters.next() {
        Some(first) => first.to_uppercase().chain(letters).collect(),
        None => String::new(),
    }
}
