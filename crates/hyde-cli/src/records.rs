//! The records of an experiment: which files they are, and their tables.

use crate::args::ModelArgs;
use crate::files;
use crate::project::Records;
use hyde_compiler::Header;
use hyde_diag::{Code, Diagnostic, Diagnostics};
use hyde_signal::{Table, csv};
use hyde_syntax::ast::{Experiment, Expr, ExprKind, RecordItem};
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
        let Some(every) = every(item, diagnostics) else {
            continue;
        };
        let content = match files::read(&path) {
            Ok(content) => content,
            Err(reason) => {
                diagnostics.push(missing(item, needed, &reason));
                continue;
            }
        };
        match csv::read(&content, every) {
            Ok(table) => {
                let hash = format!("{:x}", Sha256::digest(&content));
                found.insert(item.name.text.clone(), Record { path, hash, table });
            }
            Err(error) => diagnostics.push(
                Diagnostic::error(Code::BadRecord, format!("`{}`: {error}", path.display()))
                    .label(item.name.span, "the record is declared here")
                    .help("a record is a CSV file with a header of `name [unit]` columns, time in the first"),
            ),
        }
    }
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
            (name.clone(), Header { columns })
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
    Some(root.join(relative))
}

/// `every 1 [ms]`: the outer `None` is a mistake.
#[allow(clippy::option_option, reason = "no period is not a wrong period")]
fn every(item: &RecordItem, diagnostics: &mut Diagnostics) -> Option<Option<f64>> {
    let Some(expr) = &item.every else {
        return Some(None);
    };
    match literal_time(expr) {
        Some(period) if period > 0.0 => Some(Some(period)),
        _ => {
            diagnostics.push(
                Diagnostic::error(Code::BadRecord, "the time between rows is no positive time")
                    .label(expr.span, "a number with a unit of time is expected")
                    .help("write `every 1 [ms]`"),
            );
            None
        }
    }
}

fn literal_time(expr: &Expr) -> Option<f64> {
    let ExprKind::Number(value, Some(unit)) = &expr.kind else {
        return None;
    };
    let unit = hyde_units::parse_unit(&unit.text).ok()?;
    (unit.dimension == hyde_units::Dimension::TIME).then(|| unit.to_si(*value))
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
