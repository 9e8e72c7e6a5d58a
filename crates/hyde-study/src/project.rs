//! A model on its way to a program: file, experiment, records, settings.

use crate::aim::Aim;
use crate::asked::Asked;
use crate::fmus::{self, NamedFmu};
use crate::inputs::Kind;
use crate::package::{MANIFEST, Roots};
use crate::records::{self, Record, Records};
use crate::refused::{Fault, Refused};
use crate::run_failure;
use crate::settings::{self, Setting};
use crate::tables::{self, Table};
use crate::world::{as_text, read_text};
use hyde_compiler::{Backend, Compiled, File, Form, FreeInputs, Header, Request};
use hyde_diag::{Diagnostics, Sources};
use hyde_syntax::ast::{Drive, Experiment, ExperimentItem, Item};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

/// A loaded file with what was chosen of it.
pub struct Project {
    /// The texts.
    pub sources: Sources,
    /// The trees.
    pub file: File,
    /// SHA-256 of the file's text.
    pub hash: String,
    /// The model.
    pub model: String,
    /// The experiment, if there is one whose records are there.
    pub experiment: Option<String>,
    /// Its records, by name.
    pub records: BTreeMap<String, Record>,
    /// The tables that the file names.
    pub tables: Vec<Table>,
    /// The FMUs that the file names.
    pub fmus: Vec<NamedFmu>,
    /// What is set from outside.
    pub settings: Vec<Setting>,
    /// What is wrong so far, and what is only told.
    pub diagnostics: Diagnostics,
}

/// A file that was parsed, with the packages and tables it names.
#[derive(Clone)]
pub struct Loaded {
    /// The texts.
    pub sources: Sources,
    /// The trees.
    pub file: File,
    /// SHA-256 of the file's text.
    pub hash: String,
    /// The tables it names.
    pub tables: Vec<Table>,
    /// The FMUs it names.
    pub fmus: Vec<NamedFmu>,
    /// What is wrong so far.
    pub diagnostics: Diagnostics,
}

/// Loads what is asked. What is wrong in the files stays in the project's diagnostics.
///
/// # Errors
/// What is asked cannot be: no such file, experiment, model or record.
pub fn load(asked: &Asked, needed: Records) -> Result<Project, String> {
    Loaded::of(asked)?.choose(asked, needed)
}

impl Loaded {
    /// Parses the file that is asked for, once.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn of(asked: &Asked) -> Result<Self, String> {
        if asked.world.is_folder(&asked.file) {
            return Err(format!(
                "`{}` is a folder: name a file in it; `hyde check` and `hyde test` take folders with a `{MANIFEST}`",
                asked.file.display()
            ));
        }
        let bytes = asked.read(Kind::Model, "", "", &asked.file)?;
        Ok(Self::of_text(asked, &as_text(&asked.file, bytes)?))
    }

    /// Parses a text as the file that is asked for.
    #[must_use]
    pub fn of_text(asked: &Asked, text: &str) -> Self {
        let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
        let roots = Roots::of(&asked.world, &asked.file, &mut sources, &mut diagnostics);
        let own = asked.file.to_string_lossy();
        let searched = match roots.roots.first().and_then(|root| root.manifest.as_ref()) {
            Some(_) => "in this package or its dependencies",
            None => "beside the file",
        };
        let all = || {
            let packages = roots.own_packages().into_iter();
            let others = packages.filter(|(_, place)| *place != asked.file);
            others
                .filter_map(|(name, place)| {
                    Some((name, read_text(asked.world.as_ref(), &place).ok()?))
                })
                .collect()
        };
        let packages =
            hyde_compiler::Packages {
                find: &|importer, package| match &asked.inputs {
                    Some(inputs) if inputs.is_replayed() => {
                        let found = inputs.found(Kind::Package, importer, package);
                        Ok(found
                            .and_then(|(place, text)| Some((place, String::from_utf8(text).ok()?))))
                    }
                    Some(inputs) => {
                        let found = roots.find(importer, package)?;
                        if let Some((place, text)) = &found {
                            let content = (place.clone(), text.clone().into_bytes());
                            inputs.note(Kind::Package, importer, package, content);
                        }
                        Ok(found)
                    }
                    None => roots.find(importer, package),
                },
                all: &all,
                searched,
                whole_library: asked.whole_library,
            };
        let mut file = hyde_compiler::load(&mut sources, &own, text, &packages, &mut diagnostics);
        if let Some((id, tree)) = file.files.first()
            && let Some(name) = roots.name_of(&asked.file)
        {
            hyde_compiler::check_name(&sources, *id, tree, &name, &mut diagnostics);
        }
        let tables = tables::read(&mut file, asked, &roots, &sources, &mut diagnostics);
        let fmus = fmus::read(&mut file, asked, &roots, &mut sources, &mut diagnostics);
        Self {
            sources,
            file,
            hash: format!("{:x}", Sha256::digest(text.as_bytes())),
            tables,
            fmus,
            diagnostics,
        }
    }

    /// The file as a refusal, with what is wrong in it.
    #[must_use]
    pub fn refused(self) -> Refused {
        Refused::Model {
            sources: Box::new(self.sources),
            diagnostics: self.diagnostics,
            fault: Fault::Model,
        }
    }

    /// The file with neither a model nor an experiment chosen.
    pub(crate) fn without_model(self, asked: &Asked) -> Project {
        let Self {
            sources,
            file,
            hash,
            tables,
            fmus,
            diagnostics,
        } = self;
        Project {
            sources,
            hash,
            model: String::new(),
            experiment: None,
            records: BTreeMap::new(),
            tables,
            fmus,
            settings: asked.settings.clone(),
            diagnostics,
            file,
        }
    }

    /// Chooses the model and the experiment that are asked for, and reads its records.
    ///
    /// # Errors
    /// There is no such experiment, model or record.
    pub fn choose(self, asked: &Asked, needed: Records) -> Result<Project, String> {
        let mut project = self.without_model(asked);
        if project.diagnostics.has_errors() {
            return Ok(project);
        }
        let experiment = choose(&project, asked)?.cloned();
        project.model = match (&asked.model, &experiment) {
            (Some(model), _) => model.clone(),
            (None, Some(experiment)) => experiment.model.dotted(),
            (None, None) => match project.file.models().last() {
                Some(model) => model.to_owned(),
                None => return Err("the file has no model".to_owned()),
            },
        };
        if let Some(experiment) = &experiment {
            project.experiment = Some(experiment.name.text.clone());
            project.records = records::read(experiment, asked, needed, &mut project.diagnostics)?;
            if project.diagnostics.has_errors() {
                return Ok(project);
            }
            if project.records.len() < experiment.records.len() {
                project.experiment = None;
            }
        }
        Ok(project)
    }
}

