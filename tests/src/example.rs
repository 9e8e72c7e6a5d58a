//! [`Example`]: a `.hyde` file of this project with one of its experiments, its records, and what is set beside it.

use hyde_compiler::{
    Additions, Backend, Candidate, Compiled, File, Form, FreeInputs, Header, Laws, Request, Stage,
};
use hyde_diag::{Diagnostic, Diagnostics, FileId, Sources};
use hyde_experiment::{Options, Run, RunError};
use hyde_ir::Dae;
use hyde_signal::Table;
use hyde_syntax::ast::Experiment;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The folder of the project.
#[must_use]
pub fn root() -> PathBuf {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    here.parent().unwrap_or(here).to_path_buf()
}

/// A model of a file, with an experiment or as it stands.
#[derive(Clone)]
pub struct Example {
    path: PathBuf,
    text: String,
    experiment: Option<String>,
    files: BTreeMap<String, PathBuf>,
    data: Option<PathBuf>,
    free_inputs: bool,
    ledger: bool,
    form: Form,
    set: BTreeMap<String, f64>,
    model: Option<String>,
    whole_library: bool,
}

/// A file parsed, with its records read: what compiling begins with.
pub struct Loaded {
    /// Texts of the file and of the library packages it names.
    pub sources: Sources,
    /// Their trees.
    pub file: File,
    /// The model of the experiment, else the last one of the file.
    pub model: String,
    /// The records by the name the experiment gives them.
    pub tables: BTreeMap<String, Table>,
    diagnostics: Diagnostics,
}

impl Example {
    /// The file at `path` (relative to the project's folder) with the experiment of that name, or with none.
    ///
    /// # Errors
    /// The file cannot be read.
    pub fn load(path: impl AsRef<Path>, experiment: Option<&str>) -> Result<Self, String> {
        let path = root().join(path);
        let text = String::from_utf8(read(&path)?)
            .map_err(|_| format!("{}: no UTF-8 text", path.display()))?;
        Ok(Self {
            path,
            text,
            experiment: experiment.map(str::to_owned),
            files: BTreeMap::new(),
            data: None,
            free_inputs: false,
            ledger: false,
            form: Form::Run,
            set: BTreeMap::new(),
            model: None,
            whole_library: false,
        })
    }

    /// Puts other words in the place of some of the file, wherever these stand.
    #[must_use]
    pub fn rewritten(mut self, from: &str, to: &str) -> Self {
        self.text = self.text.replace(from, to);
        self
    }

    /// Takes another model of the file.
    #[must_use]
    pub fn model(mut self, name: &str) -> Self {
        self.model = Some(name.to_owned());
        self
    }

    /// Loads every package of the library, named or not.
    #[must_use]
    pub fn whole_library(mut self) -> Self {
        self.whole_library = true;
        self
    }

    /// Makes the energy ledger.
    #[must_use]
    pub fn ledger(mut self) -> Self {
        self.ledger = true;
        self
    }

    /// Takes a record from another file than the one beside the model.
    #[must_use]
    pub fn record(mut self, name: &str, path: impl AsRef<Path>) -> Self {
        self.files
            .insert(name.to_owned(), root().join(path.as_ref()));
        self
    }

    /// Looks for the records below another folder than the model's.
    #[must_use]
    pub fn data(mut self, folder: impl AsRef<Path>) -> Self {
        self.data = Some(root().join(folder.as_ref()));
        self
    }

    /// Leaves inputs free that nothing drives: they become parameters.
    #[must_use]
    pub fn free_inputs(mut self) -> Self {
        self.free_inputs = true;
        self
    }

    /// Takes the form that an observer runs: replays are made.
    #[must_use]
    pub fn observed(mut self) -> Self {
        self.form = Form::Observed;
        self
    }

    /// Takes the form that makes a record: what is measured and replayed, before any sensor.
    #[must_use]
    pub fn recorded(mut self) -> Self {
        self.form = Form::Recorded;
        self
    }

    /// Sets a parameter, SI; it may be a structural one.
    #[must_use]
    pub fn set(mut self, parameter: &str, value: f64) -> Self {
        self.set.insert(parameter.to_owned(), value);
        self
    }

    /// Adds to the text of the file.
    #[must_use]
    pub fn and(mut self, text: &str) -> Self {
        self.text.push_str(text);
        self
    }

