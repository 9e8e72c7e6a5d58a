//! `hyde bode`: the frequency responses and the stability margins that an experiment asks for, and those of other experiments
//! beside them.

use crate::args::{BodeArgs, ModelArgs, RunArgs};
use crate::clock;
use crate::commands::run;
use crate::exit::Exit;
use crate::files;
use crate::interruption::interrupted;
use crate::project::{self, Loaded, Records, Told as _, complain, print_output};
use crate::watch::Watch;
use hyde_sim::Reached;
use hyde_study::responses::{How, OfRun, Options, Prepared, Responses, add_cuts};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

/// Prints and plots the frequency responses of an experiment, and of those beside it.
pub(crate) fn bode(args: &BodeArgs) -> Exit {
    match responses(args) {
        Ok((text, holds)) => {
            if args.model.json || !args.model.quiet {
                print_output(&text);
            }
            if holds { Exit::Done } else { Exit::Expectation }
        }
        Err(exit) => exit,
    }
}

fn responses(args: &BodeArgs) -> Result<(String, bool), Exit> {
    let loaded = project::parsed(&args.model)?;
    let (first, time) = asked(args, &args.model, &loaded)?;
    let (mut all, mut took) = (vec![first], vec![time]);
    for name in &args.with {
        let model = ModelArgs {
            experiment: Some(name.clone()),
            ..args.model.clone()
        };
        let (other, time) = asked(args, &model, &loaded)?;
        all.push(other);
        took.push(time);
    }
    let holds = all.iter().all(Responses::holds);
    let path = |folder: &Path, name: &str| folder.join(name).display().to_string();
    let out = args.out.as_deref();
    let path = out.map(|folder| move |name: &str| path(folder, name));
    let path = path.as_ref().map(|path| path as &dyn Fn(&str) -> String);
    let (title, made) = (args.title.as_deref(), clock::now());
    let (text, written) = hyde_present::bode::text(&all, &took, path, title, &made);
    if let Some(folder) = out {
        leave(folder, &written)
            .map_err(|reason| complain(&args.model, Exit::CommandLine, &reason))?;
    }
    let text = match args.model.json {
        true => format!("{:#}", hyde_present::bode::json(&all)),
        false => text,
    };
    Ok((text, holds))
}

/// The responses of one experiment of the file, with the time that its run took.
fn asked(
    args: &BodeArgs,
    model: &ModelArgs,
    loaded: &Loaded,
) -> Result<(Responses, Option<Duration>), Exit> {
    let options = Options {
        at: args.about.at.clone(),
        in_modes: args.about.in_modes.clone(),
        linear: args.linear,
        margins: args.margins || !args.cut.is_empty(),
        points: args.points,
    };
    let mut project = project::chosen(model, loaded.clone(), Records::Needed)?;
    add_cuts(&mut project, &args.cut);
    let refused = |own| project::refused(model, &own);
    let prepared = Prepared::new(project, &options).map_err(refused)?;
    prepared.project.print_warnings(model);
    let run = match prepared.needs_run() {
        true => {
            let project = project::chosen(model, loaded.clone(), Records::Needed)?;
            Some(run::solved_of(&RunArgs::of_model(model), project)?)
        }
        false => None,
    };
    let took = run.as_ref().map(|(.., took)| *took);
    let run = run.map(|(_, compiled, run, _)| OfRun { compiled, run });
    let how = How {
        interrupted: interrupted(),
        reached: Arc::default(),
        threads: std::thread::available_parallelism().map_or(1, usize::from),
    };
    let watch = watch(model, &how.reached);
    let found = prepared.responses(run, &how);
    drop(watch);
    Ok((found.map_err(refused)?, took))
}

/// Shows how many frequencies of a response are done.
fn watch(args: &ModelArgs, reached: &Arc<Reached>) -> Watch {
    let reached = Arc::clone(reached);
    Watch::new(args.quiet, move || match reached.get() {
        (done, all) if all > 0.0 => format!("{done} of {all} frequencies"),
        _ => "linearising".to_owned(),
    })
}

/// Writes the files, each whole or not at all.
fn leave(folder: &Path, written: &[(String, Vec<u8>)]) -> Result<(), String> {
    files::make_folder(folder)?;
    written
        .iter()
        .try_for_each(|(name, content)| files::write(&folder.join(name), content))
}
