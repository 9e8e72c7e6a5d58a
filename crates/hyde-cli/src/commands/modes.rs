//! `hyde modes`: natural frequencies and dampings of the linearised model; of several experiments side by side, and over a
//! parameter; and parameters from measured ones.

use crate::args::{AboutArgs, ModelArgs, ModesArgs};
use crate::clock;
use crate::exit::Exit;
use crate::files;
use crate::project::{self, Loaded, Records, Told as _, complain, print_output};
use crate::watch::Watch;
use hyde_present::modes::{inverse, json, over, page, text};
use hyde_report::{Figure, to_html, to_png, to_svg};
use hyde_study::modes::{self, Measured, Modes, Point, Prepared};
use hyde_study::settings::Setting;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

/// Prints the modes of vibration.
pub(crate) fn modes(args: &ModesArgs) -> Exit {
    match table(args) {
        Ok(text) => {
            if args.model.json || !args.model.quiet {
                print_output(&text);
            }
            Exit::Done
        }
        Err(exit) => exit,
    }
}

fn table(args: &ModesArgs) -> Result<String, Exit> {
    if !args.measured.is_empty() {
        return fitted(args);
    }
    let others = args.with.iter().map(|name| ModelArgs {
        experiment: Some(name.clone()),
        ..args.model.clone()
    });
    let experiments: Vec<ModelArgs> = std::iter::once(args.model.clone()).chain(others).collect();
    if let Some(range) = &args.over {
        return over_range(args, &experiments, range);
    }
    let loaded = project::parsed(&args.model)?;
    let all = experiments.iter();
    let all: Result<Vec<Modes>, Exit> =
        all.map(|model| found(args, model, &loaded, None)).collect();
    let all = all?;
    let left = args.out.as_ref().map(|folder| leave(folder, None, &all));
    let left = left.transpose();
    let left = left.map_err(|reason| complain(&args.model, Exit::CommandLine, &reason))?;
    if args.model.json {
        return Ok(format!("{:#}", json(&all)));
    }
    let mut text = text(&all, args.real);
    if let Some(path) = left {
        let _ = writeln!(text, "{path}");
    }
    Ok(text)
}

/// The modes of an experiment, with one more parameter set if so.
fn found(
    args: &ModesArgs,
    model: &ModelArgs,
    loaded: &Loaded,
    set: Option<&Setting>,
) -> Result<Modes, Exit> {
    let prepared = prepared(&args.about, model, loaded.clone(), set)?;
    let reached = Arc::default();
    let watch = Watch::of_run(model.quiet, &reached);
    let found = modes::modes(prepared, args.open, args.below, &reached);
    drop(watch);
    found.map_err(|own| project::refused(model, &own))
}

/// An experiment of a file compiled for its linearised model.
pub(crate) fn prepared(
    about: &AboutArgs,
    model: &ModelArgs,
    loaded: Loaded,
    set: Option<&Setting>,
) -> Result<Prepared, Exit> {
    let project = project::chosen(model, loaded, Records::Needed)?;
    let point = Point {
        at: about.at.clone(),
        in_modes: about.in_modes.clone(),
    };
    let prepared = Prepared::new(project, &point, set);
    let prepared = prepared.map_err(|own| project::refused(model, &own))?;
    prepared.project.print_warnings(model);
    Ok(prepared)
}

/// The modes over a parameter.
fn over_range(args: &ModesArgs, experiments: &[ModelArgs], range: &str) -> Result<String, Exit> {
    let wrong = |reason: String| complain(&args.model, Exit::CommandLine, &reason);
    let settings = modes::over(range, args.points).map_err(wrong)?;
    let loaded = project::parsed(&args.model)?;
    let mut rows: Vec<over::Row> = Vec::new();
    for setting in &settings {
        let all = experiments.iter();
        let all: Result<Vec<Modes>, Exit> = all
            .map(|model| found(args, model, &loaded, Some(setting)))
            .collect();
        rows.push((setting.value, all?));
    }
    let path = settings.first().map_or("", |own| own.path.as_str());
    let unit = over::unit(&rows, path);
    let mut text = match args.model.json {
        true => format!("{:#}", over::json(&rows, path)),
        false => over::text(&rows, path, &unit),
    };
    if let Some(folder) = &args.out {
        let page = leave_range(folder, &rows, path, &unit).map_err(wrong)?;
        if !args.model.json {
            let _ = writeln!(text, "{}\n{page}", folder.join("modes.svg").display());
        }
    }
    Ok(text)
}

/// Parameters from measured modes.
fn fitted(args: &ModesArgs) -> Result<String, Exit> {
    let asked = Measured {
        measured: args.measured.clone(),
        vary: args.vary.clone(),
        pair: args.pair.clone(),
        spread: args.spread,
        damping_spread: args.damping_spread,
    };
    let measured = asked.read();
    let measured = measured.map_err(|reason| complain(&args.model, Exit::CommandLine, &reason))?;
    let loaded = project::parsed(&args.model)?;
    let prepared = prepared(&args.about, &args.model, loaded, None)?;
    let found = modes::fitted(prepared, &args.vary, measured);
    let found = found.map_err(|own| project::refused(&args.model, &own))?;
    Ok(match args.model.json {
        true => format!("{:#}", inverse::json(&found)),
        false => inverse::text(&found),
    })
}

/// Leaves `modes.html`, with the figure of the modes over a parameter if there is one; gives back its name.
fn leave(folder: &Path, over: Option<Figure>, all: &[Modes]) -> Result<String, String> {
    files::make_folder(folder)?;
    let path = folder.join("modes.html");
    let page = page::page(over, all, &clock::now());
    files::write(&path, to_html(&page).as_bytes())?;
    Ok(path.display().to_string())
}

/// The same with the figure and its numbers.
fn leave_range(
    folder: &Path,
    rows: &[over::Row],
    path: &str,
    unit: &str,
) -> Result<String, String> {
    files::make_folder(folder)?;
    let figure = over::drawn(rows, path, unit);
    files::write(&folder.join("modes.svg"), to_svg(&figure).as_bytes())?;
    files::write(&folder.join("modes.png"), &to_png(&figure, 2.0))?;
    let csv = over::csv(rows, path, unit);
    files::write(&folder.join("modes.csv"), csv.as_bytes())?;
    let first = rows.first().map_or(&[][..], |(_, all)| all);
    leave(folder, Some(figure), first)
}
