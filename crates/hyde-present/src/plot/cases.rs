//! What a batch left: cases over time, each a line of its own or all as an envelope, and their numbers over each other.

use super::Options;
use super::source::{Recorded, Source};
use crate::sweep::over_time::{OverTime, in_si};
use hyde_report::{Figure, LineStyle, envelope_panel, time_plot};
use hyde_signal::{Column, Field, Frame, Table};
use hyde_study::sweep::{Order, table_in};
use hyde_units::NamedUnit;
use std::path::{Path, PathBuf};

/// No more cases than these are lines if nobody asked for them.
const LINES: usize = 8;

/// The table of a batch's folder that is meant; `None` of a folder that holds no batch.
pub(super) fn table_of(folder: &Path, options: &Options) -> Option<Result<PathBuf, String>> {
    if !Order::is_in(options.world.as_ref(), folder) {
        return None;
    }
    // Numbers over each other are those of the cases, unless cases are named.
    let name = if options.xy && options.cases.is_empty() {
        "cases"
    } else {
        "trajectories"
    };
    Some(table_in(options.world.as_ref(), folder, name).ok_or_else(|| {
        let folder = folder.display();
        format!(
            "the batch in `{folder}` has no {name}: it is not finished, or keeps nothing over time, `keep x;`; \
             `hyde sweep {folder} --case N --out RUN` leaves all of one case, `--xy peak,gap` draws measures over inputs"
        )
    }))
}

/// The cases of a table of a batch, each as results of its own, or their numbers; `None` if the table is no batch's.
pub(super) fn of(source: &Source, options: &Options) -> Option<Result<Vec<Recorded>, String>> {
    let frame = source.frame()?;
    if frame.fields.first()?.name != "case" {
        return None;
    }
    Some(match OverTime::of(frame.clone()) {
        Some(over) => lines(&over, source, options),
        None => points(&frame, source).map(|points| vec![points]),
    })
}

/// All cases of the source as envelopes, one a panel; `None` if they are to be lines, or are not over time.
pub(super) fn envelopes(options: &Options, source: &Source) -> Option<Result<Figure, String>> {
    let over = OverTime::of(source.frame()?)?;
    if !options.cases.is_empty() || options.xy || over.cases().len() <= LINES {
        return None;
    }
    if options.from.is_some() || options.to.is_some() {
        let reason = "quantiles of many cases are plotted over their whole time: `--cases 3,7` plots lines within `--from` and `--to`";
        return Some(Err(reason.to_owned()));
    }
    let names: Vec<String> = if options.panels.is_empty() {
        let names = over.variables().map(|(field, _)| field.name.clone());
        names.take(4).collect()
    } else {
        options.panels.clone()
    };
    let mut panels = Vec::new();
    for name in &names {
        let found = over.envelopes(Some(name));
        match found.first() {
            Some(envelope) => panels.push(envelope_panel(envelope)),
            None => {
                let known: Vec<&str> = over.variables().map(|(f, _)| f.name.as_str()).collect();
                return Some(Err(format!(
                    "`{name}`: with this many cases a panel shows one variable, `{}`; `--cases 3,7` plots lines",
                    known.join("`, `")
                )));
            }
        }
    }
    Some(Ok(time_plot("", panels, None)))
}

fn lines(over: &OverTime, source: &Source, options: &Options) -> Result<Vec<Recorded>, String> {
    let known = |case: &usize| over.cases().iter().find(|(number, _)| number == case);
    let wanted: Vec<usize> = if options.cases.is_empty() {
        over.cases().iter().map(|(number, _)| *number).collect()
    } else {
        options.cases.clone()
    };
    let variables: Vec<(&Field, Vec<f64>)> = over.variables().collect();
    let mut found = Vec::new();
    for case in wanted {
        let Some((_, rows)) = known(&case) else {
            return Err(format!(
                "`{}` has no rows of case {case}: it failed, or there is none",
                source.path.display()
            ));
        };
        let mut columns = vec![Column::new(
            "t",
            second(),
            over.time()[rows.clone()].to_vec(),
        )];
        let values = variables.iter();
        columns.extend(values.map(|(field, all)| column(field, all[rows.clone()].to_vec())));
        found.push(Recorded {
            name: format!("case {case}"),
            // There are no events beside the rows of a case.
            path: source.path.clone(),
            table: Table::new(columns).map_err(|error| error.to_string())?,
            style: LineStyle::Solid,
        });
    }
    Ok(found)
}

/// The numbers of the cases that were solved.
fn points(frame: &Frame, source: &Source) -> Result<Recorded, String> {
    let solved: Vec<bool> = match frame.texts("status") {
        Some(status) => status.iter().map(|status| status == "done").collect(),
        None => vec![true; frame.rows()],
    };
    let mut columns = Vec::new();
    for (field, values) in frame.fields.iter().zip(&frame.values) {
        if let Some(values) = in_si(field, values) {
            let rows = values
                .into_iter()
                .zip(&solved)
                .filter(|(_, solved)| **solved);
            columns.push(column(field, rows.map(|(value, _)| value).collect()));
        }
    }
    Ok(Recorded {
        name: source.name.clone(),
        path: source.path.clone(),
        table: Table::every(1.0, columns).map_err(|error| error.to_string())?,
        style: LineStyle::Points,
    })
}

fn column(field: &Field, values: Vec<f64>) -> Column {
    match &field.unit {
        Some(unit) => Column::new(field.name.as_str(), unit.clone(), values),
        None => Column::raw(field.name.as_str(), values),
    }
}

fn second() -> NamedUnit {
    NamedUnit::usual(hyde_units::Dimension::TIME)
}
