//! Natural frequencies over a parameter, as a table, as JSON, as a figure and as numbers.

use super::{about, unstable};
use hyde_report::{Axis, Figure, Line, LineStyle, Panel};
use hyde_study::modes::Modes;
use hyde_units::{shown, significant};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// At most so many modes are drawn.
const PANELS: usize = 6;

/// The modes at one value of the parameter, of each experiment.
pub type Row = (f64, Vec<Modes>);

/// The unit of the parameter, in SI.
#[must_use]
pub fn unit(rows: &[Row], path: &str) -> String {
    let mut units = rows
        .iter()
        .flat_map(|(_, all)| all)
        .flat_map(|one| &one.prepared.compiled.program.parameters);
    let known = units.find(|parameter| parameter.name == path);
    known.map_or_else(String::new, |own| {
        shown(&own.dimension.usual_unit()).to_owned()
    })
}

/// One line a value; the frequencies of each experiment in Hz, lowest first.
#[must_use]
pub fn text(rows: &[Row], path: &str, unit: &str) -> String {
    let mut text = String::new();
    let all = rows
        .iter()
        .flat_map(|(value, all)| all.iter().map(move |found| (value, found)));
    let grow = all.filter_map(|(value, found)| Some((value, unstable(found)?)));
    let grow: Vec<_> = grow.collect();
    if let Some((value, told)) = grow.first() {
        let (count, value) = (grow.len(), significant(**value, 4));
        let _ = write!(text, "at {path} = {value}, the first of {count}: {told}");
    }
    let head = if unit.is_empty() {
        path.to_owned()
    } else {
        format!("{path} [{unit}]")
    };
    let _ = write!(text, "{head:>16}");
    for found in rows.first().map_or(&[][..], |(_, all)| all) {
        let _ = write!(text, "   {} [Hz]", found.name);
    }
    text.push('\n');
    for (value, all) in rows {
        let _ = write!(text, "{:>16}", significant(*value, 4));
        for (number, found) in all.iter().enumerate() {
            text.push_str(if number == 0 { "  " } else { "  |" });
            for mode in &found.modes {
                let _ = write!(text, " {:>9}", significant(mode.frequency_hz, 5));
            }
        }
        text.push('\n');
    }
    if let Some(found) = rows.first().and_then(|(_, all)| all.first()) {
        text.push_str(&about(found));
    }
    text
}

/// The same as JSON.
#[must_use]
pub fn json(rows: &[Row], path: &str) -> Value {
    let listed: Vec<_> = rows
        .iter()
        .map(|(value, all)| {
            let of = |found: &Modes| {
                let frequencies: Vec<f64> =
                    found.modes.iter().map(|mode| mode.frequency_hz).collect();
                let damping: Vec<f64> = found.modes.iter().map(|mode| mode.damping).collect();
                json!({ "experiment": found.name, "frequency_hz": frequencies, "damping": damping, "stable": unstable(found).is_none() })
            };
            json!({ "value": value, "experiments": all.iter().map(of).collect::<Vec<_>>() })
        })
        .collect();
    json!({ "ok": true, "over": path, "values": listed })
}

/// A panel for each mode, lowest at the bottom; a colour for each experiment.
#[must_use]
pub fn drawn(rows: &[Row], path: &str, unit: &str) -> Figure {
    let first = rows.first().map_or(&[][..], |(_, all)| all);
    let values: Vec<f64> = rows.iter().map(|(value, _)| *value).collect();
    let most = rows
        .iter()
        .flat_map(|(_, all)| all)
        .map(|found| found.modes.len());
    let most = most.max().unwrap_or(0).min(PANELS);
    let mut panels = Vec::new();
    for k in (0..most).rev() {
        let mut lines = Vec::new();
        for (number, experiment) in first.iter().enumerate() {
            let frequency = |(_, all): &Row| {
                let mode = all[number].modes.get(k);
                mode.map_or(f64::NAN, |mode| mode.frequency_hz)
            };
            let label = if k + 1 == most && first.len() > 1 {
                experiment.name.clone()
            } else {
                String::new()
            };
            let style = if number == 0 {
                LineStyle::Solid
            } else {
                LineStyle::Dashed
            };
            let line = Line::new(label, values.clone(), rows.iter().map(frequency).collect());
            lines.push(line.with_style(style).with_colour(number));
        }
        let x = Axis::scaled(path, unit, &values);
        let y = Axis::new(format!("mode {}", k + 1), "Hz");
        panels.push(Panel::new(x, y, lines));
    }
    Figure {
        shared_x: true,
        panel_height: 100.0,
        ..Figure::new(panels).with_title("Natural frequencies")
    }
}

/// The numbers, a line a mode.
#[must_use]
pub fn csv(rows: &[Row], path: &str, unit: &str) -> String {
    let mut csv = format!("experiment,{path} [{unit}],mode,f [Hz],damping\n");
    for (value, all) in rows {
        for found in all {
            for (number, mode) in found.modes.iter().enumerate() {
                let (name, f, damping) = (&found.name, mode.frequency_hz, mode.damping);
                let _ = writeln!(csv, "{name},{value},{},{f},{damping}", number + 1);
            }
        }
    }
    csv
}
