//! [`Model`]: a model with its experiment, compiled once.

use crate::outcome::Outcome;
use crate::refusal;
use hyde_compiler::Compiled;
use hyde_diag::Diagnostics;
use hyde_experiment::{Options, Run, RunError};
use hyde_program::{Prior, Program};
use hyde_signal::Table;
use hyde_study::settings::{self, Setting};
use hyde_study::{Aim, Asked, Project, Records, assumptions, load, run_failure};
use pyo3::prelude::*;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// A model that is compiled, with its records.
#[pyclass(frozen, module = "hyde._hyde")]
pub(crate) struct Model {
    project: Mutex<Project>,
    compiled: Arc<Compiled>,
    tables: BTreeMap<String, Table>,
    /// Values set when it was loaded, by name, SI.
    set: Vec<(String, f64)>,
    #[pyo3(get)]
    name: String,
    #[pyo3(get)]
    experiment: Option<String>,
    #[pyo3(get)]
    warnings: String,
}

/// Name, value in SI, unit, dimension's SI unit, spread in SI, source, whether it needs another compilation.
type ParameterRow = (
    String,
    Vec<f64>,
    String,
    String,
    Option<f64>,
    Option<String>,
    bool,
);

/// How often a run looks for Ctrl-C.
const LOOK: Duration = Duration::from_millis(20);

#[pymethods]
impl Model {
    /// Loads and compiles a file, with values set: numbers in SI, or texts with a unit.
    #[allow(
        clippy::too_many_arguments,
        reason = "Python names them; each is one option of a model"
    )]
    #[new]
    #[pyo3(signature = (file, experiment=None, model=None, numbers=Vec::new(), texts=Vec::new(), records=Vec::new(), data=None))]
    fn new(
        py: Python<'_>,
        file: PathBuf,
        experiment: Option<String>,
        model: Option<String>,
        numbers: Vec<(String, f64)>,
        texts: Vec<String>,
        records: Vec<(String, PathBuf)>,
        data: Option<PathBuf>,
    ) -> PyResult<Self> {
        let parsed = texts.iter().map(|text| settings::parse(text));
        let numbers = numbers.into_iter();
        let numbers = numbers.map(|(name, value)| Ok(Setting::in_si(name, value)));
        let settings: Result<Vec<Setting>, String> = numbers.chain(parsed).collect();
        let settings = settings.map_err(|reason| refusal::asked(&reason))?;
        py.detach(|| {
            let asked = Asked {
                experiment,
                model,
                settings,
                records,
                data,
                ..Asked::of_file(&file)
            };
            loaded(&asked)
        })
    }

    /// Every parameter.
    fn parameters(&self) -> PyResult<Vec<ParameterRow>> {
        let program = &self.compiled.program;
        let values = hyde_experiment::parameters(program, &self.tables, &self.set)
            .map_err(|error| self.failure(&error))?;
        let rows = program.parameters.iter().map(|parameter| {
            let own = values[parameter.place..parameter.place + parameter.len].to_vec();
            let spread = parameter.prior.map(|prior| match prior {
                Prior::Relative(part) => part * own.first().copied().unwrap_or(0.0).abs(),
                Prior::Absolute(spread) => spread,
            });
            (
                parameter.name.clone(),
                own,
                parameter.unit.text().to_owned(),
                parameter.dimension.usual_unit(),
                spread,
                parameter.source.clone(),
                parameter.structural,
            )
        });
        Ok(rows.collect())
    }

    /// What was assumed of records, tables and FMUs, each as a sentence.
    #[getter]
    fn assumptions(&self) -> PyResult<Vec<String>> {
        let program = &self.compiled.program;
        let values = hyde_experiment::parameters(program, &self.tables, &self.set)
            .map_err(|error| self.failure(&error))?;
        self.with_project(|project, _| assumptions::of_model(project, program, &values))
    }

    /// The files of the FMUs whose machine code runs in this process.
    #[getter]
    fn fmus(&self) -> PyResult<Vec<String>> {
        self.with_project(|project, _| {
            let files = project.fmus.iter().map(|own| own.fmu.file.clone());
            files.collect()
        })
    }

    /// Runs with values set: numbers in SI, or texts with a unit.
    #[allow(
        clippy::too_many_arguments,
        reason = "Python names them; each is one option of a run"
    )]
    #[pyo3(signature = (numbers=Vec::new(), texts=Vec::new(), stop=None, rtol=None, atol=None, gradient=Vec::new(), keep=None))]
    fn run(
        &self,
        py: Python<'_>,
        numbers: Vec<(String, f64)>,
        texts: Vec<String>,
        stop: Option<f64>,
        rtol: Option<f64>,
        atol: Option<f64>,
        gradient: Vec<String>,
        keep: Option<Vec<String>>,
    ) -> PyResult<Outcome> {
        let keep = keep.map(|names| self.outputs(&names)).transpose()?;
        let mut set = self.set.clone();
        for (name, value) in numbers {
            self.may_be_set(&Setting::in_si(name.clone(), value))?;
            set.push((name, value));
        }
        for text in &texts {
            let setting = settings::parse(text).map_err(|reason| refusal::asked(&reason))?;
            self.may_be_set(&setting)?;
            set.push((setting.path, setting.value));
        }
        for (name, value) in [("stop", stop), ("rtol", rtol), ("atol", atol)] {
            // A record may begin below 0, and the run with it.
            let least = match name {
                "stop" if !self.tables.is_empty() => f64::NEG_INFINITY,
                _ => 0.0,
            };
            if value.is_some_and(|value| value.is_nan() || value <= least) {
                return Err(refusal::asked(&format!("`{name}` must be positive")));
            }
        }
        let interrupted = Arc::new(AtomicBool::new(false));
        let options = Options {
            set,
            stop_s: stop,
            rtol,
            atol,
            every_s: None,
            measured_from_s: None,
            gradient,
            interrupted: Arc::clone(&interrupted),
            reached: Arc::default(),
        };
        let run = self.watched(py, &options, keep, &interrupted)?;
        Outcome::of(py, &self.compiled.program, run)
    }
}

