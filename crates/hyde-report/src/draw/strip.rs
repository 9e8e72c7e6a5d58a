//! The event strip: a row for each automaton, coloured by mode, with ticks at its events.

use super::drawing::{Anchor, Fill, Item, Stroke};
use super::flow::flow;
use super::font::Font;
use super::geometry::{Point, Rect};
use super::palette::{BLURRED, Colour, INK, WHITE};
use super::panel::{draw_frame, draw_x_ticks, text};
use super::shown_axis::ShownAxis;
use super::sizes::{GAP, LEADING, SMALL, TEXT, TICK};
use super::tints::{Tints, distinct};
use crate::{EventRow, EventStrip, Span};

const ROW: f64 = 15.0;
const ROW_GAP: f64 = 3.0;
const SWATCH: f64 = 12.0;
const KEY_ROW: f64 = SMALL * LEADING;
/// Spans narrower than this are not told apart.
const NARROW: f64 = 0.75;

/// A strip with everything placed, relative to the top left corner of its frame.
pub(crate) struct PlacedStrip<'a> {
    strip: &'a EventStrip,
    tints: &'a Tints<'a>,
    x: &'a ShownAxis,
    width: f64,
    /// Colours whose mode is not written into any span, explained above the frame.
    key: Vec<(Colour, &'a str, Point)>,
    key_height: f64,
}

impl<'a> PlacedStrip<'a> {
    /// Places the strip along an axis of `width` px.
    pub(crate) fn new(
        strip: &'a EventStrip,
        x: &'a ShownAxis,
        width: f64,
        tints: &'a Tints<'a>,
        font: &Font,
    ) -> Self {
        let wide = |least: f64| {
            move |span: &&Span| ends(span, x, width).is_some_and(|(from, to)| to - from >= least)
        };
        let spans = || strip.rows.iter().flat_map(|row| &row.spans);
        let written =
            |name: &str| spans().any(|span| span.label == name && fits(span, x, width, font));
        let seen = distinct(spans().filter(wide(NARROW)).map(|span| span.label.as_str()));
        let unwritten = seen
            .into_iter()
            .filter(|name| !name.is_empty() && !written(name));
        let mut key: Vec<(Colour, &str)> = unwritten.map(|name| (tints.of(name), name)).collect();
        if spans().filter(wide(0.0)).count() > spans().filter(wide(NARROW)).count() {
            key.push((BLURRED, "too short to show"));
        }
        let widths = key
            .iter()
            .map(|(_, name)| SWATCH + 4.0 + font.width(name, SMALL));
        let (places, rows) = flow(widths, TEXT, width);
        let base =
            |(row, left): (f64, f64)| Point::new(left, (row + 1.0 - rows) * KEY_ROW - 0.4 * SMALL);
        let key = key
            .into_iter()
            .zip(places)
            .map(|((colour, name), at)| (colour, name, base(at)));
        Self {
            strip,
            tints,
            x,
            width,
            key: key.collect(),
            key_height: rows * KEY_ROW,
        }
    }

    /// Height needed above the frame.
    pub(crate) fn header(&self) -> f64 {
        self.key_height
    }

    /// Height of the frame.
    pub(crate) fn height(&self) -> f64 {
        self.strip.rows.len() as f64 * (ROW + ROW_GAP) + ROW_GAP
    }

    /// Draws the strip with the top left corner of its frame at `origin`; row labels end `room` px left of it at most.
    pub(crate) fn draw(&self, origin: Point, room: f64, font: &Font, items: &mut Vec<Item>) {
        let frame = Rect::at(origin.x, origin.y, self.width, self.height());
        for (place, row) in self.strip.rows.iter().enumerate() {
            let top = frame.top + ROW_GAP + place as f64 * (ROW + ROW_GAP);
            let band = Rect {
                top,
                bottom: top + ROW,
                ..frame
            };
            self.draw_spans(row, &band, font, items);
            self.draw_events(row, &band, items);
            let base = top + 0.5 * (ROW + font.cap_height(SMALL));
            let label = font.shortened_ahead(&row.label, SMALL, room - TICK - GAP);
            let at = Point::new(frame.left - TICK - GAP, base);
            items.push(text(at, &label, SMALL, Anchor::End, INK));
        }
        draw_frame(&frame, items);
        draw_x_ticks(self.x, &frame, items);
        for (colour, name, at) in &self.key {
            let at = at.shifted(origin.x, origin.y);
            let area = Rect::at(at.x, at.y - 0.8 * SMALL, SWATCH, 0.9 * SMALL);
            items.push(Item::Area {
                area,
                fill: Fill::solid(*colour),
            });
            items.push(text(
                at.shifted(SWATCH + 4.0, 0.0),
                name,
                SMALL,
                Anchor::Start,
                INK,
            ));
        }
    }

    fn draw_spans(&self, row: &EventRow, band: &Rect, font: &Font, items: &mut Vec<Item>) {
        // Narrow spans that touch are one grey area.
        let mut blurred: Option<Rect> = None;
        for span in &row.spans {
            let Some((from, to)) = ends(span, self.x, self.width) else {
                continue;
            };
            let area = Rect {
                left: band.left + from,
                right: band.left + to,
                ..*band
            };
            let narrow = area.width() < NARROW;
            match blurred {
                Some(before) if narrow && area.left - before.right < NARROW => {
                    blurred = Some(Rect {
                        right: area.right,
                        ..before
                    });
                }
                _ => {
                    items.extend(blurred.take().map(|area| Item::Area {
                        area,
                        fill: Fill::solid(BLURRED),
                    }));
                    blurred = narrow.then_some(area);
                }
            }
            if !narrow {
                self.draw_span(span, &area, font, items);
            }
        }
        items.extend(blurred.map(|area| Item::Area {
            area,
            fill: Fill::solid(BLURRED),
        }));
    }

