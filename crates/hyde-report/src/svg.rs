//! Writes a laid-out figure as SVG 1.1: paths with relative coordinates in hundredths of a pixel, text as text.

use crate::Figure;
use crate::draw::{Anchor, Colour, Drawing, Fill, Item, Point, Stroke, Text, draw};
use crate::escape::escape;
use std::fmt::Write;

/// DejaVu Sans, which the texts are measured with, and its relatives of the same width.
const FONTS: &str =
    "DejaVu Sans, Bitstream Vera Sans, Verdana, Geneva, Helvetica, Arial, sans-serif";

/// Ends of curves and dots.
const ROUND: &str = " stroke-linecap=\"round\"";

/// The figure as an SVG document of its own, on white.
#[must_use]
pub fn to_svg(figure: &Figure) -> String {
    let label = figure.title.as_deref().unwrap_or("figure");
    written(&draw(figure), label)
}

/// A drawing as an SVG document with what it shows as its label.
pub(crate) fn written(drawing: &Drawing, label: &str) -> String {
    let size = format!(
        "width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\"",
        drawing.width, drawing.height
    );
    let mut svg = String::new();
    push(
        &mut svg,
        format_args!("<svg xmlns=\"http://www.w3.org/2000/svg\" {size} role=\"img\""),
    );
    push(
        &mut svg,
        format_args!(" aria-label=\"{}\">\n", escape(label)),
    );
    push(
        &mut svg,
        format_args!("<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"),
    );
    // Without kerning, as the texts were measured.
    push(
        &mut svg,
        format_args!(
            "<g font-family=\"{FONTS}\" style=\"font-kerning:none\" stroke-linejoin=\"round\">\n"
        ),
    );
    write_items(&mut svg, drawing);
    svg.push_str("</g>\n</svg>\n");
    svg
}

fn write_items(svg: &mut String, drawing: &Drawing) {
    let mut items = drawing.items.iter().peekable();
    while let Some(item) = items.next() {
        match item {
            Item::Polyline { points, stroke } => {
                // Parts of one curve are one path; so are rules of one kind.
                let mut path = path(points.iter().copied(), true);
                while let Some(Item::Polyline {
                    points,
                    stroke: next,
                }) = items.peek()
                    && next == stroke
                {
                    path += &self::path(points.iter().copied(), true);
                    items.next();
                }
                let ends = if stroke.dash.is_empty() { ROUND } else { "" };
                let stroke = stroke_attributes(stroke);
                push(
                    svg,
                    format_args!("<path d=\"{path}\" fill=\"none\"{stroke}{ends}/>\n"),
                );
            }
            Item::Rule { from, to, stroke } => {
                let mut path = rule_path(*from, *to);
                while let Some(Item::Rule {
                    from,
                    to,
                    stroke: next,
                }) = items.peek()
                    && next == stroke
                {
                    path += &rule_path(*from, *to);
                    items.next();
                }
                let stroke = stroke_attributes(stroke);
                push(svg, format_args!("<path d=\"{path}\"{stroke}/>\n"));
            }
            Item::Polygon { points, fill } => {
                let path = path(points.iter().copied(), true);
                let fill = fill_attributes(fill);
                push(svg, format_args!("<path d=\"{path}z\"{fill}/>\n"));
            }
            Item::Area { area, fill } => {
                let place = format!("x=\"{}\" y=\"{}\"", number(area.left), number(area.top));
                let size = format!(
                    "width=\"{}\" height=\"{}\"",
                    number(area.width()),
                    number(area.height())
                );
                push(
                    svg,
                    format_args!("<rect {place} {size}{}/>\n", fill_attributes(fill)),
                );
            }
            Item::Dots {
                centres,
                radius,
                fill,
            } => {
                // A line of no length with round ends is a dot.
                let path = path(centres.iter().copied(), false);
                let stroke = Stroke {
                    colour: fill.colour,
                    width: 2.0 * radius,
                    dash: &[],
                };
                let faded = if fill.opacity < 1.0 {
                    format!(" stroke-opacity=\"{}\"", fill.opacity)
                } else {
                    String::new()
                };
                let stroke = stroke_attributes(&stroke);
                push(
                    svg,
                    format_args!("<path d=\"{path}\"{stroke}{ROUND}{faded}/>\n"),
                );
            }
            Item::Text(text) => write_text(svg, text),
        }
    }
}

