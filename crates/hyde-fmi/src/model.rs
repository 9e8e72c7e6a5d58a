//! [`Model`]: the compiled model of an FMU, which all its instances share.

use crate::description::Described;
use crate::interface::{Interface, reported};
use crate::kept::Kept;
use hyde_compiler::Compiled;
use hyde_diag::{Diagnostic, Diagnostics, Severity, Sources};
use hyde_experiment::{Options, Run, RunError};
use hyde_program::Program;
use hyde_signal::Table;
use hyde_sim::{Event, EventKind, Reached, Setup};
use hyde_study::world::Buffers;
use hyde_study::{Aim, Asked, Inputs, Project, Records, run_failure, settings};
use hyde_units::significant;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A model that was chosen for an FMU, before it is compiled.
pub struct Chosen {
    /// The parsed files.
    pub project: Project,
    /// Inputs whose stimuli are left out.
    pub inputs: Vec<String>,
    /// The variables that are outputs; the usual ones if none is named.
    pub outputs: Vec<String>,
}

/// A compiled model with its records, its parameters as set on export, and its variables.
pub struct Model {
    /// What can be run.
    pub program: Program,
    /// Its variables.
    pub interface: Interface,
    /// The parameters as exported.
    pub parameters: Vec<f64>,
    project: Project,
    tables: BTreeMap<String, Table>,
    set: Vec<(String, f64)>,
}

/// A model that cannot be exported.
pub struct Uncompiled {
    /// The model with its errors.
    pub project: Project,
    /// What of the request is at fault, if that is why.
    pub reason: Option<String>,
}

impl Uncompiled {
    fn of(project: Project, reason: Option<String>) -> Box<Self> {
        Box::new(Self { project, reason })
    }
}

impl Chosen {
    /// Compiles the model. What is wrong is in the project's diagnostics.
    ///
    /// # Errors
    /// What is at fault.
    pub fn compile(mut self) -> Result<Model, Box<Uncompiled>> {
        if let Err(reason) = self.project.release(&self.inputs) {
            return Err(Uncompiled::of(self.project, Some(reason)));
        }
        let Ok(Compiled { program, .. }) = self.project.compile(Aim::Export) else {
            return Err(Uncompiled::of(self.project, None));
        };
        let tables = hyde_study::tables(&self.project.records);
        let set = self.project.set();
        let parameters = match hyde_experiment::parameters(&program, &tables, &set) {
            Ok(parameters) => parameters,
            Err(error) => {
                let (diagnostic, _) = run_failure::diagnostic(&error, &program, None);
                self.project.diagnostics.push(diagnostic);
                return Err(Uncompiled::of(self.project, None));
            }
        };
        match Interface::of(&program, &parameters, &self.outputs) {
            Ok(interface) => Ok(Model {
                program,
                interface,
                parameters,
                project: self.project,
                tables,
                set,
            }),
            Err(reason) => Err(Uncompiled::of(self.project, Some(reason))),
        }
    }
}

impl Model {
    /// Compiles what an FMU holds.
    ///
    /// # Errors
    /// What is wrong, in one text.
    pub fn of(kept: &Kept) -> Result<Self, String> {
        let files = kept.files();
        let mut world = Buffers::default();
        for (place, content) in files.values() {
            world.put(place, content.clone());
        }
        let set: Result<Vec<_>, String> =
            kept.settings.iter().map(|s| settings::parse(s)).collect();
        let asked = Asked {
            experiment: kept.experiment.clone(),
            model: Some(kept.model.clone()).filter(|_| kept.experiment.is_none()),
            settings: set?,
            records: kept.records.clone(),
            data: kept.data.clone(),
            world: Arc::new(world),
            inputs: Some(Arc::new(Inputs::replaying(files))),
            ..Asked::of_file(&kept.file)
        };
        let project = hyde_study::load(&asked, Records::Needed)?;
        if project.diagnostics.has_errors() {
            return Err(all(&project.diagnostics, &project.sources));
        }
        let chosen = Chosen {
            project,
            inputs: kept.inputs.clone(),
            outputs: kept.outputs.clone(),
        };
        chosen.compile().map_err(|other| {
            let Uncompiled { project, reason } = *other;
            reason.unwrap_or_else(|| all(&project.diagnostics, &project.sources))
        })
    }

    /// The places and values of parameters that were set on export, and those of records.
    pub(crate) fn set_places(&self) -> Vec<(usize, f64)> {
        let mut found = Vec::new();
        for known in &self.program.record_values {
            let table = self.tables.get(&known.record);
            let value = table.and_then(|table| hyde_experiment::record_value(known, table));
            found.extend(value.map(|value| (known.place, value)));
        }
        for (name, value) in &self.set {
            let parameter = self.program.parameter(name);
            let plain = parameter.filter(|(parameter, _)| !parameter.structural);
            found.extend(plain.map(|(parameter, element)| (parameter.place + element, *value)));
        }
        found
    }

    /// The project it was compiled from.
    #[must_use]
    pub fn project(&self) -> &Project {
        &self.project
    }

