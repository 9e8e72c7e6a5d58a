//! The diagnosis on a terminal: lines of at most 80 columns, in the order of the page.

use super::{Diagnosed, named, suspicion, verdict};
use crate::comparison;
use crate::unknown;
use hyde_calibrate::{Relation, ResidualMap};
use hyde_units::{Unit, significant};
use hyde_units::{drawn_in, shown};
use std::fmt::Write as _;

/// Columns of a terminal.
const WIDTH: usize = 80;
/// What was tried is listed so far; the report has all.
const TRIED: usize = 12;
/// Maps are listed so far.
const MAPS: usize = 6;

/// The whole text.
pub fn text(told: &Diagnosed<'_>) -> String {
    let mut out = String::new();
    wrapped(
        &mut out,
        &format!("{}: ", told.plan.name),
        &verdict::sentence(told),
    );
    for line in [verdict::grounds(told), verdict::doubts(told)].concat() {
        wrapped(&mut out, "  - ", &line);
    }
    findings(&mut out, told);
    if let Some(own) = &told.found.unknown {
        out.push_str(&unknown::text(own, told.found));
    }
    out.push('\n');
    out.push_str(&comparison::text(&told.errors, told.calibration));
    left(&mut out, told);
    parameters(&mut out, told);
    tried(&mut out, told);
    out
}

fn findings(out: &mut String, told: &Diagnosed<'_>) {
    for finding in &told.found.findings {
        let _ = writeln!(out, "\n  {}", named(&told.hypotheses[finding.hypothesis]));
        for quantity in finding.told_sizes().iter().chain(&finding.shapes) {
            let _ = writeln!(out, "    {}", verdict::quantity(quantity));
        }
        for other in finding.related(Relation::Another) {
            wrapped(out, "    or ", &verdict::alternative(told, other));
        }
    }
}

/// What is left depends on: the maps that leave their band.
fn left(out: &mut String, told: &Diagnosed<'_>) {
    let beyond = |map: &&ResidualMap| map.excess.0.max(map.excess.1) > 1.0;
    let shown: Vec<&ResidualMap> = told.maps.iter().filter(beyond).take(MAPS).collect();
    if shown.is_empty() {
        out.push_str("\n  the innovations depend on no measured quantity\n");
        return;
    }
    let _ = writeln!(
        out,
        "\n  {:<40} {:>8} {:>8}   up to 1: chance",
        "the innovations depend on", "before", "after"
    );
    for map in shown {
        let name = format!("{} over {}", map.channel, map.over);
        let _ = writeln!(
            out,
            "  {:<40} {:>8} {:>8}",
            comparison::shortened(&name, 40),
            significant(map.excess.0, 2),
            significant(map.excess.1, 2)
        );
    }
}

fn parameters(out: &mut String, told: &Diagnosed<'_>) {
    let program = &told.calibration.compiled.program;
    let _ = writeln!(
        out,
        "\n  {:<18} {:>10} {:>10} {:>10} {:>8} unit",
        "parameter", "declared", "before", "after", "±"
    );
    for (old, new) in &told.parameters {
        let unit = program.parameter(&new.name).map(|(own, _)| &own.unit);
        let (unit, of) = unit.map_or((String::new(), Unit::ONE), drawn_in);
        let unit = shown(&unit);
        let half = of.scale.remove((new.interval.1 - new.interval.0) / 2.0);
        let value = of.from_si(new.value);
        let line = format!(
            "  {:<18} {:>10} {:>10} {:>10} {:>8} {unit}",
            comparison::shortened(&new.name, 18),
            significant(of.from_si(new.nominal), 4),
            significant(of.from_si(old.value), 4),
            significant(value, 4),
            comparison::spread(half, value, |half| significant(half, 2)),
        );
        let _ = writeln!(out, "{}", line.trim_end());
        if !suspicion(new).is_empty() {
            let _ = writeln!(out, "      {}", suspicion(new));
        }
    }
}

fn tried(out: &mut String, told: &Diagnosed<'_>) {
    let all = told.tried();
    if all.is_empty() {
        return;
    }
    let _ = writeln!(
        out,
        "\n  {:<25} {:^19}  {:<20} smallest\n  {:<25} {:>9} {:>9}  {:<20} detectable",
        "tried and rejected", "improvement", "", "", "predicted", "fitted", "reason"
    );
    for tried in all.iter().take(TRIED) {
        let size = tried.hypothesis.sizes.first();
        let seen = tried
            .score
            .detectable
            .zip(size)
            .map(|(value, size)| verdict::number(value, 2, &size.unit));
        let line = format!(
            "  {:<25} {:>9} {:>9}  {:<20} {}",
            comparison::shortened(&named(tried.hypothesis), 25),
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
            "  and {} more: see `--out DIR` or `--json`",
            all.len() - TRIED
        );
    }
}

/// A paragraph within the width, its later lines as far in as its first words.
pub fn wrapped(out: &mut String, head: &str, words: &str) {
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
