//! Columns over time, panel by panel, and one over another.

use super::Options;
use super::source::Recorded;
use super::strip;
use hyde_report::{Figure, Line, time_panel, time_plot, xy_plot};
use hyde_signal::{Column, Table};
use hyde_units::{Agreement, NamedUnit, Unit, significant};
use hyde_units::{drawn_in, shown};
use std::ops::Range;

/// Panels over one time, with the events of the first source below.
pub(super) fn over_time(options: &Options, sources: &[Recorded]) -> Result<Figure, String> {
    let Some(first) = sources.first() else {
        return Err("nothing to plot".to_owned());
    };
    let panels = if options.panels.is_empty() {
        choice(&first.table)
    } else {
        options.panels.clone()
    };
    let mut drawn = Vec::new();
    for panel in &panels {
        let names = listed(panel);
        let mut all = Vec::new();
        for name in &names {
            for source in having(sources, name)? {
                let label = label(name, names.len(), &source.name, sources.len());
                all.push((label, source, column(source, name)?));
            }
        }
        let (unit, of) = one_unit(all.iter().map(|(.., column)| *column))?;
        let line = |(label, source, column): (String, &Recorded, &Column)| {
            let time = source.table.reading(column.name()).time();
            let rows = window(options, time);
            let x = time[rows.clone()].to_vec();
            let y = column.values()[rows].iter().map(|si| of.from_si(*si));
            Line::new(label, x, y.collect()).with_style(source.style)
        };
        let lines = all.into_iter().map(line).collect();
        drawn.push(time_panel(axis_label(&names), shown(&unit), lines));
    }
    let rows = window(options, first.table.time());
    let ends = first.table.time().get(rows).unwrap_or_default();
    let strip = match ends {
        [from, .., to] => strip::beside(
            options.world.as_ref(),
            &first.path,
            (*from, *to),
            &options.modes,
        )?,
        _ => None,
    };
    Ok(time_plot("", drawn, strip))
}

/// Panels whose columns are pairs, y over x.
pub(super) fn over_each_other(options: &Options, sources: &[Recorded]) -> Result<Figure, String> {
    let mut panels = Vec::new();
    for panel in &options.panels {
        let names = listed(panel);
        let pairs: Vec<(&str, &str)> = names
            .chunks_exact(2)
            .map(|pair| (pair[0], pair[1]))
            .collect();
        if names.len() % 2 == 1 {
            return Err(format!("`{panel}`: write pairs, `y,x` or `y1,x1,y2,x2`"));
        }
        let mut all = Vec::new();
        for (y, x) in &pairs {
            for source in having(sources, y)? {
                let label = label(y, pairs.len(), &source.name, sources.len());
                let times = [x, y].map(|name| source.table.reading(name).time());
                if times[0] != times[1] {
                    return Err(format!(
                        "`{x}` and `{y}` are sampled at different times: no curve of one over the other is drawn"
                    ));
                }
                all.push((label, source, column(source, x)?, column(source, y)?));
            }
        }
        let (x_unit, x_of) = one_unit(all.iter().map(|(_, _, x, _)| *x))?;
        let (y_unit, y_of) = one_unit(all.iter().map(|(.., y)| *y))?;
        let line = |(label, source, x, y): (String, &Recorded, &Column, &Column)| {
            let rows = window(options, source.table.reading(y.name()).time());
            let values = |column: &Column, of: Unit| {
                let values = column.values()[rows.clone()].iter();
                values.map(|si| of.from_si(*si)).collect()
            };
            Line::new(label, values(x, x_of), values(y, y_of)).with_style(source.style)
        };
        let lines = all.into_iter().map(line).collect();
        let (ys, xs): (Vec<&str>, Vec<&str>) = pairs.iter().copied().unzip();
        let x = (axis_label(&xs), shown(&x_unit));
        let y = (axis_label(&ys), shown(&y_unit));
        panels.extend(xy_plot("", x, y, lines).panels);
    }
    if panels.is_empty() {
        return Err("which columns? write pairs, `y,x`".to_owned());
    }
    for panel in &mut panels {
        panel.equal_scales = options.equal;
    }
    let alone = panels.len() == 1;
    Ok(Figure {
        width: 460.0,
        panel_height: if alone { 290.0 } else { 200.0 },
        ..Figure::new(panels)
    })
}

