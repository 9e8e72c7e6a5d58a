//! Benchmarks as a table: what Hyde has for each record, and below it what others published.

use super::{Benchmark, Published, Reason, Row};
use std::path::Path;

/// The table of a benchmark as text, with its sources, and where to put the records that are absent.
#[must_use]
pub fn words(benchmark: &Benchmark, rows: &[Row], folder: &Path) -> String {
    let mut out = format!("{}: {}\n", benchmark.name, benchmark.about);
    let head = ["".to_owned()]
        .into_iter()
        .chain(rows.iter().map(|row| row.record.to_owned()));
    let mut lines: Vec<Vec<String>> = vec![head.collect()];
    lines.push(own(rows));
    for published in benchmark.published {
        let figures = rows.iter().map(|row| figure(published, row.record));
        lines.push(
            [published.method.to_owned()]
                .into_iter()
                .chain(figures)
                .collect(),
        );
    }
    let width = |at: usize| lines.iter().map(|line| line[at].chars().count()).max();
    let widths: Vec<usize> = (0..=rows.len()).filter_map(width).collect();
    for line in &lines {
        let cells = line.iter().zip(&widths).enumerate();
        let cells = cells.map(|(at, (cell, width))| match at {
            0 => format!("{cell:<width$}"),
            _ => format!("{cell:>width$}"),
        });
        out.push_str(&format!(
            "  {}\n",
            cells.collect::<Vec<_>>().join("  ").trim_end()
        ));
    }
    let mut sources: Vec<&str> = benchmark.published.iter().map(|one| one.source).collect();
    sources.dedup();
    for source in sources {
        out.push_str(&format!("  published in: {source}\n"));
    }
    let mut reasons: Vec<&Reason> = rows
        .iter()
        .filter_map(|row| row.value.as_ref().err())
        .collect();
    reasons.dedup();
    for reason in reasons {
        out.push_str(&match reason {
            Reason::Absent(file) => format!(
                "  not measured: {file} is not at hand; put it into {}, examples/{}/README.md says where it is from\n",
                folder.display(),
                benchmark.name
            ),
            Reason::Failed(reason) => format!("  failed: {reason}\n"),
        });
    }
    out
}

/// The line of Hyde.
fn own(rows: &[Row]) -> Vec<String> {
    let fitted = rows.iter().map(|row| row.fitted).max().unwrap_or(0);
    let title = match fitted {
        0 => "Hyde".to_owned(),
        _ => format!("Hyde, {fitted} parameters fitted"),
    };
    let values = rows.iter().map(|row| match &row.value {
        Ok(value) => format!("{} {}", digits(*value), row.unit),
        Err(_) => "-".to_owned(),
    });
    [title].into_iter().chain(values).collect()
}

fn figure(published: &Published, record: &str) -> String {
    let figure = published.figures.iter().find(|(known, _)| *known == record);
    figure.map_or_else(|| "-".to_owned(), |(_, value)| value.to_string())
}

/// Three digits, as benchmarks print them.
fn digits(value: f64) -> String {
    match value.abs() {
        size if size < 0.0995 => format!("{value:.4}"),
        size if size < 0.9995 => format!("{value:.3}"),
        _ => format!("{value:.2}"),
    }
}
