//! What is plotted: the files, whatever form they have.

use super::Options;
use super::cases;
use hyde_report::LineStyle;
use hyde_signal::{Column, Frame, Layout, Table};
use hyde_study::world::below;
use hyde_units::NamedUnit;
use serde_json::Value;
use std::path::{Path, PathBuf};

/// What `hyde run --out` leaves, in the order of preference.
const RESULTS: [&str; 3] = ["results.parquet", "results.csv", "results.json"];

/// A file that was read.
pub(super) struct Source {
    /// What tells it from the others: its folder, or its own name without ending.
    pub(super) name: String,
    pub(super) path: PathBuf,
    bytes: Vec<u8>,
}

/// Columns over time.
pub(super) struct Recorded {
    pub(super) name: String,
    pub(super) path: PathBuf,
    pub(super) table: Table,
    /// How its lines are drawn.
    pub(super) style: LineStyle,
}

/// Reads the results, and those to be put beside them.
pub(super) fn read(options: &Options) -> Result<Vec<Source>, String> {
    let mut sources = Vec::new();
    for asked in std::iter::once(&options.results).chain(&options.with) {
        let path = file_of(asked, options)?;
        let named = if options.world.is_folder(asked) {
            asked.file_name()
        } else {
            asked.file_stem()
        };
        let name = named.map_or_else(
            || asked.display().to_string(),
            |name| name.to_string_lossy().into_owned(),
        );
        let bytes = options.world.read(&path)?;
        sources.push(Source { name, path, bytes });
    }
    Ok(sources)
}

impl Source {
    /// The file as a table with texts in it, if it is one.
    pub(super) fn frame(&self) -> Option<Frame> {
        hyde_signal::read_frame(&self.bytes).ok()
    }
}

/// The sources as columns over time.
pub(super) fn over_time(
    options: &Options,
    sources: &[Source],
    notes: &mut Vec<String>,
) -> Result<Vec<Recorded>, String> {
    let mut recorded = |(place, source): (usize, &Source)| {
        if let Some(cases) = cases::of(source, options) {
            return cases;
        }
        let table = match source.path.extension().and_then(|ending| ending.to_str()) {
            Some("json") => from_json(&source.bytes, options.every),
            Some(_) | None => {
                let layout = Layout {
                    every_s: options.every,
                    ..Layout::default()
                };
                let table = hyde_signal::read(&source.bytes, &layout);
                if let Ok(origin) = table.as_ref().map(Table::origin)
                    && let Some(origin) = origin
                {
                    let name = source.path.display();
                    let text = format!(
                        "note: `{name}` is plotted from its first sample on, at {}",
                        origin.text
                    );
                    notes.push(text);
                }
                table.map_err(|error| format!("{error}; {}", error.repair("file")))
            }
        };
        let table = table.map_err(|reason| format!("`{}`: {reason}", source.path.display()))?;
        let (name, path) = (source.name.clone(), source.path.clone());
        // What was put beside the first source is dashed.
        let style = if place == 0 {
            LineStyle::Solid
        } else {
            LineStyle::Dashed
        };
        Ok(vec![Recorded {
            name,
            path,
            table,
            style,
        }])
    };
    let all: Result<Vec<Vec<Recorded>>, String> =
        sources.iter().enumerate().map(&mut recorded).collect();
    Ok(all?.into_iter().flatten().collect())
}

/// The file itself, or that of the results in a folder.
fn file_of(asked: &Path, options: &Options) -> Result<PathBuf, String> {
    if !options.world.is_folder(asked) {
        return Ok(asked.to_path_buf());
    }
    if let Some(table) = cases::table_of(asked, options) {
        return table;
    }
    let mut there = RESULTS.iter().map(|name| asked.join(name));
    if let Some(found) = there.find(|path| options.world.is_file(path)) {
        return Ok(found);
    }
    let mut known: Vec<PathBuf> = below(options.world.as_ref(), asked, "csv", "");
    known.extend(below(options.world.as_ref(), asked, "parquet", ""));
    let list: Vec<String> = known
        .iter()
        .take(6)
        .map(|path| format!("`{}`", path.display()))
        .collect();
    let help = if list.is_empty() {
        "`hyde run FILE --out DIR` leaves them".to_owned()
    } else {
        format!("there is {}", list.join(", "))
    };
    Err(format!("no results are in `{}`: {help}", asked.display()))
}

/// Reads what `hyde run --format json` leaves: of each column, by its name, the unit and the values in it.
fn from_json(bytes: &[u8], every: Option<f64>) -> Result<Table, String> {
    let no_results = || {
        "no results: `hyde run --format json` leaves `{\"t\": {\"unit\": \"s\", \"values\": […]}, …}`"
            .to_owned()
    };
    let root: Value = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
    let mut columns = Vec::new();
    for (name, column) in root.as_object().ok_or_else(no_results)? {
        let values = column["values"].as_array().ok_or_else(no_results)?;
        // What is no number in JSON, it says as null.
        let values: Vec<f64> = values
            .iter()
            .map(|value| value.as_f64().unwrap_or(f64::NAN))
            .collect();
        let unit = column["unit"].as_str().ok_or_else(no_results)?;
        let unit = NamedUnit::parse(unit).map_err(|error| format!("`{name}`: {error}"))?;
        let si = values.iter().map(|value| unit.unit().to_si(*value));
        let column = Column::new(name, unit.clone(), si.collect());
        // The time comes first.
        let place = if name == "t" { 0 } else { columns.len() };
        columns.insert(place, column);
    }
    let table = match every {
        Some(period) => Table::every(period, columns),
        None => Table::new(columns),
    };
    table.map_err(|error| error.to_string())
}
