//! Texts beside markers and level reference lines, placed where they cover least, and flags of upright ones.

use super::drawing::{Anchor, Fill, Item};
use super::font::Font;
use super::geometry::{Point, Rect};
use super::palette::{INK, WHITE};
use super::panel::text;
use super::shown_axis::ShownAxis;
use super::sizes::{LEADING, REFERENCE_STROKE, SMALL};
use super::trace::{Trace, covered};
use crate::{Direction, Panel};

/// Height of a row of flags.
pub(crate) const FLAG_ROW: f64 = SMALL * LEADING;

/// A text inside the frame, on a white ground, from the top left corner of the panel.
pub(crate) struct Note {
    pub(crate) area: Rect,
    text: String,
}

/// A vertical reference line with its label above the frame, in row 0, 1, … from below.
pub(crate) struct Flag {
    x: f64,
    pub(crate) row: f64,
    left: f64,
    text: String,
}

impl Note {
    pub(crate) fn draw(&self, origin: Point, font: &Font, items: &mut Vec<Item>) {
        let area = self.area.shifted(origin.x, origin.y);
        let fill = Fill {
            colour: WHITE,
            opacity: 0.85,
        };
        items.push(Item::Area { area, fill });
        let middle = 0.5 * (area.top + area.bottom + font.cap_height(SMALL));
        items.push(text(
            Point::new(area.left + 2.0, middle),
            &self.text,
            SMALL,
            Anchor::Start,
            INK,
        ));
    }
}

impl Flag {
    /// The pole, down to the frame.
    pub(crate) fn draw_pole(&self, origin: Point, items: &mut Vec<Item>) {
        let from = origin.shifted(self.x, 1.0 - (self.row + 1.0) * FLAG_ROW);
        items.push(Item::Rule {
            from,
            to: origin.shifted(self.x, 0.0),
            stroke: REFERENCE_STROKE,
        });
    }

    /// The label, right of the pole.
    pub(crate) fn draw_label(&self, origin: Point, items: &mut Vec<Item>) {
        let at = origin.shifted(self.left, -self.row * FLAG_ROW - 0.3 * SMALL);
        items.push(text(at, &self.text, SMALL, Anchor::Start, INK));
    }
}

/// The labels of the markers and level reference lines of a panel of `size` px.
pub(crate) fn notes(
    panel: &Panel,
    (x, y): (&ShownAxis, &ShownAxis),
    traces: &[Trace],
    size: (f64, f64),
    font: &Font,
) -> Vec<Note> {
    let mut notes: Vec<Note> = Vec::new();
    let mut place = |label: &str, corners: &[Point]| {
        let area = |corner: &Point| extent(label, *corner, font);
        let cost = |area: &Rect| {
            let taken = notes.iter().filter(|note| note.area.overlaps(area)).count();
            let out = if inside(area, size) { 0.0 } else { 1e4 };
            covered(traces, area) + 1e3 * taken as f64 + out
        };
        let best = corners
            .iter()
            .map(area)
            .min_by(|a, b| cost(a).total_cmp(&cost(b)));
        notes.extend(best.map(|area| Note {
            area,
            text: label.to_owned(),
        }));
    };
    for marker in panel
        .markers
        .iter()
        .filter(|marker| !marker.label.is_empty())
    {
        if let Some(at) = point(x, y, size, marker.x, marker.y) {
            place(&marker.label, &around(at, extent(&marker.label, at, font)));
        }
    }
    for level in panel
        .references
        .iter()
        .filter(|level| !level.label.is_empty())
    {
        let up = y.fraction(level.at * y.factor);
        if level.direction == Direction::Horizontal && (0.0..=1.0).contains(&up) {
            place(
                &level.label,
                &along(
                    (1.0 - up) * size.1,
                    size.0,
                    extent(&level.label, Point::new(0.0, 0.0), font),
                ),
            );
        }
    }
    notes
}

/// Where a point of the data lies in a panel of `size` px, if it is inside.
pub(crate) fn point(
    x_axis: &ShownAxis,
    y_axis: &ShownAxis,
    size: (f64, f64),
    x: f64,
    y: f64,
) -> Option<Point> {
    let across = x_axis.fraction(x * x_axis.factor);
    let up = y_axis.fraction(y * y_axis.factor);
    let inside = (0.0..=1.0).contains(&across) && (0.0..=1.0).contains(&up);
    inside.then(|| Point::new(across * size.0, (1.0 - up) * size.1))
}

