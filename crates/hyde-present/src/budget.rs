//! Which imperfection of a model contributes how much to a measure: as a table, as JSON and as CSV.

use hyde_experiment::{BudgetOf, Share};
use hyde_study::budget::Budget;
use hyde_units::{NamedUnit, counted, engineering_as};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Parts of a measure below this are printed as nothing.
const NOTHING: f64 = 1e-5;
/// Stands for a number that there is not.
const NO_VALUE: &str = "--";

/// A line of a measure's budget.
struct Line<'m> {
    what: &'m str,
    doc: &'m str,
    share: f64,
    alone: Option<f64>,
}

/// The lines, whose shares add up to the measure.
fn lines<'m>(made: &'m Budget, budget: &BudgetOf) -> Vec<Line<'m>> {
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

/// The table.
#[must_use]
pub fn text(made: &Budget) -> String {
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

/// The same as JSON.
#[must_use]
pub fn json(made: &Budget) -> Value {
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

/// The same as CSV.
#[must_use]
pub fn csv(made: &Budget) -> String {
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
