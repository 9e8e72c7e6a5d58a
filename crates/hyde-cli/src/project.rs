//! A model on its way to a program: file, experiment, records, settings.

use crate::args::ModelArgs;
use crate::batch::inputs::Kind;
use crate::exit::Exit;
use crate::files;
pub(crate) use crate::output::{print_diagnostics, print_error, print_output};
use crate::package::{MANIFEST, Roots};
use crate::records::{self, Record};
use crate::render;
use crate::run_failure;
use crate::settings::{self, Setting};
use crate::tables::{self, Table};
use hyde_compiler::{Backend, Compiled, File, Form, Header, Request};
use hyde_diag::{Diagnostics, Sources};
use hyde_syntax::ast::Experiment;
use serde_json::json;
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;

/// A loaded file with what was chosen of it.
pub(crate) struct Project {
    pub(crate) sources: Sources,
    pub(crate) file: File,
    pub(crate) hash: String,
    pub(crate) model: String,
    pub(crate) experiment: Option<String>,
    pub(crate) records: BTreeMap<String, Record>,
    pub(crate) tables: Vec<Table>,
    pub(crate) settings: Vec<Setting>,
    pub(crate) diagnostics: Diagnostics,
}

/// What becomes of an experiment whose records are not there.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Records {
    /// It cannot be run: an error.
    Needed,
    /// Its model is checked alone, with a warning.
    IfThere,
}

/// Loads what the arguments name; reports and ends where that has errors.
pub(crate) fn load(args: &ModelArgs, needed: Records) -> Result<Project, Exit> {
    let project = load_silently(args, needed)?;
    if project.diagnostics.has_errors() {
        return Err(project.finish_with_errors(args));
    }
    Ok(project)
}

/// Loads what the arguments name. What is wrong in the files stays in the project's diagnostics.
pub(crate) fn load_silently(args: &ModelArgs, needed: Records) -> Result<Project, Exit> {
    if files::is_folder(&args.file) {
        let reason = format!(
            "`{}` is a folder: name a file in it; `hyde check` and `hyde test` take folders with a `{MANIFEST}`",
            args.file.display()
        );
        return Err(complain(args, Exit::CommandLine, &reason));
    }
    let text = args
        .read(Kind::Model, "", "", &args.file)
        .and_then(|bytes| files::as_text(&args.file, bytes))
        .map_err(|reason| complain(args, Exit::CommandLine, &reason))?;
    let settings: Result<Vec<Setting>, String> = args
        .settings
        .iter()
        .map(|text| settings::parse(text))
        .collect();
    let settings = settings.map_err(|reason| complain(args, Exit::CommandLine, &reason))?;
    let mut sources = Sources::new();
    let mut diagnostics = Diagnostics::new();
    let (file, tables) = loaded(args, &mut sources, &text, &mut diagnostics);
    let mut project = Project {
        sources,
        hash: format!("{:x}", Sha256::digest(text.as_bytes())),
        model: String::new(),
        experiment: None,
        records: BTreeMap::new(),
        tables,
        settings,
        diagnostics,
        file,
    };
    if project.diagnostics.has_errors() {
        return Ok(project);
    }
    let experiment = choose(&project, args)
        .map_err(|reason| complain(args, Exit::CommandLine, &reason))?
        .cloned();
    project.model = match (&args.model, &experiment) {
        (Some(model), _) => model.clone(),
        (None, Some(experiment)) => experiment.model.dotted(),
        (None, None) => match project.file.models().last() {
            Some(model) => model.to_owned(),
            None => return Err(complain(args, Exit::CommandLine, "the file has no model")),
        },
    };
    if let Some(experiment) = &experiment {
        project.experiment = Some(experiment.name.text.clone());
        let read = records::read(experiment, args, needed, &mut project.diagnostics);
        project.records = read.map_err(|reason| complain(args, Exit::CommandLine, &reason))?;
        if project.diagnostics.has_errors() {
            return Ok(project);
        }
        if project.records.len() < experiment.records.len() {
            project.experiment = None;
        }
    }
    Ok(project)
}