impl Model {
    pub(crate) fn program(&self) -> &Program {
        &self.compiled.program
    }

    /// What is made of the project and its compiled model.
    pub(crate) fn with_project<T>(
        &self,
        make: impl FnOnce(&Project, &Compiled) -> T,
    ) -> PyResult<T> {
        match self.project.lock() {
            Ok(project) => Ok(make(&project, &self.compiled)),
            Err(_) => Err(refusal::asked(
                "another thread ended while it used the model",
            )),
        }
    }

    /// The numbers of columns, ascending.
    fn outputs(&self, names: &[String]) -> PyResult<Vec<usize>> {
        let number = |name: &String| {
            let found = self.compiled.program.output(name);
            found.ok_or_else(|| {
                refusal::asked(&format!("`keep`: the model has no variable `{name}`"))
            })
        };
        let mut found = names.iter().map(number).collect::<PyResult<Vec<usize>>>()?;
        found.sort_unstable();
        found.dedup();
        Ok(found)
    }

    /// Runs with the lock of Python released. Signals come to the main thread: there the run is on another thread, while this
    /// one looks for Ctrl-C.
    fn watched(
        &self,
        py: Python<'_>,
        options: &Options,
        keep: Option<Vec<usize>>,
        interrupted: &AtomicBool,
    ) -> PyResult<Run> {
        let run =
            move || hyde_experiment::run_again(&self.compiled.program, &self.tables, options, keep);
        let outcome = if in_main_thread(py)? {
            unless_interrupted(py, run, interrupted)?
        } else {
            py.detach(run)
        };
        outcome.map_err(|error| self.failure(&error))
    }

