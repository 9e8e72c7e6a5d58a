//! Places title, panels, event strip and caption on the page.

use super::columns::{Columns, title_lines};
use super::drawing::{Anchor, Drawing, Item, Text};
use super::font::Font;
use super::geometry::{Point, Rect};
use super::palette::INK;
use super::panel::{PlacedPanel, text};
use super::shown_axis::ShownAxis;
use super::sizes::{GAP, LEADING, LINE, MARGIN, TEXT, TICK, TITLE};
use super::strip::PlacedStrip;
use super::tints::Tints;
use crate::Figure;

/// Between two panels, under the ticks of the upper one: labels at the ends of their axes do not touch.
const BETWEEN: f64 = 10.0;

/// Lays `figure` out.
pub(crate) fn draw(figure: &Figure) -> Drawing {
    let font = Font::new();
    let width = figure.shown_width();
    let columns = Columns::new(figure, width, &font);
    let mut page = Page {
        font: &font,
        columns,
        width,
        y: MARGIN,
        items: Vec::new(),
    };
    if let Some(title) = &figure.title {
        page.title(title);
    }
    page.panels(figure);
    if let Some(caption) = &figure.caption {
        page.caption(caption);
    }
    Drawing {
        width,
        height: (page.y + MARGIN).ceil(),
        items: page.items,
    }
}

struct Page<'a> {
    font: &'a Font,
    columns: Columns,
    width: f64,
    /// Where the next thing goes.
    y: f64,
    items: Vec<Item>,
}

impl Page<'_> {
    fn title(&mut self, title: &str) {
        // Flush with the frames if it is short enough, else with the page.
        let right = self.width - MARGIN;
        let short = self.columns.left + self.font.width(title, TITLE) <= right;
        let left = if short { self.columns.left } else { MARGIN };
        for line in self.font.wrap(title, TITLE, right - left, 3) {
            let at = Point::new(left, self.y + self.font.cap_height(TITLE) + 2.0);
            self.items.push(text(at, &line, TITLE, Anchor::Start, INK));
            self.y += TITLE * LEADING;
        }
        self.y += 4.0;
    }

    fn panels(&mut self, figure: &Figure) {
        let (left, width) = (self.columns.left, self.columns.right - self.columns.left);
        let tints = Tints::new(figure);
        let axes = std::mem::take(&mut self.columns.axes);
        for (place, (panel, axes)) in figure.panels.iter().zip(axes).enumerate() {
            let height = self.columns.heights[place];
            let placed = PlacedPanel::new(panel, axes, (width, height), &tints, self.font);
            self.y = (self.y + placed.header()).round() + 0.5;
            let frame = Rect::at(left, self.y, width, height);
            placed.draw(Point::new(left, self.y), self.font, &mut self.items);
            self.y_title(&placed.y, &frame);
            self.y = frame.bottom + TICK;
            let last = place + 1 == figure.panels.len();
            if last && let Some(strip) = &figure.events {
                let placed = PlacedStrip::new(strip, &placed.x, width, &tints, self.font);
                self.y = (self.y + 4.0 + placed.header()).round() + 0.5;
                placed.draw(
                    Point::new(left, self.y),
                    left - 2.0,
                    self.font,
                    &mut self.items,
                );
                self.y += placed.height() + TICK;
            }
            if last || !figure.shared_x {
                self.x_labels(&placed.x, left, width);
            }
            self.y += if last { 0.0 } else { BETWEEN };
        }
        if figure.panels.is_empty() {
            let at = Point::new(0.5 * self.width, self.y + LINE);
            self.items
                .push(text(at, "no data", TEXT, Anchor::Middle, INK));
            self.y += 2.0 * LINE;
        }
    }

    fn x_labels(&mut self, x: &ShownAxis, left: f64, width: f64) {
        let base = self.y + GAP + self.font.cap_height(TEXT);
        for (value, label) in x.ticks.major.iter().zip(&x.ticks.labels) {
            let at = Point::new(left + x.fraction(*value) * width, base);
            self.items.push(text(at, label, TEXT, Anchor::Middle, INK));
        }
        self.y = base + 0.3 * TEXT;
        for line in self.font.wrap(&x.title(), TEXT, width, 2) {
            let at = Point::new(
                left + 0.5 * width,
                self.y + self.font.cap_height(TEXT) + 3.0,
            );
            self.items.push(text(at, &line, TEXT, Anchor::Middle, INK));
            self.y += LINE;
        }
    }

    fn y_title(&mut self, y: &ShownAxis, frame: &Rect) {
        let lines = title_lines(y, frame.height(), self.font);
        for (place, line) in lines.into_iter().enumerate() {
            let at = Point::new(
                MARGIN + self.font.cap_height(TEXT) + place as f64 * LINE,
                0.5 * (frame.top + frame.bottom),
            );
            self.items.push(Item::Text(Text {
                at,
                text: line,
                size: TEXT,
                anchor: Anchor::Middle,
                upright: true,
                colour: INK,
            }));
        }
    }

    fn caption(&mut self, caption: &str) {
        self.y += 6.0;
        for line in self.font.wrap(caption, TEXT, self.width - 2.0 * MARGIN, 12) {
            let at = Point::new(MARGIN, self.y + self.font.cap_height(TEXT) + 3.0);
            self.items.push(text(at, &line, TEXT, Anchor::Start, INK));
            self.y += LINE;
        }
    }
}