    fn draw_span(&self, span: &Span, area: &Rect, font: &Font, items: &mut Vec<Item>) {
        items.push(Item::Area {
            area: *area,
            fill: Fill::solid(self.tints.of(&span.label)),
        });
        if area.width() > 3.0 {
            let stroke = Stroke::solid(WHITE, 0.8);
            let (from, to) = (
                Point::new(area.left, area.top),
                Point::new(area.left, area.bottom),
            );
            items.push(Item::Rule { from, to, stroke });
        }
        if fits(span, self.x, self.width, font) {
            let base = area.bottom - 0.5 * (ROW - font.cap_height(SMALL));
            let middle = Point::new(0.5 * (area.left + area.right), base);
            items.push(text(middle, &span.label, SMALL, Anchor::Middle, INK));
        }
    }

    /// Ticks as high as the row; in a row with modes at its lower edge, clear of their names.
    fn draw_events(&self, row: &EventRow, band: &Rect, items: &mut Vec<Item>) {
        let top = if row.spans.is_empty() {
            band.top + 1.0
        } else {
            band.bottom - 3.0
        };
        let mut last = f64::NEG_INFINITY;
        for tick in &row.ticks {
            let at = self.x.fraction(tick * self.x.factor) * self.width;
            // Ticks closer than half a pixel are one.
            if !(0.0..=self.width).contains(&at) || (at - last).abs() < 0.5 {
                continue;
            }
            last = at;
            let (from, to) = (
                Point::new(band.left + at, top),
                Point::new(band.left + at, band.bottom),
            );
            items.push(Item::Rule {
                from,
                to,
                stroke: Stroke::solid(INK, 0.8),
            });
        }
    }
}

/// The widest row label, at most `most` px, with the room between it and the frame.
pub(crate) fn label_room(strip: &EventStrip, most: f64, font: &Font) -> f64 {
    let widths = strip
        .rows
        .iter()
        .map(|row| font.width(&row.label, SMALL).min(most));
    widths.fold(0.0, f64::max) + TICK + GAP
}

/// Where a span begins and ends in px, if any of it can be seen.
fn ends(span: &Span, x: &ShownAxis, width: f64) -> Option<(f64, f64)> {
    let at = |time: f64| x.fraction(time * x.factor).clamp(0.0, 1.0) * width;
    let (from, to) = (at(span.from), at(span.to));
    (to > from).then_some((from, to))
}

fn fits(span: &Span, x: &ShownAxis, width: f64, font: &Font) -> bool {
    ends(span, x, width).is_some_and(|(from, to)| font.width(&span.label, SMALL) + 4.0 <= to - from)
}

#[cfg(test)]
mod tests {
    use super::super::range::Room;
    use super::*;
    use crate::{Axis, Figure};

    const WIDTH: f64 = 500.0;

    /// Names in the key, and the items drawn, of one row over 0 to 1 s.
    fn drawn(spans: &[(f64, f64, &str)], ticks: Vec<f64>) -> (Vec<String>, Vec<Item>) {
        let span = |(from, to, label): &(f64, f64, &str)| Span {
            from: *from,
            to: *to,
            label: (*label).to_owned(),
        };
        let row = EventRow {
            label: "guide".to_owned(),
            spans: spans.iter().map(span).collect(),
            ticks,
        };
        let figure = Figure {
            events: Some(EventStrip { rows: vec![row] }),
            ..Figure::new(Vec::new())
        };
        let axis = Axis::new("time", "s").with_range(0.0, 1.0);
        let axis = ShownAxis::new(&axis, std::iter::empty(), Room::Tight);
        let (tints, font) = (Tints::new(&figure), Font::new());
        let placed = PlacedStrip::new(figure.events.as_ref().unwrap(), &axis, WIDTH, &tints, &font);
        let mut items = Vec::new();
        placed.draw(Point::new(0.0, 0.0), 60.0, &font, &mut items);
        (
            placed
                .key
                .iter()
                .map(|(_, name, _)| (*name).to_owned())
                .collect(),
            items,
        )
    }

    fn areas(items: &[Item], colour: Colour) -> usize {
        items
            .iter()
            .filter(|item| matches!(item, Item::Area { fill, .. } if fill.colour == colour))
            .count()
    }

    #[test]
    fn a_mode_that_fits_nowhere_is_in_the_key() {
        let (key, _) = drawn(&[(0.0, 0.02, "stuck"), (0.02, 1.0, "slip")], Vec::new());
        assert_eq!(key, ["stuck"]);
    }

    #[test]
    fn modes_shorter_than_a_pixel_are_one_grey_area() {
        let mut spans: Vec<_> = (0..1000)
            .map(|k| (f64::from(k) * 1e-4, f64::from(k + 1) * 1e-4, "a"))
            .collect();
        spans.push((0.1, 0.5, "b"));
        spans.push((0.5, 0.5001, "c"));
        let (key, items) = drawn(&spans, Vec::new());
        assert_eq!(key, ["too short to show"]);
        assert_eq!(areas(&items, BLURRED), 3); // two runs, and the key
    }

    #[test]
    fn ticks_are_thinned_and_those_outside_left_out() {
        let rules = |ticks| {
            drawn(&[], ticks)
                .1
                .iter()
                .filter(|item| matches!(item, Item::Rule { .. }))
                .count()
        };
        let frame = rules(Vec::new());
        assert_eq!(
            rules(vec![-1.0, 0.2, 0.2001, 0.5, f64::NAN, 2.0]),
            frame + 2
        );
    }
}
