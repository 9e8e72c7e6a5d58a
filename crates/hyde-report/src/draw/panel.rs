//! One panel: grid, bands, curves, frame, ticks, reference lines, markers and legend.

use super::drawing::{Anchor, Fill, Item, Stroke, Text};
use super::font::Font;
use super::geometry::{Point, Rect};
use super::legend::{Legend, entries, legend, rings, stroke_of};
use super::note::{FLAG_ROW, Flag, Note, flags, notes, point};
use super::palette::{Colour, INK, REFERENCE, line_colour};
use super::shown_axis::ShownAxis;
use super::sizes::{
    DISC, DOT, FINE_GRID_STROKE, FRAME_STROKE, GAP, GRID_STROKE, REFERENCE_STROKE, TEXT, TICK,
};
use super::tints::Tints;
use super::trace::{Trace, trace};
use crate::{Direction, LineStyle, Panel};

/// A panel with everything placed, relative to the top left corner of its frame.
pub(crate) struct PlacedPanel<'a> {
    panel: &'a Panel,
    tints: &'a Tints<'a>,
    pub(crate) x: ShownAxis,
    pub(crate) y: ShownAxis,
    /// Width and height of the frame.
    size: (f64, f64),
    traces: Vec<Trace>,
    notes: Vec<Note>,
    flags: Vec<Flag>,
    flag_rows: f64,
    legend: Legend,
}

impl<'a> PlacedPanel<'a> {
    /// Places everything in a frame of `size` (width, height) px; the axes have their ticks.
    pub(crate) fn new(
        panel: &'a Panel,
        (x, y): (ShownAxis, ShownAxis),
        size: (f64, f64),
        tints: &'a Tints<'a>,
        font: &Font,
    ) -> Self {
        let traced = panel
            .lines
            .iter()
            .map(|line| trace(line, &x, &y, size.0, size.1));
        let traces: Vec<_> = traced.collect();
        let flags = flags(panel, &x, size.0, font);
        let flag_rows = flags
            .iter()
            .fold(0.0, |most: f64, flag| most.max(flag.row + 1.0));
        let notes = notes(panel, (&x, &y), &traces, size, font);
        let taken: Vec<Rect> = notes.iter().map(|note| note.area).collect();
        let entries = entries(panel, tints, size.0, font);
        let legend = legend(entries, &traces, &taken, size, flag_rows * FLAG_ROW);
        Self {
            panel,
            tints,
            x,
            y,
            size,
            traces,
            notes,
            flags,
            flag_rows,
            legend,
        }
    }

    /// Height needed above the frame.
    pub(crate) fn header(&self) -> f64 {
        self.legend.above + self.flag_rows * FLAG_ROW
    }

    /// Draws the panel with the top left corner of its frame at `origin`.
    pub(crate) fn draw(&self, origin: Point, font: &Font, items: &mut Vec<Item>) {
        let frame = Rect::at(origin.x, origin.y, self.size.0, self.size.1);
        self.draw_bands(&frame, items);
        self.draw_grid(&frame, items);
        self.draw_between(origin, items);
        self.draw_references(&frame, items);
        for (place, traced) in self.traces.iter().enumerate() {
            self.draw_trace(place, traced, origin, items);
        }
        draw_frame(&frame, items);
        draw_x_ticks(&self.x, &frame, items);
        self.draw_y_ticks(&frame, font, items);
        self.draw_markers(origin, items);
        self.notes
            .iter()
            .for_each(|note| note.draw(origin, font, items));
        self.flags
            .iter()
            .for_each(|flag| flag.draw_pole(origin, items));
        self.flags
            .iter()
            .for_each(|flag| flag.draw_label(origin, items));
        self.legend.draw(origin, font, items);
        let empty = |traced: &Trace| traced.strokes.is_empty() && traced.dots.is_empty();
        if self.traces.iter().all(empty) {
            let middle = origin.shifted(0.5 * self.size.0, 0.5 * self.size.1);
            items.push(text(middle, "no data", TEXT, Anchor::Middle, REFERENCE));
        }
    }

