//! The legend of a panel: what it lists, and where it goes so that it covers nothing.

use super::drawing::{Anchor, Fill, Item, Stroke, Text};
use super::flow::flow;
use super::font::Font;
use super::geometry::{Point, Rect};
use super::palette::{GRID, INK, WHITE, line_colour, line_dash};
use super::sizes::{CURVE, DISC, DOT, LEADING, RING, TEXT};
use super::tints::{Tints, band_labels};
use super::trace::{Trace, covered};
use crate::{Line, LineStyle, Panel};

const SAMPLE: f64 = 22.0;
const SAMPLE_GAP: f64 = 6.0;
const BETWEEN: f64 = 16.0;
const INSET: f64 = 6.0;
const ROW: f64 = TEXT * LEADING;

/// The entries of a legend and where they are.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Legend {
    /// Each with the top left corner of its row, from the top left corner of the panel (y < 0: above it).
    entries: Vec<(Entry, Point)>,
    /// The box behind the entries, where they are inside the panel.
    inside: Option<Rect>,
    /// Height taken above the panel.
    pub(crate) above: f64,
}

/// One row of a legend.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    sample: Sample,
    text: String,
    width: f64,
}

#[derive(Clone, Debug, PartialEq)]
enum Sample {
    Line(Stroke),
    Dots(Fill),
    Ring(Fill),
    Disc(Fill),
    Patch(Fill),
}

/// Places `entries` in a panel of `size` px: in a corner or a middle where they cover neither `traces` nor `taken`,
/// else in rows above, `lift` px over the frame.
pub(crate) fn legend(
    entries: Vec<Entry>,
    traces: &[Trace],
    taken: &[Rect],
    size: (f64, f64),
    lift: f64,
) -> Legend {
    let widest = entries
        .iter()
        .fold(0.0, |most: f64, entry| most.max(entry.width));
    let needs = (widest + 2.0 * INSET, entries.len() as f64 * ROW + INSET);
    let few = entries.len() <= 6 && needs.0 < 0.6 * size.0 && needs.1 < 0.6 * size.1;
    let free = |place: &Rect| {
        let around = place.grown(3.0);
        covered(traces, &around) <= 0.0 && !taken.iter().any(|other| around.overlaps(other))
    };
    let place = places(needs, size).into_iter().filter(|_| few).find(free);
    match place {
        _ if entries.is_empty() => Legend::default(),
        Some(place) => {
            let top = place.top + 0.5 * INSET;
            let at = |row: usize| Point::new(place.left + INSET, top + row as f64 * ROW);
            let entries = entries
                .into_iter()
                .enumerate()
                .map(|(row, entry)| (entry, at(row)));
            Legend {
                entries: entries.collect(),
                inside: Some(place),
                above: 0.0,
            }
        }
        None => rows_above(entries, size.0, lift),
    }
}

impl Legend {
    /// The legend of a panel whose top left corner is at `origin`.
    pub(crate) fn draw(&self, origin: Point, font: &Font, items: &mut Vec<Item>) {
        if let Some(area) = self.inside {
            // White within a grid-coloured border, so that no piece of grid is left hanging beside it.
            let area = area.shifted(origin.x, origin.y);
            items.push(Item::Area {
                area: area.grown(0.6),
                fill: Fill::solid(GRID),
            });
            items.push(Item::Area {
                area,
                fill: Fill::solid(WHITE),
            });
        }
        for (entry, corner) in &self.entries {
            let middle = corner.shifted(origin.x, origin.y + 0.5 * ROW);
            items.extend(entry.sample.items(middle));
            items.push(Item::Text(Text {
                at: middle.shifted(SAMPLE + SAMPLE_GAP, 0.5 * font.cap_height(TEXT)),
                text: entry.text.clone(),
                size: TEXT,
                anchor: Anchor::Start,
                upright: false,
                colour: INK,
            }));
        }
    }
}

impl Sample {
    /// The sample with its left end at `at`.
    fn items(&self, at: Point) -> Vec<Item> {
        match self {
            Self::Line(stroke) => vec![Item::Polyline {
                points: vec![at, at.shifted(SAMPLE, 0.0)],
                stroke: *stroke,
            }],
            Self::Dots(fill) => {
                let centres = [0.2, 0.5, 0.8].map(|part| at.shifted(part * SAMPLE, 0.0));
                vec![Item::Dots {
                    centres: centres.to_vec(),
                    radius: DOT,
                    fill: *fill,
                }]
            }
            Self::Disc(fill) => vec![Item::Dots {
                centres: vec![at.shifted(0.5 * SAMPLE, 0.0)],
                radius: 2.0 * DISC,
                fill: *fill,
            }],
            Self::Ring(fill) => rings(vec![at.shifted(0.5 * SAMPLE, 0.0)], *fill),
            Self::Patch(fill) => {
                let area = Rect::at(at.x, at.y - 0.35 * TEXT, SAMPLE, 0.7 * TEXT);
                vec![Item::Area { area, fill: *fill }]
            }
        }
    }
}

/// Rings round some points, white inside.
pub(crate) fn rings(centres: Vec<Point>, fill: Fill) -> Vec<Item> {
    let inside = Item::Dots {
        centres: centres.clone(),
        radius: RING.1,
        fill: Fill::solid(WHITE),
    };
    let outside = Item::Dots {
        centres,
        radius: RING.0,
        fill,
    };
    vec![outside, inside]
}

