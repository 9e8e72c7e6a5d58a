//! `hyde look`: what is in a trace, before any model reads it.

mod page;
mod text;

use crate::args::LookArgs;
use crate::exit::Exit;
use crate::files;
use crate::project::{print_error, print_output};
use hyde_signal::Table;
use hyde_signal::look::{Look, look as look_at};
use hyde_study::record_settings::{self, Given, RECORD};
use hyde_study::world::Disk;
use serde_json::{Value, json};

/// A file that was looked at.
pub(super) struct Seen {
    pub(super) given: Given,
    pub(super) table: Table,
    pub(super) look: Look,
}

/// A file that cannot be read: its name, what is wrong, and the repair.
pub(super) struct Failed {
    file: String,
    message: String,
    help: Option<String>,
}

/// Looks at every file.
pub(crate) fn look(args: &LookArgs) -> Exit {
    let (mut seen, mut failed) = (Vec::new(), Vec::new());
    for file in &args.files {
        match seen_of(file) {
            Ok(found) => seen.push(found),
            Err(reason) => failed.push(reason),
        }
    }
    let left = args.out.as_ref().map(|folder| page::leave(folder, &seen));
    if args.json {
        let files: Vec<Value> = seen.iter().map(json_of).collect();
        let errors: Vec<Value> = failed
            .iter()
            .map(|f| json!({ "file": f.file, "error": f.message, "help": f.help }))
            .collect();
        let all = json!({ "ok": failed.is_empty(), "files": files, "errors": errors });
        print_output(&format!("{all:#}"));
    } else {
        let texts: Vec<String> = seen.iter().map(text::screen).collect();
        print_output(texts.join("\n").trim_end());
        failed.iter().for_each(Failed::print);
    }
    match left.transpose() {
        Err(reason) => {
            print_error(&format!("error: {reason}"));
            return Exit::CommandLine;
        }
        Ok(Some(path)) if !args.json => print_output(&path),
        Ok(_) => {}
    }
    if failed.is_empty() {
        Exit::Done
    } else {
        Exit::Model
    }
}

impl Failed {
    pub(super) fn print(&self) {
        let Self {
            file,
            message,
            help,
        } = self;
        let help = help.as_ref();
        let help = help.map_or_else(String::new, |help| format!("\n  help: {help}"));
        print_error(&format!("error: {file}: {message}{help}"));
    }
}

/// Reads a file and looks at it.
pub(super) fn seen_of(file: &str) -> Result<Seen, Failed> {
    let wrong = |message: String, help| Failed {
        file: file.to_owned(),
        message,
        help,
    };
    let given = Given::of(&Disk, RECORD, file).map_err(|reason| wrong(reason, None))?;
    let content = files::read(&given.path).map_err(|reason| wrong(reason, None))?;
    let table = record_settings::alone(&Disk, &given, &content)
        .map_err(|(message, help)| wrong(message, help))?;
    let look = look_at(&table);
    Ok(Seen { given, table, look })
}

impl Seen {
    /// The line that declares the record in an experiment.
    fn line(&self) -> String {
        let file = self.given.path.file_name().unwrap_or_default();
        let file = file.to_string_lossy();
        format!("record {RECORD} = {file:?} {}", self.settings())
            .trim_end()
            .to_owned()
    }

    /// How the file is to be read: as was said, with the units that follow from other channels.
    pub(super) fn settings(&self) -> String {
        let units: Vec<String> = self
            .look
            .channels
            .iter()
            .filter_map(|channel| {
                let (unit, _) = channel.guessed.as_ref()?;
                Some(format!("column = {:?} in [{unit}]", channel.name))
            })
            .collect();
        match (self.given.text.as_str(), units.is_empty()) {
            (text, true) => text.to_owned(),
            ("", false) => format!("({})", units.join(", ")),
            (text, false) => match text.split_once(')') {
                Some((inner, rest)) if text.starts_with('(') => {
                    format!("{inner}, {}){rest}", units.join(", "))
                }
                _ => format!("({}) {text}", units.join(", ")),
            },
        }
    }

    /// The channels whose unit nobody says and nothing tells.
    fn without_units(&self) -> Vec<&str> {
        let all = self.look.channels.iter();
        let bare = all.filter(|c| c.unit.is_none() && c.guessed.is_none());
        bare.filter(|c| c.shown.role != hyde_signal::look::Role::State)
            .map(|c| c.name.as_str())
            .collect()
    }
}

fn json_of(seen: &Seen) -> Value {
    let Seen { given, table, look } = seen;
    let clocks: Vec<Value> = look
        .clocks
        .iter()
        .map(|clock| {
            json!({
                "samples": clock.rows, "start_s": clock.start_s, "length_s": clock.length_s, "step_s": clock.step_s,
                "jitter_s": clock.jitter_s, "drift_ppm": clock.drift_ppm,
                "gaps": clock.gaps.iter().map(|(from, long)| json!({ "from_s": from, "length_s": long })).collect::<Vec<_>>(),
                "doubles_s": clock.doubles,
            })
        })
        .collect();
    let channels: Vec<Value> = look
        .channels
        .iter()
        .map(|channel| {
            let s = &channel.sampled;
            json!({
                "name": channel.name, "meaning": channel.meaning, "unit": channel.unit, "clock": channel.clock,
                "guessed_unit": channel.guessed.as_ref().map(|(unit, why)| json!({ "unit": unit, "why": why })),
                "role": channel.shown.role.to_string(), "reference": channel.shown.reference, "why": channel.shown.why,
                "min": s.range.0, "max": s.range.1, "step": s.step, "noise": s.noise,
                "stuck": s.stuck.map(|held| json!({ "from_s": held.from_s, "to_s": held.to_s, "value": held.value })),
                "saturated": s.saturated.map(|limit| json!({ "value": limit.value, "samples": limit.samples })),
                "wraps": s.wraps.map(|wrap| json!({ "period": wrap.period, "times": wrap.times })),
                "spikes_s": s.spikes,
            })
        })
        .collect();
    let delays: Vec<Value> = look
        .delays
        .iter()
        .map(|d| json!({ "leads": d.leads, "follows": d.follows, "by_s": d.by_s, "correlation": d.correlation }))
        .collect();
    json!({
        "file": given.path.to_string_lossy(),
        "layout": layout_of(table),
        "assumptions": look.notes.iter().map(ToString::to_string).collect::<Vec<_>>(),
        "clocks": clocks, "channels": channels, "delays": delays,
        "unusable": look.unusable.iter().map(|u| json!({ "name": u.name, "why": u.fault.message, "help": u.fault.repair })).collect::<Vec<_>>(),
        "line": seen.line(),
        "without_unit": seen.without_units(),
    })
}

/// The layout in words.
fn layout_of(table: &Table) -> String {
    table
        .layout()
        .map_or_else(|| "Parquet".to_owned(), |kind| kind.to_string())
}