    fn draw_bands(&self, frame: &Rect, items: &mut Vec<Item>) {
        for band in &self.panel.bands {
            let part = |at: f64| self.x.fraction(at * self.x.factor).clamp(0.0, 1.0);
            let end = |at: f64| frame.left + part(at) * frame.width();
            let (left, right) = (end(band.from.min(band.to)), end(band.from.max(band.to)));
            if right > left {
                let fill = Fill::solid(self.tints.of(&band.label));
                items.push(Item::Area {
                    area: Rect {
                        left,
                        right,
                        ..*frame
                    },
                    fill,
                });
            }
        }
    }

    /// Each area as one polygon: along its lower curve, and back along the upper one.
    fn draw_between(&self, origin: Point, items: &mut Vec<Item>) {
        let (width, height) = self.size;
        for between in &self.panel.between {
            let place = |x: f64, y: f64| {
                let part = |axis: &ShownAxis, at: f64| axis.fraction(at * axis.factor);
                let across = part(&self.x, x).clamp(0.0, 1.0) * width;
                let down = (1.0 - part(&self.y, y).clamp(0.0, 1.0)) * height;
                Point::new(origin.x + across, origin.y + down)
            };
            let edges = between.low.iter().zip(&between.high);
            let rows: Vec<(f64, f64, f64)> = between
                .x
                .iter()
                .zip(edges)
                .map(|(x, (low, high))| (*x, *low, *high))
                .collect();
            let whole = |row: &(f64, f64, f64)| (row.0 + row.1 + row.2).is_finite();
            for run in rows.chunk_by(|a, b| whole(a) && whole(b)) {
                if run.len() < 2 {
                    continue;
                }
                let there = run.iter().map(|(x, low, _)| place(*x, *low));
                let back = run.iter().rev().map(|(x, _, high)| place(*x, *high));
                items.push(Item::Polygon {
                    points: there.chain(back).collect(),
                    fill: Fill {
                        colour: line_colour(between.colour),
                        opacity: between.opacity,
                    },
                });
            }
        }
    }

    fn draw_grid(&self, frame: &Rect, items: &mut Vec<Item>) {
        let mut across = |axis: &ShownAxis, values: &[f64], stroke: Stroke, rule: Rule| {
            items.extend(
                values
                    .iter()
                    .map(|value| rule(frame, axis.fraction(*value), stroke)),
            );
        };
        across(&self.x, &self.x.ticks.minor, FINE_GRID_STROKE, upright_rule);
        across(&self.y, &self.y.ticks.minor, FINE_GRID_STROKE, level_rule);
        across(&self.x, &self.x.ticks.major, GRID_STROKE, upright_rule);
        across(&self.y, &self.y.ticks.major, GRID_STROKE, level_rule);
    }

    fn draw_references(&self, frame: &Rect, items: &mut Vec<Item>) {
        for reference in &self.panel.references {
            let (axis, rule): (_, Rule) = match reference.direction {
                Direction::Vertical => (&self.x, upright_rule),
                Direction::Horizontal => (&self.y, level_rule),
            };
            let part = axis.fraction(reference.at * axis.factor);
            if (0.0..=1.0).contains(&part) {
                items.push(rule(frame, part, REFERENCE_STROKE));
            }
        }
    }

    fn draw_trace(&self, place: usize, traced: &Trace, origin: Point, items: &mut Vec<Item>) {
        // Five shades are told apart; one item for each keeps the file small.
        const SHADES: [f64; 5] = [0.15, 0.3, 0.5, 0.75, 1.0];
        let stroke = stroke_of(&self.panel.lines[place], place);
        for points in &traced.strokes {
            let points = points
                .iter()
                .map(|point| point.shifted(origin.x, origin.y))
                .collect();
            items.push(Item::Polyline { points, stroke });
        }
        for (shade, opacity) in SHADES.into_iter().enumerate() {
            let in_shade = |weight: f64| ((weight * 5.0) as usize).min(4) == shade;
            let dots = traced.dots.iter().filter(|(_, weight)| in_shade(*weight));
            let centres: Vec<_> = dots.map(|(at, _)| at.shifted(origin.x, origin.y)).collect();
            if !centres.is_empty() {
                let fill = Fill {
                    colour: stroke.colour,
                    opacity,
                };
                let dots = |radius: f64, fill: Fill| Item::Dots {
                    centres: centres.clone(),
                    radius,
                    fill,
                };
                match self.panel.lines[place].style {
                    LineStyle::Rings => items.extend(rings(centres.clone(), fill)),
                    LineStyle::Discs => {
                        let radius = DISC * (shade + 1) as f64;
                        items.push(dots(radius, Fill::solid(stroke.colour)));
                    }
                    LineStyle::Points | LineStyle::Solid | LineStyle::Dashed | LineStyle::Steps => {
                        items.push(dots(DOT, fill))
                    }
                }
            }
        }
    }

