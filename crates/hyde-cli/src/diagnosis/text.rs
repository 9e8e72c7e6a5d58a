//! The diagnosis on a terminal: lines of at most 80 columns, in the order of the page.

use super::{Told, named, suspicion, verdict};
use crate::before_after;
use crate::unknown;
use hyde_units::{engineering, significant};
use std::fmt::Write as _;

/// Columns of a terminal.
const WIDTH: usize = 80;
/// What was tried is listed so far; the report has all.
const TRIED: usize = 12;

/// The whole text.
pub(crate) fn text(told: &Told<'_>) -> String {
    let mut out = String::new();
    wrapped(
        &mut out,
        &format!("{}: ", told.plan.name),
        &verdict::sentence(told),
    );
    for doubt in verdict::doubts(told) {
        wrapped(&mut out, "  - ", &doubt);
    }
    findings(&mut out, told);
    if let Some(own) = &told.found.unknown {
        out.push_str(&unknown::text(own, told.found));
    }
    out.push('\n');
    out.push_str(&before_after::text(&told.errors, told.calibration));
    parameters(&mut out, told);
    tried(&mut out, told);
    out
}

fn findings(out: &mut String, told: &Told<'_>) {
    for finding in &told.found.findings {
        let _ = writeln!(out, "\n  {}", named(&told.hypotheses[finding.hypothesis]));
        for quantity in std::iter::once(&finding.size).chain(&finding.shapes) {
            let _ = writeln!(out, "    {}", verdict::quantity(quantity));
        }
        for &other in &finding.alternatives {
            let _ = writeln!(out, "    or {}", named(&told.hypotheses[other]));
        }
    }
}

fn parameters(out: &mut String, told: &Told<'_>) {
    let program = &told.calibration.compiled.program;
    let _ = writeln!(
        out,
        "\n  {:<18} {:>11} {:>11} {:>11} {:>8}",
        "parameter", "declared", "before", "after", "±"
    );
    for (old, new) in &told.parameters {
        let dimension = program.parameter(&new.name).map(|(p, _)| p.dimension);
        let number =
            |value: f64| dimension.map_or_else(|| significant(value, 4), |d| engineering(value, d));
        let half = (new.interval.1 - new.interval.0) / 2.0;
        let part = significant(100.0 * (half / new.value).abs(), 2);
        let line = format!(
            "  {:<18} {:>11} {:>11} {:>11} {:>8}  {}",
            new.name,
            number(new.nominal),
            number(old.value),
            number(new.value),
            format!("{part} %"),
            suspicion(new)
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
}

fn tried(out: &mut String, told: &Told<'_>) {
    let all = told.tried();
    if all.is_empty() {
        return;
    }
    let _ = writeln!(
        out,
        "\n  {:<32} {:>8} {:>8}  {:<14} would be seen",
        "tried and rejected", "score", "gain", "because"
    );
    for tried in all.iter().take(TRIED) {
        let size = tried.hypothesis.sizes.first();
        let seen = tried.score.detectable.zip(size).map(|(value, size)| {
            let unit = if size.unit == "1" { "" } else { &size.unit };
            format!("{} {unit}", significant(value, 2))
        });
        let line = format!(
            "  {:<32} {:>8} {:>8}  {:<18} {}",
            before_after::shortened(&named(tried.hypothesis), 32),
            significant(tried.score.gain(), 3),
            tried
                .trial
                .map_or_else(String::new, |trial| significant(trial.gain, 3)),
            tried.reason(),
            seen.unwrap_or_default()
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
    if all.len() > TRIED {
        let _ = writeln!(
            out,
            "  and {} more: `--out DIR` or `--json` has them",
            all.len() - TRIED
        );
    }
}

/// A paragraph within the width, its later lines as far in as its first words.
fn wrapped(out: &mut String, head: &str, words: &str) {
    let indent = " ".repeat(if head.starts_with(' ') { head.len() } else { 2 });
    let mut line = head.trim_end().to_owned();
    let mut fresh = true;
    for word in words.split(' ') {
        if !fresh && line.chars().count() + 1 + word.chars().count() > WIDTH {
            let _ = writeln!(out, "{line}");
            line = format!("{indent}{word}");
        } else {
            line.push(' ');
            line.push_str(word);
        }
        fresh = false;
    }
    let _ = writeln!(out, "{line}");
}
