//! `hyde new`: a first model of an axis.

use super::look::print_unread;
use crate::args::{NewArgs, TemplateName};
use crate::exit::Exit;
use crate::files;
use crate::project::{print_error, print_output};
use hyde_study::first_model::{FirstModel, Template, Trace, Wish, first_model};
use hyde_study::record_files::{parts, sum};
use hyde_study::record_settings::split;
use hyde_study::settings;
use hyde_study::traces::seen;
use hyde_study::world::Disk;
use hyde_units::NamedUnit;
use std::path::{Path, PathBuf};

/// Writes the file and says what to do with it.
pub(crate) fn new(args: &NewArgs) -> Exit {
    match written(args) {
        Ok((path, model)) => {
            print_output(&told(&path, &model));
            Exit::Done
        }
        Err((exit, reason)) => {
            if !reason.is_empty() {
                print_error(&format!("error: {reason}"));
            }
            exit
        }
    }
}

type Failed = (Exit, String);

fn written(args: &NewArgs) -> Result<(PathBuf, FirstModel), Failed> {
    let wrong = |reason: String| (Exit::CommandLine, reason);
    let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let named = args.name.starts_with(|c: char| c.is_ascii_alphabetic());
    if !named || !args.name.chars().all(letter) || hyde_syntax::is_reserved(&args.name) {
        return Err(wrong(format!(
            "`{}` cannot be the name of a package: write letters, digits and `_`, such as `x_axis`",
            args.name
        )));
    }
    let template = template(args.template);
    let folder = folder(args);
    let traces = args.from.iter().map(|text| trace(text, &folder));
    let traces = traces.collect::<Result<Vec<Trace>, Failed>>()?;
    let wish = Wish {
        name: args.name.clone(),
        template,
        constant: quantity(
            args.constant.as_deref(),
            "constant",
            constant_unit(template),
        )
        .map_err(wrong)?,
        ratio: quantity(args.ratio.as_deref(), "ratio", ratio_unit(template)).map_err(wrong)?,
        traces,
    };
    let mut model = first_model(&wish)
        .map_err(|no| (Exit::Model, format!("{}\n  help: {}", no.message, no.help)))?;
    let path = folder.join(format!("{}.hyde", args.name));
    if files::is_file(&path) {
        return Err(wrong(format!(
            "`{}` is there already: give another name, or another folder by `--out DIR`",
            path.display()
        )));
    }
    // A text that the formatter cannot take is left as it is written.
    if let Ok(formatted) = hyde_format::format(&args.name, &model.text) {
        model.text = formatted.text;
    }
    files::make_folder(&folder).map_err(wrong)?;
    files::write(&path, model.text.as_bytes()).map_err(wrong)?;
    Ok((path, model))
}

/// The folder of the model: as given, else that of the first trace.
fn folder(args: &NewArgs) -> PathBuf {
    let of_trace = || {
        let text = args.from.first()?;
        let file = parts(split(&Disk, text).0).next()?;
        let parent = Path::new(file).parent()?;
        (!parent.as_os_str().is_empty()).then(|| parent.to_owned())
    };
    args.out
        .clone()
        .or_else(of_trace)
        .unwrap_or_else(|| PathBuf::from("."))
}

/// A trace as the model will read it.
fn trace(text: &str, folder: &Path) -> Result<Trace, Failed> {
    let look = |text: &str| {
        seen(&Disk, text).map_err(|failed| {
            print_unread(&failed);
            (Exit::Model, String::new())
        })
    };
    let seen = look(text)?;
    let settings = seen.settings();
    let path = seen.given.path.clone();
    let seen = match settings == seen.given.text {
        true => seen,
        // With the units that follow from other channels.
        false => look(&format!("{} {settings}", path.display()))?,
    };
    let files = seen.files.iter().map(|file| inside(file, folder));
    let files = files.collect::<Result<Vec<PathBuf>, Failed>>()?;
    Ok(Trace {
        file: sum(&files, |file| file.to_string_lossy().into_owned()),
        settings,
        table: seen.table,
        look: seen.look,
    })
}

/// Where a file is below the folder of the model.
fn inside(file: &Path, folder: &Path) -> Result<PathBuf, Failed> {
    let both = files::real(file).zip(files::real(folder));
    let below = both.and_then(|(file, folder)| file.strip_prefix(folder).map(Path::to_owned).ok());
    below.ok_or_else(|| {
        let place = file.parent().unwrap_or(Path::new(".")).display().to_string();
        let reason = format!(
            "`{}` is not below the folder of the model, and a model reads no file outside its folder: write `--out {place}`",
            file.display()
        );
        (Exit::CommandLine, reason)
    })
}

fn template(name: TemplateName) -> Template {
    match name {
        TemplateName::Screw => Template::Screw,
        TemplateName::Belt => Template::Belt,
        TemplateName::Rack => Template::Rack,
        TemplateName::Linear => Template::Linear,
        TemplateName::Table => Template::Table,
        TemplateName::Bench => Template::Bench,
    }
}

fn constant_unit(template: Template) -> &'static str {
    if template.turns() { "N.m/A" } else { "N/A" }
}

fn ratio_unit(template: Template) -> &'static str {
    if template == Template::Table {
        "1"
    } else {
        "mm/rev"
    }
}

/// A positive value in a unit of the right dimension, SI.
fn quantity(text: Option<&str>, name: &str, unit: &str) -> Result<Option<f64>, String> {
    let Some(text) = text else {
        return Ok(None);
    };
    let example = if unit == "1" {
        "90".to_owned()
    } else {
        format!("10 [{unit}]")
    };
    let wanted = format!("`--{name} '{text}'`: write a positive value, `--{name} '{example}'`");
    let setting = settings::parse(&format!("{name}={text}")).map_err(|_| wanted.clone())?;
    let dimension = |unit: &NamedUnit| unit.unit().dimension;
    let own = setting.unit.as_ref().map(dimension);
    let expected = match unit {
        "1" => None,
        unit => NamedUnit::parse(unit).ok().as_ref().map(dimension),
    };
    let agree = match (own, expected) {
        (Some(own), Some(expected)) => own.agreement(expected) != hyde_units::Agreement::Different,
        (own, expected) => own == expected,
    };
    match agree && setting.value > 0.0 && !setting.truth {
        true => Ok(Some(setting.value)),
        false => Err(wanted),
    }
}

fn told(path: &Path, model: &FirstModel) -> String {
    let notes = hyde_present::assumptions::text(&model.notes);
    let mut lines: Vec<String> = notes.lines().map(str::to_owned).collect();
    let confirm = model
        .text
        .lines()
        .filter(|line| line.contains("// confirm"));
    let shown = path.display();
    lines.push(format!(
        "{shown}: {} lines end with `// confirm`; check them, then",
        confirm.count()
    ));
    let studies = match model.experiment {
        "trial" => ["run", "fit", "diagnose"].as_slice(),
        _ => ["run"].as_slice(),
    };
    lines.extend(
        studies
            .iter()
            .map(|study| format!("  hyde {study} {shown} {}", model.experiment)),
    );
    lines.join("\n")
}
