//! `hyde export fmu`: an FMU of a model, written without a compiler: a library that is the same for every model, and what it
//! runs.

use super::identifier;
use crate::args::{FmiVersion, FmuArgs, ReferenceRun};
use crate::exit::Exit;
use crate::files;
use crate::interruption;
use crate::project::{self, Project, Records, Told as _, complain, print_output};
use crate::watch::Watch;
use hyde_fmi::{
    Causality, Chosen, Described, Kept, Model, Reference, Uncompiled, Version, archive,
};
use hyde_sim::Reached;
use hyde_study::Inputs;
use hyde_units::counted;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;

/// The library of every FMU.
const LIBRARY: &str = "libhyde_fmu.so";
/// What it loads besides the C library: put beside it where the command brings them.
const LOADED: [&str; 5] = ["klu", "amd", "colamd", "btf", "suitesparseconfig"];

/// Writes an FMU.
pub(crate) fn fmu(args: &FmuArgs) -> Exit {
    match written(args) {
        Ok(text) => {
            if !args.model.quiet {
                print_output(&text);
            }
            Exit::Done
        }
        Err(exit) => exit,
    }
}

fn written(args: &FmuArgs) -> Result<String, Exit> {
    let inputs = Arc::new(Inputs::recording());
    let mut own = args.model.clone();
    own.inputs = Some(Arc::clone(&inputs));
    let project = project::load(&own, Records::Needed)?;
    project.print_warnings(&own);
    let refused = |reason: String| complain(&own, Exit::CommandLine, &reason);
    let library = Library::find().map_err(refused)?;
    let chosen = Chosen {
        project,
        inputs: args.input.clone(),
        outputs: args.output.clone(),
    };
    let model = chosen.compile().map_err(|other| failed(args, &other))?;
    let kept = kept(args, model.project(), &inputs)?;
    let bytes = kept.to_bytes().map_err(refused)?;
    let identifier = identifier(model.project());
    let described = model
        .described(&identifier, Kept::token(&bytes))
        .map_err(|error| refused(model.explain(&error)))?;
    let version = match args.fmi {
        FmiVersion::Two => Version::Fmi2,
        FmiVersion::Three => Version::Fmi3,
    };
    let description = match version {
        Version::Fmi2 => described.fmi2(),
        Version::Fmi3 => described.fmi3(),
    };
    let sources = match args.with_source {
        true => kept.sources(),
        false => Vec::new(),
    };
    let libraries = library.read(&identifier).map_err(refused)?;
    let reference = reference(args, &model, &described)?;
    let files = match &reference {
        Ok(reference) => reference.as_ref(),
        Err(_) => None,
    };
    let none = Reference::default();
    let files = files.unwrap_or(&none);
    let content = archive(version, &description, &libraries, &bytes, &sources, files);
    let content = content.map_err(|error| refused(error.to_string()))?;
    let default = PathBuf::from(format!("{identifier}.fmu"));
    let path = args.out.as_ref().unwrap_or(&default);
    files::write(path, &content).map_err(refused)?;
    Ok(match args.model.json {
        true => format!(
            "{:#}",
            told_as_json(path, version, &model, &described, &reference)
        ),
        false => told(path, version, &model, libraries.len() > 1, &reference),
    })
}

/// So many rows of an experiment are reference results, if not all are asked for: an export takes less than a second.
const REFERENCE_ROWS: u32 = 1000;

/// The reference results of an FMU, if it is to have any; or why its experiment has none.
type Referenced = Result<Option<Reference>, String>;

/// Runs the experiment for the reference results. Inputs that the importer sets have their stimuli in it.
fn reference(args: &FmuArgs, model: &Model, described: &Described<'_>) -> Result<Referenced, Exit> {
    let Some(experiment) = model.project().experiment.as_deref() else {
        return Ok(Ok(None));
    };
    let rows = match args.reference {
        ReferenceRun::None => return Ok(Ok(None)),
        ReferenceRun::First => Some(REFERENCE_ROWS),
        ReferenceRun::Whole => None,
    };
    let driven = match args.input.is_empty() {
        true => None,
        false => {
            let chosen = Chosen {
                project: project::load(&args.model, Records::Needed)?,
                inputs: Vec::new(),
                outputs: args.output.clone(),
            };
            Some(chosen.compile().map_err(|other| failed(args, &other))?)
        }
    };
    let driven = driven.as_ref().unwrap_or(model);
    let interface = &model.interface;
    let numbers = interface.with(Causality::Input);
    let numbers = numbers.chain(interface.with(Causality::Output));
    let names: Vec<&str> = numbers
        .map(|number| interface.variables[number].name.as_str())
        .collect();
    let interrupted = interruption::interrupted();
    let reached = Arc::<Reached>::default();
    let watch = Watch::of_run(args.model.quiet, &reached);
    let run = driven.run(&names, rows, Arc::clone(&interrupted), reached);
    drop(watch);
    if interrupted.load(Ordering::Relaxed) {
        let reason =
            "interrupted while it ran the experiment for the reference results: no FMU was written";
        return Err(complain(&args.model, Exit::Interrupted, reason));
    }
    Ok(match run {
        Ok(run) => Ok(Some(Reference::of(
            described,
            experiment,
            &driven.program,
            &run,
        ))),
        Err(error) => Err(driven.explain(&error)),
    })
}

