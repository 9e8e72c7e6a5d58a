//! How sizes and parameters went from one diagnosis to the next, as a table and as JSON.

use crate::comparison::shortened;
use hyde_signal::statistics::distributions::TWO_SIDED;
use hyde_study::trend::{Trends, slope, why_none, word};
use hyde_units::significant;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The table.
#[must_use]
pub fn text(found: &Trends) -> String {
    let Trends {
        labels,
        per,
        trends,
    } = found;
    let mut out = String::new();
    let _ = writeln!(out, "{} reports: {}", labels.len(), labels.join(", "));
    let _ = writeln!(
        out,
        "\n  {:<26} {:>10} {:>10} {:>8} {:>17}",
        "",
        "first",
        "last",
        "unit",
        format!("a {per}")
    );
    for trend in trends {
        let (Some(first), Some(last)) = (trend.points.first(), trend.points.last()) else {
            continue;
        };
        let none = || {
            let why = why_none(&trend.points).unwrap_or_default();
            format!("{:>17}  {why}", "no slope:")
        };
        let went = slope(&trend.points).map_or_else(none, |slope| {
            let numbers = format!(
                "{} ± {}",
                significant(slope.each, 3),
                significant(slope.half, 2)
            );
            format!("{numbers:>17}  {}", word(&slope))
        });
        let missing = match labels.len() - trend.points.len() {
            0 => String::new(),
            _ => format!("  in {} of {}", trend.points.len(), labels.len()),
        };
        let line = format!(
            "  {:<26} {:>10} {:>10} {:>8} {went}{missing}",
            shortened(&trend.name, 26),
            significant(first.value, 4),
            significant(last.value, 4),
            trend.unit
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
    out
}

/// The same as JSON.
#[must_use]
pub fn json(found: &Trends) -> Value {
    let Trends {
        labels,
        per,
        trends,
    } = found;
    let each = trends.iter().map(|trend| {
        let points: Vec<Value> = trend
            .points
            .iter()
            .map(|point| {
                let half = TWO_SIDED * point.deviation;
                json!({
                    "at": point.at,
                    "value": point.value,
                    "interval": [point.value - half, point.value + half],
                })
            })
            .collect();
        let went = slope(&trend.points).map(|slope| {
            json!({
                "per": per,
                "value": slope.each,
                "interval": [slope.each - slope.half, slope.each + slope.half],
                "word": word(&slope),
            })
        });
        let none = why_none(&trend.points);
        json!({ "name": trend.name, "unit": trend.unit, "points": points, "slope": went, "no_slope": none })
    });
    json!({ "ok": true, "reports": labels, "trends": each.collect::<Vec<Value>>() })
}
