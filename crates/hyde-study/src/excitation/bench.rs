//! [`Bench`]: the model of a calibration, to which designed records are given.

use super::columns::{self, Source};
use crate::asked::Asked;
use crate::calibration::{Prepared, chosen, prepared, single_plan};
use crate::project::{Loaded, Project};
use crate::records::{Record, headers};
use crate::refusals::calibrations as refused;
use crate::refused::{Fault, Refused};
use crate::run_failure;
use crate::unobservable::{unreadable, unsupported};
use hyde_calibrate::{
    CalibrationPlan, Information, Linearised, Observer, Problem, RecordError, Recording, Simulated,
    Unsupported, Varied, simulated,
};
use hyde_compiler::{Compiled, Form};
use hyde_diag::Diagnostic;
use hyde_experiment::Options;
use hyde_program::Program;
use hyde_signal::{Column, Table};
use hyde_syntax::ast::{Study, StudyKind};
use hyde_units::{Dimension, NamedUnit};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Samples of the record by which a model is compiled: columns of zeros.
const BLANK: usize = 400;
/// What random numbers begin with.
const SEED: u64 = 1;

/// A model with designed records.
pub struct Bench {
    /// The file with its model.
    pub project: Project,
    /// The block.
    pub plan: CalibrationPlan,
    /// The name of the experiment.
    pub experiment: String,
    /// The observed form.
    pub compiled: Compiled,
    /// What makes a record: the loop closed.
    pub recorded: Program,
    /// What is varied.
    pub varied: Vec<Varied>,
    /// Values set from outside: position and value.
    pub set: Vec<(usize, f64)>,
    /// The record and the column that signals are for.
    pub column: Source,
    unit: NamedUnit,
    columns: Vec<Source>,
}

/// A designed record, as it would be recorded, and what it would tell.
pub struct Told {
    /// The record.
    pub recording: Recording,
    /// What it would tell of the parameters.
    pub information: Information,
    /// What the axis does on it.
    pub tables: BTreeMap<String, Table>,
}

/// Why a designed record tells nothing.
#[derive(Clone, Debug)]
pub enum Failed {
    /// The run failed, or a column has no channel.
    Simulated(Simulated),
    /// What was simulated cannot be observed.
    Record(RecordError),
    /// The model has no fixed-step form.
    Unsupported(Unsupported),
}

/// The model of a calibration, or of that of a diagnosis: the one named, or the file's only one. `step_s` is the time
/// between the samples of its records; the signal is for the column named, or the first that a stimulus reads, in `unit`.
///
/// # Errors
/// There is none of that name; its block or its model is at fault.
pub fn bench(
    mut loaded: Loaded,
    asked: &Asked,
    name: Option<&str>,
    step_s: f64,
    column: Option<&str>,
    unit: &NamedUnit,
) -> Result<Bench, Refused> {
    if loaded.diagnostics.has_errors() {
        return Err(loaded.refused());
    }
    let name = calibration_of(&loaded, name).map_err(Refused::Asked)?;
    let found = single_plan(&mut loaded, Some(&name)).map_err(Refused::Asked)?;
    let Some((plan, experiment)) = found else {
        return Err(loaded.refused());
    };
    let file = loaded.file.files.first().map(|(_, tree)| tree);
    let all = file.map_or_else(Vec::new, |tree| columns::all(tree, &experiment));
    let driven = columns::driven(&experiment);
    let column = column_of(&driven, column).map_err(Refused::Asked)?;
    let records = experiment.records.iter().filter_map(|item| {
        let name = &item.name.text;
        let blank = vec![0.0; BLANK];
        let table = table(
            name,
            &all,
            BLANK,
            step_s,
            column.as_ref().map(|own| (own, unit, &*blank)),
        )?;
        let record = Record {
            path: PathBuf::from("designed"),
            hash: String::new(),
            table,
        };
        Some((name.clone(), record))
    });
    let records: BTreeMap<String, Record> = records.collect();
    let Loaded {
        sources,
        file,
        hash,
        tables,
        fmus,
        mut diagnostics,
    } = loaded;
    if column.is_none() {
        diagnostics.push(refused::nothing_to_design(&experiment.name.text, plan.span));
    }
    let project = Project {
        sources,
        file,
        hash,
        tables,
        fmus,
        diagnostics,
        model: experiment.model.dotted(),
        experiment: Some(experiment.name.text.clone()),
        records,
        settings: asked.settings.clone(),
    };
    let Some(column) = column.filter(|_| !project.diagnostics.has_errors()) else {
        return Err(project.refused(Fault::Model));
    };
    let prepared = prepared(project)?;
    let (varied, wrong) = prepared.varied(&plan);
    let Prepared {
        mut project,
        compiled,
        set,
        ..
    } = prepared;
    let recorded = {
        let settings: BTreeMap<String, f64> = project.set().into_iter().collect();
        let headers = headers(&project.records);
        let request = project.request(&settings, &headers, Form::Recorded);
        let mut diagnostics = hyde_diag::Diagnostics::new();
        let compiled = hyde_compiler::compile(&request, &mut diagnostics);
        compiled.ok_or(diagnostics)
    };
    let recorded = match (recorded, wrong.is_empty()) {
        (Ok(recorded), true) => recorded.program,
        (recorded, _) => {
            if let Err(diagnostics) = recorded {
                diagnostics
                    .iter()
                    .for_each(|own| project.diagnostics.push(own.clone()));
            }
            wrong
                .into_iter()
                .for_each(|own| project.diagnostics.push(own));
            return Err(project.refused(Fault::Model));
        }
    };
    Ok(Bench {
        project,
        plan,
        experiment: experiment.name.text,
        compiled,
        recorded,
        varied,
        set,
        column,
        unit: unit.clone(),
        columns: all,
    })
}

