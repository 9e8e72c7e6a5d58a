//! A self-test in lines of at most 80 columns.

use super::json::{shown, sums};
use crate::lines::wrapped;
use hyde_calibrate::{Designed, Found, Planting, Row};
use hyde_study::diagnosis::verdict;
use hyde_study::selftest::Tested;
use hyde_units::significant;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The widest line.
const WIDTH: usize = 80;

/// The tables.
pub fn text(told: &Tested<'_>) -> String {
    let mut out = String::new();
    let sizes: Vec<String> = told.asked.sizes.iter().map(|&size| shown(size)).collect();
    let _ = writeln!(
        out,
        "{}: {} simulated data sets, seed {}",
        told.plan.name,
        told.outcomes.len(),
        told.seed
    );
    if !told.table.rows.is_empty() {
        let _ = writeln!(
            out,
            "\n  planted at {} of the range; `2x` is twice the smallest detectable size\n",
            sizes.join(", ")
        );
        let _ = writeln!(
            out,
            "  {:<35} {:>7} {:>10} {:>9}  mistaken for",
            "effect", "right", "detectable", "hidden"
        );
        for row in &told.table.rows {
            line(&mut out, told, row);
        }
        let (visible, right) = sums(told);
        let percent = 100.0 * right as f64 / (visible as f64).max(1.0);
        let _ = writeln!(
            out,
            "\n  correct effect and site ranked first: {right} of {visible} detectable, {} %",
            significant(percent, 3)
        );
    }
    controls(&mut out, told);
    designed(&mut out, told);
    refused(&mut out, told);
    out
}

fn line(out: &mut String, told: &Tested<'_>, row: &Row) {
    let hypothesis = &told.hypotheses[row.hypothesis];
    let seen = row.detectable.zip(hypothesis.sizes.first());
    let from = seen.map_or_else(String::new, |(value, size)| {
        verdict::number(value, 2, &size.unit)
    });
    let hidden = match (row.hidden, row.hidden_wrong) {
        (0, _) => String::new(),
        (hidden, 0) => format!("{hidden}"),
        (hidden, wrong) => format!("{hidden} ({wrong}!)"),
    };
    let others: Vec<String> = row
        .taken_for
        .iter()
        .map(|(other, count)| format!("{count} {}", found_name(told, *other)))
        .collect();
    let right = format!("{}/{}", row.right, row.visible);
    let head = format!(
        "  {:<35} {right:>7} {from:>10} {hidden:>9}",
        named(told, row.hypothesis)
    );
    let _ = match others.as_slice() {
        [] => writeln!(out, "{}", head.trim_end()),
        [only] if head.len() + 2 + only.len() <= WIDTH => writeln!(out, "{head}  {only}"),
        several => {
            let lines = several
                .iter()
                .map(|other| format!("      mistaken for: {other}"));
            writeln!(
                out,
                "{}\n{}",
                head.trim_end(),
                lines.collect::<Vec<_>>().join("\n")
            )
        }
    };
}

fn controls(out: &mut String, told: &Tested<'_>) {
    let table = told.table;
    let lines = [
        ("nothing planted: verdict `none`", table.empty),
        ("wrong parameter: verdict `none`", table.parameter),
        (
            "unknown effect: no known effect reported, or incomplete",
            table.open_set,
        ),
        ("faulty sensor: no effect reported", table.sensor),
    ];
    let _ = writeln!(out);
    for (what, (cases, right)) in lines.into_iter().filter(|(_, (cases, _))| *cases > 0) {
        let _ = writeln!(out, "  {what:<60} {right:>4} of {cases}");
    }
    let withheld = [
        ("a new law was written", table.laws),
        (
            "a known effect was reported that repeats it",
            table.equivalents,
        ),
        (
            "an effect listed as easily confused was reported",
            table.neighbours,
        ),
    ];
    for (what, cases) in withheld.into_iter().filter(|(_, cases)| *cases > 0) {
        let _ = writeln!(out, "    {what:<58} {cases:>4}");
    }
    for (key, claimed) in &table.wrong {
        let names: Vec<String> = claimed.iter().map(|&f| found_name(told, f)).collect();
        let found = match names.as_slice() {
            [] => "an unknown effect".to_owned(),
            names => names.join(", then "),
        };
        let _ = writeln!(out, "    {key}:\n      {found}");
    }
}

