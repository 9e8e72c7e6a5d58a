//! The records of an experiment: which files they are, and their tables.

use crate::asked::Asked;
use crate::package::links_out;
use crate::record_files::{self, Files};
use crate::record_settings::Given;
use crate::refusals::files as refused;
use hyde_compiler::Header;
use hyde_diag::{Diagnostic, Diagnostics};
use hyde_signal::Table;
use hyde_syntax::ast::{Experiment, RecordItem};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What becomes of an experiment whose records are not there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Records {
    /// It cannot be run: an error.
    Needed,
    /// Its model is checked alone, with a warning.
    IfThere,
}

/// A record that was read.
#[derive(Debug)]
pub struct Record {
    /// Where it is; of several files the pattern that names them.
    pub path: PathBuf,
    /// SHA-256 of its content; of several files, of their contents one after another.
    pub hash: String,
    /// Its columns over time.
    pub table: Table,
}

/// Reads every record of an experiment. What is missing or wrong is reported and left out.
///
/// # Errors
/// A record is asked for that the experiment does not have.
pub fn read(
    experiment: &Experiment,
    asked: &Asked,
    needed: Records,
    diagnostics: &mut Diagnostics,
) -> Result<BTreeMap<String, Record>, String> {
    let given = given(asked, experiment)?;
    let mut found = BTreeMap::new();
    for item in &experiment.records {
        let Some(files) = files_of(item, &given, asked, needed, diagnostics) else {
            continue;
        };
        let settings = given.get(item.name.text.as_str());
        let settings = settings.and_then(|given| given.settings.as_ref());
        match record_files::read(item, settings, files, asked, needed) {
            Ok(record) => {
                found.insert(item.name.text.clone(), record);
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
pub fn headers(records: &BTreeMap<String, Record>) -> BTreeMap<String, Header> {
    records
        .iter()
        .map(|(name, record)| {
            let columns = record.table.names().into_iter();
            let columns = columns
                .map(|(name, column)| (name.to_owned(), column.unit().cloned()))
                .collect();
            let unusable = record.table.unusable().iter();
            let unusable = unusable
                .map(|column| {
                    let fault = column.fault.clone();
                    (column.name.clone(), fault.message, fault.repair)
                })
                .collect();
            let sparse = record.table.unusable().iter().filter_map(|own| {
                let readings = own.readings.as_ref()?;
                let unit = readings.column(&own.name)?.unit().cloned();
                Some((own.name.clone(), unit))
            });
            let sparse = sparse.collect();
            let header = Header {
                sparse,
                columns,
                step_s: record.table.usual_step(),
                unusable,
            };
            (name.clone(), header)
        })
        .collect()
}

/// The tables of records, for the run.
pub fn tables(records: &BTreeMap<String, Record>) -> BTreeMap<String, Table> {
    records
        .iter()
        .map(|(name, record)| (name.clone(), record.table.clone()))
        .collect()
}

/// The files that were named for records; a name that the experiment does not have is a mistake of whoever asks.
fn given<'a>(
    asked: &'a Asked,
    experiment: &Experiment,
) -> Result<BTreeMap<&'a str, Given>, String> {
    let records = experiment.records.iter();
    let known: Vec<&str> = records.map(|record| record.name.text.as_str()).collect();
    for (name, _) in &asked.records {
        if !known.contains(&name.as_str()) {
            let quoted: Vec<String> = known.iter().map(|name| format!("`{name}`")).collect();
            let has = match quoted.is_empty() {
                true => "none".to_owned(),
                false => quoted.join(", "),
            };
            return Err(format!(
                "the experiment `{}` has no record `{name}`; it has {has}",
                experiment.name.text
            ));
        }
    }
    let files = asked.records.iter().map(|(name, path)| {
        let given = Given::of(asked.world.as_ref(), name, &path.to_string_lossy())?;
        Ok((name.as_str(), given))
    });
    files.collect()
}

/// The files of a record: as given, else its default, below `--data` or beside the model.
fn files_of(
    item: &RecordItem,
    given: &BTreeMap<&str, Given>,
    asked: &Asked,
    needed: Records,
    diagnostics: &mut Diagnostics,
) -> Option<Files> {
    if let Some(given) = given.get(item.name.text.as_str()) {
        let text = given.path.to_string_lossy();
        return Some(Files::named(asked.world.as_ref(), Path::new(""), &text));
    }
    let Some(default) = &item.default else {
        diagnostics.push(missing(item, needed, "no file is given"));
        return None;
    };
    let inside = record_files::parts(&default.text)
        .flat_map(|name| Path::new(name).components())
        .all(|part| {
            matches!(
                part,
                std::path::Component::Normal(_) | std::path::Component::CurDir
            )
        });
    if !inside {
        diagnostics.push(refused::leaves_folder(
            &item.name.text,
            (&default.text, default.span),
        ));
        return None;
    }
    let root = asked
        .data
        .clone()
        .or_else(|| asked.file.parent().map(Path::to_path_buf))
        .unwrap_or_default();
    let files = Files::named(asked.world.as_ref(), &root, &default.text);
    let out = |file: &PathBuf| links_out(asked.world.as_ref(), &root, file);
    if files.all.iter().any(out) {
        let default = (&*default.text, default.span);
        diagnostics.push(refused::links_out(&item.name.text, default));
        return None;
    }
    Some(files)
}

/// That the file of a record is not there.
pub(crate) fn missing(item: &RecordItem, needed: Records, reason: &str) -> Diagnostic {
    match needed {
        Records::Needed => refused::missing_record(&item.name, reason),
        Records::IfThere => refused::missing_record_unused(&item.name, reason),
    }
}
