//! `hyde run`: solves an experiment and compares it with its records.

mod trajectories;

use crate::args::{Format, RunArgs};
use crate::clock;
use crate::exit::Exit;
use crate::files;
use crate::interruption;
use crate::project::{
    self, Aim, Project, Records, Told as _, complain, print_diagnostics, print_error, print_output,
};
use crate::render;
use crate::watch::Watch;
use hyde_compiler::Compiled;
use hyde_experiment::{Options, Run, RunError};
use hyde_present::asked_figures;
use hyde_present::forces;
use hyde_present::run_page;
use hyde_present::summary;
use hyde_program::Program;
use hyde_report::to_html;
use hyde_signal::{Written, WrittenValues, csv, parquet};
use hyde_sim::{Reached, Results};
use hyde_study::run_failure;
use hyde_units::{NamedUnit, significant};
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::path::Path;
use std::sync::Arc;

/// Runs an experiment, prints what happened, and leaves its files.
pub(crate) fn run(args: &RunArgs) -> Exit {
    match solved(args) {
        Ok((project, compiled, run, took)) => finish(args, &project, &compiled, &run, took),
        Err(exit) => exit,
    }
}

/// The same for a model that is loaded.
pub(crate) fn run_project(args: &RunArgs, project: Project) -> Exit {
    match solved_of(args, project) {
        Ok((project, compiled, run, took)) => finish(args, &project, &compiled, &run, took),
        Err(exit) => exit,
    }
}

/// Loads, compiles and solves.
pub(crate) fn solved(
    args: &RunArgs,
) -> Result<(Project, Compiled, Run, std::time::Duration), Exit> {
    solved_of(args, project::load(&args.model, Records::Needed)?)
}

/// Compiles and solves what was loaded.
#[allow(
    clippy::disallowed_methods,
    reason = "the command line tells how long a run took"
)]
pub(crate) fn solved_of(
    args: &RunArgs,
    mut project: Project,
) -> Result<(Project, Compiled, Run, std::time::Duration), Exit> {
    for (option, value) in [
        ("stop", args.stop),
        ("rtol", args.rtol),
        ("atol", args.atol),
    ] {
        if value.is_some_and(|value| value.is_nan() || value <= 0.0) {
            let reason = format!("`--{option}` must be positive");
            return Err(complain(&args.model, Exit::CommandLine, &reason));
        }
    }
    let compiled = project.compile_or_report(
        &args.model,
        if args.ledger { Aim::Ledger } else { Aim::Run },
    )?;
    project.print_warnings(&args.model);
    let options = Options {
        set: project.set(),
        stop_s: args.stop,
        rtol: args.rtol,
        atol: args.atol,
        every_s: None,
        measured_from_s: None,
        gradient: args.gradient.clone(),
        interrupted: interruption::interrupted(),
        reached: Arc::default(),
    };
    let tables = hyde_study::tables(&project.records);
    let start = std::time::Instant::now();
    let watch = watch(args.model.json || args.model.quiet, &options.reached);
    let outcome = hyde_experiment::run(&compiled.program, &tables, &options);
    drop(watch);
    match outcome {
        Ok(run) => {
            let took = start.elapsed();
            Ok((project, compiled, run, took))
        }
        Err(error) => Err(failed(args, project, &compiled, &options, &error)),
    }
}

/// Shows how far a run is, unless it is to be silent.
pub(crate) fn watch(silent: bool, reached: &Arc<Reached>) -> Watch {
    let reached = Arc::clone(reached);
    Watch::new(silent, move || {
        let (now, end) = reached.get();
        let [now, end] = [now, end].map(|time| significant(time, 4));
        format!("simulated {now} s of {end} s")
    })
}

fn finish(
    args: &RunArgs,
    project: &Project,
    compiled: &Compiled,
    run: &Run,
    took: std::time::Duration,
) -> Exit {
    if let Some(folder) = &args.out
        && let Err(reason) = leave(folder, args.format, project, compiled, run)
    {
        return complain(&args.model, Exit::CommandLine, &reason);
    }
    if args.model.json {
        let mut summary = summary::json(project, compiled, run);
        if args.forces {
            summary["forces"] = forces::json(compiled, run);
        }
        print_output(&format!("{summary:#}"));
    } else if !args.model.quiet {
        print_output(&summary::text(project, compiled, run, took));
        if args.forces {
            print_output(&forces::text(compiled, run));
        }
        if let Some(folder) = &args.out {
            let asked = &compiled.program.experiment.figures;
            let figures: String = asked.iter().map(|f| format!(", {}.png", f.name)).collect();
            print_output(&format!(
                "\n  results, events.csv, summary.json{figures} and report.html are in {}",
                folder.display()
            ));
        }
    }
    if run.measures.iter().all(|measure| measure.holds) {
        return Exit::Done;
    }
    if args.model.quiet {
        for measure in run.measures.iter().filter(|measure| !measure.holds) {
            let (name, why) = (&measure.name, summary::why_missing(measure));
            print_error(&if measure.expectation {
                format!("expect {name}: does not hold{why}")
            } else {
                format!("{name}: no value{why}")
            });
        }
    }
    Exit::Expectation
}

/// Writes the files of a run, each whole or not at all.
fn leave(
    folder: &Path,
    format: Format,
    project: &Project,
    compiled: &Compiled,
    run: &Run,
) -> Result<(), String> {
    files::make_folder(folder)?;
    leave_results(folder, format, &compiled.program, &run.results)?;
    let events = summary::events_csv(project, compiled, &run.results.events);
    files::write(&folder.join("events.csv"), events.as_bytes())?;
    let summary = format!("{:#}\n", summary::json(project, compiled, run));
    files::write(&folder.join("summary.json"), summary.as_bytes())?;
    let figures = asked_figures::of_run(&compiled.program, run);
    for (name, content) in asked_figures::files(&figures) {
        files::write(&folder.join(name), &content)?;
    }
    files::write(
        &folder.join("report.html"),
        to_html(&run_page::page(project, compiled, run, &clock::now())).as_bytes(),
    )
}

