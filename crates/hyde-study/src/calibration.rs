//! A calibration on its way to a report: its block, its records, its program in the observed form.

use crate::asked::Asked;
use crate::package::links_out;
use crate::project::{Aim, Loaded, Project, Records};
use crate::record_files;
use crate::refused::{Fault, Refused};
use crate::unobservable::{unreadable, unsupported};
use crate::world::{World, matching};
use hyde_calibrate::{CalibrationPlan, Observer, Recording, Source, Varied, Vary};
use hyde_compiler::Compiled;
use hyde_diag::{Code, Diagnostic, Diagnostics, Span};
use hyde_program::Given;
use hyde_syntax::ast::{Experiment, Study, StudyKind};
use hyde_units::counted;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Everything a calibration is made of.
pub struct Calibration {
    /// The file with its model.
    pub project: Project,
    /// The model in the observed form.
    pub compiled: Compiled,
    /// The block.
    pub plan: CalibrationPlan,
    /// The records to fit.
    pub fitted: Vec<Recording>,
    /// The records held out.
    pub holdout: Vec<Recording>,
    /// What is varied.
    pub varied: Vec<Varied>,
    /// Values set from outside: position and value.
    pub set: Vec<(usize, f64)>,
    /// What all models are compared by.
    pub observer: Observer,
}

/// Makes a calibration of a file that is loaded: the one named, or the file's only one.
///
/// # Errors
/// There is none of that name; its block, its model or its records are at fault.
pub fn calibration(
    loaded: Loaded,
    asked: &Asked,
    name: Option<&str>,
) -> Result<Calibration, Refused> {
    let mut loaded = loaded;
    if loaded.diagnostics.has_errors() {
        return Err(loaded.refused());
    }
    let Some((plan, experiment)) = plan(&mut loaded, name).map_err(Refused::Asked)? else {
        return Err(loaded.refused());
    };
    let mut lists = [Vec::new(), Vec::new()];
    for (list, sources) in lists.iter_mut().zip([&plan.fit, &plan.holdout]) {
        for source in sources {
            list.extend(files_of(
                source,
                &experiment,
                asked,
                &mut loaded.diagnostics,
            ));
        }
    }
    let [fitted, holdout] = lists;
    let of_first = Asked {
        experiment: Some(experiment.name.text.clone()),
        records: fitted.first().cloned().unwrap_or_default(),
        ..asked.clone()
    };
    let project = loaded.choose(&of_first, Records::Needed);
    let Prepared {
        mut project,
        compiled,
        set,
        varied,
        mut wrong,
    } = prepared(project.map_err(Refused::Asked)?, &plan)?;
    let (mut recordings, mut count) = (Vec::new(), 0);
    let lists = if wrong.is_empty() {
        [fitted, holdout]
    } else {
        [Vec::new(), Vec::new()]
    };
    for (number, list) in lists.into_iter().enumerate() {
        for files in &list {
            match recording(
                asked.world.as_ref(),
                files,
                &experiment,
                &compiled,
                plan.span,
            ) {
                Ok(recording) => recordings.push(recording),
                Err(diagnostic) => wrong.push(*diagnostic),
            }
        }
        if number == 0 {
            count = recordings.len();
        }
    }
    let holdout = recordings.split_off(count);
    let fitted = recordings;
    let program = &compiled.program;
    let observer = match wrong.is_empty() {
        true => {
            Observer::new(program, &fitted, &set).map_err(|u| Box::new(unsupported(&u, plan.span)))
        }
        false => Err(Box::new(wrong.remove(0))),
    };
    match observer {
        Ok(observer) => Ok(Calibration {
            project,
            compiled,
            plan,
            fitted,
            holdout,
            varied,
            set,
            observer,
        }),
        Err(first) => {
            project.diagnostics.push(*first);
            wrong
                .into_iter()
                .for_each(|diagnostic| project.diagnostics.push(diagnostic));
            Err(project.refused(Fault::Model))
        }
    }
}

/// The model of a calibration, before its records are read.
pub(crate) struct Prepared {
    pub(crate) project: Project,
    pub(crate) compiled: Compiled,
    /// Values set from outside: position and value.
    pub(crate) set: Vec<(usize, f64)>,
    pub(crate) varied: Vec<Varied>,
    /// What is wrong with what is varied.
    pub(crate) wrong: Vec<Diagnostic>,
}

