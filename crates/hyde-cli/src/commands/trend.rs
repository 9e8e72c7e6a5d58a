//! `hyde trend`: how sizes and parameters went from one diagnosis to the next.
//!
//! A folder whose name begins with a date, `2026-03-14`, is of that day; where one is not, all count one after the other.
//! Slopes are those of least squares weighed by the intervals, which grow where values scatter by more.

use crate::args::TrendArgs;
use crate::exit::Exit;
use crate::files;
use crate::project::{print_error, print_output};
use hyde_units::significant;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;

/// Half the width of a 95 % interval in standard deviations.
const TWO_SIDED: f64 = 1.96;

/// A quantity in one report.
struct Point {
    /// Day, or number of the report.
    at: f64,
    value: f64,
    /// Standard deviation.
    deviation: f64,
}

/// A quantity through all reports.
struct Trend {
    name: String,
    unit: String,
    points: Vec<Point>,
}

/// What a quantity does.
struct Slope {
    /// A day, or a report.
    each: f64,
    /// Half the width of its 95 % interval.
    half: f64,
}

/// Reads the reports and tells.
pub(crate) fn trend(args: &TrendArgs) -> Exit {
    match told(args) {
        Ok(text) => {
            print_output(&text);
            Exit::Done
        }
        Err(reason) => {
            print_error(&format!("error: {reason}"));
            Exit::CommandLine
        }
    }
}

fn told(args: &TrendArgs) -> Result<String, String> {
    if args.folders.len() < 2 {
        return Err(
            "a trend needs two reports or more: `hyde trend 2026-01-10 2026-03-14`".to_owned(),
        );
    }
    let labels: Vec<String> = args.folders.iter().map(|folder| label(folder)).collect();
    let days: Option<Vec<f64>> = labels.iter().map(|label| day(label)).collect();
    let number = |count: usize| (0..count).map(|k| k as f64).collect();
    let at: Vec<f64> = days.clone().unwrap_or_else(|| number(labels.len()));
    let mut trends: BTreeMap<(usize, String), Trend> = BTreeMap::new();
    for (folder, at) in args.folders.iter().zip(&at) {
        let report = report(folder)?;
        for (rank, name, unit, quantity) in quantities(&report) {
            let trend = trends.entry((rank, name.clone())).or_insert(Trend {
                name,
                unit,
                points: Vec::new(),
            });
            let ends = &quantity["interval"];
            let (low, high) = (ends[0].as_f64(), ends[1].as_f64());
            if let (Some(value), Some(low), Some(high)) = (quantity["value"].as_f64(), low, high) {
                trend.points.push(Point {
                    at: *at,
                    value,
                    deviation: (high - low) / (2.0 * TWO_SIDED),
                });
            }
        }
    }
    let trends: Vec<Trend> = trends.into_values().collect();
    let per = if days.is_some() { "day" } else { "report" };
    Ok(match args.json {
        true => format!("{:#}", as_json(&trends, &labels, per)),
        false => text(&trends, &labels, per),
    })
}

/// The folder's name.
fn label(folder: &Path) -> String {
    let own = if files::is_file(folder) {
        folder.parent()
    } else {
        Some(folder)
    };
    let name = own.and_then(Path::file_name).unwrap_or_default();
    name.to_string_lossy().into_owned()
}

fn report(folder: &Path) -> Result<Value, String> {
    let path = match files::is_folder(folder) {
        true => folder.join("report.json"),
        false => folder.to_path_buf(),
    };
    let text = files::read_text(&path)?;
    let report: Value = serde_json::from_str(&text)
        .map_err(|error| format!("`{}` is not valid JSON: {error}", path.display()))?;
    if report["report"] != 1 || !report["effects"].is_array() {
        return Err(format!(
            "`{}` is not a report of this version of `hyde diagnose`",
            path.display()
        ));
    }
    Ok(report)
}

/// Sizes and shapes of effects, then parameters: rank, name, unit, value with interval.
fn quantities(report: &Value) -> Vec<(usize, String, String, Value)> {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let mut found = Vec::new();
    for effect in list(&report["effects"]) {
        let name = format!("{} at {}", text(&effect["effect"]), text(&effect["site"]));
        let size = json!({ "value": effect["size"], "interval": effect["interval"] });
        found.push((0, name.clone(), text(&effect["unit"]), size));
        for (shape, quantity) in effect["shape"].as_object().into_iter().flatten() {
            let unit = text(&quantity["unit"]);
            found.push((1, format!("{name}, {shape}"), unit, quantity.clone()));
        }
    }
    for parameter in list(&report["parameters"]) {
        let unit = text(&parameter["unit"]);
        found.push((
            2,
            text(&parameter["name"]),
            unit,
            parameter["after"].clone(),
        ));
    }
    found
}