/// Writes the results in a form. Those of an earlier run in another form are not left beside them.
fn leave_results(
    folder: &Path,
    format: Format,
    program: &Program,
    results: &Results,
) -> Result<(), String> {
    let name = match format {
        Format::Csv => "results.csv",
        Format::Parquet => "results.parquet",
        Format::Json => "results.json",
        Format::Mat => "results.mat",
    };
    let path = folder.join(name);
    match format {
        Format::Csv => files::write_with(&path, |file| {
            csv::write_to(file, &columns(program, results))
        }),
        Format::Parquet => files::write_with(&path, |file| {
            parquet::write_to(file, &columns(program, results)).map(drop)
        }),
        Format::Json => {
            let text = format!("{}\n", results_json(program, results));
            files::write(&path, text.as_bytes())
        }
        Format::Mat => files::write(&path, &trajectories::mat(program, results)),
    }?;
    let others = [
        "results.csv",
        "results.parquet",
        "results.json",
        "results.mat",
    ];
    others
        .iter()
        .filter(|other| **other != name)
        .try_for_each(|other| files::remove(&folder.join(other)))
}

/// Results in the form of a record: time first, every column with its unit.
fn columns<'a>(program: &'a Program, results: &'a Results) -> Vec<Written<'a>> {
    let time = NamedUnit::usual(hyde_units::Dimension::TIME);
    let mut columns = vec![Written {
        name: "t".into(),
        unit: Some(Cow::Owned(time)),
        values: WrittenValues::Each(&results.time),
    }];
    for (number, values) in results.kept() {
        let output = &program.outputs[number];
        if !output.auxiliary {
            columns.push(Written {
                name: output.name.as_str().into(),
                unit: Some(Cow::Borrowed(&output.unit)),
                values: WrittenValues::Series(values),
            });
        }
    }
    columns.extend(gradient_columns(program, results));
    columns
}

/// The derivatives of every column by each parameter: `d(x)/d(p)`, in SI.
fn gradient_columns<'a>(program: &Program, results: &'a Results) -> Vec<Written<'a>> {
    let mut columns = Vec::new();
    let Some(gradient) = &results.gradient else {
        return columns;
    };
    for (&place, of_parameter) in gradient.parameters.iter().zip(&gradient.columns) {
        let Some((parameter, name)) = program.parameter_at(place) else {
            continue;
        };
        for (&number, values) in results.outputs.iter().zip(of_parameter) {
            let output = &program.outputs[number];
            if !output.auxiliary {
                let unit = NamedUnit::usual(output.dimension.divide(parameter.dimension));
                columns.push(Written {
                    name: format!("d({})/d({name})", output.name).into(),
                    unit: Some(Cow::Owned(unit)),
                    values: WrittenValues::Each(values),
                });
            }
        }
    }
    columns
}

fn results_json(program: &Program, results: &Results) -> Value {
    let mut columns = Map::new();
    columns.insert(
        "t".to_owned(),
        json!({ "unit": "s", "values": results.time }),
    );
    for (number, values) in results.kept() {
        let output = &program.outputs[number];
        if !output.auxiliary {
            let entry = json!({ "unit": output.dimension.usual_unit(), "values": values.values() });
            columns.insert(output.name.clone(), entry);
        }
    }
    for column in gradient_columns(program, results) {
        let unit = column.unit.as_ref();
        let unit = unit.map(|unit| unit.unit().dimension.usual_unit());
        let entry = json!({ "unit": unit, "values": column.values() });
        columns.insert(column.name.into_owned(), entry);
    }
    Value::Object(columns)
}

fn failed(
    args: &RunArgs,
    mut project: Project,
    compiled: &Compiled,
    options: &Options,
    error: &RunError,
) -> Exit {
    let name = project.experiment.as_deref();
    let mut experiments = project.file.experiments();
    let experiment = experiments.find(|known| name == Some(known.name.text.as_str()));
    let (diagnostic, fault) = run_failure::diagnostic(error, &compiled.program, experiment);
    let exit = Exit::from(fault);
    let reason = diagnostic.message.clone();
    if exit == Exit::Interrupted {
        complain(&args.model, exit, &diagnostic.message);
    } else {
        project.diagnostics.push(diagnostic);
        tell(args, &project);
    }
    // The rows so far are kept, marked as incomplete.
    if let (Some(folder), RunError::Failed(failure)) = (&args.out, error) {
        let (program, tables) = (&compiled.program, hyde_study::tables(&project.records));
        let run = hyde_experiment::incomplete(program, &tables, options, failure, reason);
        let kept = run
            .map_err(|_| "nothing of this run can be kept".to_owned())
            .and_then(|run| leave(folder, args.format, &project, compiled, &run));
        match kept {
            Ok(()) if args.model.quiet => {}
            Ok(()) => print_error(&format!(
                "the results up to {} s are in {}, marked as incomplete",
                significant(failure.t, 7),
                folder.display()
            )),
            Err(reason) => print_error(&format!("error: {reason}")),
        }
    }
    exit
}

/// Prints the diagnostics of a run.
fn tell(args: &RunArgs, project: &Project) {
    if args.model.json {
        let diagnostics = render::to_json(&project.diagnostics, &project.sources);
        print_output(&format!(
            "{:#}",
            json!({ "ok": false, "diagnostics": diagnostics })
        ));
    } else {
        print_diagnostics(&project.diagnostics, &project.sources, "");
    }
}
