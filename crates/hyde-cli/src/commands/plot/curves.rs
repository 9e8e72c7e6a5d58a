//! Columns over time, panel by panel, and one over another.

use super::source::Recorded;
use super::strip;
use crate::args::PlotArgs;
use crate::figures::shown;
use hyde_report::{Figure, Line, time_panel, time_plot, xy_plot};
use hyde_signal::{Column, Table};
use hyde_units::significant;
use std::ops::Range;

/// Panels over one time, with the events of the first source below.
pub(super) fn over_time(args: &PlotArgs, sources: &[Recorded]) -> Result<Figure, String> {
    let Some(first) = sources.first() else {
        return Err("nothing to plot".to_owned());
    };
    let panels = if args.panels.is_empty() {
        choice(&first.table)
    } else {
        args.panels.clone()
    };
    let mut drawn = Vec::new();
    for panel in &panels {
        let names = listed(panel);
        let mut unit = OneUnit::default();
        let mut lines = Vec::new();
        for name in &names {
            for source in having(sources, name)? {
                let column = column(source, name)?;
                unit.take(name, column)?;
                let rows = window(args, source.table.time());
                let x = source.table.time()[rows.clone()].to_vec();
                let label = label(name, names.len(), &source.name, sources.len());
                let line = Line::new(label, x, column.values()[rows].to_vec());
                lines.push(line.with_style(source.style));
            }
        }
        drawn.push(time_panel(axis_label(&names), &unit.shown(), lines));
    }
    let rows = window(args, first.table.time());
    let ends = first.table.time().get(rows).unwrap_or_default();
    let strip = match ends {
        [from, .., to] => strip::beside(&first.path, (*from, *to), &args.modes)?,
        _ => None,
    };
    Ok(time_plot("", drawn, strip))
}

/// Panels whose columns are pairs, y over x.
pub(super) fn over_each_other(args: &PlotArgs, sources: &[Recorded]) -> Result<Figure, String> {
    let mut panels = Vec::new();
    for panel in &args.panels {
        let names = listed(panel);
        let pairs: Vec<(&str, &str)> = names
            .chunks_exact(2)
            .map(|pair| (pair[0], pair[1]))
            .collect();
        if names.len() % 2 == 1 {
            return Err(format!("`{panel}`: write pairs, `y,x` or `y1,x1,y2,x2`"));
        }
        let (mut x_unit, mut y_unit) = (OneUnit::default(), OneUnit::default());
        let mut lines = Vec::new();
        for (y, x) in &pairs {
            for source in having(sources, y)? {
                let (of_x, of_y) = (column(source, x)?, column(source, y)?);
                x_unit.take(x, of_x)?;
                y_unit.take(y, of_y)?;
                let rows = window(args, source.table.time());
                let label = label(y, pairs.len(), &source.name, sources.len());
                let values = |column: &Column| column.values()[rows.clone()].to_vec();
                lines.push(Line::new(label, values(of_x), values(of_y)).with_style(source.style));
            }
        }
        let (ys, xs): (Vec<&str>, Vec<&str>) = pairs.iter().copied().unzip();
        let x = (axis_label(&xs), x_unit.shown());
        let y = (axis_label(&ys), y_unit.shown());
        panels.extend(xy_plot("", (x.0, &x.1), (y.0, &y.1), lines).panels);
    }
    if panels.is_empty() {
        return Err("which columns? write pairs, `y,x`".to_owned());
    }
    for panel in &mut panels {
        panel.equal_scales = args.equal;
    }
    let alone = panels.len() == 1;
    Ok(Figure {
        width: 460.0,
        panel_height: if alone { 290.0 } else { 200.0 },
        ..Figure::new(panels)
    })
}

/// The unit that all columns along one axis have.
#[derive(Default)]
struct OneUnit(Option<String>);

impl OneUnit {
    fn take(&mut self, name: &str, column: &Column) -> Result<(), String> {
        let own = si_unit(column);
        match &self.0 {
            Some(unit) if *unit != own => Err(format!(
                "`{name}` is in {own}, the panel in {unit}: give it a panel of its own"
            )),
            _ => {
                self.0 = Some(own);
                Ok(())
            }
        }
    }