    /// Takes another text and experiment for those of the file.
    #[must_use]
    pub fn replaced(mut self, text: &str, experiment: &str) -> Self {
        text.clone_into(&mut self.text);
        self.experiment = Some(experiment.to_owned());
        self
    }

    /// The text of the file.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Parses the file and reads its records.
    ///
    /// # Errors
    /// Every diagnostic, one a line.
    pub fn parse(&self) -> Result<Loaded, String> {
        let mut sources = Sources::new();
        let mut diagnostics = Diagnostics::new();
        let name = self.path.file_name().unwrap_or_default().to_string_lossy();
        let file = hyde_compiler::load(
            &mut sources,
            &name,
            &self.text,
            &hyde_compiler::Packages {
                whole_library: self.whole_library,
                ..hyde_compiler::Packages::LIBRARY
            },
            &mut diagnostics,
        );
        refuse(&diagnostics, &sources)?;
        let mut tables = BTreeMap::new();
        let experiment = self.experiment_of(&file)?;
        for item in experiment.map_or(&[][..], |known| &known.records) {
            let name = &item.name.text;
            let folder = self.data.as_deref().or_else(|| self.path.parent());
            let default = || Some(folder?.join(&item.default.as_ref()?.text));
            let path = self.files.get(name).cloned().or_else(default);
            let path = path.ok_or_else(|| format!("the record `{name}` has no file"))?;
            let table = hyde_experiment::read_record(item, &path.to_string_lossy(), &read(&path)?)
                .map_err(|diagnostic| line(&diagnostic, &sources))?;
            tables.insert(name.clone(), table);
        }
        let model = match (&self.model, experiment) {
            (Some(model), _) => model.clone(),
            (None, Some(experiment)) => experiment.model.dotted(),
            (None, None) => file.models().last().unwrap_or_default().to_owned(),
        };
        Ok(Loaded {
            sources,
            file,
            model,
            tables,
            diagnostics,
        })
    }

    /// Compiles it.
    ///
    /// # Errors
    /// Every diagnostic, one a line.
    pub fn compile(&self, backend: Backend) -> Result<Compiled, String> {
        self.parse()?.compile(self, backend)
    }

    /// Its equations, ready to be solved.
    ///
    /// # Errors
    /// Every diagnostic, one a line.
    pub fn analyze(&self) -> Result<Dae, String> {
        let mut loaded = self.parse()?;
        let mut diagnostics = std::mem::take(&mut loaded.diagnostics);
        let headers = loaded.headers();
        let request = loaded.request(self, &headers, Backend::Interpreter);
        hyde_compiler::analyze(&request, &mut diagnostics)
            .ok_or_else(|| lines(&diagnostics, &loaded.sources))
    }

    /// The result of a stage as text.
    ///
    /// # Errors
    /// Every diagnostic, one a line.
    pub fn emit(&self, stage: Stage) -> Result<String, String> {
        let mut loaded = self.parse()?;
        let mut diagnostics = std::mem::take(&mut loaded.diagnostics);
        let headers = loaded.headers();
        let request = loaded.request(self, &headers, Backend::Native);
        hyde_compiler::emit(&request, stage, &mut diagnostics)
            .ok_or_else(|| lines(&diagnostics, &loaded.sources))
    }

    /// Compiles and runs its experiment.
    ///
    /// # Errors
    /// Every diagnostic, or why the run did not start or end.
    pub fn run(&self) -> Result<(Compiled, Run), String> {
        self.run_with(&Options::default())
    }

    /// The same with other tolerances or times; what [`Example::set`] set is set in addition.
    ///
    /// # Errors
    /// Every diagnostic, or why the run did not start or end.
    pub fn run_with(&self, options: &Options) -> Result<(Compiled, Run), String> {
        let loaded = self.parse()?;
        let compiled = loaded.compile(self, Backend::Native)?;
        let mut options = options.clone();
        options
            .set
            .extend(self.set.iter().map(|(name, value)| (name.clone(), *value)));
        let run = hyde_experiment::run(&compiled.program, &loaded.tables, &options)
            .map_err(|error| cause(&error, &loaded.sources))?;
        Ok((compiled, run))
    }

    fn experiment_of<'f>(&self, file: &'f File) -> Result<Option<&'f Experiment>, String> {
        let Some(name) = &self.experiment else {
            return Ok(None);
        };
        let found = file
            .experiments()
            .find(|experiment| experiment.name.text == *name);
        found
            .map(Some)
            .ok_or_else(|| format!("{}: no experiment `{name}`", self.path.display()))
    }
}