/// The name of the calibration that is meant.
fn calibration_of(loaded: &Loaded, name: Option<&str>) -> Result<String, String> {
    let all: Vec<&Study> = loaded.file.studies().collect();
    let of_kind = |kind: StudyKind| -> Vec<&Study> {
        let own = all.iter().copied();
        own.filter(|study| study.kind == kind).collect()
    };
    let calibrations = of_kind(StudyKind::Calibrate);
    let diagnoses = of_kind(StudyKind::Diagnose);
    let named = |list: &[&Study]| {
        let mut own = list.iter();
        own.any(|study| Some(study.name.text.as_str()) == name)
    };
    if !named(&calibrations) && named(&diagnoses) {
        return Ok(chosen(&diagnoses, name, "diagnosis")?.of.dotted());
    }
    Ok(chosen(&calibrations, name, "calibration")?
        .name
        .text
        .clone())
}

/// The column that a signal is for: the one named, or the first one; `None` if stimuli read none.
fn column_of(driven: &[Source], name: Option<&str>) -> Result<Option<Source>, String> {
    let Some(name) = name else {
        return Ok(driven.first().cloned());
    };
    let is_named =
        |(record, column): &&Source| column == name || format!("{record}.{column}") == name;
    match driven.iter().find(is_named) {
        Some(own) => Ok(Some(own.clone())),
        None => {
            let known: Vec<String> = driven.iter().map(|(_, own)| format!("`{own}`")).collect();
            Err(format!(
                "no stimulus reads a column `{name}` that is not measured\n  help: the columns that drive the model are {}",
                known.join(", ")
            ))
        }
    }
}

/// A table of a record: columns of zeros, but the one given.
fn table(
    record: &str,
    columns: &[Source],
    rows: usize,
    step_s: f64,
    given: Option<(&Source, &NamedUnit, &[f64])>,
) -> Option<Table> {
    let own: Vec<&Source> = columns.iter().filter(|(of, _)| of == record).collect();
    let free = |name: &&str| own.iter().all(|(_, column)| column != name);
    let time = ["t", "time", "clock"].into_iter().find(free)?;
    let seconds = NamedUnit::parse("s").ok()?;
    let instants = (0..rows).map(|row| (row as f64 * step_s * 1e9).round() / 1e9);
    let mut all = vec![Column::new(time, seconds, instants.collect())];
    for source in own {
        all.push(match given.filter(|(known, ..)| *known == source) {
            Some((_, unit, values)) => Column::new(source.1.clone(), unit.clone(), values.to_vec()),
            None => Column::raw(source.1.clone(), vec![0.0; rows]),
        });
    }
    Table::new(all).ok()
}