/// The files that are meant: the one named, or those of the package in the folder named.
///
/// # Errors
/// The folder has no manifest, or one with mistakes.
pub fn files_of(asked: &Asked) -> Result<Vec<PathBuf>, Refused> {
    if !asked.world.is_folder(&asked.file) {
        return Ok(vec![asked.file.clone()]);
    }
    if !asked.world.is_file(&asked.file.join(MANIFEST)) {
        let folder = asked.file.display();
        return Err(Refused::Asked(format!(
            "the folder `{folder}` has no `{MANIFEST}`"
        )));
    }
    let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
    let roots = Roots::at(&asked.world, &asked.file, &mut sources, &mut diagnostics);
    if diagnostics.has_errors() {
        return Err(Refused::Model {
            sources: Box::new(sources),
            diagnostics,
            fault: Fault::Model,
        });
    }
    let packages = roots.own_packages().into_iter();
    Ok(packages.map(|(_, file)| file).collect())
}

impl Project {
    /// The kernels of what [`Project::compile`] makes for [`Aim::Export`], as C, with some of the outputs, by number; what is
    /// wrong stays in the project's diagnostics.
    pub fn kernels_as_c(&mut self, outputs: &[usize]) -> Option<String> {
        let settings: BTreeMap<String, f64> = self.set().into_iter().collect();
        let headers = records::headers(&self.records);
        let request = Request {
            free_inputs: Aim::Export.free_inputs(),
            ..self.request(&settings, &headers, Form::Run)
        };
        let mut diagnostics = Diagnostics::new();
        let found = hyde_compiler::kernels_as_c(&request, outputs, &mut diagnostics);
        if found.is_none() {
            self.diagnostics = diagnostics;
        }
        found
    }

    /// Compiles; what is wrong stays in the project's diagnostics.
    ///
    /// # Errors
    /// What is at fault.
    pub fn compile(&mut self, aim: Aim) -> Result<Compiled, Fault> {
        self.compile_unless(aim, &|| false)
    }

    /// The same, ended early if `stop` is true before a stage: what there is then is [`Fault::Interrupted`].
    ///
    /// # Errors
    /// What is at fault.
    pub fn compile_unless(&mut self, aim: Aim, stop: &dyn Fn() -> bool) -> Result<Compiled, Fault> {
        let settings = self
            .settings
            .iter()
            .map(|setting| (setting.path.clone(), setting.value))
            .collect();
        let headers = records::headers(&self.records);
        let request = Request {
            sources: &self.sources,
            file: &self.file,
            model: &self.model,
            experiment: self.experiment.as_deref(),
            settings: &settings,
            records: &headers,
            free_inputs: aim.free_inputs(),
            ledger: matches!(aim, Aim::Ledger | Aim::Linearize | Aim::Look),
            form: match aim {
                Aim::Observe => Form::Observed,
                Aim::Run | Aim::Ledger | Aim::Linearize | Aim::Look | Aim::Export => Form::Run,
            },
            backend: Backend::Native,
        };
        let compiled = hyde_compiler::compile_unless(&request, stop, &mut self.diagnostics);
        let Some(mut compiled) = compiled else {
            return Err(match self.diagnostics.has_errors() {
                true => Fault::Model,
                false => Fault::Interrupted,
            });
        };
        if let Some(diagnostic) = fmus::refused(&compiled.program, aim) {
            self.diagnostics.push(diagnostic);
            return Err(Fault::Model);
        }
        fmus::attach(&mut compiled.program, &self.fmus);
        for setting in &self.settings {
            let checked = match compiled.program.parameter(&setting.path) {
                Some((parameter, _)) => settings::check(setting, parameter),
                None => Err(run_failure::no_parameter(&compiled.program, &setting.path)),
            };
            if let Err(reason) = checked {
                let diagnostic = run_failure::cannot_set(&compiled.program, &setting.path, reason);
                self.diagnostics.push(diagnostic);
                return Err(Fault::Asked);
            }
        }
        Ok(compiled)
    }