    fn shown(&self) -> String {
        self.0
            .as_deref()
            .map_or_else(String::new, |unit| shown(unit).to_owned())
    }
}

/// The columns of a panel.
fn listed(panel: &str) -> Vec<&str> {
    panel.split(',').map(str::trim).collect()
}

/// What stands on an axis: the name that all along it have.
fn axis_label<'n>(names: &[&'n str]) -> &'n str {
    match names {
        [first, rest @ ..] if rest.iter().all(|name| name == first) => first,
        _ => "",
    }
}

/// What stands in the legend: of name and source, what tells the line from the others.
fn label(name: &str, names: usize, source: &str, sources: usize) -> String {
    match (names > 1, sources > 1) {
        (false, false) => String::new(),
        (true, false) => name.to_owned(),
        (false, true) => source.to_owned(),
        (true, true) => format!("{name}, {source}"),
    }
}

/// Refuses a window in which there is nothing: the figure would be empty.
pub(super) fn check_window(args: &PlotArgs, sources: &[Recorded]) -> Result<(), String> {
    let times = || sources.iter().map(|source| source.table.time());
    if sources.is_empty() || times().any(|time| !window(args, time).is_empty()) {
        return Ok(());
    }
    let firsts = times().filter_map(|time| time.first().copied());
    let lasts = times().filter_map(|time| time.last().copied());
    Err(format!(
        "no row lies within `--from` and `--to`: the rows are from {} s to {} s",
        significant(firsts.fold(f64::INFINITY, f64::min), 6),
        significant(lasts.fold(f64::NEG_INFINITY, f64::max), 6)
    ))
}

/// The rows within `--from` and `--to`.
fn window(args: &PlotArgs, time: &[f64]) -> Range<usize> {
    let from = args
        .from
        .map_or(0, |from| time.partition_point(|&t| t < from));
    let to = args
        .to
        .map_or(time.len(), |to| time.partition_point(|&t| t <= to));
    from..to.max(from)
}

/// The sources that have a column; the first one's complaint if none has.
fn having<'s>(sources: &'s [Recorded], name: &str) -> Result<Vec<&'s Recorded>, String> {
    let has = |source: &&Recorded| source.table.column(name).is_some();
    let found: Vec<&Recorded> = sources.iter().filter(has).collect();
    match sources.first() {
        Some(first) if found.is_empty() => Err(unknown(&first.table, name)),
        _ => Ok(found),
    }
}

fn column<'s>(source: &'s Recorded, name: &str) -> Result<&'s Column, String> {
    let column = source.table.column(name);
    column.ok_or_else(|| unknown(&source.table, name))
}

/// That no column has the name, and which have one like it.
fn unknown(table: &Table, name: &str) -> String {
    let last = name.rsplit('.').next().unwrap_or(name);
    let names = || table.columns().iter().map(Column::name);
    let near: Vec<&str> = names()
        .filter(|known| known.ends_with(last))
        .take(4)
        .collect();
    let list = if near.is_empty() {
        names().take(8).collect()
    } else {
        near
    };
    format!(
        "no column is called `{name}`; there are `{}`, …",
        list.join("`, `")
    )
}

fn si_unit(column: &Column) -> String {
    column
        .unit()
        .map_or(String::new(), |unit| unit.unit().dimension.usual_unit())
}

/// The first columns, one panel a unit.
fn choice(table: &Table) -> Vec<String> {
    let mut groups: Vec<(String, Vec<&str>)> = Vec::new();
    for column in table
        .columns()
        .iter()
        .filter(|column| !matches!(column.name(), "t" | "time"))
    {
        let unit = si_unit(column);
        match groups.iter_mut().find(|(known, _)| *known == unit) {
            Some((_, list)) if list.len() < 3 => list.push(column.name()),
            Some(_) => {}
            None => groups.push((unit, vec![column.name()])),
        }
    }
    groups
        .into_iter()
        .take(4)
        .map(|(_, list)| list.join(","))
        .collect()
}
