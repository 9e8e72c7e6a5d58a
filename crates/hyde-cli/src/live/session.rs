//! The model of a page: loaded and compiled when its files change, run with what the sliders say.

use super::frequencies::Frequencies;
use super::sliders::sliders;
use super::watched::Watched;
use crate::clock;
use crate::files;
use hyde_compiler::{Compiled, NewValue, write_values};
use hyde_diag::Diagnostics;
use hyde_experiment::{Options, RunError};
use hyde_present::run_page;
use hyde_program::Given;
use hyde_report::{Page, Section, to_body};
use hyde_signal::Table;
use hyde_study::settings::Setting;
use hyde_study::{Aim, Asked, Inputs, Project, Records, run_failure};
use hyde_units::Kind;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Values of parameters in the units that the page shows.
pub(super) type Moved = BTreeMap<String, f64>;

/// An experiment that is shown.
pub(crate) struct Session {
    asked: Asked,
    ready: Option<Ready>,
    /// Why there is nothing to run, as the console shows it.
    wrong: String,
}

/// What can be run.
struct Ready {
    project: Project,
    compiled: Compiled,
    /// The same for its linearised system, or why there is none.
    linear: Result<Frequencies, String>,
    tables: BTreeMap<String, Table>,
    /// What was set when the command was called.
    set: Vec<Setting>,
    warnings: String,
}

impl Session {
    /// Loads what is asked for.
    ///
    /// # Errors
    /// There is no such file or experiment, or it must be said which one.
    pub(crate) fn new(asked: Asked) -> Result<Self, String> {
        let mut session = Self {
            asked,
            ready: None,
            wrong: String::new(),
        };
        session.load()?;
        Ok(session)
    }

    /// Loads the files again. What is wrong in them is kept to be shown.
    ///
    /// # Errors
    /// There is no such file or experiment.
    fn load(&mut self) -> Result<(), String> {
        self.ready = None;
        self.wrong.clear();
        self.asked.inputs = Some(Arc::new(Inputs::recording()));
        let mut project = hyde_study::load(&self.asked, Records::Needed)?;
        let experiment = project.experiment.is_some();
        let compiled = match project.diagnostics.has_errors() {
            true => None,
            false if !experiment => {
                return Err("the file has no experiment: `hyde live` runs one".to_owned());
            }
            false => project.compile(Aim::Run).ok(),
        };
        let text = hyde_study::render::render(&project.diagnostics, &project.sources, false);
        match compiled {
            Some(compiled) => {
                let tables = hyde_study::tables(&project.records);
                let linear = Frequencies::of(&self.asked, &project);
                project.diagnostics = Diagnostics::new();
                self.ready = Some(Ready {
                    set: project.settings.clone(),
                    compiled,
                    linear,
                    tables,
                    warnings: text,
                    project,
                });
            }
            None => self.wrong = text,
        }
        Ok(())
    }

    /// Loads the files again, for the page.
    pub(super) fn reload(&mut self) {
        if let Err(reason) = self.load() {
            self.wrong = format!("error: {reason}");
        }
    }

    /// The files on the disk that the page depends on.
    pub(super) fn watched(&self) -> Watched {
        let inputs = self.asked.inputs.as_ref().map(|inputs| inputs.all());
        let places = inputs.unwrap_or_default().into_values();
        Watched::new(&self.asked.file, places.map(|(place, _)| place.into()))
    }

    /// What the page shows beside the result: name, sliders, warnings.
    pub(super) fn state(&self) -> Value {
        let file = self.asked.file.to_string_lossy().into_owned();
        let Some(ready) = &self.ready else {
            return json!({ "file": file, "error": self.wrong, "sliders": [] });
        };
        let program = &ready.compiled.program;
        let set = ready.project.set();
        let values = hyde_experiment::parameters(program, &ready.tables, &set);
        let own = ready.project.file.files.first().map(|(id, _)| *id);
        let sliders = values.map_or_else(|_| Vec::new(), |all| sliders(program, &all, own));
        json!({
            "file": file,
            "experiment": ready.project.experiment,
            "model": program.name,
            "sliders": sliders,
            // Without measured channels the beginning of a run has the figures of the whole.
            "begins": program.experiment.measured.is_empty(),
            "warnings": ready.warnings,
        })
    }