/// The unit that all columns along one axis are drawn in: the one that they are declared in, that of SI if they differ there.
fn one_unit<'c>(columns: impl Iterator<Item = &'c Column>) -> Result<(String, Unit), String> {
    let mut one: Option<(String, Unit)> = None;
    for column in columns {
        let (text, unit) = column.unit().map_or((String::new(), Unit::ONE), drawn_in);
        one = match one {
            None => Some((text, unit)),
            Some((known, of)) if known == text => Some((known, of)),
            Some((known, of)) => {
                let alike = known.is_empty() == text.is_empty()
                    && of.dimension.agreement(unit.dimension) == Agreement::Same;
                if !alike {
                    return Err(format!(
                        "`{}` is in {}, the panel in {}: use a separate panel for it",
                        column.name(),
                        named(&text),
                        named(&known)
                    ));
                }
                let si = NamedUnit::usual(of.dimension);
                Some((si.text().to_owned(), si.unit()))
            }
        };
    }
    Ok(one.unwrap_or((String::new(), Unit::ONE)))
}

/// The word for a unit in a sentence.
fn named(unit: &str) -> &str {
    if unit.is_empty() { "no unit" } else { unit }
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
pub(super) fn check_window(options: &Options, sources: &[Recorded]) -> Result<(), String> {
    let times = || sources.iter().map(|source| source.table.time());
    if sources.is_empty() || times().any(|time| !window(options, time).is_empty()) {
        return Ok(());
    }
    let firsts = times().filter_map(|time| time.first().copied());
    let lasts = times().filter_map(|time| time.last().copied());
    Err(format!(
        "no sample lies within `--from` and `--to`: the samples are from {} s to {} s",
        significant(firsts.fold(f64::INFINITY, f64::min), 6),
        significant(lasts.fold(f64::NEG_INFINITY, f64::max), 6)
    ))
}

/// The rows within `--from` and `--to`.
fn window(options: &Options, time: &[f64]) -> Range<usize> {
    let from = options
        .from
        .map_or(0, |from| time.partition_point(|&t| t < from));
    let to = options
        .to
        .map_or(time.len(), |to| time.partition_point(|&t| t <= to));
    from..to.max(from)
}

/// The sources that have a column; the first one's complaint if none has.
fn having<'s>(sources: &'s [Recorded], name: &str) -> Result<Vec<&'s Recorded>, String> {
    let has = |source: &&Recorded| source.table.reading(name).column(name).is_some();
    let found: Vec<&Recorded> = sources.iter().filter(has).collect();
    match sources.first() {
        Some(first) if found.is_empty() => Err(unknown(&first.table, name)),
        _ => Ok(found),
    }
}

fn column<'s>(source: &'s Recorded, name: &str) -> Result<&'s Column, String> {
    let column = source.table.reading(name).column(name);
    column.ok_or_else(|| unknown(&source.table, name))
}

/// That no column has the name, and which have one like it; of a column that cannot be used, why.
fn unknown(table: &Table, name: &str) -> String {
    if let Some(known) = table.unusable().iter().find(|known| known.name == name) {
        let (message, repair) = (&known.fault.message, &known.fault.repair);
        return format!("`{name}` cannot be plotted: {message}; {repair}");
    }
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

/// The first columns, one panel a unit.
fn choice(table: &Table) -> Vec<String> {
    let mut groups: Vec<(String, Vec<&str>)> = Vec::new();
    for column in table
        .columns()
        .iter()
        .filter(|column| !matches!(column.name(), "t" | "time"))
    {
        let unit = column.unit().map_or(String::new(), |unit| drawn_in(unit).0);
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
