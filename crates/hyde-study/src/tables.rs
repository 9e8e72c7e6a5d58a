//! The files of tables: which they are, and their columns.

use crate::asked::Asked;
use crate::inputs::Kind;
use crate::package::Roots;
use crate::refusals::files as refused;
use hyde_compiler::{File, TableFile};
use hyde_diag::{Diagnostic, Diagnostics, Sources, Span};
use hyde_signal::Layout;
use sha2::{Digest, Sha256};
use std::path::PathBuf;

/// A table's file that was read.
#[derive(Clone, Debug)]
pub struct Table {
    /// Where it is.
    pub path: PathBuf,
    /// SHA-256 of its content.
    pub hash: String,
    /// Number of rows.
    pub rows: usize,
    /// What was taken for granted of it.
    pub notes: Vec<String>,
}

/// Reads the files of every table into `file`. What is missing or wrong is reported.
pub(crate) fn read(
    file: &mut File,
    asked: &Asked,
    roots: &Roots,
    sources: &Sources,
    diagnostics: &mut Diagnostics,
) -> Vec<Table> {
    let mut found: Vec<Table> = Vec::new();
    for (id, name, span) in file.tables_named() {
        match of_file(asked, roots, &sources.get(id).name, &name, span) {
            Ok((table, columns)) => {
                file.tables.insert((id, name), TableFile { columns });
                if found.iter().all(|known| known.path != table.path) {
                    found.push(table);
                }
            }
            Err(diagnostic) => diagnostics.push(diagnostic),
        }
    }
    found
}

type Columns = Vec<(String, Option<hyde_units::NamedUnit>, Vec<f64>)>;

fn of_file(
    asked: &Asked,
    roots: &Roots,
    importer: &str,
    name: &str,
    span: Span,
) -> Result<(Table, Columns), Diagnostic> {
    let path = match &asked.inputs {
        Some(inputs) if inputs.is_replayed() => PathBuf::from(name),
        Some(_) | None => roots
            .data(importer, name)
            .map_err(|diagnostic| diagnostic.label(span, "named here"))?,
    };
    let content = asked
        .read(Kind::Table, importer, name, &path)
        .map_err(|reason| refused::no_table(&reason, span))?;
    // A table has no time: its rows are only counted.
    let table = hyde_signal::read_whole(&content, &Layout::every(1.0)).map_err(|error| {
        let (why, repair) = (error.to_string(), error.repair("file"));
        refused::unreadable_table(&path.display().to_string(), (&why, &repair), span)
    })?;
    let columns = table.columns().iter();
    let columns = columns.map(|column| {
        (
            column.name().to_owned(),
            column.unit().cloned(),
            column.values().to_vec(),
        )
    });
    let columns = columns.collect();
    let read = Table {
        path,
        hash: format!("{:x}", Sha256::digest(&content)),
        rows: table.rows(),
        notes: table.notes().iter().map(ToString::to_string).collect(),
    };
    Ok((read, columns))
}