/// A line through the points, or (`joined` false) a line of no length at each of them.
fn path(points: impl Iterator<Item = Point>, joined: bool) -> String {
    let mut path = String::new();
    let mut last = (0, 0);
    for (place, point) in points.enumerate() {
        // Differences of rounded values: rounding does not add up.
        let here = (hundredths(point.x), hundredths(point.y));
        let (dx, dy) = (here.0 - last.0, here.1 - last.1);
        let command = match (place, joined) {
            (0, _) => "M",
            (1, true) => "l",
            (_, true) => "",
            (_, false) => "m",
        };
        // A sign separates numbers as well as a space.
        let before = if command.is_empty() && dx >= 0 {
            " "
        } else {
            ""
        };
        let between = if dy < 0 { "" } else { " " };
        push(
            &mut path,
            format_args!("{command}{before}{}{between}{}", short(dx), short(dy)),
        );
        if !joined {
            path.push_str("h0");
        }
        last = here;
    }
    path
}

fn rule_path(from: Point, to: Point) -> String {
    format!(
        "M{} {}L{} {}",
        number(from.x),
        number(from.y),
        number(to.x),
        number(to.y)
    )
}

fn write_text(svg: &mut String, text: &Text) {
    let anchor = match text.anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    };
    let (x, y) = (number(text.at.x), number(text.at.y));
    let place = if text.upright {
        format!("transform=\"translate({x} {y})rotate(-90)\"")
    } else {
        format!("x=\"{x}\" y=\"{y}\"")
    };
    let size = number(text.size);
    let fill = colour(text.colour);
    let words = escape(&text.text);
    push(
        svg,
        format_args!("<text {place}{anchor} font-size=\"{size}\" fill=\"{fill}\">{words}</text>\n"),
    );
}

fn stroke_attributes(stroke: &Stroke) -> String {
    let mut attributes = format!(
        " stroke=\"{}\" stroke-width=\"{}\"",
        colour(stroke.colour),
        number(stroke.width)
    );
    if !stroke.dash.is_empty() {
        let lengths: Vec<String> = stroke.dash.iter().map(|length| number(*length)).collect();
        push(
            &mut attributes,
            format_args!(" stroke-dasharray=\"{}\"", lengths.join(" ")),
        );
    }
    attributes
}

fn fill_attributes(fill: &Fill) -> String {
    let faded = if fill.opacity < 1.0 {
        format!(" fill-opacity=\"{}\"", fill.opacity)
    } else {
        String::new()
    };
    format!(" fill=\"{}\"{faded}", colour(fill.colour))
}

fn colour(colour: Colour) -> String {
    format!("#{:02x}{:02x}{:02x}", colour.0, colour.1, colour.2)
}

fn number(value: f64) -> String {
    short(hundredths(value))
}

fn hundredths(value: f64) -> i64 {
    (value * 100.0).round() as i64
}

/// Hundredths in the fewest characters: `-3.5`, `.25`, `12`.
fn short(hundredths: i64) -> String {
    let sign = if hundredths < 0 { "-" } else { "" };
    let (whole, part) = (
        hundredths.unsigned_abs() / 100,
        hundredths.unsigned_abs() % 100,
    );
    match (whole, part) {
        (_, 0) => format!("{sign}{whole}"),
        (0, _) => format!("{sign}.{part:02}").trim_end_matches('0').to_owned(),
        _ => format!("{sign}{whole}.{part:02}")
            .trim_end_matches('0')
            .to_owned(),
    }
}

fn push(text: &mut String, more: std::fmt::Arguments<'_>) {
    // Writing to a string cannot fail.
    let _ = text.write_fmt(more);
}

#[cfg(test)]
mod tests;