    /// Runs the experiment, for the outputs that are named, to its stop or for so many rows, if it says a time between rows.
    /// `interrupted` ends the run from outside, and `reached` tells how far it is.
    ///
    /// # Errors
    /// There is no run, or it fails.
    pub fn run(
        &self,
        outputs: &[&str],
        rows: Option<u32>,
        interrupted: Arc<AtomicBool>,
        reached: Arc<Reached>,
    ) -> Result<Run, RunError> {
        let setup = self.setup(None, None, None)?;
        let every_s = self.every_s().filter(|every_s| *every_s > 0.0);
        let until_s = rows.zip(every_s);
        let until_s = until_s.map(|(rows, every_s)| setup.start_s + f64::from(rows) * every_s);
        let options = Options {
            set: self.set.clone(),
            stop_s: until_s.filter(|until_s| *until_s < setup.stop_s),
            interrupted,
            reached,
            ..Options::default()
        };
        let known = outputs
            .iter()
            .filter_map(|name| reported(&self.program, name));
        let mut keep: Vec<usize> = known.collect();
        keep.sort_unstable();
        keep.dedup();
        hyde_experiment::run_again(&self.program, &self.tables, &options, Some(keep))
    }

    /// What a description says of the model. The token is of the bytes that the FMU holds.
    ///
    /// # Errors
    /// Why it cannot be run.
    pub fn described(&self, identifier: &str, token: String) -> Result<Described<'_>, RunError> {
        let setup = self.setup(None, None, None)?;
        Ok(Described {
            interface: &self.interface,
            name: self.program.name.clone(),
            identifier: identifier.to_owned(),
            description: self.doc(),
            token,
            times: (setup.start_s, setup.stop_s),
            tolerances: (setup.rtol, setup.atol),
            every_s: self.every_s(),
        })
    }

    /// The time between two rows of the experiment in s, if it says one.
    fn every_s(&self) -> Option<f64> {
        let every = hyde_program::Constant::Every;
        self.program.kernels.constant(every, &self.parameters)
    }

    /// What an absolute tolerance is to be, over the relative one.
    pub(crate) fn nominal(&self) -> f64 {
        let setup = self.setup(None, None, None);
        setup.map_or(1.0, |setup| setup.atol / setup.rtol)
    }

    /// What the experiment is, or the model, in the words of its author.
    fn doc(&self) -> Option<String> {
        let name = self.project.experiment.as_deref()?;
        let mut experiments = self.project.file.experiments();
        experiments
            .find(|known| known.name.text == name)?
            .doc
            .clone()
    }

    /// What a run is told: as `hyde run` tells it, with start, stop and tolerance of an importer.
    pub(crate) fn setup(
        &self,
        start_s: Option<f64>,
        stop_s: Option<f64>,
        rtol: Option<f64>,
    ) -> Result<Setup<'_>, RunError> {
        let (start, own_stop) =
            hyde_experiment::extent(&self.program, &self.tables, &self.parameters);
        let start_s = start_s.unwrap_or(start.0);
        let stop_s = stop_s.or((own_stop > start_s).then_some(own_stop));
        let options = Options {
            set: self.set.clone(),
            stop_s: Some(stop_s.unwrap_or(start_s + 1.0)),
            rtol,
            ..Options::default()
        };
        let mut setup = hyde_experiment::setup(&self.program, &self.tables, &options)?;
        setup.start_s = start_s;
        if self.program.n_unknowns == 0 {
            // Without a solver, time passes in the strides of the rows.
            setup.max_step_s = setup.max_step_s.min(setup.row_spacing());
        }
        setup.rows_s = Vec::new();
        setup.reductions = Vec::new();
        setup.keep = Some(Vec::new());
        Ok(setup)
    }

    /// A run that failed, in one text: code, fact, component, equation, line, time.
    #[must_use]
    pub fn explain(&self, error: &RunError) -> String {
        let (diagnostic, _) = run_failure::diagnostic(error, &self.program, None);
        let mut text = one(&diagnostic, &self.project.sources);
        if let RunError::Failed(failure) = error {
            let origin = failure.origins.first();
            let component = origin.map(|origin| origin.instance.as_str());
            if let Some(component) = component.filter(|name| !name.is_empty()) {
                text.push_str(&format!("; in the component `{component}`"));
            }
        }
        text
    }

    /// An event, in one line.
    #[must_use]
    pub fn tell(&self, event: &Event) -> String {
        let t = significant(event.t, 9);
        let place = self.project.sources.place(event.origin.span);
        let what = match &event.kind {
            EventKind::Transition {
                automaton,
                from,
                to,
            } => {
                let automaton = &self.program.automata[*automaton];
                let (from, to) = (&automaton.modes[*from], &automaton.modes[*to]);
                format!("{}: {from} -> {to}", automaton.name)
            }
            EventKind::When => "when".to_owned(),
            EventKind::Relation(truth) => format!("becomes {truth}"),
            EventKind::Slide { after, .. } => match after {
                Some(_) => "sliding ends".to_owned(),
                None => "sliding begins".to_owned(),
            },
        };
        format!("{t} s, {what}: `{}`, {place}", event.cause)
    }
}

/// Errors in one text.
fn all(diagnostics: &Diagnostics, sources: &Sources) -> String {
    let errors = diagnostics.iter();
    let errors = errors.filter(|known| known.severity == Severity::Error);
    let lines: Vec<String> = errors.map(|known| one(known, sources)).collect();
    lines.join("; ")
}

fn one(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let mut text = format!("{}: {}", diagnostic.code, diagnostic.message);
    for label in &diagnostic.labels {
        let (place, written) = (sources.place(label.span), sources.text(label.span));
        let written = written.lines().next().unwrap_or("").trim();
        text.push_str(&format!("; {place}: `{written}`: {}", label.text));
    }
    for note in &diagnostic.notes {
        text.push_str(&format!("; {note}"));
    }
    text
}
