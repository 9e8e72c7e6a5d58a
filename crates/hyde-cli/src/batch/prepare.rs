//! From an order to its plan: the model loaded, its first variant compiled, the cases laid out, the identity known.

use super::order::{Order, Parts};
use super::variants::{Source, Variants};
use crate::args::ModelArgs;
use crate::exit::Exit;
use crate::project::{self, Asked, Loaded, Project, Records, Told as _, complain, report_errors};
use hyde_diag::{Code, Diagnostic};
use hyde_experiment::batch::{Dataset, Draft, Model, Plan, record_files};
use hyde_present::assumptions;
use hyde_study::{Inputs, Kind};
use hyde_syntax::ast::{Study, StudyKind};
use std::path::Path;
use std::sync::Arc;

/// A batch that can be solved.
pub(crate) struct Prepared {
    pub(crate) args: ModelArgs,
    pub(crate) asked: Asked,
    pub(crate) project: Project,
    pub(crate) draft: Draft,
    pub(crate) plan: Plan,
    pub(crate) dataset: Dataset,
    pub(crate) variants: Variants,
    pub(crate) parts: Parts,
    /// What was taken for granted of records and tables.
    pub(crate) notes: Vec<String>,
}

impl Prepared {
    /// Prepares an order. What is wrong with the model or the sweep is reported; a missing record that is not needed ends it
    /// with nothing said.
    pub(crate) fn new(
        order: &Order,
        inputs: &Arc<Inputs>,
        needed: Records,
        (json, quiet): (bool, bool),
    ) -> Result<Self, Exit> {
        let mut args = ModelArgs::of_file(&order.file);
        args.settings.clone_from(&order.settings);
        args.records.clone_from(&order.records);
        args.data.clone_from(&order.data);
        (args.json, args.quiet) = (json, quiet);
        args.inputs = Some(Arc::clone(inputs));
        let loaded = project::parsed(&args)?;
        if loaded.diagnostics.has_errors() {
            return Err(project::refused(&args, &loaded.refused()));
        }
        let study = study(&loaded, &order.sweep);
        let study = study.map_err(|reason| complain(&args, Exit::CommandLine, &reason))?;
        args.experiment = Some(study.of.dotted());
        let asked = project::asked(&args)?;
        let project = loaded.choose(&asked, needed);
        let mut project = project.map_err(|reason| complain(&args, Exit::CommandLine, &reason))?;
        if project.diagnostics.has_errors() {
            return Err(project.finish_with_errors(&args));
        }
        if project.experiment.is_none() {
            return Err(Exit::Done); // Its records are not there, which was to be no error.
        }
        let refuse = |mut project: Project, diagnostic: Diagnostic| {
            project.diagnostics.push(diagnostic);
            project.finish_with_errors(&args)
        };
        let mut draft = match Draft::read(&study) {
            Ok(draft) => draft,
            Err(diagnostic) => return Err(refuse(project, diagnostic)),
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
            Err(diagnostics) => return Err(report_errors(&args, &project.sources, &diagnostics)),
        };
        let cases = match &draft.cases {
            None => None,
            Some(name) => {
                Some(table(&asked, name).map_err(|why| complain(&args, Exit::Model, &why))?)
            }
        };
        let parameters = hyde_experiment::parameters(&ready.program, &ready.tables, &project.set());
        let parameters = match parameters {
            Ok(parameters) => parameters,
            Err(error) => {
                let (diagnostic, fault) =
                    hyde_study::run_failure::diagnostic(&error, &ready.program, None);
                return Err(complain(&args, fault.into(), &diagnostic.message));
            }
        };
        let model = Model {
            program: &ready.program,
            parameters: &parameters,
            cases: cases.as_ref(),
            seed: order.seed,
        };
        let plan = match Plan::new(&draft, &model) {
            Ok(plan) => plan,
            Err(diagnostic) => return Err(refuse(project, diagnostic)),
        };
        let dataset = match Dataset::new(&ready.program, &draft.keep) {
            Ok(dataset) => dataset,
            Err(name) => {
                let diagnostic = Diagnostic::error(Code::BadSweep, format!("`keep {name}`: there is no such variable"))
                    .label(study.name.span, "in this sweep")
                    .help("the results of `hyde run --out DIR` list all variables; `keep guide.*;` keeps those of a component");
                return Err(refuse(project, diagnostic));
            }
        };
        read_all_records(&source).map_err(|why| complain(&args, Exit::Model, &why))?;
        if dataset.measures.is_empty() && dataset.kept.is_empty() {
            let diagnostic = Diagnostic::warning(
                Code::BadSweep,
                "the experiment has no `measure`, and the sweep keeps no variable",
            )
            .label(
                study.of.span,
                "write `measure Length peak = max(abs(e));` there",
            );
            project.diagnostics.push(diagnostic);
        }
        project.print_warnings(&args);
        let parts = order.identity(inputs);
        let notes = assumptions::of_model(&project, &ready.program, &parameters);
        Ok(Self {
            variants: Variants::new(&dataset),
            args,
            asked,
            project,
            draft,
            plan,
            dataset,
            parts,
            notes,
        })
    }

    /// What its variants are made of.
    pub(crate) fn source(&self) -> Source<'_> {
        Source {
            project: &self.project,
            asked: &self.asked,
            draft: &self.draft,
        }
    }

    /// The key of a case in a store.
    pub(crate) fn key(case: usize) -> String {
        format!("{case:010}")
    }
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
    if !hyde_study::is_inside(name) {
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