/// Days since 1970-01-01 of a name that begins with a date (Hinnant, chrono-compatible low-level date algorithms, 2021).
fn day(name: &str) -> Option<f64> {
    let number = |from: usize, to: usize| name.get(from..to)?.parse::<u16>().ok().map(i64::from);
    let dashes = name.get(4..5) == Some("-") && name.get(7..8) == Some("-");
    let (year, month, day) = (number(0, 4)?, number(5, 7)?, number(8, 10)?);
    if !dashes || !(1..=12).contains(&month) || !(1..=31).contains(&day) {
        return None;
    }
    let year = if month <= 2 { year - 1 } else { year };
    let era = year.div_euclid(400);
    let of_era = year - era * 400;
    let of_year = (153 * (month + if month > 2 { -3 } else { 9 }) + 2) / 5 + day - 1;
    let days = era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + of_year - 719_468;
    Some(days as f64)
}

/// The slope of a trend; `None` where its points do not tell one.
fn slope(points: &[Point]) -> Option<Slope> {
    if points.len() < 2
        || points
            .iter()
            .any(|point| point.deviation.is_nan() || point.deviation <= 0.0)
    {
        return None;
    }
    let sum = |of: &dyn Fn(&Point) -> f64| -> f64 {
        points
            .iter()
            .map(|p| of(p) / (p.deviation * p.deviation))
            .sum()
    };
    let weight = sum(&|_| 1.0);
    let (at, value) = (sum(&|p| p.at) / weight, sum(&|p| p.value) / weight);
    let spread = sum(&|p| (p.at - at).powi(2));
    if spread <= 0.0 {
        return None;
    }
    let each = sum(&|p| (p.at - at) * (p.value - value)) / spread;
    let left = sum(&|p| (p.value - value - each * (p.at - at)).powi(2));
    let scatter = left / (points.len() as f64 - 2.0).max(1.0);
    Some(Slope {
        each,
        half: TWO_SIDED * (scatter.max(1.0) / spread).sqrt(),
    })
}

fn word(slope: &Slope) -> &'static str {
    if slope.each > slope.half {
        "rises"
    } else if slope.each < -slope.half {
        "falls"
    } else {
        "steady"
    }
}

fn text(trends: &[Trend], labels: &[String], per: &str) -> String {
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
        let went = slope(&trend.points).map_or_else(String::new, |slope| {
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
            hyde_present::comparison::shortened(&trend.name, 26),
            significant(first.value, 4),
            significant(last.value, 4),
            trend.unit
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
    out
}

fn as_json(trends: &[Trend], labels: &[String], per: &str) -> Value {
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
        json!({ "name": trend.name, "unit": trend.unit, "points": points, "slope": went })
    });
    json!({ "ok": true, "reports": labels, "trends": each.collect::<Vec<Value>>() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        assert_eq!(day("1970-01-01"), Some(0.0));
        assert_eq!(day("2000-03-01-left"), Some(11_017.0));
        assert_eq!(day("2026-13-01"), None);
        assert_eq!(day("out"), None);
    }

    #[test]
    fn a_slope_has_the_interval_of_its_points() {
        let point = |at: f64, value: f64| Point {
            at,
            value,
            deviation: 0.1,
        };
        let found = slope(&[point(0.0, 1.0), point(1.0, 2.0), point(2.0, 3.0)]).unwrap();
        assert!((found.each - 1.0).abs() < 1e-12);
        // The variance of a slope of equal weights is sd^2 over the sum of (t - mean)^2 = 2.
        assert!((found.half - 1.96 * 0.1 / 2.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!(word(&found), "rises");
        let steady = slope(&[point(0.0, 1.0), point(1.0, 1.1)]).unwrap();
        assert_eq!(word(&steady), "steady");
        // Points that scatter by more than their intervals widen it.
        let wide = slope(&[point(0.0, 1.0), point(1.0, 3.0), point(2.0, 1.2)]).unwrap();
        assert!(wide.half > found.half);
    }
}
