//! How sizes and parameters went from one diagnosis to the next.
//!
//! A report whose name begins with a date, `2026-03-14`, is of that day, and reports are sorted by their days; where one is
//! not, all count one after the other.
//! Slopes are those of least squares weighed by the intervals, which grow where values scatter by more.

use hyde_signal::statistics::distributions::TWO_SIDED;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// A quantity in one report.
pub struct Point {
    /// Day, or number of the report.
    pub at: f64,
    /// Its value.
    pub value: f64,
    /// Standard deviation.
    pub deviation: f64,
}

/// A quantity through all reports.
pub struct Trend {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// One for each report that has it.
    pub points: Vec<Point>,
}

/// What a quantity does.
pub struct Slope {
    /// A day, or a report.
    pub each: f64,
    /// Half the width of its 95 % interval.
    pub half: f64,
}

/// All quantities through all reports.
pub struct Trends {
    /// The names of the reports.
    pub labels: Vec<String>,
    /// What a slope is over: `day` or `report`.
    pub per: &'static str,
    /// The quantities: sizes, shapes, parameters.
    pub trends: Vec<Trend>,
}

/// The trends of reports of `hyde diagnose`, each with its name.
///
/// # Errors
/// There are fewer than two.
pub fn trends(reports: &[(String, Value)]) -> Result<Trends, String> {
    if reports.len() < 2 {
        return Err(
            "a trend needs two reports or more: `hyde trend 2026-01-10 2026-03-14`".to_owned(),
        );
    }
    let mut reports: Vec<&(String, Value)> = reports.iter().collect();
    if reports.iter().all(|(label, _)| day(label).is_some()) {
        let order = |label: &str| day(label).unwrap_or(0.0);
        reports.sort_by(|a, b| order(&a.0).total_cmp(&order(&b.0)));
    }
    let labels: Vec<String> = reports.iter().map(|(label, _)| label.clone()).collect();
    let days: Option<Vec<f64>> = labels.iter().map(|label| day(label)).collect();
    let number = |count: usize| (0..count).map(|k| k as f64).collect();
    let at: Vec<f64> = days.clone().unwrap_or_else(|| number(labels.len()));
    let mut trends: BTreeMap<(usize, String), Trend> = BTreeMap::new();
    for ((_, report), at) in reports.into_iter().zip(&at) {
        for (rank, name, unit, quantity) in quantities(report) {
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
    Ok(Trends {
        labels,
        per: if days.is_some() { "day" } else { "report" },
        trends: trends.into_values().collect(),
    })
}

/// Sizes and shapes of effects, then parameters: rank, name, unit, value with interval.
fn quantities(report: &Value) -> Vec<(usize, String, String, Value)> {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let list = |value: &Value| value.as_array().cloned().unwrap_or_default();
    let mut found = Vec::new();
    for effect in list(&report["effects"]) {
        let name = format!("{} at {}", text(&effect["effect"]), text(&effect["site"]));
        let sizes: Vec<(&String, &Value)> =
            effect["sizes"].as_object().into_iter().flatten().collect();
        // The amplitude of a sine and a cosine is neither of them.
        let told = sizes.iter().any(|(_, own)| own["value"] == effect["size"]);
        match told && sizes.len() > 1 {
            true => found.extend(sizes.into_iter().map(|(size, own)| {
                let name = format!("{name}, {size}");
                (0, name, text(&own["unit"]), own.clone())
            })),
            false => {
                let size = json!({ "value": effect["size"], "interval": effect["interval"] });
                found.push((0, name.clone(), text(&effect["unit"]), size));
            }
        }
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

/// Why points tell no slope, if so.
#[must_use]
pub fn why_none(points: &[Point]) -> Option<&'static str> {
    let unknown = |point: &Point| point.deviation.is_nan() || point.deviation <= 0.0;
    // Days and numbers of reports are whole.
    let at_once = |pair: &[Point]| (pair[1].at - pair[0].at).abs() < 0.5;
    if points.len() < 2 {
        Some("of one report")
    } else if points.windows(2).all(at_once) {
        Some("all of one day")
    } else if points.iter().any(unknown) {
        Some("an interval is missing")
    } else {
        None
    }
}

/// The slope of a trend; `None` where its points do not tell one.
#[must_use]
pub fn slope(points: &[Point]) -> Option<Slope> {
    if why_none(points).is_some() {
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
    let each = sum(&|p| (p.at - at) * (p.value - value)) / spread;
    let left = sum(&|p| (p.value - value - each * (p.at - at)).powi(2));
    let scatter = left / (points.len() as f64 - 2.0).max(1.0);
    Some(Slope {
        each,
        half: TWO_SIDED * (scatter.max(1.0) / spread).sqrt(),
    })
}

/// What a quantity does, in a word.
#[must_use]
pub fn word(slope: &Slope) -> &'static str {
    if slope.each > slope.half {
        "rises"
    } else if slope.each < -slope.half {
        "falls"
    } else {
        "steady"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_of_several_sizes_has_a_trend_and_a_pair_its_amplitude() {
        let of = |value: f64| json!({ "value": value, "unit": "N", "interval": [value, value] });
        let effect = |size: f64, sizes: Value| json!({ "effect": "E", "site": "s", "size": size, "unit": "N", "interval": [0, 9], "sizes": sizes, "shape": {} });
        let named = |own: Value| -> Vec<String> {
            let report = json!({ "effects": [own], "parameters": [] });
            quantities(&report).into_iter().map(|own| own.1).collect()
        };
        let several = effect(2.0, json!({ "F1": of(1.0), "F2": of(2.0) }));
        assert_eq!(named(several), ["E at s, F1", "E at s, F2"]);
        let pair = effect(5.0, json!({ "Fs": of(3.0), "Fc": of(4.0) }));
        assert_eq!(named(pair), ["E at s"]);
        assert_eq!(named(effect(1.0, json!({ "F": of(1.0) }))), ["E at s"]);
    }

    #[test]
    fn days_are_those_of_the_calendar() {
        assert_eq!(day("1970-01-01"), Some(0.0));
        assert_eq!(day("2000-03-01-left"), Some(11_017.0));
        assert_eq!(day("2026-13-01"), None);
        assert_eq!(day("out"), None);
    }

    #[test]
    fn reports_are_in_the_order_of_their_days_and_one_day_tells_no_slope() {
        let report = |size: f64| {
            let value = json!({ "value": size, "interval": [size - 0.1, size + 0.1] });
            json!({ "effects": [], "parameters": [{ "name": "c", "unit": "N/m", "after": value }] })
        };
        let of = |label: &str, size: f64| (label.to_owned(), report(size));
        let mixed = [
            of("2026-03-04", 4.0),
            of("2026-03-01", 1.0),
            of("2026-03-02", 2.0),
        ];
        let found = trends(&mixed).unwrap();
        assert_eq!(found.labels, ["2026-03-01", "2026-03-02", "2026-03-04"]);
        let values: Vec<f64> = found.trends[0].points.iter().map(|p| p.value).collect();
        assert_eq!(values, [1.0, 2.0, 4.0]);
        let slope_of = |found: &Trends| slope(&found.trends[0].points);
        assert!((slope_of(&found).unwrap().each - 1.0).abs() < 1e-9);
        let one = [of("2026-03-01-evening", 3.0), of("2026-03-01-morning", 1.0)];
        let one = trends(&one).unwrap();
        assert_eq!(one.labels, ["2026-03-01-evening", "2026-03-01-morning"]);
        assert!(slope_of(&one).is_none());
        assert_eq!(why_none(&one.trends[0].points), Some("all of one day"));
        // Names without a date count one after the other.
        let numbered = trends(&[of("b", 3.0), of("a", 1.0)]).unwrap();
        assert!((slope_of(&numbered).unwrap().each + 2.0).abs() < 1e-9);
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