/// Compiles a project in the observed form, and finds what its calibration varies.
pub(crate) fn prepared(mut project: Project, plan: &CalibrationPlan) -> Result<Prepared, Refused> {
    if project.diagnostics.has_errors() {
        return Err(project.refused(Fault::Model));
    }
    let compiled = match project.compile(Aim::Observe) {
        Ok(compiled) => compiled,
        Err(fault) => return Err(project.refused(fault)),
    };
    let program = &compiled.program;
    let set: Vec<(usize, f64)> = project
        .set()
        .iter()
        .filter_map(|(name, value)| {
            let (parameter, element) = program.parameter(name)?;
            (!parameter.structural).then_some((parameter.place + element, *value))
        })
        .collect();
    let mut p = vec![0.0; program.n_parameters];
    program.kernels.parameters(&set, &mut p);
    let mut wrong = Vec::new();
    let varied = varied(plan, &compiled, &p, &mut wrong);
    Ok(Prepared {
        project,
        compiled,
        set,
        varied,
        wrong,
    })
}

/// The block that is meant, and the experiment of its records; `None` where one of them is at fault, as diagnostics say.
pub(crate) fn plan(
    loaded: &mut Loaded,
    name: Option<&str>,
) -> Result<Option<(CalibrationPlan, Experiment)>, String> {
    let Loaded {
        file, diagnostics, ..
    } = loaded;
    let studies = file.studies();
    let studies: Vec<&Study> = studies
        .filter(|study| study.kind == StudyKind::Calibrate)
        .collect();
    let study = chosen(&studies, name, "calibration")?;
    let Some(plan) = CalibrationPlan::read(study, diagnostics) else {
        return Ok(None);
    };
    let mut found: Option<&Experiment> = None;
    for source in plan.fit.iter().chain(&plan.holdout) {
        let known = file
            .experiments()
            .find(|experiment| experiment.name.text == source.experiment);
        let problem = match (known, found) {
            (None, _) => Some(format!(
                "the file has no experiment `{}`",
                source.experiment
            )),
            (Some(known), _) if known.model.dotted() != plan.model => Some(format!(
                "`{}` is an experiment of `{}`, the calibration is of `{}`",
                source.experiment,
                known.model.dotted(),
                plan.model
            )),
            (Some(known), Some(found)) if known.name.text != found.name.text => Some(format!(
                "the records of `{}` and `{}` are of two experiments",
                found.name.text, known.name.text
            )),
            (Some(known), _) => {
                found = Some(known);
                None
            }
        };
        if let Some(problem) = problem {
            diagnostics.push(
                Diagnostic::error(Code::BadStudy, problem)
                    .label(source.span, "asked for here")
                    .help("the records of a calibration are of one experiment of its model"),
            );
        }
    }
    match found {
        Some(experiment) if !diagnostics.has_errors() => Ok(Some((plan, experiment.clone()))),
        Some(_) | None => Ok(None),
    }
}

/// The study meant: the one named, or the only one.
pub fn chosen<'s>(
    studies: &[&'s Study],
    name: Option<&str>,
    what: &str,
) -> Result<&'s Study, String> {
    let known: Vec<String> = studies
        .iter()
        .map(|study| format!("`{}`", study.name.text))
        .collect();
    let listed = match known.as_slice() {
        [] => "it has none".to_owned(),
        _ => format!("it has {}", known.join(", ")),
    };
    match (name, studies) {
        (Some(name), _) => studies
            .iter()
            .copied()
            .find(|study| study.name.text == name)
            .ok_or_else(|| format!("the file has no {what} `{name}`; {listed}")),
        (None, [only]) => Ok(only),
        (None, _) => Err(format!("which {what}? {listed}")),
    }
}

