//! `hyde plot`: columns of results or of a record as a figure.

use crate::args::PlotArgs;
use crate::exit::Exit;
use crate::figures::shown;
use crate::files;
use crate::project::{print_error, print_output};
use hyde_report::{
    EventRow, EventStrip, Figure, Line, Span, time_panel, time_plot, to_png, to_svg, xy_plot,
};
use hyde_signal::{Column, Table};
use std::path::{Path, PathBuf};

/// Plots columns into a file.
pub(crate) fn plot(args: &PlotArgs) -> Exit {
    let outcome = figure(args).and_then(|figure| {
        let content = match args
            .out
            .extension()
            .and_then(|extension| extension.to_str())
        {
            Some("svg") => to_svg(&figure).into_bytes(),
            Some("png") => to_png(&figure, 2.0),
            _ => {
                return Err(format!(
                    "`{}`: a figure is an .svg or a .png file",
                    args.out.display()
                ));
            }
        };
        files::write(&args.out, &content)
    });
    match outcome {
        Ok(()) => {
            print_output(&format!("{}", args.out.display()));
            Exit::Done
        }
        Err(reason) => {
            print_error(&format!("error: {reason}"));
            Exit::CommandLine
        }
    }
}

fn figure(args: &PlotArgs) -> Result<Figure, String> {
    let path = if args.results.is_dir() {
        let parquet = args.results.join("results.parquet");
        if files::is_file(&parquet) {
            parquet
        } else {
            args.results.join("results.csv")
        }
    } else {
        args.results.clone()
    };
    let table = hyde_signal::read(&files::read(&path)?, args.every)
        .map_err(|error| format!("`{}`: {error}", path.display()))?;
    let panels = if args.panels.is_empty() {
        choice(&table)
    } else {
        args.panels.clone()
    };
    let title = args.title.clone().unwrap_or_default();
    let window = window(args, table.time());
    if args.xy {
        return xy(&table, &panels, &title, window);
    }
    let mut drawn = Vec::new();
    for panel in &panels {
        let mut lines = Vec::new();
        let mut unit = String::new();
        let names: Vec<&str> = panel.split(',').map(str::trim).collect();
        for name in &names {
            let column = column(&table, name)?;
            let own = si_unit(column);
            if !lines.is_empty() && own != unit {
                return Err(format!(
                    "`{name}` is in {own}, the panel in {unit}: give it a panel of its own"
                ));
            }
            unit = own;
            let label = if names.len() == 1 {
                String::new()
            } else {
                (*name).to_owned()
            };
            lines.push(Line::new(
                label,
                table.time()[window.clone()].to_vec(),
                column.values()[window.clone()].to_vec(),
            ));
        }
        let label = if names.len() == 1 { names[0] } else { "" };
        drawn.push(time_panel(label, shown(&unit), lines));
    }
    let figure = time_plot(title, drawn, strip(&path, table.time(), window));
    Ok(if args.title.is_none() {
        Figure {
            title: None,
            ..figure
        }
    } else {
        figure
    })
}

fn xy(
    table: &Table,
    panels: &[String],
    title: &str,
    window: std::ops::Range<usize>,
) -> Result<Figure, String> {
    let Some(pair) = panels.first() else {
        return Err("which two columns?".to_owned());
    };
    let names: Vec<&str> = pair.split(',').map(str::trim).collect();
    let [y, x] = names.as_slice() else {
        return Err(format!("`{pair}`: write `y,x`"));
    };
    let (y_column, x_column) = (column(table, y)?, column(table, x)?);
    let line = Line::new(
        "",
        x_column.values()[window.clone()].to_vec(),
        y_column.values()[window].to_vec(),
    );
    let (x_unit, y_unit) = (si_unit(x_column), si_unit(y_column));
    Ok(xy_plot(
        title,
        (x, shown(&x_unit)),
        (y, shown(&y_unit)),
        vec![line],
    ))
}

/// The rows within `--from` and `--to`.
fn window(args: &PlotArgs, time: &[f64]) -> std::ops::Range<usize> {
    let from = args
        .from
        .map_or(0, |from| time.partition_point(|&t| t < from));
    let to = args
        .to
        .map_or(time.len(), |to| time.partition_point(|&t| t <= to));
    from..to.max(from)
}

fn column<'t>(table: &'t Table, name: &str) -> Result<&'t Column, String> {
    table.column(name).ok_or_else(|| {
        let last = name.rsplit('.').next().unwrap_or(name);
        let near: Vec<&str> = table
            .columns()
            .iter()
            .map(Column::name)
            .filter(|known| known.ends_with(last))
            .take(4)
            .collect();
        let known: Vec<&str> = table.columns().iter().map(Column::name).take(8).collect();
        let list = if near.is_empty() { known } else { near };
        format!(
            "no column is called `{name}`; there are `{}`, …",
            list.join("`, `")
        )
    })
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

/// The modes from the event log beside the results.
fn strip(results: &Path, time: &[f64], window: std::ops::Range<usize>) -> Option<EventStrip> {
    let path: PathBuf = results.with_file_name("events.csv");
    let text = files::read_text(&path).ok()?;
    let (first, last) = (
        *time.get(window.start)?,
        *time.get(window.end.checked_sub(1)?)?,
    );
    let mut rows: Vec<EventRow> = Vec::new();
    let mut open: Vec<(f64, String)> = Vec::new();
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.splitn(5, ',').collect();
        let [t, what, before, after, _] = fields.as_slice() else {
            continue;
        };
        let Ok(t) = t.parse::<f64>() else { continue };
        if matches!(*what, "when" | "if") {
            continue;
        }
        let number = rows
            .iter()
            .position(|row| row.label == *what)
            .unwrap_or_else(|| {
                rows.push(EventRow {
                    label: (*what).to_owned(),
                    ..EventRow::default()
                });
                open.push((first, (*before).to_owned()));
                rows.len() - 1
            });
        let (from, mode) = std::mem::replace(&mut open[number], (t, (*after).to_owned()));
        rows[number].spans.push(Span {
            from,
            to: t,
            label: mode,
        });
    }
    for (row, (from, mode)) in rows.iter_mut().zip(open) {
        row.spans.push(Span {
            from,
            to: last,
            label: mode,
        });
        row.spans.retain(|span| span.to > first && span.from < last);
        for span in &mut row.spans {
            span.from = span.from.max(first);
            span.to = span.to.min(last);
        }
    }
    (!rows.is_empty()).then_some(EventStrip { rows })
}