    /// Refuses what a compiled model cannot take.
    fn may_be_set(&self, setting: &Setting) -> PyResult<()> {
        let Some((parameter, _)) = self.compiled.program.parameter(&setting.path) else {
            return self.may_become_parameter(&setting.path);
        };
        if parameter.structural {
            let reason = format!(
                "`{0}` is structural: the equations are compiled with its value; set it when the model is loaded, \
                 `hyde.load(FILE, set={{\"{0}\": VALUE}})`",
                setting.path
            );
            return Err(refusal::asked(&reason));
        }
        settings::check(setting, parameter).map_err(|reason| refusal::asked(&reason))
    }

    /// Refuses a start value: it becomes a parameter only where the model is compiled with it.
    fn may_become_parameter(&self, path: &str) -> PyResult<()> {
        let of = path.strip_suffix(".start");
        match of.and_then(|variable| self.compiled.program.output(variable)) {
            None => Ok(()),
            Some(_) => Err(refusal::asked(&format!(
                "`{path}` becomes a parameter when the model is loaded with it: `hyde.load(FILE, set={{\"{path}\": VALUE}})`"
            ))),
        }
    }

    fn failure(&self, error: &RunError) -> PyErr {
        let of_project = |project: &Project, compiled: &Compiled| {
            let name = project.experiment.as_deref();
            let mut experiments = project.file.experiments();
            let experiment = experiments.find(|known| name == Some(known.name.text.as_str()));
            let (diagnostic, fault) = run_failure::diagnostic(error, &compiled.program, experiment);
            let mut diagnostics = Diagnostics::default();
            diagnostics.push(diagnostic);
            refusal::of(&diagnostics, &project.sources, fault)
        };
        self.with_project(of_project).unwrap_or_else(|error| error)
    }
}

fn in_main_thread(py: Python<'_>) -> PyResult<bool> {
    let threading = py.import("threading")?;
    let current = threading.call_method0("current_thread")?;
    Ok(current.is(&threading.call_method0("main_thread")?))
}

/// Computes on another thread; Ctrl-C tells it to end, and is raised when it has.
fn unless_interrupted<T: Send>(
    py: Python<'_>,
    compute: impl FnOnce() -> T + Send,
    interrupted: &AtomicBool,
) -> PyResult<T> {
    let (done, ended) = std::sync::mpsc::channel();
    std::thread::scope(|scope| {
        scope.spawn(move || {
            // Whoever waits is there until this arrives.
            let _ = done.send(compute());
        });
        py.detach(move || {
            loop {
                match ended.recv_timeout(LOOK) {
                    Ok(computed) => return Ok(computed),
                    Err(std::sync::mpsc::RecvTimeoutError::Timeout) => {
                        if let Err(signal) = Python::attach(|py| py.check_signals()) {
                            interrupted.store(true, Ordering::Relaxed);
                            return Err(signal);
                        }
                    }
                    Err(std::sync::mpsc::RecvTimeoutError::Disconnected) => {
                        return Err(refusal::asked("the run ended without a result"));
                    }
                }
            }
        })
    })
}

fn loaded(asked: &Asked) -> PyResult<Model> {
    let mut project = load(asked, Records::Needed).map_err(|reason| refusal::asked(&reason))?;
    let aim = if project.experiment.is_some() {
        Aim::Run
    } else {
        Aim::Look
    };
    let compiled = match project.compile(aim) {
        Ok(compiled) => compiled,
        Err(fault) => return Err(refusal::refused(&project.refused(fault))),
    };
    let tables = hyde_study::tables(&project.records);
    let warnings = hyde_study::render::render(&project.diagnostics, &project.sources, false);
    Ok(Model {
        set: project.set(),
        name: project.model.clone(),
        experiment: project.experiment.clone(),
        warnings: warnings.trim_end().to_owned(),
        tables,
        compiled: Arc::new(compiled),
        project: Mutex::new(project),
    })
}
