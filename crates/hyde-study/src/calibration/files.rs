//! The records of a calibration: the files that its patterns name, and what an observer reads of them.

use crate::asked::Asked;
use crate::package::links_out;
use crate::record_files;
use crate::record_settings::{Given, called, split};
use crate::refusals::files as refused;
use crate::unobservable::unreadable;
use crate::world::{World, matching};
use hyde_calibrate::{Recording, Source};
use hyde_diag::{Diagnostic, Diagnostics, Span};
use hyde_program::Program;
use hyde_syntax::ast::Experiment;
use hyde_units::counted;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The files of a source: for each record set, the files of its records.
pub(super) fn files_of(
    source: &Source,
    experiment: &Experiment,
    asked: &Asked,
    diagnostics: &mut Diagnostics,
) -> Vec<Vec<(String, PathBuf)>> {
    let folder = asked
        .data
        .clone()
        .or_else(|| asked.file.parent().map(Path::to_path_buf))
        .unwrap_or_default();
    let mut patterns: Vec<(String, String, Span, bool)> = Vec::new();
    for (number, (record, pattern)) in source.patterns.iter().enumerate() {
        let own = experiment
            .records
            .get(number)
            .map(|item| item.name.text.clone());
        let Some(record) = record.clone().or(own) else {
            let records = counted(experiment.records.len(), "record");
            let own = &source.experiment;
            diagnostics.push(crate::refusals::calibrations::pattern_of_no_record(
                own,
                &records,
                pattern.span,
            ));
            return Vec::new();
        };
        let whole = record_files::is_sum(&pattern.text);
        patterns.push((record, pattern.text.clone(), pattern.span, whole));
    }
    for item in &experiment.records {
        if let Some(default) = &item.default
            && !patterns
                .iter()
                .any(|(record, ..)| *record == item.name.text)
        {
            // What the experiment itself reads is one record.
            let name = item.name.text.clone();
            patterns.push((name, default.text.clone(), source.span, true));
        }
    }
    let mut sets: Vec<Vec<(String, PathBuf)>> = Vec::new();
    for (record, text, span, whole) in &patterns {
        let (pattern, settings) = split(asked.world.as_ref(), text);
        let (matching, files) = match whole {
            true => record_files::Files::named(asked.world.as_ref(), &folder, pattern)
                .one_record(asked.world.as_ref()),
            false => {
                let found = matching(asked.world.as_ref(), &folder, pattern);
                (found.clone(), found)
            }
        };
        if matching.is_empty() {
            let folder = shown(&folder);
            diagnostics.push(refused::no_such_file(
                (pattern, *span),
                &folder,
                asked.data.is_some(),
            ));
            return Vec::new();
        }
        if let Some(path) = files
            .iter()
            .find(|path| links_out(asked.world.as_ref(), &folder, path))
        {
            diagnostics.push(refused::link_out_of_folder(
                &path.display().to_string(),
                *span,
            ));
            return Vec::new();
        }
        let several = sets.len() > 1;
        if several && matching.len() != 1 && matching.len() != sets.len() {
            diagnostics.push(refused::numbers_of_files(
                &counted(sets.len(), "file"),
                matching.len(),
                *span,
            ));
            return Vec::new();
        }
        let old = if sets.is_empty() {
            vec![Vec::new()]
        } else {
            std::mem::take(&mut sets)
        };
        let count = old.len().max(matching.len());
        for number in 0..count {
            let mut set = old[number.min(old.len() - 1)].clone();
            // How it is read goes with the file.
            let path = matching[number.min(matching.len() - 1)].display();
            let path = PathBuf::from(format!("{path} {settings}").trim_end());
            set.push((record.clone(), path));
            sets.push(set);
        }
    }
    sets
}

fn shown(folder: &Path) -> String {
    match folder.as_os_str().is_empty() {
        true => ".".to_owned(),
        false => folder.display().to_string(),
    }
}

/// Reads the files of a record set for a program with values that are set from outside.
pub(super) fn recording(
    world: &dyn World,
    set: &[(String, PathBuf)],
    experiment: &Experiment,
    (program, values): (&Program, &[(usize, f64)]),
    span: Span,
) -> Result<Recording, Box<Diagnostic>> {
    let mut tables: BTreeMap<String, hyde_signal::Table> = BTreeMap::new();
    let mut name = String::new();
    for (record, path) in set {
        let item = experiment
            .records
            .iter()
            .find(|item| item.name.text == *record);
        let Some(item) = item else {
            let own = &experiment.name.text;
            return Err(Box::new(refused::no_record_of_experiment(
                own, record, span,
            )));
        };
        let wrong = |reason: String| Box::new(refused::unreadable_record(&reason, span));
        let text = path.to_string_lossy();
        let given = Given::of(world, record, &text).map_err(wrong)?;
        if name.is_empty() {
            name = called(world, &text);
        }
        let files = record_files::Files::named(world, Path::new(""), &given.path.to_string_lossy());
        let open = |file: &Path| world.read(file);
        let missing = |reason: &str| refused::no_files(reason, span);
        let read = record_files::joined(item, given.settings.as_ref(), files, &open, &missing);
        let table = read.map_err(Box::new)?.table;
        tables.insert(record.clone(), table);
    }
    let mut all: Vec<(&str, &mut hyde_signal::Table)> = tables
        .iter_mut()
        .map(|(name, table)| (name.as_str(), table))
        .collect();
    hyde_signal::align(&mut all);
    Recording::new(&name, program, tables, values)
        .map_err(|error| Box::new(unreadable(&name, &error, span)))
}