    /// Gives the parts of a program that are FMUs what computes them.
    pub fn attach_fmus(&self, program: &mut hyde_program::Program) {
        fmus::attach(program, &self.fmus);
    }

    /// Takes the stimuli of these inputs out of the experiment: another tool is to set them.
    ///
    /// # Errors
    /// No stimulus of the experiment drives an input of that name.
    pub fn release(&mut self, inputs: &[String]) -> Result<(), String> {
        let chosen = self.experiment.clone();
        let items = self.file.files.first_mut().into_iter();
        let items = items.flat_map(|(_, tree)| &mut Arc::make_mut(tree).items);
        let experiment = items.into_iter().find_map(|item| match item {
            Item::Experiment(own) if chosen.as_ref() == Some(&own.name.text) => Some(own),
            Item::Experiment(_) | Item::Class(_) | Item::Type(_) | Item::Study(_) => None,
        });
        let mut driven: Vec<String> = Vec::new();
        for item in experiment.into_iter().flat_map(|own| &mut own.items) {
            if let ExperimentItem::Stimulus(drives) = item {
                driven.extend(drives.iter().flat_map(Drive::names));
                drives.retain(|drive| !inputs.iter().any(|input| drive.drives(input)));
            }
        }
        // A stimulus of an element is named by the array as well.
        driven.dedup();
        match inputs.iter().find(|input| !driven.contains(input)) {
            None => Ok(()),
            Some(other) if driven.is_empty() => Err(format!(
                "no stimulus drives an input `{other}`: the experiment has none"
            )),
            Some(other) => Err(format!(
                "no stimulus drives an input `{other}`; those of the experiment drive `{}`",
                driven.join("`, `")
            )),
        }
    }

    /// What is asked of the compiler for the project in a form, with these settings and the headers of its records.
    pub fn request<'a>(
        &'a self,
        settings: &'a BTreeMap<String, f64>,
        records: &'a BTreeMap<String, Header>,
        form: Form,
    ) -> Request<'a> {
        Request {
            sources: &self.sources,
            file: &self.file,
            model: &self.model,
            experiment: self.experiment.as_deref(),
            settings,
            records,
            free_inputs: FreeInputs::None,
            ledger: false,
            form,
            backend: Backend::Native,
        }
    }

    /// The plain values set from outside, as the run takes them.
    pub fn set(&self) -> Vec<(String, f64)> {
        self.settings
            .iter()
            .map(|setting| (setting.path.clone(), setting.value))
            .collect()
    }

    /// The project as a refusal, with what is wrong in it.
    #[must_use]
    pub fn refused(self, fault: Fault) -> Refused {
        Refused::Model {
            sources: Box::new(self.sources),
            diagnostics: self.diagnostics,
            fault,
        }
    }
}

/// The experiment meant: the one named, or the file's only one.
fn choose<'p>(project: &'p Project, asked: &Asked) -> Result<Option<&'p Experiment>, String> {
    let all: Vec<&Experiment> = project.file.experiments().collect();
    if let Some(name) = &asked.experiment {
        let found = all
            .iter()
            .copied()
            .find(|experiment| experiment.name.text == *name);
        return found.map(Some).ok_or_else(|| {
            let known: Vec<String> = all
                .iter()
                .map(|experiment| format!("`{}`", experiment.name.text))
                .collect();
            match known.as_slice() {
                [] => format!("the file has no experiment `{name}`; it has none"),
                _ => format!(
                    "the file has no experiment `{name}`; it has {}",
                    known.join(", ")
                ),
            }
        });
    }
    match all.as_slice() {
        _ if asked.model.is_some() => Ok(None),
        [] => Ok(None),
        [only] => Ok(Some(only)),
        several => {
            let known: Vec<String> = several
                .iter()
                .map(|experiment| format!("`{}`", experiment.name.text))
                .collect();
            Err(format!(
                "which experiment? the file has {}",
                known.join(", ")
            ))
        }
    }
}