    /// Runs with these values. Nothing is compiled. Of a run that takes longer than `limit` there is the beginning.
    #[allow(
        clippy::disallowed_methods,
        reason = "the page tells how long a run took"
    )]
    pub(super) fn run(
        &mut self,
        moved: &Moved,
        interrupted: &Arc<AtomicBool>,
        limit: Option<Duration>,
    ) -> Value {
        let Some(ready) = &mut self.ready else {
            return json!({ "ok": false, "error": self.wrong });
        };
        ready.project.settings = match ready.settings(moved) {
            Ok(settings) => settings,
            Err(reason) => return json!({ "ok": false, "error": reason }),
        };
        let options = Options {
            set: ready.project.set(),
            stop_s: None,
            rtol: None,
            atol: None,
            every_s: None,
            measured_from_s: None,
            gradient: Vec::new(),
            interrupted: limit.map_or_else(|| Arc::clone(interrupted), alarm),
            reached: Arc::default(),
        };
        let program = &ready.compiled.program;
        let start = Instant::now();
        let mut run = hyde_experiment::run_again(program, &ready.tables, &options, None);
        let took = start.elapsed().as_secs_f64() * 1e3;
        let mut partial = false;
        if let (true, Err(RunError::Failed(failure))) = (limit.is_some(), &run)
            && options.interrupted.load(Ordering::Relaxed)
        {
            partial = true;
            let reason = "this is its beginning, the rest follows".to_owned();
            run = hyde_experiment::incomplete(program, &ready.tables, &options, failure, reason);
        }
        let answer = match run {
            Ok(run) => {
                let page = run_page::page(&ready.project, &ready.compiled, &run, &clock::now());
                let (first, rest) = parts(page);
                let (body, rest) = (to_body(&first, "run"), to_body(&rest, "rest"));
                json!({ "ok": true, "body": body, "rest": rest, "took_ms": took, "partial": partial })
            }
            Err(error) => json!({ "ok": false, "error": ready.told(&error) }),
        };
        ready.project.settings = ready.set.clone();
        answer
    }

    /// Natural frequencies, frequency responses and margins with these values.
    pub(super) fn frequencies(&self, moved: &Moved) -> Value {
        let found = self.ready.as_ref().map(|ready| {
            let linear = ready.linear.as_ref().map_err(String::clone)?;
            linear.page(&ready.settings(moved)?)
        });
        match found {
            Some(Ok(page)) => json!({ "ok": true, "body": to_body(&page, "frequencies") }),
            Some(Err(reason)) => json!({ "ok": false, "error": reason }),
            None => json!({ "ok": false, "error": "" }),
        }
    }

    /// Writes values into the file. It must be the one that was compiled.
    pub(super) fn write(&self, moved: &Moved) -> Value {
        match self.written(moved) {
            Ok(notes) => json!({ "ok": true, "notes": notes }),
            Err(reason) => json!({ "ok": false, "error": reason }),
        }
    }

    /// Writes; what is to be told about it.
    fn written(&self, moved: &Moved) -> Result<Vec<String>, String> {
        let ready = self.ready.as_ref().ok_or("there is no model to write")?;
        let program = &ready.compiled.program;
        let (id, _) = ready.project.file.files.first().ok_or("there is no file")?;
        let text = &ready.project.sources.get(*id).text;
        if files::read_text(&self.asked.file)? != *text {
            return Err("the file has changed since it was loaded: nothing was written".to_owned());
        }
        ready.allowed(moved)?;
        let mut notes = Vec::new();
        let mut values = Vec::new();
        for (path, value) in moved {
            let known = program.parameter(path);
            let (parameter, _) = known.ok_or_else(|| format!("there is no `{path}`"))?;
            let given = parameter.origin.span;
            let same = program
                .parameters
                .iter()
                .filter(|own| own.origin.span == given);
            values.push(NewValue {
                path: path.clone(),
                si: parameter.unit.unit().to_si(*value),
                unit: parameter.unit.clone(),
                given,
                shared: same.count() > 1,
            });
            if let Some(source) = &parameter.source {
                notes.push(format!(
                    "the source of `{path}` is still \"{source}\": change it if that is no longer right"
                ));
            }
        }
        let experiment = ready.project.experiment.as_deref().unwrap_or_default();
        let new = write_values(&ready.project.file, text, experiment, &values)?;
        files::rewrite(&self.asked.file, new.as_bytes())?;
        Ok(notes)
    }
}

