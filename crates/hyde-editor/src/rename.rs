//! Where a name is used, in every file that can see it, and how it gets another name.

use crate::analysis::{Analysis, Identity};
use crate::outline;
use crate::position::Encoding;
use crate::scope::Thing;
use crate::uri;
use hyde_study::world::{World, below, read_text};
use lsp_types::{Location, TextEdit, Uri, WorkspaceEdit};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A use of a name in a file.
pub(crate) struct Use {
    pub(crate) path: PathBuf,
    pub(crate) bytes: Range<usize>,
    pub(crate) declares: bool,
}

/// The uses of a name in some files, each parsed with what it imports; and whether a name of that text is not understood
/// somewhere.
#[derive(Default)]
pub(crate) struct Uses {
    pub(crate) uses: Vec<Use>,
    pub(crate) texts: BTreeMap<PathBuf, String>,
    /// The first place where the text stands and its meaning is not known.
    pub(crate) unknown: Option<String>,
}

/// The files that may use what a file declares: those below the folders, and those that are open.
pub(crate) fn candidates(
    world: &Arc<dyn World>,
    folders: &[PathBuf],
    open: impl Iterator<Item = PathBuf>,
) -> BTreeSet<PathBuf> {
    let mut found: BTreeSet<PathBuf> = open.collect();
    for folder in folders {
        found.extend(below(world.as_ref(), folder, "hyde", ""));
    }
    found
}

/// Every use of what is declared at a place under a name.
pub(crate) fn uses(
    world: &Arc<dyn World>,
    files: &BTreeSet<PathBuf>,
    identity: &Identity,
    name: &str,
) -> Uses {
    let mut all = Uses::default();
    for path in files {
        let holds = read_text(world.as_ref(), path).is_ok_and(|text| text.contains(name));
        let Some(analysis) = holds.then(|| Analysis::of(world, path)).flatten() else {
            continue;
        };
        in_file(&analysis, identity, name, &mut all);
    }
    all
}

/// The uses in one file.
pub(crate) fn in_file(analysis: &Analysis, identity: &Identity, name: &str, all: &mut Uses) {
    let mut own: Vec<(Range<usize>, bool)> = Vec::new();
    for found in analysis.occurrences() {
        let bytes = found.span.start as usize..found.span.end as usize;
        match &found.meaning {
            Some(meaning) if analysis.identity(meaning) == *identity => {
                own.push((bytes, found.declares));
            }
            None if found.text == name && all.unknown.is_none() => {
                all.unknown = Some(analysis.loaded.sources.place(found.span));
            }
            Some(_) | None => {}
        }
    }
    let text = analysis.text();
    let written = outline::written(text);
    for (opened, closed) in outline::ends(&written) {
        if own.iter().any(|(bytes, _)| *bytes == opened) {
            own.push((closed, false));
        }
    }
    own.sort_by_key(|(bytes, declares)| (bytes.start, !declares));
    own.dedup_by_key(|(bytes, _)| bytes.start);
    if !own.is_empty() {
        all.texts.insert(analysis.path.clone(), text.to_owned());
    }
    all.uses
        .extend(own.into_iter().map(|(bytes, declares)| Use {
            path: analysis.path.clone(),
            bytes,
            declares,
        }));
}

impl Uses {
    /// The places as the protocol has them.
    pub(crate) fn locations(&self, encoding: Encoding, declarations: bool) -> Vec<Location> {
        let own = self.uses.iter().filter(|own| declarations || !own.declares);
        own.filter_map(|own| {
            let text = self.texts.get(&own.path)?;
            let range = encoding.range(text, own.bytes.clone());
            Some(Location::new(uri::of(&own.path)?, range))
        })
        .collect()
    }

    /// The edit that gives another name.
    ///
    /// # Errors
    /// Why the name cannot be given.
    #[allow(
        clippy::mutable_key_type,
        reason = "the protocol's types have addresses as keys"
    )]
    pub(crate) fn renamed(
        &self,
        world: &Arc<dyn World>,
        encoding: Encoding,
        (old, new): (&str, &str),
    ) -> Result<WorkspaceEdit, String> {
        let first = new.starts_with(|c: char| c.is_ascii_alphabetic() || c == '_');
        let word = first && new.chars().all(|c| c.is_ascii_alphanumeric() || c == '_');
        if !word {
            return Err(format!(
                "`{new}` is not a name: write letters, digits and `_`, a letter first"
            ));
        }
        if hyde_syntax::is_reserved(new) {
            return Err(format!("`{new}` is a keyword of the language"));
        }
        if let Some(place) = &self.unknown {
            return Err(format!(
                "the meaning of `{old}` is not known at {place}: repair that place if it has an error, else rename by hand"
            ));
        }
        for path in self.texts.keys() {
            let Some(analysis) = Analysis::of(world, path) else {
                continue;
            };
            let known = analysis.occurrences();
            if let Some(found) = known.iter().find(|found| found.text == new) {
                let place = analysis.loaded.sources.place(found.span);
                return Err(format!("there is a `{new}` already, at {place}"));
            }
        }
        let mut changes: std::collections::HashMap<Uri, Vec<TextEdit>> = Default::default();
        for location in self.locations(encoding, true) {
            let edit = TextEdit::new(location.range, new.to_owned());
            changes.entry(location.uri).or_default().push(edit);
        }
        Ok(WorkspaceEdit {
            changes: Some(changes),
            ..WorkspaceEdit::default()
        })
    }
}

/// Why something cannot be renamed: it is declared in the library, or its name is that of a file.
pub(crate) fn fixed(analysis: &Analysis, thing: Thing<'_>, source: &str) -> Option<String> {
    if matches!(thing, Thing::Package(_)) {
        return Some("the name of a package is that of its file".to_owned());
    }
    let of_library = !Path::new(source).is_absolute();
    let own = Path::new(source) == analysis.path;
    (of_library && !own).then(|| format!("it is declared in the library, in `{source}`"))
}
