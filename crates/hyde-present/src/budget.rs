//! Which imperfection of a model contributes how much to a measure: as a table, as JSON and as CSV.
//!
//! The table shows the digits that tighter tolerances do not change ([`Estimate::digits`]).

use hyde_experiment::{BudgetOf, Estimate, Share};
use hyde_study::budget::Budget;
use hyde_units::{NamedUnit, counted, engineering_as, engineering_difference, significant};
use serde_json::{Value, json};
use std::fmt::Write as _;

/// Stands for a number that there is not.
const NO_VALUE: &str = "--";
/// A share of a measure is printed to tenths of a percent.
const PERCENT: f64 = 0.1;

/// A line of a measure's budget.
struct Line<'m> {
    what: &'m str,
    doc: &'m str,
    share: Estimate,
    alone: Option<Estimate>,
    kind: Kind,
}

/// What a number is: of a temperature in degC a difference is one in K.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Value,
    Difference,
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
            kind: Kind::Difference,
        }
    };
    let mut lines: Vec<Line<'_>> = budget.shares.iter().map(share).collect();
    lines.push(Line {
        what: "interaction",
        doc: "of them with each other",
        share: budget.interaction,
        alone: None,
        kind: Kind::Difference,
    });
    lines.push(Line {
        what: "left",
        doc: "with all of them ideal",
        share: budget.left,
        alone: None,
        kind: Kind::Value,
    });
    lines
}

/// The numbers of a measure's budget.
fn numbers(budget: &BudgetOf) -> impl Iterator<Item = Estimate> {
    let shares = budget.shares.iter();
    let shares = shares.flat_map(|share| [share.share, share.alone]);
    [budget.value, budget.interaction, budget.left]
        .into_iter()
        .chain(shares)
}

/// A number as far as its digits count, in its unit.
fn rounded(number: Estimate, unit: &NamedUnit, kind: Kind) -> String {
    let own = unit.unit();
    let shown = Estimate {
        value: match kind {
            Kind::Value => own.from_si(number.value),
            Kind::Difference => own.scale.remove(number.value),
        },
        error: own.scale.remove(number.error),
    };
    if !shown.value.is_finite() {
        return NO_VALUE.to_owned();
    }
    let value = match shown.digits() {
        0 => 0.0,
        digits => format!("{:.*e}", digits - 1, shown.value)
            .parse()
            .unwrap_or(shown.value),
    };
    match kind {
        Kind::Difference if value == 0.0 => "0".to_owned(),
        Kind::Difference => engineering_difference(own.difference_to_si(value), unit),
        Kind::Value => engineering_as(own.to_si(value), unit),
    }
}

/// A part of a measure in percent, to tenths where these count.
fn percent(part: Estimate, of: Estimate) -> String {
    let all = 100.0 / of.value;
    let (share, error) = (all * part.value, (all * part.error).abs());
    if !share.is_finite() {
        return NO_VALUE.to_owned();
    }
    let told = if share.abs() <= error { 0.0 } else { share };
    let places = usize::from(told == 0.0 || error.is_nan() || 2.0 * error <= PERCENT);
    // Adding zero makes no minus of what is rounded to nothing.
    let told = (told / PERCENT).round() * PERCENT + 0.0;
    format!("{told:.places$} %")
}

/// The table.
#[must_use]
pub fn text(made: &Budget) -> String {
    let title = |name: &str, unit: &NamedUnit, budget: &BudgetOf| match budget.value.value {
        value if value.is_finite() => {
            format!("{name} = {}", rounded(budget.value, unit, Kind::Value))
        }
        _ => format!("{name} has no value"),
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
        let title = title(name, unit, budget);
        let left = width + 14 - title.len();
        let _ = writeln!(
            out,
            "\n  {title}{:>left$} {:>7} {:>11}",
            "share", "", "alone"
        );
        for line in lines(made, budget) {
            let number = |number| rounded(number, unit, line.kind);
            let percent = percent(line.share, budget.value);
            let (what, share) = (line.what, number(line.share));
            let alone = line.alone.map_or_else(String::new, number);
            let printed = format!(
                "    {what:<width$} {share:>11} {percent:>7} {alone:>11}  {}",
                line.doc
            );
            let _ = writeln!(out, "{}", printed.trim_end());
        }
        if numbers(budget).any(|number| !number.value.is_finite()) {
            let _ = writeln!(
                out,
                "    {NO_VALUE}: a run has no value of `{name}`; `settling` has no value if the\n       variable does not settle before the end of the run"
            );
        }
    }
    out.push('\n');
    out.push_str(&certainty(made));
    out
}

/// Which digits are shown.
fn certainty(made: &Budget) -> String {
    let mut all = made.measures.iter().flat_map(|(.., of)| numbers(of));
    let unknown = all.any(|number| number.error.is_nan() && number.value.is_finite());
    let (rtol, atol) = made.tolerances;
    let [rtol, atol] = [rtol, atol].map(|own| significant(own, 3));
    match unknown {
        true => format!(
            "  at a tenth of rtol = {rtol}, atol = {atol} a run gives no value: digits are not checked\n"
        ),
        false => format!(
            "  digits are those that a tenth of rtol = {rtol}, atol = {atol} does not change\n"
        ),
    }
}

/// The same as JSON.
#[must_use]
pub fn json(made: &Budget) -> Value {
    let measures = made.measures.iter().map(|(name, unit, budget)| {
        let shares = budget.shares.iter().map(|share| {
            let ideal = &made.ideals[share.ideal];
            json!({
                "name": ideal.name.text, "text": ideal.doc,
                "share": share.share.value, "share_error": share.share.error,
                "alone": share.alone.value, "alone_error": share.alone.error,
            })
        });
        json!({
            "name": name, "unit": unit.unit().dimension.usual_unit(),
            "value": budget.value.value, "value_error": budget.value.error,
            "shares": shares.collect::<Value>(),
            "interaction": budget.interaction.value, "interaction_error": budget.interaction.error,
            "left": budget.left.value, "left_error": budget.left.error,
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
    let mut out = String::from("measure,unit,part,share,alone,share_error,alone_error\n");
    for (name, unit, budget) in &made.measures {
        let unit = unit.unit().dimension.usual_unit();
        for line in lines(made, budget) {
            let alone = |of: fn(Estimate) -> f64| {
                let alone = line.alone.map(of);
                alone.map_or_else(String::new, written)
            };
            let (share, error) = (written(line.share.value), written(line.share.error));
            let (alone, alone_error) = (alone(|own| own.value), alone(|own| own.error));
            let _ = writeln!(
                out,
                "{name},{unit},{},{share},{alone},{error},{alone_error}",
                line.what
            );
        }
    }
    out
}