/// The files that a command is about: the one named, or those of the package in the folder named.
pub(crate) fn files_of(args: &ModelArgs) -> Result<Vec<ModelArgs>, Exit> {
    if !files::is_folder(&args.file) {
        return Ok(vec![args.clone()]);
    }
    if !files::is_file(&args.file.join(MANIFEST)) {
        let reason = format!("the folder `{}` has no `{MANIFEST}`", args.file.display());
        return Err(complain(args, Exit::CommandLine, &reason));
    }
    let (mut sources, mut diagnostics) = (Sources::new(), Diagnostics::new());
    let roots = Roots::at(&args.file, &mut sources, &mut diagnostics);
    if diagnostics.has_errors() {
        return Err(report_errors(args, &sources, &diagnostics));
    }
    let packages = roots.own_packages().into_iter();
    Ok(packages
        .map(|(_, file)| ModelArgs {
            file,
            ..args.clone()
        })
        .collect())
}

/// Parses the model's file with the packages and the tables it names: see [`crate::package`].
pub(crate) fn loaded(
    args: &ModelArgs,
    sources: &mut Sources,
    text: &str,
    diagnostics: &mut Diagnostics,
) -> (File, Vec<Table>) {
    let roots = Roots::of(&args.file, sources, diagnostics);
    let own = args.file.to_string_lossy();
    let searched = match roots.roots.first().and_then(|root| root.manifest.as_ref()) {
        Some(_) => "in this package or its dependencies",
        None => "beside the file",
    };
    let all = || {
        let packages = roots.own_packages().into_iter();
        let others = packages.filter(|(_, place)| *place != args.file);
        others
            .filter_map(|(name, place)| Some((name, files::read_text(&place).ok()?)))
            .collect()
    };
    let packages = hyde_compiler::Packages {
        find: &|importer, package| match &args.inputs {
            Some(inputs) if inputs.is_replayed() => {
                let found = inputs.found(Kind::Package, importer, package);
                Ok(found.and_then(|(place, text)| Some((place, String::from_utf8(text).ok()?))))
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
        whole_library: args.whole_library,
    };
    let mut file = hyde_compiler::load(sources, &own, text, &packages, diagnostics);
    if let Some((id, tree)) = file.files.first()
        && let Some(name) = roots.name_of(&args.file)
    {
        hyde_compiler::check_name(sources, *id, tree, &name, diagnostics);
    }
    let tables = tables::read(&mut file, args, &roots, sources, diagnostics);
    (file, tables)
}

/// What a program is for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Aim {
    /// A run.
    Run,
    /// A run with the energy ledger, and to check everything that is written.
    Ledger,
    /// The linearised model, its inputs free, with the energies of its parts.
    Linearize,
    /// What an observer runs: replays made, measured channels alone reported.
    Observe,
}

impl Project {
    /// Compiles; reports and ends with the errors otherwise. Warnings are printed.
    pub(crate) fn compile(&mut self, args: &ModelArgs, aim: Aim) -> Result<Compiled, Exit> {
        let compiled = self.compile_silently(aim);
        compiled.inspect_err(|_| {
            self.finish_with_errors(args);
        })
    }

    /// Compiles; what is wrong stays in the project's diagnostics.
    pub(crate) fn compile_silently(&mut self, aim: Aim) -> Result<Compiled, Exit> {
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
            free_inputs: aim == Aim::Linearize,
            ledger: matches!(aim, Aim::Ledger | Aim::Linearize),
            form: match aim {
                Aim::Observe => Form::Observed,
                Aim::Run | Aim::Ledger | Aim::Linearize => Form::Run,
            },
            backend: Backend::Native,
        };
        let compiled = hyde_compiler::compile(&request, &mut self.diagnostics);
        let Some(compiled) = compiled else {
            return Err(Exit::Model);
        };
        for setting in &self.settings {
            let checked = match compiled.program.parameter(&setting.path) {
                Some((parameter, _)) => settings::check(setting, parameter),
                None => Err(unknown_parameter(&compiled, &setting.path)),
            };
            if let Err(reason) = checked {
                let diagnostic = run_failure::cannot_set(&compiled.program, &setting.path, reason);
                self.diagnostics.push(diagnostic);
                return Err(Exit::CommandLine);
            }
        }
        Ok(compiled)
    }

    /// Which effects fit where on the model, as long as that is in order.
    pub(crate) fn candidates(
        &mut self,
        args: &ModelArgs,
    ) -> Result<Vec<hyde_compiler::Candidate>, Exit> {
        let request = Request {
            sources: &self.sources,
            file: &self.file,
            model: &self.model,
            experiment: None,
            settings: &BTreeMap::new(),
            records: &BTreeMap::new(),
            free_inputs: true,
            ledger: false,
            form: Form::Run,
            backend: Backend::Native,
        };
        let found = hyde_compiler::candidates(&request, &mut self.diagnostics);
        found.ok_or_else(|| self.finish_with_errors(args))
    }

    /// What is asked of the compiler for the project in a form, with these settings and the headers of its records.
    pub(crate) fn request<'a>(
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
            free_inputs: false,
            ledger: false,
            form,
            backend: Backend::Native,
        }
    }

    /// The plain values set from outside, as the run takes them.
    pub(crate) fn set(&self) -> Vec<(String, f64)> {
        self.settings
            .iter()
            .map(|setting| (setting.path.clone(), setting.value))
            .collect()
    }

    /// Prints warnings, if any.
    pub(crate) fn print_warnings(&self, args: &ModelArgs) {
        if !self.diagnostics.is_empty() && !args.json && !args.quiet {
            print_diagnostics(&self.diagnostics, &self.sources, "");
        }
    }

    /// Prints the diagnostics of a model that is at fault.
    pub(crate) fn finish_with_errors(&self, args: &ModelArgs) -> Exit {
        report_errors(args, &self.sources, &self.diagnostics)
    }
}

