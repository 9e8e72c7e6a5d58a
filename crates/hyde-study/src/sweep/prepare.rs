//! From an order to its plan: the model loaded, its first variant compiled, the cases laid out, the identity known.

use super::order::{Order, Parts};
use super::variants::{Source, Variants};
use crate::refusals::runs as refusals;
use crate::settings::Setting;
use crate::store::Store;
use crate::{
    Asked, Fault, Kind, Loaded, Project, Records, Refused, assumptions, is_inside, run_failure,
};
use hyde_diag::{Code, Diagnostic, Diagnostics, Severity};
use hyde_experiment::batch::{Dataset, Draft, Model, Plan, record_files, shards, varied};
use hyde_syntax::ast::{Study, StudyKind};
use std::path::Path;

/// A batch that can be solved.
pub struct Prepared {
    /// What was asked, with its files.
    pub asked: Asked,
    /// The model and the experiment.
    pub project: Project,
    /// The sweep as it is written.
    pub draft: Draft,
    /// Its cases.
    pub plan: Plan,
    /// The columns of its data set.
    pub dataset: Dataset,
    /// The models that were compiled so far.
    pub variants: Variants,
    /// Its identity.
    pub parts: Parts,
    /// What was taken for granted of records and tables.
    pub notes: Vec<String>,
}

impl Prepared {
    /// Prepares an order; `base` says where files are and who runs FMUs, and keeps track of the files. `None` where records
    /// are missing that are not needed.
    ///
    /// # Errors
    /// What is wrong with the order, the model, its data or the sweep.
    pub fn new(order: &Order, base: &Asked, needed: Records) -> Result<Option<Self>, Refused> {
        let asked = Asked {
            file: order.file.clone(),
            data: order.data.clone(),
            ..base.clone()
        };
        let asked = asked.with_texts(&order.settings, &order.records);
        let mut asked = asked.map_err(Refused::Asked)?;
        let loaded = Loaded::of(&asked).map_err(Refused::Asked)?;
        if loaded.diagnostics.has_errors() {
            return Err(loaded.refused());
        }
        let study = study(&loaded, &order.sweep).map_err(Refused::Asked)?;
        asked.experiment = Some(study.of.dotted());
        let mut project = loaded.choose(&asked, needed).map_err(Refused::Asked)?;
        if project.diagnostics.has_errors() {
            return Err(project.refused(Fault::Model));
        }
        if project.experiment.is_none() {
            return Ok(None);
        }
        let mut draft = match Draft::read(&study) {
            Ok(draft) => draft,
            Err(diagnostic) => return Err(refused(project, diagnostic)),
        };
        draft.keep.extend(order.keep.iter().cloned());
        let source = Source {
            project: &project,
            asked: &asked,
            draft: &draft,
        };
        let first = vec![0; draft.choices().count()];
        let ready = match source.compile(&first, &[]) {
            Ok(ready) => ready,
            Err(diagnostics) => {
                project.diagnostics = diagnostics;
                return Err(project.refused(Fault::Model));
            }
        };
        let at_fault = |reason| Refused::Because(reason, Fault::Model);
        let cases = draft.cases.as_ref().map(|name| table(&asked, name));
        let cases = cases.transpose().map_err(at_fault)?;
        let parameters = hyde_experiment::parameters(&ready.program, &ready.tables, &project.set());
        let parameters = parameters.map_err(|error| {
            let (diagnostic, fault) = run_failure::diagnostic(&error, &ready.program, None);
            Refused::Because(diagnostic.message, fault)
        })?;
        let model = Model {
            program: &ready.program,
            parameters: &parameters,
            cases: cases.as_ref(),
            seed: order.seed,
        };
        let plan = match Plan::new(&draft, &model) {
            Ok(plan) => plan,
            Err(diagnostic) => return Err(refused(project, diagnostic)),
        };
        let dataset = match Dataset::new(&ready.program, &parameters, &draft.keep) {
            Ok(dataset) => dataset,
            Err(name) => {
                let diagnostic = refusals::keeps_nothing(&name, study.name.span);
                return Err(refused(project, diagnostic));
            }
        };
        read_all_records(&source).map_err(at_fault)?;
        if let Some(diagnostics) = unknown_names(&source) {
            project.diagnostics = diagnostics;
            return Err(project.refused(Fault::Model));
        }
        if dataset.measures.is_empty() && dataset.kept.is_empty() {
            let warning = refusals::measures_nothing(study.of.span);
            project.diagnostics.push(warning);
        }
        let inputs = asked.inputs.clone().unwrap_or_default();
        let notes = assumptions::of_model(&project, &ready.program, &parameters);
        Ok(Some(Self {
            variants: Variants::new(&dataset),
            parts: order.identity(&inputs),
            asked,
            project,
            draft,
            plan,
            dataset,
            notes,
        }))
    }