/// Labels of vertical references, from right to left, each in the lowest row with room: a label starts at its pole, so
/// the pole of a higher one passes left of the lower ones.
pub(crate) fn flags(panel: &Panel, x: &ShownAxis, width: f64, font: &Font) -> Vec<Flag> {
    let vertical = panel
        .references
        .iter()
        .filter(|reference| reference.direction == Direction::Vertical);
    let mut wanted: Vec<(f64, &str)> = vertical
        .map(|reference| {
            (
                x.fraction(reference.at * x.factor),
                reference.label.as_str(),
            )
        })
        .filter(|(part, label)| (0.0..=1.0).contains(part) && !label.is_empty())
        .collect();
    wanted.sort_by(|a, b| b.0.total_cmp(&a.0));
    // The left end of what is already in each row.
    let mut rows: Vec<f64> = Vec::new();
    let mut flags = Vec::new();
    for (part, label) in wanted {
        let text = font.shortened(label, SMALL, width);
        let length = font.width(&text, SMALL);
        let pole = part * width;
        // Left of the pole where there is no room at the right.
        let left = if pole + 3.0 + length > width {
            (pole - 3.0 - length).max(0.0)
        } else {
            pole + 3.0
        };
        let row = rows
            .iter()
            .position(|taken| left + length + 4.0 < *taken)
            .unwrap_or(rows.len());
        match rows.get_mut(row) {
            Some(taken) => *taken = left.min(pole),
            None => rows.push(left.min(pole)),
        }
        flags.push(Flag {
            x: pole,
            row: row as f64,
            left,
            text,
        });
    }
    flags
}

/// The box of a label with its top left corner at `corner`.
fn extent(label: &str, corner: Point, font: &Font) -> Rect {
    Rect::at(
        corner.x,
        corner.y,
        font.width(label, SMALL) + 4.0,
        font.cap_height(SMALL) + 5.0,
    )
}

/// Corners of a box of the size of `area` around a marker, in the order tried.
fn around(at: Point, area: Rect) -> Vec<Point> {
    let (width, height) = (area.width(), area.height());
    let (left, right) = (at.x - width - 5.0, at.x + 5.0);
    let (above, level, below) = (at.y - height - 3.0, at.y - 0.5 * height, at.y + 3.0);
    let centre = at.x - 0.5 * width;
    let sides = [
        (right, above),
        (right, below),
        (left, above),
        (left, below),
        (right, level),
        (left, level),
    ];
    let middles = [(centre, above - 3.0), (centre, below + 3.0)];
    sides
        .into_iter()
        .chain(middles)
        .map(|(x, y)| Point::new(x, y))
        .collect()
}

/// Corners of a box of the size of `area` along a level line, in the order tried.
fn along(y: f64, width: f64, area: Rect) -> Vec<Point> {
    let (above, below) = (y - area.height() - 1.0, y + 1.0);
    let right = width - area.width() - 3.0;
    let columns = [1.0, 0.0, 0.75, 0.5, 0.25].map(|part| 3.0 + part * (right - 3.0));
    columns
        .into_iter()
        .flat_map(|x| [Point::new(x, above), Point::new(x, below)])
        .collect()
}

fn inside(area: &Rect, size: (f64, f64)) -> bool {
    area.left >= 0.0 && area.top >= 0.0 && area.right <= size.0 && area.bottom <= size.1
}

#[cfg(test)]
mod tests {
    use super::super::range::Room;
    use super::*;
    use crate::{Axis, Marker, Reference};

    const SIZE: (f64, f64) = (400.0, 150.0);

    fn unit_axis() -> ShownAxis {
        ShownAxis::new(
            &Axis::new("", "").with_range(0.0, 1.0),
            std::iter::empty(),
            Room::Tight,
        )
    }

    fn panel() -> Panel {
        Panel::new(Axis::new("", ""), Axis::new("", ""), Vec::new())
    }

    #[test]
    fn the_label_of_a_marker_keeps_off_the_curve_and_inside_the_frame() {
        let marker = |x, y| Marker {
            x,
            y,
            label: "peak".to_owned(),
        };
        let panel = Panel {
            markers: vec![marker(0.5, 0.5), marker(0.999, 0.5), marker(0.5, 0.999)],
            ..panel()
        };
        let rising = vec![Point::new(0.0, 150.0), Point::new(400.0, 0.0)];
        let traces = [Trace {
            strokes: vec![rising],
            dots: Vec::new(),
        }];
        let axis = unit_axis();
        let notes = notes(&panel, (&axis, &axis), &traces, SIZE, &Font::new());
        assert_eq!(notes.len(), 3);
        for note in &notes {
            assert!(
                covered(&traces, &note.area) <= 0.0 && inside(&note.area, SIZE),
                "{:?}",
                note.area
            );
        }
    }

    #[test]
    fn flags_that_would_touch_are_stacked() {
        let at = |at: f64| Reference {
            direction: Direction::Vertical,
            at,
            label: "resonance".to_owned(),
        };
        let panel = Panel {
            references: [0.1, 0.12, 0.5, 0.99, 1.5].map(at).to_vec(),
            ..panel()
        };
        let flags = flags(&panel, &unit_axis(), SIZE.0, &Font::new());
        let rows: Vec<_> = flags.iter().map(|flag| flag.row as i32).collect();
        assert_eq!(rows, [0, 0, 0, 1]); // from right to left; the one at 1.5 is outside
        assert!(flags[0].left + Font::new().width("resonance", SMALL) < flags[0].x);
    }
}
