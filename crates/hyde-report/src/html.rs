//! Writes a page as one HTML text: style and figures inside, no scripts, nothing fetched.

use crate::escape::escape;
use crate::page::{Align, Block, Column, Outcome, Page, Section, Table, Verdict};
use crate::{Figure, to_svg};

/// The style of all pages.
pub const STYLE: &str = include_str!("html/style.css");

/// How the ids of the sections of a page begin.
const SECTION: &str = "s";

/// The page as one HTML text that needs no other file and no network.
#[must_use]
pub fn to_html(page: &Page) -> String {
    let title = escape(&page.title);
    let facts: String = page
        .facts
        .iter()
        .map(|(name, value)| fact(name, value))
        .collect();
    let body = to_body(page, SECTION);
    let footer = if page.footer.is_empty() {
        String::new()
    } else {
        format!("<footer>{}</footer>\n", escape(&page.footer))
    };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <title>{title}</title>\n<style>\n{STYLE}</style>\n</head>\n<body>\n<header>\n<h1>{title}</h1>\n\
         <dl>{facts}</dl>\n</header>\n{}{body}{footer}</body>\n</html>\n",
        contents(page)
    )
}

/// The sections of a page alone, for a page of another program that has [`STYLE`]. Their ids begin with `name`, which no other
/// element of that page has.
#[must_use]
pub fn to_body(page: &Page, name: &str) -> String {
    let sections = page.sections.iter().enumerate();
    let sections: String = sections
        .map(|(place, section)| write_section(&format!("{name}{place}"), section))
        .collect();
    format!("<main>\n{sections}</main>\n")
}

fn fact(name: &str, value: &str) -> String {
    format!(
        "<div><dt>{}</dt><dd>{}</dd></div>",
        escape(name),
        escape(value)
    )
}

/// A text, in which words between two backquotes are those of a program.
fn prose(text: &str) -> String {
    let parts: Vec<&str> = text.split('`').collect();
    if parts.len().is_multiple_of(2) {
        return escape(text);
    }
    let part = |(number, part): (usize, &&str)| match number % 2 {
        0 => escape(part),
        _ => format!("<code>{}</code>", escape(part)),
    };
    parts.iter().enumerate().map(part).collect()
}

/// The table of contents: sections, and the figures with a title under theirs.
fn contents(page: &Page) -> String {
    let entry = |(place, section): (usize, &Section)| {
        let figures: String = figures(section)
            .filter_map(|(number, figure)| Some((number, figure.title.as_deref()?)))
            .map(|(number, title)| {
                format!(
                    "<li><a href=\"#{SECTION}{place}f{number}\">{}</a></li>",
                    escape(title)
                )
            })
            .collect();
        let figures = if figures.is_empty() {
            figures
        } else {
            format!("<ul>{figures}</ul>")
        };
        format!(
            "<li><a href=\"#{SECTION}{place}\">{}</a>{figures}</li>\n",
            escape(&section.heading)
        )
    };
    let entries: String = page.sections.iter().enumerate().map(entry).collect();
    if page.sections.len() < 2 {
        String::new()
    } else {
        format!("<nav aria-label=\"Contents\"><ul>\n{entries}</ul></nav>\n")
    }
}

fn figures(section: &Section) -> impl Iterator<Item = (usize, &Figure)> {
    section
        .blocks
        .iter()
        .enumerate()
        .filter_map(|(number, block)| match block {
            Block::Figure(figure) => Some((number, figure)),
            Block::Text(_)
            | Block::Code(_)
            | Block::Verdicts(_)
            | Block::Table(_)
            | Block::Diagram(_) => None,
        })
}

fn write_section(id: &str, section: &Section) -> String {
    let mut html = format!(
        "<section id=\"{id}\">\n<h2>{}</h2>\n",
        escape(&section.heading)
    );
    // Figures in a row share a grid.
    let in_grid = |block: &Block| matches!(block, Block::Figure(_));
    let mut number = 0;
    for run in section.blocks.chunk_by(|a, b| in_grid(a) == in_grid(b)) {
        let blocks: String = (number..)
            .zip(run)
            .map(|(number, block)| write_block(id, number, block))
            .collect();
        let grid = run.first().is_some_and(in_grid);
        html += &if grid {
            let class = if run.iter().all(is_small) {
                "figures small"
            } else {
                "figures"
            };
            format!("<div class=\"{class}\">\n{blocks}</div>\n")
        } else {
            blocks
        };
        number += run.len();
    }
    html + "</section>\n"
}