impl Loaded {
    /// Compiles an example that was parsed before.
    ///
    /// # Errors
    /// Every diagnostic, one a line.
    pub fn compile(&self, example: &Example, backend: Backend) -> Result<Compiled, String> {
        self.compile_with(example, &Additions::new(), backend)
    }

    /// The same with effects put on the model.
    ///
    /// # Errors
    /// Every diagnostic, one a line.
    pub fn compile_with(
        &self,
        example: &Example,
        additions: &Additions,
        backend: Backend,
    ) -> Result<Compiled, String> {
        let mut diagnostics = self.diagnostics.clone();
        let headers = self.headers();
        let request = self.request(example, &headers, backend);
        hyde_compiler::compile_with(&request, additions, &mut diagnostics)
            .ok_or_else(|| lines(&diagnostics, &self.sources))
    }

    /// Every effect of the files at every site of the model where it fits.
    ///
    /// # Errors
    /// Every diagnostic, one a line.
    pub fn candidates(&self, example: &Example) -> Result<Vec<Candidate>, String> {
        let mut diagnostics = self.diagnostics.clone();
        let headers = self.headers();
        let request = self.request(example, &headers, Backend::Native);
        hyde_compiler::candidates(&request, &mut diagnostics)
            .ok_or_else(|| lines(&diagnostics, &self.sources))
    }

    /// Where a law may act on the model, and the shapes that it may be made of.
    ///
    /// # Errors
    /// Every diagnostic, one a line.
    pub fn laws(&self, example: &Example) -> Result<Laws, String> {
        let mut diagnostics = self.diagnostics.clone();
        let headers = self.headers();
        let request = self.request(example, &headers, Backend::Native);
        hyde_compiler::laws(&request, &mut diagnostics)
            .ok_or_else(|| lines(&diagnostics, &self.sources))
    }

    /// The user's file, in which additions name things.
    #[must_use]
    pub fn own_file(&self) -> FileId {
        self.file.files[0].0
    }

    fn headers(&self) -> BTreeMap<String, Header> {
        let header = |table: &Table| {
            let columns = table.columns().iter();
            let columns = columns.map(|column| (column.name().to_owned(), column.unit().cloned()));
            Header {
                columns: columns.collect(),
                step_s: table.usual_step(),
                unusable: Vec::new(),
                sparse: Vec::new(),
            }
        };
        self.tables
            .iter()
            .map(|(name, table)| (name.clone(), header(table)))
            .collect()
    }

    fn request<'a>(
        &'a self,
        example: &'a Example,
        headers: &'a BTreeMap<String, Header>,
        backend: Backend,
    ) -> Request<'a> {
        Request {
            sources: &self.sources,
            file: &self.file,
            model: &self.model,
            experiment: example.experiment.as_deref(),
            settings: &example.set,
            records: headers,
            free_inputs: match example.free_inputs {
                true => FreeInputs::All,
                false => FreeInputs::None,
            },
            ledger: example.ledger,
            form: example.form,
            backend,
        }
    }
}

#[allow(clippy::disallowed_methods, reason = "tests open the examples' files")]
fn read(path: &Path) -> Result<Vec<u8>, String> {
    std::fs::read(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn refuse(diagnostics: &Diagnostics, sources: &Sources) -> Result<(), String> {
    if diagnostics.has_errors() {
        return Err(lines(diagnostics, sources));
    }
    Ok(())
}

fn lines(diagnostics: &Diagnostics, sources: &Sources) -> String {
    let all: Vec<String> = diagnostics.iter().map(|one| line(one, sources)).collect();
    all.join("\n")
}

fn line(diagnostic: &Diagnostic, sources: &Sources) -> String {
    let place = diagnostic
        .labels
        .first()
        .map(|label| sources.place(label.span));
    let place = place.unwrap_or_default();
    format!("{place} {}: {}", diagnostic.code, diagnostic.message)
}

/// A run that did not start or did not end; its results are too long to print.
fn cause(error: &RunError, sources: &Sources) -> String {
    let RunError::Failed(failure) = error else {
        return format!("{error:?}");
    };
    let places: Vec<String> = failure
        .origins
        .iter()
        .map(|origin| sources.place(origin.span))
        .collect();
    format!(
        "{:?} at {} s, {}",
        failure.kind,
        failure.t,
        places.join(", ")
    )
}
