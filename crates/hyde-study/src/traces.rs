//! [`seen`]: what is in a trace, before any model reads it.

use crate::record_files::{self, Files, own_name};
use crate::record_settings::{self, Given, RECORD};
use crate::world::World;
use hyde_signal::Table;
use hyde_signal::look::{Look, look as look_at};
use std::path::{Path, PathBuf};

/// A file that was looked at.
pub struct Seen {
    /// Which file, or which sum or pattern of several, and how they are read.
    pub given: Given,
    /// The files that it names, which are one record.
    pub files: Vec<PathBuf>,
    /// Its columns.
    pub table: Table,
    /// What is in them.
    pub look: Look,
}

/// A file that cannot be read: its name, what is wrong, and the repair.
pub struct Unread {
    /// Its name.
    pub file: String,
    /// What is wrong.
    pub message: String,
    /// What to do.
    pub help: Option<String>,
}

/// Reads a file, or several that a sum or a pattern names as one record, and looks at it; how it is to be read may follow its
/// name.
///
/// # Errors
/// It cannot be read.
pub fn seen(world: &dyn World, file: &str) -> Result<Seen, Unread> {
    let wrong = |message: String, help| Unread {
        file: file.to_owned(),
        message,
        help,
    };
    let given = Given::of(world, RECORD, file).map_err(|reason| wrong(reason, None))?;
    let files = Files::named(world, Path::new(""), &given.path.to_string_lossy());
    let found = files.all.clone();
    let table = record_settings::alone(world, &given, files)
        .map_err(|(message, help)| wrong(message, help))?;
    let look = look_at(&table);
    Ok(Seen {
        given,
        files: found,
        table,
        look,
    })
}

impl Seen {
    /// The line that declares the record in an experiment.
    #[must_use]
    pub fn line(&self) -> String {
        let file = record_files::sum(&self.files, own_name);
        format!("record {RECORD} = {file:?} {}", self.settings())
            .trim_end()
            .to_owned()
    }

    /// How the file is to be read: as was said, with the units that follow from other channels.
    pub fn settings(&self) -> String {
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
            (text, false) => match closed(text) {
                Some(at) if text.starts_with('(') => {
                    let (inner, rest) = text.split_at(at);
                    format!("{inner}, {}{rest}", units.join(", "))
                }
                _ => format!("({}) {text}", units.join(", ")),
            },
        }
    }

    /// The channels whose unit nobody says and nothing tells.
    #[must_use]
    pub fn without_units(&self) -> Vec<&str> {
        let all = self.look.channels.iter();
        let bare = all.filter(|c| c.unit.is_none() && c.guessed.is_none());
        bare.filter(|c| c.shown.role != hyde_signal::look::Role::State)
            .map(|c| c.name.as_str())
            .collect()
    }
}

/// Where the settings end: the first closing parenthesis that is not in a text.
fn closed(settings: &str) -> Option<usize> {
    let (mut quoted, mut escaped) = (false, false);
    let mut signs = settings.char_indices();
    let end = signs.find(|(_, sign)| {
        let own = std::mem::take(&mut escaped);
        match sign {
            '\\' if quoted && !own => escaped = true,
            '"' if !own => quoted = !quoted,
            _ => {}
        }
        *sign == ')' && !quoted
    });
    end.map(|(at, _)| at)
}

#[cfg(test)]
mod tests {
    use super::closed;

    #[test]
    fn a_parenthesis_in_a_name_does_not_end_the_settings() {
        for (settings, inner) in [
            (
                r#"(column = "Pos (filt)" in [mm]) every 1 [ms]"#,
                r#"(column = "Pos (filt)" in [mm]"#,
            ),
            (r#"(column = "a\") b")"#, r#"(column = "a\") b""#),
            ("(run = 1)", "(run = 1"),
        ] {
            assert_eq!(closed(settings).map(|at| &settings[..at]), Some(inner));
        }
        assert_eq!(closed("every 1 [ms]"), None);
    }
}