/// Figures of at most this width in px stand three beside each other on a wide screen.
const SMALL: f64 = 400.0;

fn is_small(block: &Block) -> bool {
    matches!(block, Block::Figure(figure) if figure.shown_width() <= SMALL)
}

fn write_block(section: &str, number: usize, block: &Block) -> String {
    match block {
        Block::Text(text) => format!("<p>{}</p>\n", prose(text)),
        Block::Code(text) => format!("<pre>{}</pre>\n", escape(text)),
        Block::Verdicts(verdicts) => {
            let lines: String = verdicts.iter().map(write_verdict).collect();
            format!("<ul class=\"verdicts\">\n{lines}</ul>\n")
        }
        Block::Table(table) => write_table(table),
        Block::Figure(figure) => write_figure(&format!("{section}f{number}"), figure),
        Block::Diagram(diagram) => {
            let (svg, width) = diagram.to_svg();
            format!(
                "<figure style=\"--width:{width}px\">\n<div class=\"scroll\">\n{svg}</div>\n<figcaption>{}</figcaption>\n</figure>\n",
                escape(&diagram.caption())
            )
        }
    }
}

fn write_verdict(verdict: &Verdict) -> String {
    let (class, word) = match verdict.outcome {
        Outcome::Passed => ("passed", "✓ held"),
        Outcome::Failed => ("failed", "✗ failed"),
        Outcome::Note => ("note", "note"),
    };
    format!(
        "<li class=\"{class}\"><b>{word}</b> <span>{}</span></li>\n",
        prose(&verdict.text)
    )
}

fn write_table(table: &Table) -> String {
    let class = |column: Option<&Column>| match column.map(|column| column.align) {
        Some(Align::Right) => " class=\"n\"",
        Some(Align::Left) | None => "",
    };
    let head =
        |column: &Column| format!("<th{}>{}</th>", class(Some(column)), escape(&column.head));
    let heads: String = table.columns.iter().map(head).collect();
    let titled = table.columns.iter().any(|column| !column.head.is_empty());
    let heads = if titled {
        format!("<thead><tr>{heads}</tr></thead>\n")
    } else {
        String::new()
    };
    let cell = |(place, text): (usize, &String)| {
        format!(
            "<td{}>{}</td>",
            class(table.columns.get(place)),
            prose(text)
        )
    };
    let row = |cells: &Vec<String>| {
        format!(
            "<tr>{}</tr>\n",
            cells.iter().enumerate().map(cell).collect::<String>()
        )
    };
    let rows: String = table.rows.iter().map(row).collect();
    let note = table.note.as_ref().map_or_else(String::new, |note| {
        format!("<p class=\"note\">{}</p>\n", prose(note))
    });
    // A long table scrolls by itself on a screen.
    let scroll = if table.rows.len() > 30 {
        "scroll long"
    } else {
        "scroll"
    };
    format!(
        "<div class=\"{scroll}\"><table>\n{heads}<tbody>\n{rows}</tbody>\n</table></div>\n{note}"
    )
}

/// Title and caption become text of the page, so that they wrap with it.
fn write_figure(id: &str, figure: &Figure) -> String {
    let title = figure
        .title
        .as_ref()
        .map_or_else(String::new, |title| format!("<h3>{}</h3>\n", escape(title)));
    let caption = figure.caption.as_ref().map_or_else(String::new, |caption| {
        format!("<figcaption>{}</figcaption>\n", prose(caption))
    });
    let bare = Figure {
        title: None,
        caption: None,
        ..figure.clone()
    };
    let label = escape(figure.title.as_deref().unwrap_or("figure"));
    let svg = to_svg(&bare).replacen(
        "aria-label=\"figure\"",
        &format!("aria-label=\"{label}\""),
        1,
    );
    let width = figure.shown_width();
    format!(
        "<figure id=\"{id}\" style=\"--width:{width}px\">\n{title}<div class=\"scroll\">\n{svg}</div>\n{caption}</figure>\n"
    )
}

#[cfg(test)]
mod tests;
