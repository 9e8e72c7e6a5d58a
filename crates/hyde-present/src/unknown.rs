//! What is missing and in no library, as text and as JSON.

use crate::diagnosed::wrapped;
use hyde_calibrate::{Diagnosis, FoundLaw, Kind, Map, Panel, Summand, Unknown};
use hyde_study::unknown::most_like;
use hyde_units::significant;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The effect written, where it was seen, and the map, in lines.
pub fn text(unknown: &Unknown, found: &Diagnosis) -> String {
    let mut out = String::new();
    match &unknown.found {
        Some(own) => {
            let _ = writeln!(out, "\n{}", own.written.text.trim_end());
            let seen = &own.law.seen;
            out.push('\n');
            let [place, speed] = own.law.site.kind.variables();
            let more = own.law.of_more().into_iter();
            let more = more.map(|(name, most)| format!("{name} to {}, ", significant(most, 3)));
            let more: String = more.collect();
            let range = format!(
                "{}: {speed} to {}, {more}{place} {} to {}, time {} to {} (SI)",
                own.law.site.path,
                significant(seen.speed, 3),
                significant(seen.place.0, 3),
                significant(seen.place.1, 3),
                significant(seen.time.0, 3),
                significant(seen.time.1, 3)
            );
            wrapped(&mut out, "  operating range at", &range);
            let improvement = format!(
                "{}, {} in cross-validation; {} of that of the best line below",
                significant(own.gain, 3),
                significant(own.fold_gain, 3),
                significant(own.share, 3)
            );
            wrapped(&mut out, "  improvement", &improvement);
            for (term, share) in &own.equivalents {
                let term = format!(
                    "{} ({} of the improvement of the first term)",
                    named(term, &own.law.site.kind),
                    significant(*share, 3)
                );
                wrapped(&mut out, "  nearly as good:", &term);
            }
        }
        None => {
            let _ = writeln!(out, "\n  {}; see the table below", no_law(found));
        }
    }
    let _ = writeln!(
        out,
        "\n  {} at {}, fitted as any function of",
        unknown.map.site.kind.what(),
        unknown.map.site.path
    );
    let name = |panel: &Panel| panel.variable.name(&unknown.map.site.kind);
    let wave = wave(&unknown.map);
    let widths = unknown.map.panels.iter().map(|panel| name(panel).len());
    let width = widths.max().unwrap_or(0).max(wave.len());
    let _ = writeln!(
        out,
        "    {:<width$} {:>11} {:>9}",
        "", "improvement", "by chance"
    );
    for panel in &unknown.map.panels {
        let _ = writeln!(
            out,
            "    {:<width$} {:>11} {:>9}",
            name(panel),
            significant(panel.gain, 3),
            significant(panel.band, 3)
        );
    }
    let gain = significant(unknown.map.waves, 3);
    let _ = writeln!(out, "    {wave:<width$} {gain:>11} {:>9}", "-");
    out
}

/// The row of a map for waves too short for its panels.
pub fn wave(map: &Map) -> String {
    let [place, speed] = map.site.kind.variables();
    format!("wave over {place}, or {speed} times a wave")
}

/// Why there is no law.
fn no_law(found: &Diagnosis) -> &'static str {
    match found.frozen.as_slice() {
        [] => "no formula improves the fit enough to justify its constants",
        _ => "no formula is searched for because a sensor reading was frozen",
    }
}

/// The same as JSON; numbers are SI.
pub fn report(unknown: &Unknown, found: &Diagnosis) -> Value {
    let panel = |panel: &Panel, kind: &Kind| {
        json!({
            "variable": panel.variable.name(kind),
            "gain": panel.gain,
            "band": panel.band.is_finite().then_some(panel.band),
            "at": panel.knots,
            "force": panel.force,
        })
    };
    let panels = |map: &Map| -> Vec<Value> {
        let each = map.panels.iter();
        each.map(|one| panel(one, &map.site.kind)).collect()
    };
    let latent: Vec<Value> = unknown
        .latent
        .iter()
        .map(|force| {
            json!({
                "time": force.time,
                "place": force.place,
                "speed": force.speed,
                "acceleration": force.acceleration,
                "signal": force.signal,
                "force": force.force,
                "deviation": force.deviation,
            })
        })
        .collect();
    let others: Vec<Value> = unknown
        .others
        .iter()
        .map(|map| json!({ "site": map.site.path, "panels": panels(map), "waves": map.waves }))
        .collect();
    json!({
        "most_like": most_like(unknown),
        "why_no_law": unknown.found.is_none().then(|| no_law(found)),
        "law": unknown.found.as_ref().map(|own| law(own, found)),
        "map": {
            "site": unknown.map.site.path,
            "panels": panels(&unknown.map),
            "waves": unknown.map.waves,
        },
        "latent": latent,
        "other_sites": others,
    })
}

fn law(own: &FoundLaw, found: &Diagnosis) -> Value {
    let seen = &own.law.seen;
    let values: BTreeMap<&str, f64> = found
        .findings
        .last()
        .into_iter()
        .flat_map(|finding| finding.sizes.iter().chain(&finding.shapes))
        .map(|quantity| (quantity.name.as_str(), quantity.value))
        .collect();
    let equivalents: Vec<Value> = own
        .equivalents
        .iter()
        .map(|(term, share)| json!({ "form": named(term, &own.law.site.kind), "share": share }))
        .collect();
    json!({
        "name": own.written.name,
        "site": own.law.site.path,
        "aliases": own.law.site.aliases,
        "text": own.written.text,
        "values": values,
        "seen": {
            "speed": seen.speed,
            "acceleration": seen.acceleration,
            "signal": seen.signal,
            "place": [seen.place.0, seen.place.1],
            "time": [seen.time.0, seen.time.1],
        },
        "gains": own.gains,
        "gain": own.gain,
        "fold_gain": own.fold_gain,
        "share_of_map": own.share,
        "equivalents": equivalents,
    })
}

/// A term in words.
fn named(term: &Summand, kind: &Kind) -> String {
    let names: Vec<String> = term
        .factors
        .iter()
        .map(|factor| factor.words(kind))
        .collect();
    match names.as_slice() {
        [] => "a constant".to_owned(),
        list => list.join(" times "),
    }
}