/// The verdicts `one of` that a designed record resolves, those that remain, and what the signals are made of.
fn designed(out: &mut String, told: &Tested<'_>) {
    let Some(designs) = told.designs else {
        return;
    };
    let (one_of, resolved) = told.table.designed;
    let what = "verdict `one of`: resolved by one designed record";
    let _ = writeln!(out, "  {what:<60} {resolved:>4} of {one_of}");
    for (case, kept) in told.outcomes {
        let (Planting::Planted(number, _), Ok(outcome)) = (&case.kind, kept) else {
            continue;
        };
        let Some(own) = outcome.designed.as_ref().filter(|d| !d.resolves(*number)) else {
            continue;
        };
        let _ = writeln!(out, "    {}:", case.key);
        let _ = match own {
            Designed::NoSignal => writeln!(out, "      no signal distinguishes the effects"),
            Designed::Unrecorded(signal) => writeln!(out, "      {signal}: it cannot be recorded"),
            Designed::Diagnosed { signal, claims, .. } => {
                let _ = writeln!(out, "      {signal}:");
                let names = claims.iter().map(|claim| {
                    let first = claim.hypothesis.map_or(Found::Law, Found::Effect);
                    let others = claim.alternatives.iter().map(|(n, _)| Found::Effect(*n));
                    let all = std::iter::once(first).chain(others);
                    let all: Vec<String> = all.map(|found| found_name(told, found)).collect();
                    all.join(" or ")
                });
                let names: Vec<String> = names.collect();
                let found = match names.as_slice() {
                    [] => "nothing".to_owned(),
                    names => names.join(", then "),
                };
                writeln!(out, "        {found}")
            }
        };
    }
    if one_of == 0 {
        return;
    }
    for (name, reason) in designs.unmade() {
        let reason = reason.lines().next().unwrap_or_default();
        let text = format!("{name}: {reason}");
        for (number, line) in wrapped(&text, WIDTH - 6).iter().enumerate() {
            let head = if number == 0 { "    - " } else { "      " };
            let _ = writeln!(out, "{head}{line}");
        }
    }
    let assumed = designs.assumed();
    if !assumed.is_empty() {
        let _ = writeln!(
            out,
            "    assumed for the designed record, as no option says otherwise:"
        );
        for option in assumed {
            let _ = writeln!(out, "      {option}");
        }
    }
}

/// What could not be planted or found, and why.
fn refused(out: &mut String, told: &Tested<'_>) {
    let mut reasons: BTreeMap<&str, Vec<String>> = BTreeMap::new();
    for (case, kept) in told.outcomes {
        let (Planting::Planted(number, _) | Planting::OpenSet(number, _), Err(reason)) =
            (&case.kind, kept)
        else {
            continue;
        };
        let names = reasons.entry(reason).or_default();
        let name = named(told, *number);
        if !names.contains(&name) {
            names.push(name);
        }
    }
    for (reason, names) in reasons {
        let _ = writeln!(out, "\n  {reason}:");
        for name in names {
            let _ = writeln!(out, "    {name}");
        }
    }
    if !told.siteless.is_empty() {
        let _ = writeln!(out, "\n  no site on this model:");
        for name in &told.siteless {
            let _ = writeln!(out, "    {name}");
        }
    }
}

fn found_name(told: &Tested<'_>, found: Found) -> String {
    match found {
        Found::Nothing => "nothing".to_owned(),
        Found::Law => "a new law".to_owned(),
        Found::Effect(number) => named(told, number),
    }
}

fn named(told: &Tested<'_>, number: usize) -> String {
    let hypothesis = &told.hypotheses[number];
    format!("{} at {}", hypothesis.effect, hypothesis.site)
}
