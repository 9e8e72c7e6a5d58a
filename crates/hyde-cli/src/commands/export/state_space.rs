//! `hyde export statespace`: the linearised model as matrices with names, for MATLAB, Octave, python-control, or as JSON.

use super::{identifier, no_arrays};
use crate::args::StateSpaceArgs;
use crate::commands::modes::prepared;
use crate::exit::Exit;
use crate::files;
use crate::project::{self, complain, print_output};
use hyde_present::state_space::{content, octave, python, text};
use hyde_study::state_space::state_space;
use serde_json::json;
use std::path::{Path, PathBuf};

/// The form of the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Mat,
    Json,
    Python,
    Octave,
}

impl Form {
    fn of(path: &Path) -> Result<Self, String> {
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        match ending.as_ref() {
            "mat" => Ok(Self::Mat),
            "json" => Ok(Self::Json),
            "py" => Ok(Self::Python),
            "m" => Ok(Self::Octave),
            _ => Err(format!(
                "`--out {}`: the ending of the file is its format: write `.mat`, `.json`, `.py` or `.m`",
                path.display()
            )),
        }
    }
}

/// Writes the file.
pub(crate) fn export(args: &StateSpaceArgs) -> Exit {
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

fn written(args: &StateSpaceArgs) -> Result<String, Exit> {
    let model = &args.model;
    let refused = |reason: String| complain(model, Exit::CommandLine, &reason);
    let form = args.out.as_deref().map(Form::of).transpose();
    let form = form.map_err(refused)?.unwrap_or(Form::Mat);
    let ready = prepared(&args.about, model, project::parsed(model)?, None)?;
    no_arrays(&ready.compiled.program, &args.output).map_err(refused)?;
    let default = PathBuf::from(format!("{}.mat", identifier(&ready.project)));
    let found = state_space(ready, (&args.input, &args.output), args.open);
    let found = found.map_err(|own| project::refused(model, &own))?;
    let content = match form {
        Form::Mat => content::mat(&found),
        Form::Json => format!("{:#}\n", content::json(&found)).into_bytes(),
        Form::Python => python::text(&found).into_bytes(),
        Form::Octave => octave::text(&found).into_bytes(),
    };
    let path = args.out.as_ref().unwrap_or(&default);
    files::write(path, &content).map_err(refused)?;
    let path = path.display().to_string();
    Ok(match model.json {
        true => {
            let mut told = content::names(&found);
            told["ok"] = json!(true);
            told["file"] = json!(path);
            format!("{told:#}")
        }
        false => text(&path, &found),
    })
}