    fn draw_y_ticks(&self, frame: &Rect, font: &Font, items: &mut Vec<Item>) {
        let y = |value: f64| frame.bottom - self.y.fraction(value) * frame.height();
        let tick = |value: f64, length: f64| Item::Rule {
            from: Point::new(frame.left - length, y(value)),
            to: Point::new(frame.left, y(value)),
            stroke: FRAME_STROKE,
        };
        items.extend(self.y.ticks.major.iter().map(|value| tick(*value, TICK)));
        items.extend(
            self.y
                .ticks
                .minor
                .iter()
                .map(|value| tick(*value, 0.5 * TICK)),
        );
        for (value, label) in self.y.ticks.major.iter().zip(&self.y.ticks.labels) {
            let base = y(*value) + 0.5 * font.cap_height(TEXT);
            let at = Point::new(frame.left - TICK - GAP, base);
            items.push(text(at, label, TEXT, Anchor::End, INK));
        }
    }

    fn draw_markers(&self, origin: Point, items: &mut Vec<Item>) {
        let place = |x: f64, y: f64| point(&self.x, &self.y, self.size, x, y);
        let places = self
            .panel
            .markers
            .iter()
            .filter_map(|marker| place(marker.x, marker.y));
        let centres: Vec<_> = places.map(|at| at.shifted(origin.x, origin.y)).collect();
        if !centres.is_empty() {
            items.extend(rings(centres, Fill::solid(INK)));
        }
    }
}

/// A line across a frame at a fraction of its width or height.
type Rule = fn(&Rect, f64, Stroke) -> Item;

/// The four sides of a frame.
pub(crate) fn draw_frame(frame: &Rect, items: &mut Vec<Item>) {
    for part in [0.0, 1.0] {
        items.push(level_rule(frame, part, FRAME_STROKE));
        items.push(upright_rule(frame, part, FRAME_STROKE));
    }
}

/// The ticks below a frame, without labels.
pub(crate) fn draw_x_ticks(axis: &ShownAxis, frame: &Rect, items: &mut Vec<Item>) {
    let mut tick = |value: f64, length: f64| {
        let x = frame.left + axis.fraction(value) * frame.width();
        let (from, to) = (
            Point::new(x, frame.bottom),
            Point::new(x, frame.bottom + length),
        );
        items.push(Item::Rule {
            from,
            to,
            stroke: FRAME_STROKE,
        });
    };
    axis.ticks.major.iter().for_each(|value| tick(*value, TICK));
    axis.ticks
        .minor
        .iter()
        .for_each(|value| tick(*value, 0.5 * TICK));
}

/// A text that reads from left to right.
pub(crate) fn text(at: Point, text: &str, size: f64, anchor: Anchor, colour: Colour) -> Item {
    Item::Text(Text {
        at,
        text: text.to_owned(),
        size,
        anchor,
        upright: false,
        colour,
    })
}

fn upright_rule(frame: &Rect, part: f64, stroke: Stroke) -> Item {
    let x = frame.left + part * frame.width();
    Item::Rule {
        from: Point::new(x, frame.top),
        to: Point::new(x, frame.bottom),
        stroke,
    }
}

fn level_rule(frame: &Rect, part: f64, stroke: Stroke) -> Item {
    let y = frame.bottom - part * frame.height();
    Item::Rule {
        from: Point::new(frame.left, y),
        to: Point::new(frame.right, y),
        stroke,
    }
}