/// How the curve of a line is drawn.
pub(crate) fn stroke_of(line: &Line, place: usize) -> Stroke {
    let index = line.colour.unwrap_or(place);
    let dash = if line.style == LineStyle::Dashed {
        &[5.0, 3.0]
    } else {
        line_dash(index)
    };
    Stroke {
        colour: line_colour(index),
        width: CURVE,
        dash,
    }
}

/// What the legend of a panel of `width` px lists: the lines, unless the only one is what the axis says, and the bands.
pub(crate) fn entries(panel: &Panel, tints: &Tints<'_>, width: f64, font: &Font) -> Vec<Entry> {
    let named = panel
        .lines
        .iter()
        .enumerate()
        .filter(|(_, line)| !line.label.is_empty());
    let named: Vec<(usize, &Line)> = named.collect();
    let told_by_axis = matches!(named[..], [(_, only)] if only.label == panel.y.label);
    let lines = named
        .into_iter()
        .filter(|_| !told_by_axis)
        .map(|(place, line)| {
            let stroke = stroke_of(line, place);
            let sample = match line.style {
                LineStyle::Points => Sample::Dots(Fill::solid(stroke.colour)),
                LineStyle::Rings => Sample::Ring(Fill::solid(stroke.colour)),
                LineStyle::Discs => Sample::Disc(Fill::solid(stroke.colour)),
                LineStyle::Solid | LineStyle::Dashed | LineStyle::Steps => Sample::Line(stroke),
            };
            (sample, line.label.as_str())
        });
    let bands = band_labels(panel)
        .into_iter()
        .filter(|label| !label.is_empty());
    let patches = bands.map(|label| (Sample::Patch(Fill::solid(tints.of(label))), label));
    let entry = |(sample, label): (Sample, &str)| {
        let text = font.shortened(label, TEXT, width - SAMPLE - SAMPLE_GAP);
        Entry {
            sample,
            width: SAMPLE + SAMPLE_GAP + font.width(&text, TEXT),
            text,
        }
    };
    lines.chain(patches).map(entry).collect()
}

/// Corners and middles of a panel, the usual ones first.
fn places(needs: (f64, f64), size: (f64, f64)) -> Vec<Rect> {
    let (right, bottom) = (size.0 - needs.0 - INSET, size.1 - needs.1 - INSET);
    let middle = 0.5 * (size.0 - needs.0);
    let corners = [
        (right, INSET),
        (INSET, INSET),
        (right, bottom),
        (INSET, bottom),
        (middle, INSET),
        (middle, bottom),
    ];
    corners
        .into_iter()
        .map(|(left, top)| Rect::at(left, top, needs.0, needs.1))
        .collect()
}

/// Entries side by side in as many rows as they need, aligned with the left end of the frame.
fn rows_above(entries: Vec<Entry>, width: f64, lift: f64) -> Legend {
    let (places, rows) = flow(entries.iter().map(|entry| entry.width), BETWEEN, width);
    let above = rows * ROW + 4.0;
    let corner = |(row, left): (f64, f64)| Point::new(left, row * ROW - above - lift);
    let entries = entries
        .into_iter()
        .zip(places.into_iter().map(corner))
        .collect();
    Legend {
        entries,
        inside: None,
        above,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;

    const SIZE: (f64, f64) = (400.0, 150.0);

    fn place(strokes: Vec<Vec<Point>>, taken: &[Rect], count: usize) -> Legend {
        let lines = (0..count).map(|k| Line::new(format!("line {k}"), Vec::new(), Vec::new()));
        let panel = Panel::new(Axis::new("x", ""), Axis::new("y", ""), lines.collect());
        let figure = crate::Figure::new(Vec::new());
        let entries = entries(&panel, &Tints::new(&figure), SIZE.0, &Font::new());
        legend(
            entries,
            &[Trace {
                strokes,
                dots: Vec::new(),
            }],
            taken,
            SIZE,
            0.0,
        )
    }

    #[test]
    fn it_goes_where_nothing_is_drawn() {
        let empty = place(Vec::new(), &[], 2).inside.unwrap();
        assert!(empty.left > 200.0 && empty.top < 75.0);
        let falling = vec![vec![Point::new(0.0, 10.0), Point::new(400.0, 10.0)]];
        let below = place(falling.clone(), &[], 2).inside.unwrap();
        assert!(below.left > 200.0 && below.top > 75.0);
        let note = Rect::at(350.0, 130.0, 20.0, 10.0);
        let left = place(falling, &[note], 2).inside.unwrap();
        assert!(left.left < 200.0 && left.top > 75.0);
    }

    #[test]
    fn it_goes_above_when_there_is_no_room_or_too_many_entries() {
        let zigzag = (0..40).map(|k| Point::new(f64::from(k) * 10.0, f64::from(k % 2) * 150.0));
        let crowded = place(vec![zigzag.collect()], &[], 2);
        assert!(crowded.inside.is_none() && crowded.above > 10.0);
        let many = place(Vec::new(), &[], 10);
        assert!(many.inside.is_none() && many.above > 2.0 * ROW);
    }

    #[test]
    fn a_line_named_like_its_axis_is_not_listed() {
        let line = |label: &str| Line::new(label, Vec::new(), Vec::new());
        let count = |lines: Vec<Line>| {
            let panel = Panel::new(Axis::new("x", ""), Axis::new("y", ""), lines);
            let figure = crate::Figure::new(Vec::new());
            entries(&panel, &Tints::new(&figure), SIZE.0, &Font::new()).len()
        };
        assert_eq!(count(vec![line("y")]), 0);
        assert_eq!(count(vec![line("other")]), 1);
        assert_eq!(count(vec![line("y"), line("other"), line("")]), 2);
    }
}