    /// The shards of so many that have cases which a store does not have.
    #[must_use]
    pub fn missing_shards(&self, store: &dyn Store, count: usize) -> Vec<usize> {
        let list = shards(self.plan.count(), count);
        let missing = list
            .into_iter()
            .zip(1..)
            .filter(|(range, _)| range.clone().any(|case| !store.has(&Self::key(case))));
        missing.map(|(_, number)| number).collect()
    }

    /// The project of one case, as a run of its own takes it.
    #[must_use]
    pub fn project_of(mut self, number: usize) -> Project {
        let case = self.plan.case(number);
        let options = self.plan.options(&case);
        let (file, model) = varied(
            &self.project.file,
            &self.draft,
            &self.project.model,
            &options,
        );
        let ready = self.source().compile(&options, &self.plan.settings(&case));
        self.project.file = file;
        self.project.model = model;
        if let Ok(ready) = ready {
            for (name, table) in ready.tables {
                if let Some(record) = self.project.records.get_mut(&name) {
                    record.table = table;
                }
            }
        }
        for (path, value) in self.plan.settings(&case) {
            let input = self.plan.inputs.iter().find(|input| input.name == path);
            let unit = input.and_then(|input| input.unit.as_ref());
            let setting = Setting::of(path, value, unit.cloned());
            self.project.settings.push(setting);
        }
        self.project
    }

    /// What its variants are made of.
    pub fn source(&self) -> Source<'_> {
        Source {
            project: &self.project,
            asked: &self.asked,
            draft: &self.draft,
        }
    }

    /// The key of a case in a store.
    pub fn key(case: usize) -> String {
        format!("{case:010}")
    }
}

/// The project as a refusal, for one more reason.
fn refused(mut project: Project, diagnostic: Diagnostic) -> Refused {
    project.diagnostics.push(diagnostic);
    project.refused(Fault::Model)
}

/// The sweep that is meant: the one named, or the file's only one.
fn study(loaded: &Loaded, name: &str) -> Result<Study, String> {
    let all: Vec<&Study> = loaded
        .file
        .studies()
        .filter(|study| study.kind == StudyKind::Sweep)
        .collect();
    let found = match all.as_slice() {
        [only] if name.is_empty() => Some(*only),
        list => list.iter().copied().find(|study| study.name.text == name),
    };
    found.cloned().ok_or_else(|| {
        let names: Vec<String> = all
            .iter()
            .map(|study| format!("`{}`", study.name.text))
            .collect();
        let has = if names.is_empty() {
            "none".to_owned()
        } else {
            names.join(", ")
        };
        match name {
            "" => format!("which sweep? the file has {has}"),
            name => format!("the file has no sweep `{name}`; it has {has}"),
        }
    })
}

/// The table of cases: looked for as records are.
fn table(asked: &Asked, name: &str) -> Result<hyde_signal::Table, String> {
    if !is_inside(name) {
        return Err(format!("`{name}` leaves the model's folder"));
    }
    let root = asked
        .data
        .clone()
        .or_else(|| asked.file.parent().map(Path::to_path_buf));
    let path = root.unwrap_or_default().join(name);
    let bytes = asked.read(Kind::Record, "", &path.to_string_lossy(), &path)?;
    // A table of cases has no time: its rows are only counted.
    hyde_signal::read_whole(&bytes, &hyde_signal::Layout::every(1.0))
        .map_err(|error| format!("`{}`: {error}", path.display()))
}

/// What an alternative that names something unknown is refused with: it would fail in each of its cases. Another one that does
/// not compile is an outcome of the batch.
fn unknown_names(source: &Source<'_>) -> Option<Diagnostics> {
    let choices = source.draft.choices().enumerate();
    let choices: Vec<(usize, usize)> = choices
        .filter(|(_, choice)| !choice.name.starts_with("record "))
        .map(|(at, choice)| (at, choice.options.len()))
        .collect();
    let mut alternatives = choices
        .iter()
        .flat_map(|&(at, count)| (1..count).map(move |option| (at, option)));
    alternatives.find_map(|(at, option)| {
        let mut options = vec![0; source.draft.choices().count()];
        options[at] = option;
        let refused = source.compile(&options, &[]).err()?;
        let unknown =
            |own: &Diagnostic| own.severity == Severity::Error && own.code == Code::UnknownType;
        let found = refused.iter().any(unknown);
        found.then_some(refused)
    })
}

/// Reads the records of every alternative, so that all that the batch reads is known.
fn read_all_records(source: &Source<'_>) -> Result<(), String> {
    let counts: Vec<usize> = source
        .draft
        .choices()
        .map(|choice| choice.options.len())
        .collect();
    for (at, &count) in counts.iter().enumerate() {
        for option in 1..count {
            let mut options = vec![0; counts.len()];
            options[at] = option;
            if !record_files(source.draft, &options).is_empty()
                && source
                    .draft
                    .choices()
                    .nth(at)
                    .is_some_and(|c| c.name.starts_with("record "))
            {
                source.compile(&options, &[]).map_err(|diagnostics| {
                    let first = diagnostics.iter().next().map(|d| d.message.clone());
                    first.unwrap_or_default()
                })?;
            }
        }
    }
    Ok(())
}
