//! `hyde excite`: what to record next.

use crate::args::{Criterion, ExciteArgs, ModelArgs, SignalFormat, SignalName};
use crate::exit::Exit;
use crate::project::{complain, print_output};
use crate::{files, study};
use hyde_present::excitation::file::{SignalForm, content};
use hyde_present::excitation::{table, text};
use hyde_signal::excite::{Design, Shape, design};
use hyde_study::excitation::{self, Options, refused, wished};
use std::path::Path;

/// Designs a signal, tells and writes it.
pub(crate) fn excite(args: &ExciteArgs) -> Exit {
    let found = match args.file {
        Some(_) => of_model(args),
        None => designed(args),
    };
    match found {
        Ok(told) => {
            if !told.is_empty() {
                print_output(&told);
            }
            Exit::Done
        }
        Err(exit) => exit,
    }
}

/// A signal of one kind.
fn designed(args: &ExciteArgs) -> Result<String, Exit> {
    let wrong = |reason: String| complain(&model_args(args), Exit::CommandLine, &reason);
    let asked = wished(&options(args)).map_err(wrong)?;
    let design = design(&asked.wish).map_err(|own| wrong(refused::reason(&own, &asked.wish)))?;
    leave(args, &asked.column, &design).map_err(wrong)?;
    Ok(match (args.json, args.quiet) {
        (true, _) => format!("{:#}", text::json(&asked, &design)),
        (false, true) => String::new(),
        (false, false) => text::text(None, &asked, &design, args.out.as_deref()),
    })
}

/// The best signal for a model.
fn of_model(args: &ExciteArgs) -> Result<String, Exit> {
    let model = model_args(args);
    let wrong = |reason: String| complain(&model, Exit::CommandLine, &reason);
    let options = options(args);
    let wished = wished(&options).map_err(wrong)?;
    let mut found = study::comparison(&model, args.study.as_deref(), (&options, wished))?;
    found.wished.column.clone_from(&found.bench.column.1);
    let best = &found.all[found.best];
    leave(args, &found.wished.column, &best.design).map_err(wrong)?;
    Ok(match (args.json, args.quiet) {
        (true, _) => format!("{:#}", table::json(&found)),
        (false, true) => String::new(),
        (false, false) => table::text(&found, options.criterion, args.out.as_deref()),
    })
}

/// Writes the file, if one is asked for.
fn leave(args: &ExciteArgs, column: &str, design: &Design) -> Result<(), String> {
    let Some(path) = &args.out else {
        return Ok(());
    };
    let form = match format_of(args, path) {
        SignalFormat::Csv => SignalForm::Csv,
        SignalFormat::Twincat => SignalForm::Twincat,
        SignalFormat::Gcode => SignalForm::Gcode(args.axis),
    };
    files::write(path, content(column, design, form)?.as_bytes())
}

fn format_of(args: &ExciteArgs, path: &Path) -> SignalFormat {
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    let ending = ending.to_string_lossy();
    let by_ending = match ["nc", "ngc", "mpf", "gcode"].contains(&ending.as_ref()) {
        true => SignalFormat::Gcode,
        false => SignalFormat::Csv,
    };
    args.format.unwrap_or(by_ending)
}

/// The model's file with what is set.
fn model_args(args: &ExciteArgs) -> ModelArgs {
    let file = args.file.clone().unwrap_or_default();
    ModelArgs {
        settings: args.settings.clone(),
        json: args.json,
        quiet: args.quiet,
        whole_library: !args.between.is_empty(),
        ..ModelArgs::of_file(&file)
    }
}

fn options(args: &ExciteArgs) -> Options {
    let limits = &args.limits;
    let shape = |name: &SignalName| match name {
        SignalName::Multisine => Shape::Multisine,
        SignalName::Chirp => Shape::Chirp,
        SignalName::Jogs => Shape::Jogs,
        SignalName::Reversals => Shape::Reversals,
    };
    Options {
        of_model: args.file.is_some(),
        signal: args.signal.iter().map(shape).collect(),
        criterion: match args.criterion {
            Criterion::D => excitation::Criterion::D,
            Criterion::A => excitation::Criterion::A,
        },
        between: args.between.clone(),
        size: args.size,
        motion: limits.motion(),
        effort: limits.effort.clone(),
        band: args.band.clone(),
        duration: args.duration.clone(),
        every: args.every.clone(),
        start: args.start.clone(),
        speeds: args.speeds,
        places: args.places,
        reversal: args.reversal.clone(),
        column: args.column.clone(),
        unit: args.unit.clone(),
    }
}