/// Prints the diagnostics of what is at fault.
pub(crate) fn report_errors(
    args: &ModelArgs,
    sources: &Sources,
    diagnostics: &Diagnostics,
) -> Exit {
    if args.json {
        let list = render::to_json(diagnostics, sources);
        print_output(&format!(
            "{:#}",
            json!({ "ok": false, "diagnostics": list })
        ));
    } else {
        let count = diagnostics.error_count();
        let errors = if count == 1 {
            "1 error".to_owned()
        } else {
            format!("{count} errors")
        };
        let file = args.file.display();
        let last = format!("{file}: {errors}; `hyde explain CODE` tells more");
        print_diagnostics(diagnostics, sources, &last);
    }
    Exit::Model
}

/// The experiment meant: the one named, or the file's only one.
fn choose<'p>(project: &'p Project, args: &ModelArgs) -> Result<Option<&'p Experiment>, String> {
    let all: Vec<&Experiment> = project.file.experiments().collect();
    if let Some(name) = &args.experiment {
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
        _ if args.model.is_some() => Ok(None),
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

fn unknown_parameter(compiled: &Compiled, path: &str) -> String {
    let last = path.rsplit('.').next().unwrap_or(path);
    let near: Vec<&str> = compiled
        .program
        .parameters
        .iter()
        .map(|parameter| parameter.name.as_str())
        .filter(|name| name.rsplit('.').next() == Some(last))
        .take(3)
        .collect();
    if near.is_empty() {
        return format!("the model has no parameter `{path}`");
    }
    format!(
        "the model has no parameter `{path}`; did you mean `{}`?",
        near.join("`, `")
    )
}

/// Tells what is wrong with the command line, and gives back the exit status.
pub(crate) fn complain(args: &ModelArgs, exit: Exit, reason: &str) -> Exit {
    if args.json {
        print_output(&format!("{:#}", json!({ "ok": false, "error": reason })));
    } else {
        print_error(&format!("error: {reason}"));
    }
    exit
}
