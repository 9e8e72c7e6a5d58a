//! `hyde params`: all parameters with value, unit, prior and source; those without a source are marked.

use crate::args::ParamsArgs;
use crate::exit::Exit;
use crate::project::{self, Aim, Records, Told as _, print_output};
use hyde_experiment::parameters;
use hyde_program::{Parameter, Prior};
use hyde_units::shown;
use hyde_units::{counted, significant};
use serde_json::json;
use std::fmt::Write as _;

/// Lists parameters.
pub(crate) fn params(args: &ParamsArgs) -> Exit {
    match listed(args) {
        Ok(text) => {
            print_output(&text);
            Exit::Done
        }
        Err(exit) => exit,
    }
}

fn listed(args: &ParamsArgs) -> Result<String, Exit> {
    let mut project = project::load(&args.model, Records::IfThere)?;
    let alone = project.experiment.is_none();
    let compiled =
        project.compile_or_report(&args.model, if alone { Aim::Look } else { Aim::Run })?;
    let program = &compiled.program;
    let tables = hyde_study::tables(&project.records);
    let values = parameters(program, &tables, &project.set())
        .map_err(|error| project.report_refused(&args.model, program, &error))?;
    let wanted: Vec<&Parameter> = program
        .parameters
        .iter()
        .filter(|parameter| !args.unsourced || parameter.source.is_none())
        .collect();
    let value = |parameter: &Parameter| {
        let list = &values[parameter.place..parameter.place + parameter.len];
        let texts: Vec<String> = list
            .iter()
            .map(|value| significant(parameter.unit.unit().from_si(*value), 6))
            .collect();
        texts.join(", ")
    };
    if args.model.json {
        let list: Vec<_> = wanted
            .iter()
            .map(|parameter| {
                json!({
                    "name": parameter.name,
                    "si": values[parameter.place..parameter.place + parameter.len],
                    "value": value(parameter),
                    "unit": parameter.unit.text(),
                    "prior": prior(parameter),
                    "source": parameter.source,
                    "structural": parameter.structural,
                    "found": parameter.found,
                    "place": project.sources.place(parameter.origin.span),
                })
            })
            .collect();
        return Ok(format!("{:#}", json!({ "ok": true, "parameters": list })));
    }
    let width = wanted
        .iter()
        .map(|p| p.name.chars().count())
        .max()
        .unwrap_or(0);
    let width = width.min(36);
    let mut text = String::new();
    for parameter in &wanted {
        let unit = shown(parameter.unit.text());
        let source = parameter
            .source
            .as_ref()
            .map_or_else(String::new, |source| format!("from {source}"));
        let source = match parameter.found {
            true => format!("a guess, found at the start {source}"),
            false => source,
        };
        let line = format!(
            "{:<width$} {:>12} {unit:<12} {:>6} {source}",
            parameter.name,
            value(parameter),
            prior(parameter).unwrap_or_default(),
        );
        let _ = writeln!(text, "{}", line.trim_end());
    }
    let without = program
        .parameters
        .iter()
        .filter(|p| p.source.is_none())
        .count();
    let _ = writeln!(
        text,
        "{}, {without} without a source",
        counted(program.parameters.len(), "parameter")
    );
    Ok(text)
}

fn prior(parameter: &Parameter) -> Option<String> {
    Some(match parameter.prior? {
        Prior::Relative(part) => format!("±{}%", significant(100.0 * part, 3)),
        Prior::Absolute(spread) => {
            format!("±{}", significant(parameter.unit.unit().from_si(spread), 3))
        }
    })
}