/// The files of a source: for each record set, the files of its records.
fn files_of(
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
            diagnostics.push(
                Diagnostic::error(
                    Code::BadStudy,
                    format!(
                        "`{}` has {}",
                        source.experiment,
                        counted(experiment.records.len(), "record")
                    ),
                )
                .label(pattern.span, "no record is assigned to this pattern")
                .help("name the record of the pattern: `fit bench(file = \"fit-*.csv\");`"),
            );
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
    for (record, pattern, span, whole) in &patterns {
        let (matching, files) = match whole {
            true => record_files::Files::named(asked.world.as_ref(), &folder, pattern)
                .one_record(asked.world.as_ref()),
            false => {
                let found = matching(asked.world.as_ref(), &folder, pattern);
                (found.clone(), found)
            }
        };
        if matching.is_empty() {
            let help = match asked.data {
                None => "name the folder of the records: `--data DIR`",
                Some(_) => "put such files there, or write another pattern",
            };
            diagnostics.push(
                Diagnostic::error(
                    Code::NoFiles,
                    format!("no file is called `{pattern}` in `{}`", shown(&folder)),
                )
                .label(*span, "asked for here")
                .help(help),
            );
            return Vec::new();
        }
        if let Some(path) = files
            .iter()
            .find(|path| links_out(asked.world.as_ref(), &folder, path))
        {
            diagnostics.push(
                Diagnostic::error(
                    Code::NoRecord,
                    format!(
                        "`{}` is a link to a file outside its folder",
                        path.display()
                    ),
                )
                .label(
                    *span,
                    "only files below the model's folder or `--data` are read",
                )
                .help("move the file into the folder, or name its folder: `--data DIR`"),
            );
            return Vec::new();
        }
        let several = sets.len() > 1;
        if several && matching.len() != 1 && matching.len() != sets.len() {
            diagnostics.push(
                Diagnostic::error(
                    Code::NoFiles,
                    format!(
                        "{} for one record and {} for another",
                        counted(sets.len(), "file"),
                        matching.len()
                    ),
                )
                .label(*span, "asked for here")
                .help("give every record the same number of files, or one file"),
            );
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
            set.push((
                record.clone(),
                matching[number.min(matching.len() - 1)].clone(),
            ));
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

/// Reads the files of a record set.
fn recording(
    world: &dyn World,
    set: &[(String, PathBuf)],
    experiment: &Experiment,
    compiled: &Compiled,
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
            let message = format!("`{}` has no record `{record}`", experiment.name.text);
            return Err(Box::new(
                Diagnostic::error(Code::BadStudy, message).label(span, "in this study"),
            ));
        };
        let files = record_files::Files::named(world, Path::new(""), &path.to_string_lossy());
        if name.is_empty() {
            name = files.names();
        }
        let open = |file: &Path| world.read(file);
        let missing = |reason: &str| {
            Diagnostic::error(Code::NoFiles, reason.to_owned()).label(span, "in this study")
        };
        let read = record_files::joined(item, None, files, &open, &missing);
        let table = read.map_err(Box::new)?.table;
        tables.insert(record.clone(), table);
    }
    let mut all: Vec<(&str, &mut hyde_signal::Table)> = tables
        .iter_mut()
        .map(|(name, table)| (name.as_str(), table))
        .collect();
    hyde_signal::align(&mut all);
    Recording::new(&name, &compiled.program, tables)
        .map_err(|error| Box::new(unreadable(&name, &error, span)))
}

/// What may be varied, by name.
fn varied(
    plan: &CalibrationPlan,
    compiled: &Compiled,
    p: &[f64],
    wrong: &mut Vec<Diagnostic>,
) -> Vec<Varied> {
    let program = &compiled.program;
    let mut found: Vec<Varied> = Vec::new();
    for vary in &plan.vary {
        match vary {
            Vary::Uncertain(span) => {
                let uncertain = Varied::uncertain(program, p);
                if uncertain.is_empty() {
                    wrong.push(
                        Diagnostic::error(
                            Code::CannotVary,
                            "no parameter of the model is uncertain",
                        )
                        .label(*span, "asked for here")
                        .help("declare the uncertainty of a parameter: `parameter Mass M = 310 [kg] ~ ±8%;`"),
                    );
                }
                found.extend(uncertain);
            }
            Vary::Parameter { name, bounds, span } => {
                let mut own = Varied::of(program, name, p);
                let problem = match program.parameter(name) {
                    None => Some("no such parameter".to_owned()),
                    Some((parameter, _)) if parameter.structural => Some(
                        "it changes the structure of the equations: each value is a separate model"
                            .to_owned(),
                    ),
                    Some((parameter, _)) if parameter.is_final => Some("it is final".to_owned()),
                    Some((parameter, _)) => bounds.as_ref().and_then(|(from, to, unit)| {
                        let misfit = |value| {
                            let (unit, truth) = (Some(unit), false);
                            parameter.misfit(&Given { value, unit, truth })
                        };
                        let misfit = misfit(*from).or_else(|| misfit(*to))?;
                        let help = misfit
                            .help()
                            .map_or(String::new(), |help| format!("; {help}"));
                        Some(format!("it {}{help}", misfit.reason))
                    }),
                };
                if let Some(problem) = problem {
                    wrong.push(
                        Diagnostic::error(Code::CannotVary, format!("`{name}` cannot be varied"))
                            .label(*span, problem)
                            .help("`hyde params FILE` lists the parameters"),
                    );
                }
                if let Some((from, to, _)) = bounds {
                    own.iter_mut()
                        .for_each(|varied| varied.bounds = (*from, *to));
                }
                found.extend(own);
            }
        }
    }
    // Named after `uncertain`, a parameter has the bounds given to it.
    let mut last: Vec<Varied> = Vec::new();
    for varied in found {
        last.retain(|other| other.place != varied.place);
        last.push(varied);
    }
    last
}
