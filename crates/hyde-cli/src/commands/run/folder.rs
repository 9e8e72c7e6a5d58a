//! The files that a run leaves in its folder: results in the form asked for, events, summary, figures and report.

use super::trajectories;
use crate::args::Format;
use crate::clock;
use crate::files;
use crate::project::Project;
use hyde_compiler::Compiled;
use hyde_experiment::Run;
use hyde_present::{asked_figures, run_page, summary};
use hyde_program::Program;
use hyde_report::to_html;
use hyde_signal::{Written, WrittenValues, csv, parquet};
use hyde_sim::Results;
use hyde_units::NamedUnit;
use serde_json::{Map, Value, json};
use std::borrow::Cow;
use std::path::Path;

/// Writes the files of a run, each whole or not at all.
pub(super) fn leave(
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
pub(super) fn columns<'a>(program: &'a Program, results: &'a Results) -> Vec<Written<'a>> {
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