impl Bench {
    /// The records with a signal (SI) in the column that it is for, all others 0.
    #[must_use]
    pub fn tables(&self, values: &[f64], step_s: f64) -> BTreeMap<String, Table> {
        let records = self.project.records.keys();
        let each = records.filter_map(|record| {
            let given = Some((&self.column, &self.unit, values));
            let table = table(record, &self.columns, values.len(), step_s, given)?;
            Some((record.clone(), table))
        });
        each.collect()
    }

    /// How far positions of the axis go on a signal, and how fast: of each measured length or angle its unit, the farthest that
    /// it is from where it starts, and its largest speed, SI. The run stops at the end of the signal.
    ///
    /// # Errors
    /// The run fails.
    pub fn motions(
        &self,
        tables: &BTreeMap<String, Table>,
    ) -> Result<Vec<(NamedUnit, f64, f64)>, Failed> {
        let run = hyde_experiment::run(&self.recorded, tables, &self.options());
        let run = run.map_err(|error| Failed::Simulated(Simulated::Run(Box::new(error))))?;
        let measured = self.recorded.experiment.measured.iter();
        let found = measured.filter_map(|channel| {
            let dimension = channel.unit.unit().dimension;
            let is_place = [Dimension::LENGTH, Dimension::ANGLE].contains(&dimension);
            let column = run.results.column(channel.output)?;
            if !is_place || column.is_empty() {
                return None;
            }
            let start = column.first()?;
            let away = column.iter().map(|value| (value - start).abs());
            let farthest = away.fold(0.0, f64::max);
            let rows = run.results.time.windows(2).zip(column.windows(2));
            let speeds = rows.filter_map(|(time, value)| {
                let step = time[1] - time[0];
                // At an event there are two rows, and a few close by.
                (step > 1e-6).then(|| ((value[1] - value[0]) / step).abs())
            });
            Some((channel.unit.clone(), farthest, speeds.fold(0.0, f64::max)))
        });
        Ok(found.collect())
    }

    /// What a designed record would tell of the parameters.
    ///
    /// # Errors
    /// See [`Failed`].
    pub fn told(&self, name: &str, tables: &BTreeMap<String, Table>) -> Result<Told, Failed> {
        let made = simulated(
            &self.recorded,
            tables,
            &self.options(),
            None,
            SEED,
            &format!("excite / {name}"),
        );
        let made = made.map_err(Failed::Simulated)?;
        let program = &self.compiled.program;
        let recording = Recording::new(name, program, made.clone(), &self.set);
        let recording = recording.map_err(Failed::Record)?;
        let recordings = [recording];
        let observer = Observer::new(program, &recordings, &self.set);
        let observer = observer.map_err(Failed::Unsupported)?;
        let problem = Problem {
            program,
            recordings: &recordings,
            observer: &observer,
            varied: &self.varied,
            set: &self.set,
            fold: None,
            reached: None,
        };
        let nominal: Vec<f64> = self.varied.iter().map(|varied| varied.nominal).collect();
        let information = problem.information(&nominal).map_err(Failed::Unsupported)?;
        let [recording] = recordings;
        Ok(Told {
            recording,
            information,
            tables: made,
        })
    }

    /// A designed record linearised, to ask what effects it would distinguish.
    ///
    /// # Errors
    /// See [`Failed`].
    pub fn linearised(&self, recording: Recording) -> Result<Linearised, Failed> {
        let (program, set) = (&self.compiled.program, self.project.set());
        Linearised::new(program, vec![recording], &self.varied, &set).map_err(Failed::Unsupported)
    }

    /// Why a designed record tells nothing, as a diagnostic.
    #[must_use]
    pub fn diagnostic(&self, name: &str, failed: &Failed) -> Diagnostic {
        let span = self.plan.span;
        match failed {
            Failed::Simulated(Simulated::Run(error)) => {
                run_failure::diagnostic(error, &self.recorded, None).0
            }
            Failed::Simulated(Simulated::Column(record, column)) => {
                refused::no_channel(record, column, span)
            }
            Failed::Record(error) => unreadable(name, error, span),
            Failed::Unsupported(error) => unsupported(error, span),
        }
    }

    fn options(&self) -> Options {
        Options {
            set: self.project.set(),
            ..Options::default()
        }
    }
}