fn failed(args: &FmuArgs, other: &Uncompiled) -> Exit {
    match &other.reason {
        Some(reason) => complain(&args.model, Exit::CommandLine, reason),
        None => other.project.finish_with_errors(&args.model),
    }
}

/// What the FMU holds.
fn kept(args: &FmuArgs, project: &Project, inputs: &Inputs) -> Result<Kept, Exit> {
    let asked = project::asked(&args.model)?;
    let kept = Kept::of(&args.model.file, &project.model, inputs);
    let mut kept = kept.with_data(args.model.data.as_deref(), &args.model.file);
    kept.experiment.clone_from(&project.experiment);
    kept.settings.clone_from(&args.model.settings);
    kept.records = asked.records;
    kept.inputs.clone_from(&args.input);
    kept.outputs.clone_from(&args.output);
    Ok(kept)
}

/// Where the library is.
struct Library(PathBuf);

impl Library {
    /// Looks for the library beside the command: in `lib/` of the archive, or where the command was built.
    fn find() -> Result<Self, String> {
        let command = std::env::current_exe().map_err(|error| error.to_string())?;
        let folder = command.parent().unwrap_or(Path::new("."));
        let places = [
            folder.join("../lib").join(LIBRARY),
            folder.join("deps").join(LIBRARY),
            folder.join(LIBRARY),
        ];
        let found = places.iter().find(|place| files::is_file(place));
        found.cloned().map(Self).ok_or_else(|| {
            let shown: Vec<String> = places
                .iter()
                .map(|place| format!("`{}`", place.display()))
                .collect();
            format!(
                "the library of FMUs is missing: none of {} is a file; install the archive of \
                 `./dev package`, or build it with `cargo build -p hyde-cli`",
                shown.join(", ")
            )
        })
    }

    /// The library as that of a model, and what it loads from its own folder.
    fn read(&self, identifier: &str) -> Result<Vec<(String, Vec<u8>)>, String> {
        let mut found = vec![(format!("{identifier}.so"), files::read(&self.0)?)];
        let folder = self.0.parent().unwrap_or(Path::new("."));
        for path in files::in_folder(folder) {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let loaded = |known: &&str| name.starts_with(&format!("lib{known}.so"));
            if LOADED.iter().any(loaded) {
                found.push((name.into_owned(), files::read(&path)?));
            }
        }
        Ok(found)
    }
}

/// What was written, and what was assumed.
fn told(
    path: &Path,
    version: Version,
    model: &Model,
    complete: bool,
    reference: &Referenced,
) -> String {
    let interface = &model.interface;
    let count = |causality, what| counted(interface.with(causality).count(), what);
    let kinds = match &interface.no_model_exchange {
        None => "co-simulation and model exchange",
        Some(_) => "co-simulation",
    };
    let mut lines = vec![
        format!("  {}", path.display()),
        format!("  FMI {}, {kinds}, Linux x86-64", version.number()),
        format!(
            "  {}, {}, {}, {}",
            count(Causality::Input, "input"),
            count(Causality::Output, "output"),
            count(Causality::Parameter, "parameter"),
            counted(interface.states.len(), "state"),
        ),
    ];
    if let Some(why) = &interface.no_model_exchange {
        lines.push(format!("  no model exchange: {why}"));
    }
    for input in &model.program.experiment.differentiated {
        lines.push(format!(
            "  the equations need the derivative of `{input}`; between steps it is 0"
        ));
    }
    match reference {
        Ok(Some(reference)) => lines.push(match reference.until_s {
            None => "  reference results: the run of the experiment".to_owned(),
            Some(until_s) => format!(
                "  reference results: the run to {} s; --reference whole: all, with expectations",
                hyde_units::significant(until_s, 6)
            ),
        }),
        Ok(None) => {}
        Err(reason) => {
            // The whole of it is what `hyde run` says.
            let fact = reason.split("; ").next().unwrap_or(reason);
            lines.push(format!("  no reference results: {fact}"));
        }
    }
    if !complete {
        lines.push("  the importer needs libklu.so.1 (SuiteSparse) on its machine".to_owned());
    }
    lines.join("\n")
}

fn told_as_json(
    path: &Path,
    version: Version,
    model: &Model,
    described: &Described<'_>,
    reference: &Referenced,
) -> serde_json::Value {
    let interface = &model.interface;
    let names = |causality| -> Vec<&str> {
        let numbers = interface.with(causality);
        numbers
            .map(|number| interface.variables[number].name.as_str())
            .collect()
    };
    json!({
        "ok": true,
        "fmu": path.display().to_string(),
        "fmi": version.number(),
        "model_identifier": described.identifier,
        "model_exchange": interface.no_model_exchange.is_none(),
        "inputs": names(Causality::Input),
        "outputs": names(Causality::Output),
        "parameters": interface.with(Causality::Parameter).count(),
        "states": interface.states.len(),
        "differentiated_inputs": model.program.experiment.differentiated,
        "reference_results": matches!(reference, Ok(Some(_))),
        "reference_until_s": reference.as_ref().ok().and_then(|r| r.as_ref()?.until_s),
        "no_reference_results": reference.as_ref().err(),
    })
}
