//! `hyde modes --over`: natural frequencies over a parameter, as a table and a figure.

use super::{Found, found, page};
use crate::args::{ModelArgs, ModesArgs};
use crate::exit::Exit;
use crate::files;
use crate::project::complain;
use hyde_report::{Axis, Figure, Line, LineStyle, Panel, to_png, to_svg};
use hyde_study::settings::{self, Setting};
use hyde_units::shown;
use hyde_units::significant;
use serde_json::json;
use std::fmt::Write as _;
use std::path::Path;

/// At most so many modes are drawn.
const PANELS: usize = 6;

/// The modes at one value of the parameter, of each experiment.
type Row = (f64, Vec<Found>);

pub(super) fn table(
    args: &ModesArgs,
    experiments: &[ModelArgs],
    over: &str,
) -> Result<String, Exit> {
    let wrong = |reason: &str| complain(&args.model, Exit::CommandLine, reason);
    let (from, to) = ends(over).map_err(|reason| wrong(&reason))?;
    let mut rows: Vec<Row> = Vec::new();
    let count = args.points.max(2);
    for k in 0..count {
        let part = k as f64 / (count - 1) as f64;
        let value = from.value + part * (to.value - from.value);
        let setting = Setting {
            value,
            ..from.clone()
        };
        let all: Result<Vec<Found>, Exit> = experiments
            .iter()
            .map(|model| found(args, model, Some(&setting)))
            .collect();
        rows.push((value, all?));
    }
    let unit = unit(&rows, &from.path);
    let mut text = if args.model.json {
        json(&rows, &from.path)
    } else {
        text(&rows, &from.path, &unit)
    };
    if let Some(folder) = &args.out {
        let page = leave(folder, &rows, &from.path, &unit).map_err(|reason| wrong(&reason))?;
        if !args.model.json {
            let _ = writeln!(text, "{}\n{page}", folder.join("modes.svg").display());
        }
    }
    Ok(text)
}

/// Both ends of `path=from..to [unit]`.
fn ends(text: &str) -> Result<(Setting, Setting), String> {
    let bad = || format!("`--over {text}`: write `path=from..to [unit]`");
    let (path, range) = text.split_once('=').ok_or_else(bad)?;
    let (from, rest) = range.split_once("..").ok_or_else(bad)?;
    let unit = rest.find('[').map_or("", |at| &rest[at..]);
    let from = settings::parse(&format!("{path}={} {unit}", from.trim()))?;
    let to = settings::parse(&format!("{path}={}", rest.trim()))?;
    Ok((from, to))
}

fn unit(rows: &[Row], path: &str) -> String {
    let mut units = rows
        .iter()
        .flat_map(|(_, all)| all)
        .flat_map(|one| &one.units);
    let known = units.find(|(name, _)| name == path);
    known.map_or_else(String::new, |(_, unit)| shown(unit).to_owned())
}

/// One line a value; the frequencies of each experiment in Hz, lowest first.
fn text(rows: &[Row], path: &str, unit: &str) -> String {
    let mut text = String::new();
    let all = rows
        .iter()
        .flat_map(|(value, all)| all.iter().map(move |found| (value, found)));
    let grow = all.filter_map(|(value, found)| Some((value, found.unstable.as_ref()?)));
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
        text.push_str(&found.about);
    }
    text
}

fn json(rows: &[Row], path: &str) -> String {
    let listed: Vec<_> = rows
        .iter()
        .map(|(value, all)| {
            let of = |found: &Found| {
                let frequencies: Vec<f64> =
                    found.modes.iter().map(|mode| mode.frequency_hz).collect();
                let damping: Vec<f64> = found.modes.iter().map(|mode| mode.damping).collect();
                json!({ "experiment": found.name, "frequency_hz": frequencies, "damping": damping, "stable": found.unstable.is_none() })
            };
            json!({ "value": value, "experiments": all.iter().map(of).collect::<Vec<_>>() })
        })
        .collect();
    format!(
        "{:#}",
        json!({ "ok": true, "over": path, "values": listed })
    )
}

fn leave(folder: &Path, rows: &[Row], path: &str, unit: &str) -> Result<String, String> {
    files::make_folder(folder)?;
    let figure = drawn(rows, path, unit);
    files::write(&folder.join("modes.svg"), to_svg(&figure).as_bytes())?;
    files::write(&folder.join("modes.png"), &to_png(&figure, 2.0))?;
    let mut csv = format!("experiment,{path} [{unit}],mode,f [Hz],damping\n");
    for (value, all) in rows {
        for found in all {
            for (number, mode) in found.modes.iter().enumerate() {
                let (name, f, damping) = (&found.name, mode.frequency_hz, mode.damping);
                let _ = writeln!(csv, "{name},{value},{},{f},{damping}", number + 1);
            }
        }
    }
    files::write(&folder.join("modes.csv"), csv.as_bytes())?;
    let first = rows.first().map_or(&[][..], |(_, all)| all);
    page::leave(folder, Some(figure), first)
}

/// A panel for each mode, lowest at the bottom; a colour for each experiment.
fn drawn(rows: &[Row], path: &str, unit: &str) -> Figure {
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
