//! The lines of a diagram: connections from box to box, or along the bar of a joint; signals with an arrow. What does not go
//! to the next column runs in a lane of its own below all boxes, and up and down between the columns.

use super::{Diagram, GAP, INK, Layers, ROW, SIGNAL};
use crate::draw::{Fill, Item, Point, Rect, Stroke};

/// From one line to the next where they run side by side, and the length of an arrow.
const APART: f64 = 5.0;
const ARROW: f64 = 7.0;

const CONNECTION: f64 = 2.2;
const THIN: f64 = 1.2;

/// Draws all lines; returns how far down anything reaches.
pub(super) fn routes(
    diagram: &Diagram,
    layers: &Layers,
    places: &[Rect],
    items: &mut Vec<Item>,
) -> f64 {
    let bottom = places.iter().map(|area| area.bottom).fold(0.0, f64::max);
    let mut router = Router {
        layers,
        places,
        lanes: 0,
        below: bottom + 0.25 * ROW,
        beside: vec![0; places.len()],
        items,
    };
    for (joint, node) in diagram.joints.iter().zip(&layers.joints) {
        match node {
            Some(node) => router.joint(joint, *node),
            None => joint
                .windows(2)
                .for_each(|pair| router.link(pair[0], pair[1], Kind::Connection)),
        }
    }
    for &(from, to) in &diagram.signals {
        router.link(from, to, Kind::Signal);
    }
    match router.lanes {
        0 => bottom,
        lanes => router.below + lanes as f64 * APART,
    }
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Connection,
    Signal,
}

struct Router<'a> {
    layers: &'a Layers,
    places: &'a [Rect],
    lanes: usize,
    /// Where the first lane runs.
    below: f64,
    /// Lines so far that run up or down beside a node.
    beside: Vec<usize>,
    items: &'a mut Vec<Item>,
}

impl Router<'_> {
    /// The parts that meet at a joint: a bar, and a line from it to each.
    fn joint(&mut self, parts: &[usize], node: usize) {
        let x = self.places[node].left;
        let mut ends = vec![middle(self.places[node])];
        for &part in parts {
            let (area, own, joint) = (
                self.places[part],
                self.layers.columns[part],
                self.layers.columns[node],
            );
            let y = middle(area);
            if own + 1 == joint {
                self.line(
                    vec![Point::new(area.right, y), Point::new(x, y)],
                    Kind::Connection,
                );
                ends.push(y);
            } else if own == joint + 1 {
                self.line(
                    vec![Point::new(x, y), Point::new(area.left, y)],
                    Kind::Connection,
                );
                ends.push(y);
            } else {
                self.detour(part, node, Kind::Connection);
            }
        }
        let (top, end) = ends.iter().fold((f64::MAX, f64::MIN), |(top, end), &y| {
            (top.min(y), end.max(y))
        });
        self.line(
            vec![Point::new(x, top), Point::new(x, end)],
            Kind::Connection,
        );
        let dots = Item::Dots {
            centres: vec![Point::new(x, ends[0])],
            radius: 3.0,
            fill: Fill::solid(INK),
        };
        self.items.push(dots);
    }

    /// A line from one part to another.
    fn link(&mut self, from: usize, to: usize, kind: Kind) {
        let (mut a, mut b) = (from, to);
        if kind == Kind::Connection && self.layers.columns[a] > self.layers.columns[b] {
            (a, b) = (b, a);
        }
        if self.layers.columns[a] + 2 != self.layers.columns[b] {
            self.detour(a, b, kind);
            return;
        }
        let (start, end) = (self.places[a], self.places[b]);
        // Beside the bar of a joint that the part has as well.
        let lift = match self.meets_joint(a) {
            true => 2.0 * APART,
            false => 0.0,
        };
        let (y, to_y) = (middle(start) - lift, middle(end) - lift);
        let x = end.left - 0.5 * GAP + self.side(b);
        let bend = [Point::new(x, y), Point::new(x, to_y)];
        let mut points = vec![Point::new(start.right, y)];
        points.extend(bend.into_iter().filter(|_| (y - to_y).abs() > 0.5));
        points.push(Point::new(end.left, to_y));
        self.line(points, kind);
    }

    /// Whether a joint stands right of a part, at its height.
    fn meets_joint(&self, part: usize) -> bool {
        let (columns, rows) = (&self.layers.columns, &self.layers.rows);
        let mut joints = self.layers.joints.iter().flatten();
        joints.any(|&node| columns[node] == columns[part] + 1 && rows[node] == rows[part])
    }

    /// A line through a lane below.
    fn detour(&mut self, from: usize, to: usize, kind: Kind) {
        let (start, end) = (self.places[from], self.places[to]);
        let lane = self.below + self.lanes as f64 * APART;
        self.lanes += 1;
        let out = start.right + 0.25 * GAP + self.side(from).abs();
        let back = end.left - 0.3 * GAP - self.side(to).abs();
        let (y, to_y) = (middle(start) + APART, middle(end) + APART);
        self.line(
            vec![
                Point::new(start.right, y),
                Point::new(out, y),
                Point::new(out, lane),
                Point::new(back, lane),
                Point::new(back, to_y),
                Point::new(end.left, to_y),
            ],
            kind,
        );
    }

    /// Each further line beside a node stands a little apart.
    fn side(&mut self, node: usize) -> f64 {
        let count = &mut self.beside[node];
        *count += 1;
        (*count - 1) as f64 * APART
    }

    fn line(&mut self, points: Vec<Point>, kind: Kind) {
        let (colour, width) = match kind {
            Kind::Connection => (INK, CONNECTION),
            Kind::Signal => (SIGNAL, THIN),
        };
        if let (Kind::Signal, Some(tip)) = (kind, points.last().copied()) {
            let arrow = [(0.0, 0.0), (-ARROW, -0.4 * ARROW), (-ARROW, 0.4 * ARROW)];
            self.items.push(Item::Polygon {
                points: arrow.map(|(dx, dy)| tip.shifted(dx, dy)).to_vec(),
                fill: Fill::solid(colour),
            });
        }
        let stroke = Stroke::solid(colour, width);
        self.items.push(Item::Polyline { points, stroke });
    }
}

fn middle(area: Rect) -> f64 {
    0.5 * (area.top + area.bottom)
}
