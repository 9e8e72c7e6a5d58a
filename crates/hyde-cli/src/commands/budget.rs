//! `hyde budget`: which imperfection of a model contributes how much to the measures of an experiment.

use super::run;
use crate::args::{BudgetArgs, ModelArgs, RunArgs};
use crate::exit::Exit;
use crate::files;
use crate::project::{self, Project, Records, complain, print_error, print_output};
use hyde_compiler::{changed, ideals};
use hyde_experiment::{BudgetOf, Share};
use hyde_present::summary;
use hyde_syntax::ast::{Experiment, Ideal};
use hyde_units::{NamedUnit, counted, engineering_as};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Parts of a measure below this are printed as nothing.
const NOTHING: f64 = 1e-5;
/// Stands for a number that there is not.
const NO_VALUE: &str = "--";

/// Runs the experiment as it is, with all ideal, without each imperfection and with it alone, and prints what every measure is made of.
pub(crate) fn budget(args: &BudgetArgs) -> Exit {
    match made(&args.model).and_then(|made| leave(args, made)) {
        Ok(()) => Exit::Done,
        Err(exit) => exit,
    }
}

/// What came out.
struct Made {
    title: String,
    ideals: Vec<Ideal>,
    measures: Vec<(String, NamedUnit, BudgetOf)>,
}

/// The measures of one run, in their order.
type Measures = Vec<(String, NamedUnit, f64)>;

fn made(args: &ModelArgs) -> Result<Made, Exit> {
    let project = project::load(args, Records::Needed)?;
    let asked = asked(args, &project)?;
    let model = project.model.clone();
    let experiment = asked.name.text.clone();
    let ideals: Vec<Ideal> = ideals(&asked).cloned().collect();
    let real = measures(args, project)?;
    if real.is_empty() {
        let reason = format!(
            "`{experiment}` has no `measure`: add the error to be split, `measure Length lag = max(abs(r - s));`"
        );
        return Err(complain(args, Exit::CommandLine, &reason));
    }
    // Warnings were printed with the real model.
    let quiet = ModelArgs {
        quiet: true,
        ..args.clone()
    };
    let run = |what: &str, chosen: &dyn Fn(&Ideal) -> bool| -> Result<Measures, Exit> {
        let mut project = project::load(&quiet, Records::Needed)?;
        project.file = project.file.idealised(&experiment, chosen);
        measures(&quiet, project).inspect_err(|_| print_error(&format!("so it is {what}")))
    };
    let all = run("with all of the budget ideal", &|_| true)?;
    let mut each = Vec::new();
    for ideal in &ideals {
        let name = &ideal.name.text;
        let without = run(&format!("without `{name}`"), &|other| {
            other.name.text == *name
        })?;
        let alone = run(&format!("with `{name}` alone"), &|other| {
            other.name.text != *name
        })?;
        each.push((without, alone));
    }
    let measures = real
        .into_iter()
        .enumerate()
        .map(|(number, (name, unit, value))| {
            let of = |measures: &Measures| measures[number].2;
            let each: Vec<(f64, f64)> = each.iter().map(|(a, b)| (of(a), of(b))).collect();
            (name, unit, BudgetOf::new(value, of(&all), &each))
        });
    Ok(Made {
        title: format!("{experiment} of {model}"),
        measures: measures.collect(),
        ideals,
    })
}

/// The experiment, if it has a budget and nothing set from outside is part of it.
fn asked(args: &ModelArgs, project: &Project) -> Result<Experiment, Exit> {
    let refuse = |reason: String| complain(args, Exit::CommandLine, &reason);
    let mut known = project.file.experiments();
    let name = project.experiment.as_deref();
    let Some(experiment) = known.find(|known| name == Some(known.name.text.as_str())) else {
        return Err(refuse(
            "a budget needs an experiment, and the file has none".to_owned(),
        ));
    };
    if ideals(experiment).next().is_none() {
        return Err(refuse(format!(
            "`{}` has no `budget`: list the imperfections with their ideal values, `budget play(nut.gap = 0), belt(belt.k = 1e9 [N/m]);`",
            experiment.name.text
        )));
    }
    for ideal in ideals(experiment) {
        let changed = changed(ideal);
        let both = project
            .settings
            .iter()
            .find(|setting| changed.contains(&setting.path));
        if let Some(setting) = both {
            return Err(refuse(format!(
                "`--set {}` sets a parameter that `{}` of the budget varies",
                setting.path, ideal.name.text
            )));
        }
    }
    Ok(experiment.clone())
}

fn measures(args: &ModelArgs, project: Project) -> Result<Measures, Exit> {
    let (_, compiled, run, _) = run::solved_of(&RunArgs::of_model(args), project)?;
    let both = run
        .measures
        .iter()
        .zip(&compiled.program.experiment.measures);
    let measures = both.filter(|(measure, _)| !measure.expectation);
    let mut missing = run
        .measures
        .iter()
        .filter(|measure| measure.missing.is_some());
    if let Some(measure) = missing.next() {
        let (name, why) = (&measure.name, summary::why_missing(measure));
        let reason = format!("`{name}` has no value{why}");
        return Err(complain(args, Exit::Expectation, &reason));
    }
    Ok(measures
        .map(|(measure, known)| (measure.name.clone(), known.unit.clone(), measure.value))
        .collect())
}

