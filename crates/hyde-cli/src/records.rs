//! The records of an experiment: which files they are, and their tables.

use crate::args::ModelArgs;
use crate::batch::inputs::Kind;
use crate::package::links_out;
use crate::project::Records;
use hyde_compiler::Header;
use hyde_diag::{Code, Diagnostic, Diagnostics};
use hyde_signal::Table;
use hyde_syntax::ast::{Experiment, RecordItem};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A record that was read.
pub(crate) struct Record {
    pub(crate) path: PathBuf,
    pub(crate) hash: String,
    pub(crate) table: Table,
}

/// Reads every record of an experiment. What is missing or wrong is reported and left out.
pub(crate) fn read(
    experiment: &Experiment,
    args: &ModelArgs,
    needed: Records,
    diagnostics: &mut Diagnostics,
) -> Result<BTreeMap<String, Record>, String> {
    let given = given(args, experiment)?;
    let mut found = BTreeMap::new();
    for item in &experiment.records {
        let Some(path) = path_of(item, &given, args, needed, diagnostics) else {
            continue;
        };
        let content = match args.read(Kind::Record, "", &path.to_string_lossy(), &path) {
            Ok(content) => content,
            Err(reason) => {
                diagnostics.push(missing(item, needed, &reason));
                continue;
            }
        };
        match hyde_experiment::read_record(item, &path.display().to_string(), &content) {
            Ok(table) => {
                let hash = format!("{:x}", Sha256::digest(&content));
                found.insert(item.name.text.clone(), Record { path, hash, table });
            }
            Err(diagnostic) => diagnostics.push(diagnostic),
        }
    }
    let mut tables: Vec<(&str, &mut Table)> = found
        .iter_mut()
        .map(|(name, record): (&String, &mut Record)| (name.as_str(), &mut record.table))
        .collect();
    hyde_signal::align(&mut tables);
    Ok(found)
}

/// The headers of records, for the compiler.
pub(crate) fn headers(records: &BTreeMap<String, Record>) -> BTreeMap<String, Header> {
    records
        .iter()
        .map(|(name, record)| {
            let columns = record.table.columns().iter();
            let columns = columns
                .map(|column| (column.name().to_owned(), column.unit().cloned()))
                .collect();
            let unusable = record.table.unusable().iter();
            let unusable = unusable
                .map(|column| {
                    let fault = column.fault.clone();
                    (column.name.clone(), fault.message, fault.repair)
                })
                .collect();
            let header = Header {
                columns,
                step_s: record.table.usual_step(),
                unusable,
            };
            (name.clone(), header)
        })
        .collect()
}

/// The tables of records, for the run.
pub(crate) fn tables(records: &BTreeMap<String, Record>) -> BTreeMap<String, Table> {
    records
        .iter()
        .map(|(name, record)| (name.clone(), record.table.clone()))
        .collect()
}

/// `--record NAME=PATH`; a name that the experiment does not have is a mistake of the command line.
fn given(args: &ModelArgs, experiment: &Experiment) -> Result<BTreeMap<String, PathBuf>, String> {
    let mut found = BTreeMap::new();
    for text in &args.records {
        let (name, path) = text
            .split_once('=')
            .ok_or_else(|| format!("`--record {text}`: write `NAME=PATH`"))?;
        if !experiment
            .records
            .iter()
            .any(|record| record.name.text == name)
        {
            let known: Vec<String> = experiment
                .records
                .iter()
                .map(|record| format!("`{}`", record.name.text))
                .collect();
            let known = if known.is_empty() {
                "none".to_owned()
            } else {
                known.join(", ")
            };
            return Err(format!(
                "the experiment `{}` has no record `{name}`; it has {known}",
                experiment.name.text
            ));
        }
        found.insert(name.to_owned(), PathBuf::from(path));
    }
    Ok(found)
}

/// The file of a record: as given, else its default, below `--data` or beside the model.
fn path_of(
    item: &RecordItem,
    given: &BTreeMap<String, PathBuf>,
    args: &ModelArgs,
    needed: Records,
    diagnostics: &mut Diagnostics,
) -> Option<PathBuf> {
    if let Some(path) = given.get(&item.name.text) {
        return Some(path.clone());
    }
    let Some(default) = &item.default else {
        diagnostics.push(missing(item, needed, "no file is given"));
        return None;
    };
    let relative = Path::new(&default.text);
    let inside = relative.components().all(|part| {
        matches!(
            part,
            std::path::Component::Normal(_) | std::path::Component::CurDir
        )
    });
    if !inside {
        diagnostics.push(
            Diagnostic::error(
                Code::NoRecord,
                format!("`{}` leaves the model's folder", default.text),
            )
            .label(
                default.span,
                "only files below the model's folder or `--data` are read",
            )
            .help(format!(
                "give it on the command line: `--record {}={}`",
                item.name.text, default.text
            )),
        );
        return None;
    }
    let root = args
        .data
        .clone()
        .or_else(|| args.file.parent().map(Path::to_path_buf))
        .unwrap_or_default();
    let path = root.join(relative);
    if links_out(&root, &path) {
        let message = format!("`{}` leads out of its folder by a link", default.text);
        let diagnostic = Diagnostic::error(Code::NoRecord, message)
            .label(
                default.span,
                "only files below the model's folder or `--data` are read",
            )
            .help(format!(
                "put the file into the folder, or give it on the command line: `--record {}=PATH`",
                item.name.text
            ));
        diagnostics.push(diagnostic);
        return None;
    }
    Some(path)
}

fn missing(item: &RecordItem, needed: Records, reason: &str) -> Diagnostic {
    let name = &item.name.text;
    let message = format!("the record `{name}` is missing: {reason}");
    let diagnostic = match needed {
        Records::Needed => Diagnostic::error(Code::NoRecord, message),
        Records::IfThere => Diagnostic::warning(
            Code::NoRecord,
            format!("{message}; the model is checked without its experiment"),
        ),
    };
    diagnostic
        .label(item.name.span, "declared here")
        .help(format!(
            "give its file: `--record {name}=PATH`, or the folder it is below: `--data DIR`"
        ))
}
