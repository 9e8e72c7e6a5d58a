//! How a record is to be read where its experiment does not say it: behind its file, as whoever asks names it, or in a file
//! beside it.

use crate::record_files::{self, Files};
use crate::refusals::files as refused;
use crate::world::World;
use hyde_diag::{Diagnostic, Diagnostics, Sources};
use hyde_signal::{Note, Table};
use hyde_syntax::ast::RecordItem;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// A record as whoever asks gives it: `scope.csv (time = "Time" in [ms])`, `log.txt every 1 [ms]`.
#[derive(Debug)]
pub struct Given {
    /// The file.
    pub path: PathBuf,
    /// How it is to be read, where that is said.
    pub settings: Option<RecordItem>,
    /// The text of the settings.
    pub text: String,
}

/// Reads files as one record, as settings say or the files beside them, for whoever has no experiment.
///
/// # Errors
/// What is wrong, with the repair.
pub(crate) fn alone(
    world: &dyn World,
    given: &Given,
    files: Files,
) -> Result<Table, (String, Option<String>)> {
    let item = parsed(RECORD, "").map_err(|reason| (reason, None))?;
    let open = |file: &Path| world.read(file);
    record_files::joined(
        &item,
        given.settings.as_ref(),
        files,
        &open,
        &refused::no_record,
    )
    .map(|record| record.table)
    .map_err(|diagnostic| (diagnostic.message.clone(), diagnostic.help.clone()))
}

/// What a record is called where nobody has named it.
pub const RECORD: &str = "log";

/// How settings begin behind a file.
const BEGINNINGS: [&str; 4] = [" (", "(", " layout ", " every "];

impl Given {
    /// Reads a file with what stands behind it, for the record of that name.
    ///
    /// # Errors
    /// What stands behind the file is not understood.
    pub fn of(world: &dyn World, name: &str, text: &str) -> Result<Self, String> {
        let (file, behind) = split(world, text);
        if behind.is_empty() {
            return Ok(Self {
                path: PathBuf::from(file),
                settings: None,
                text: String::new(),
            });
        }
        let settings =
            parsed(name, behind).map_err(|reason| format!("`--record {name}={text}`: {reason}"))?;
        Ok(Self {
            path: PathBuf::from(file),
            settings: Some(settings),
            text: behind.to_owned(),
        })
    }
}

/// How messages call files: by their names, with what stands behind them.
pub(crate) fn called(world: &dyn World, text: &str) -> String {
    let (files, behind) = split(world, text);
    let names = Files::named(world, Path::new(""), files).names();
    format!("{names} {behind}").trim_end().to_owned()
}

/// The name of a file, and what stands behind it of how it is read.
#[must_use]
pub fn split<'t>(world: &dyn World, text: &'t str) -> (&'t str, &'t str) {
    let beginnings = BEGINNINGS.iter();
    let at = beginnings
        .filter_map(|beginning| text.find(beginning))
        .min();
    match at.filter(|_| !world.is_file(Path::new(text))) {
        Some(at) => (text[..at].trim_end(), text[at..].trim()),
        None => (text, ""),
    }
}

/// The file beside a record that may say how it is to be read: `scope.csv.layout`.
pub(crate) fn side_file(path: &Path) -> PathBuf {
    let mut name: OsString = path.as_os_str().to_owned();
    name.push(".layout");
    PathBuf::from(name)
}

/// Reads a record: as the command line says, else as the experiment does, else as the file beside it.
pub(crate) fn table(
    item: &RecordItem,
    given: Option<&RecordItem>,
    path: &Path,
    content: &[u8],
    side: Option<Vec<u8>>,
) -> Result<Table, Diagnostic> {
    let declares = !item.layout.is_empty() || item.every.is_some() || item.kind.is_some();
    let (settings, note) = match (given, side.filter(|_| !declares)) {
        (Some(given), _) => (Some(given.clone()), None),
        (None, None) => (None, None),
        (None, Some(side)) => {
            let name = side_file(path).display().to_string();
            let text = String::from_utf8_lossy(&side).trim().to_owned();
            let settings = parsed(&item.name.text, &text)
                .map_err(|reason| refused::bad_settings(&name, &reason, item.name.span))?;
            let note = Note::new(format!("read as `{name}` says: {text}"));
            (Some(settings), Some(note))
        }
    };
    let item = settings.map_or_else(|| item.clone(), |settings| replaced(item, settings));
    let mut table = hyde_experiment::read_record(&item, &path.display().to_string(), content)?;
    note.into_iter().for_each(|note| table.tell(note));
    Ok(table)
}

/// The declaration with other settings, which stand in no file that messages could show.
fn replaced(item: &RecordItem, settings: RecordItem) -> RecordItem {
    let place = item.name.span;
    let mut settings = settings;
    for setting in &mut settings.layout {
        setting.name.span = place;
        setting.value.span = place;
        if let Some((_, unit)) = &mut setting.unit {
            unit.span = place;
        }
    }
    if let Some(kind) = &mut settings.kind {
        kind.span = place;
    }
    if let Some(every) = &mut settings.every {
        every.span = place;
    }
    RecordItem {
        name: item.name.clone(),
        default: item.default.clone(),
        ..settings
    }
}

/// The settings in a text.
fn parsed(name: &str, text: &str) -> Result<RecordItem, String> {
    let mut sources = Sources::default();
    let file = sources.add("record", format!("record {name} = \"\" {}", text.trim()));
    let mut diagnostics = Diagnostics::default();
    let item = hyde_syntax::parse_record(&sources, file, &mut diagnostics);
    match (item, diagnostics.iter().next()) {
        (Some(item), None) => Ok(item),
        (_, Some(diagnostic)) => Err(format!("`{}`: {}", text.trim(), diagnostic.message)),
        (None, None) => Err(format!("`{}` is not understood", text.trim())),
    }
}