fn leave(args: &BudgetArgs, made: Made) -> Result<(), Exit> {
    if let Some(folder) = &args.out {
        let written = files::make_folder(folder)
            .and_then(|()| files::write(&folder.join("budget.csv"), csv(&made).as_bytes()));
        written.map_err(|reason| complain(&args.model, Exit::CommandLine, &reason))?;
    }
    if args.model.json {
        print_output(&format!("{:#}", to_json(&made)));
    } else if !args.model.quiet {
        print_output(&text(&made));
    }
    Ok(())
}

/// A line of a measure's budget.
struct Line<'m> {
    what: &'m str,
    doc: &'m str,
    share: f64,
    alone: Option<f64>,
}

/// The lines, whose shares add up to the measure.
fn lines<'m>(made: &'m Made, budget: &BudgetOf) -> Vec<Line<'m>> {
    let share = |share: &Share| {
        let ideal = &made.ideals[share.ideal];
        Line {
            what: &ideal.name.text,
            doc: ideal.doc.as_deref().unwrap_or(""),
            share: share.share,
            alone: Some(share.alone),
        }
    };
    let last = |what, doc, share| Line {
        what,
        doc,
        share,
        alone: None,
    };
    let mut lines: Vec<Line<'_>> = budget.shares.iter().map(share).collect();
    lines.push(last(
        "interaction",
        "of them with each other",
        budget.interaction,
    ));
    lines.push(last("left", "with all of them ideal", budget.left));
    lines
}

fn text(made: &Made) -> String {
    let title = |name: &str, unit: &NamedUnit, budget: &BudgetOf| match budget.value.is_finite() {
        true => format!("{name} = {}", engineering_as(budget.value, unit)),
        false => format!("{name} has no value"),
    };
    // As wide as the names, and as the titles need, so that the heads stand above their columns.
    let names = made.ideals.iter().map(|ideal| ideal.name.text.len());
    let titles = made.measures.iter();
    let titles = titles.map(|(name, unit, budget)| title(name, unit, budget).len());
    let width = names.chain(titles.map(|title| title.saturating_sub(7)));
    let width = width.max().unwrap_or(0).max("interaction".len());
    let runs = 2 * made.ideals.len() + 2;
    let mut out = format!("budget of {}: {}\n", made.title, counted(runs, "run"));
    for (name, unit, budget) in &made.measures {
        let number = |value: f64| {
            if !value.is_finite() {
                NO_VALUE.to_owned()
            } else if value.abs() <= NOTHING * budget.value.abs() {
                "0".to_owned()
            } else {
                engineering_as(value, unit)
            }
        };
        let title = title(name, unit, budget);
        let left = width + 14 - title.len();
        let _ = writeln!(
            out,
            "\n  {title}{:>left$} {:>7} {:>11}",
            "share", "", "alone"
        );
        for line in lines(made, budget) {
            // Adding zero makes no minus of what is rounded to nothing.
            let percent = (1000.0 * line.share / budget.value).round() / 10.0 + 0.0;
            let percent = match percent.is_finite() {
                true => format!("{percent:.1} %"),
                false => NO_VALUE.to_owned(),
            };
            let (what, share) = (line.what, number(line.share));
            let alone = line.alone.map_or_else(String::new, number);
            let printed = format!(
                "    {what:<width$} {share:>11} {percent:>7} {alone:>11}  {}",
                line.doc
            );
            let _ = writeln!(out, "{}", printed.trim_end());
        }
        let shares = budget.shares.iter();
        let mut numbers = shares.flat_map(|share| [share.share, share.alone]);
        if !budget.value.is_finite() || numbers.any(|number| !number.is_finite()) {
            let _ = writeln!(
                out,
                "    {NO_VALUE}: a run has no value of `{name}`; `settling` has no value if the\n       variable does not settle before the end of the run"
            );
        }
    }
    out
}

fn to_json(made: &Made) -> Value {
    let measures = made.measures.iter().map(|(name, unit, budget)| {
        let shares = budget.shares.iter().map(|share| {
            let ideal = &made.ideals[share.ideal];
            json!({ "name": ideal.name.text, "text": ideal.doc, "share": share.share, "alone": share.alone })
        });
        json!({
            "name": name, "unit": unit.unit().dimension.usual_unit(), "value": budget.value,
            "shares": shares.collect::<Value>(), "interaction": budget.interaction, "left": budget.left,
        })
    });
    json!({ "ok": true, "budget": made.title, "measures": measures.collect::<Value>() })
}

/// A number of the CSV; an empty cell where there is none.
fn written(value: f64) -> String {
    match value.is_finite() {
        true => value.to_string(),
        false => String::new(),
    }
}

fn csv(made: &Made) -> String {
    let mut out = String::from("measure,unit,part,share,alone\n");
    for (name, unit, budget) in &made.measures {
        let unit = unit.unit().dimension.usual_unit();
        for line in lines(made, budget) {
            let alone = line.alone.map_or_else(String::new, written);
            let share = written(line.share);
            let _ = writeln!(out, "{name},{unit},{},{share},{alone}", line.what);
        }
    }
    out
}