/// The sections of a run that stand beside its frequencies: what came out, and the curves with their modes.
const FIRST: [&str; 5] = [
    "Incomplete",
    "Verdict",
    "Key figures",
    "Measured against simulated",
    "Figures",
];

/// What stands beside the frequencies, and what follows both: the events first, what no slider changes last.
fn parts(page: Page) -> (Page, Page) {
    let is_first = |section: &Section| FIRST.contains(&section.heading.as_str());
    let (first, mut rest): (Vec<Section>, Vec<Section>) =
        page.sections.into_iter().partition(is_first);
    rest.sort_by_key(|section| match section.heading.as_str() {
        "Events" => 0,
        "Model" => 2,
        _ => 1,
    });
    let of = |sections| Page {
        sections,
        ..Page::default()
    };
    (of(first), of(rest))
}

/// A flag that is set after a time.
fn alarm(after: Duration) -> Arc<AtomicBool> {
    let flag: Arc<AtomicBool> = Arc::default();
    let set = Arc::clone(&flag);
    std::thread::spawn(move || {
        std::thread::sleep(after);
        set.store(true, Ordering::Relaxed);
    });
    flag
}

impl Ready {
    /// Why a run failed, as the console tells it.
    fn told(&self, error: &RunError) -> String {
        let name = self.project.experiment.as_deref();
        let mut experiments = self.project.file.experiments();
        let experiment = experiments.find(|own| name == Some(own.name.text.as_str()));
        let program = &self.compiled.program;
        let (diagnostic, _) = run_failure::diagnostic(error, program, experiment);
        let mut all = Diagnostics::new();
        all.push(diagnostic);
        hyde_study::render::render(&all, &self.project.sources, false)
    }

    /// Whether a run would take these values.
    fn allowed(&self, moved: &Moved) -> Result<(), String> {
        let program = &self.compiled.program;
        let set: Vec<(String, f64)> = self
            .settings(moved)?
            .into_iter()
            .map(|own| (own.path, own.value))
            .collect();
        let allowed = hyde_experiment::parameters(program, &self.tables, &set)
            .and_then(|all| hyde_experiment::within_bounds(program, &all));
        allowed.map_err(|error| format!("nothing was written:\n{}", self.told(&error)))
    }

    /// What was set when the command was called, and the values of the sliders over it.
    fn settings(&self, moved: &Moved) -> Result<Vec<Setting>, String> {
        let mut settings = self.set.clone();
        settings.retain(|own| !moved.contains_key(&own.path));
        for (path, value) in moved {
            let known = self.compiled.program.parameter(path);
            let (parameter, _) =
                known.ok_or_else(|| format!("the model has no parameter `{path}`"))?;
            if parameter.structural || parameter.is_final {
                return Err(format!(
                    "`{path}` cannot be moved: it changes the structure of the equations"
                ));
            }
            let si = parameter.unit.unit().to_si(*value);
            let given = Given {
                value: si,
                unit: Some(&parameter.unit),
                truth: parameter.allowed.kind == Kind::Boolean,
            };
            if let Some(misfit) = parameter.misfit(&given) {
                return Err(format!("`{path}` {}", misfit.reason));
            }
            settings.push(Setting::of(path.clone(), si, Some(parameter.unit.clone())));
        }
        Ok(settings)
    }
}
