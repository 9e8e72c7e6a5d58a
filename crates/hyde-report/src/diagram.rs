//! A picture of components and their connections, laid out in columns from the commands to the load.

mod layers;
mod routes;

use crate::draw::{Anchor, Colour, Drawing, Fill, Font, Item, Point, Rect, Stroke, Text};
use crate::svg;
use layers::{Layers, layers};
use routes::routes;

/// Components, what is connected, and what is read. Numbers are places in `parts`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagram {
    /// The components.
    pub parts: Vec<DiagramPart>,
    /// Connections: the parts that meet at one.
    pub joints: Vec<Vec<usize>>,
    /// Signals: which part is read, and which reads it.
    pub signals: Vec<(usize, usize)>,
}

/// A component of a [`Diagram`].
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DiagramPart {
    /// Its name.
    pub name: String,
    /// Its class; an input of the model has none.
    pub class: String,
}

/// Height of a box and from one to the next, room beside a text, and from one column to the next, in px.
const BOX: f64 = 36.0;
const ROW: f64 = 50.0;
const PADDING: f64 = 9.0;
const GAP: f64 = 36.0;
/// From the bar of a joint to the next where both reach as far up and down.
const BAR: f64 = 12.0;
/// Around the whole.
const MARGIN: f64 = 10.0;
/// Sizes of the texts.
const NAME: f64 = 12.0;
const CLASS: f64 = 10.0;

const INK: Colour = Colour(26, 26, 26);
const PALE: Colour = Colour(95, 95, 95);
const SIGNAL: Colour = Colour(0, 68, 136);
const PART: Colour = Colour(242, 242, 242);
const INPUT: Colour = Colour(244, 238, 196);

impl Diagram {
    /// The picture as an SVG document, and its width in px.
    pub(crate) fn to_svg(&self) -> (String, f64) {
        let drawing = self.drawing();
        (svg::written(&drawing, "topology"), drawing.width)
    }

    /// What the lines mean.
    pub(crate) fn caption(&self) -> String {
        let mut parts = Vec::new();
        if !self.joints.is_empty() {
            parts.push("thick lines are connections");
        }
        if !self.signals.is_empty() {
            parts.push("arrows are signals, from what is read to what reads it");
        }
        let text = parts.join(", ");
        let mut letters = text.chars();
        letters.next().map_or(String::new(), |first| {
            format!("{}{}.", first.to_uppercase(), letters.as_str())
        })
    }

    fn drawing(&self) -> Drawing {
        let font = Font::new();
        let layers = layers(self);
        let places = self.places(&layers, &font);
        let mut items = Vec::new();
        let bottom = routes(self, &layers, &places, &mut items);
        for (part, area) in self.parts.iter().zip(&places) {
            draw_part(part, *area, &mut items);
        }
        let right = places.iter().map(|area| area.right).fold(0.0, f64::max);
        Drawing {
            width: (right + GAP + MARGIN).ceil(),
            height: (bottom + MARGIN).ceil(),
            items,
        }
    }

    /// Where the boxes stand, those of the joints, which are points, behind those of the parts.
    fn places(&self, layers: &Layers, font: &Font) -> Vec<Rect> {
        let width = |node: usize| match self.parts.get(node) {
            Some(part) => {
                let text = font
                    .width(&part.name, NAME)
                    .max(font.width(&part.class, CLASS));
                (text + 2.0 * PADDING).ceil()
            }
            None => 0.0,
        };
        let columns = layers
            .columns
            .iter()
            .copied()
            .max()
            .map_or(0, |last| last + 1);
        let mut left = MARGIN + GAP;
        let mut places = vec![Rect::at(0.0, 0.0, 0.0, 0.0); layers.columns.len()];
        for column in 0..columns {
            let own = || (0..layers.columns.len()).filter(|&node| layers.columns[node] == column);
            let widest = own().map(width).fold(0.0, f64::max);
            if own().next().is_none() {
                continue; // No joint stands between these columns of parts.
            }
            let bars = own().map(|node| layers.bars[node]).max().unwrap_or(0) as f64 * BAR;
            for node in own() {
                let is_part = node < self.parts.len();
                let wide = if is_part { widest } else { 0.0 };
                let top = MARGIN + layers.rows[node] as f64 * ROW;
                let aside = layers.bars[node] as f64 * BAR;
                places[node] = Rect::at(left + aside, top, wide, BOX);
            }
            left += widest + bars + GAP;
        }
        places
    }
}

fn draw_part(part: &DiagramPart, area: Rect, items: &mut Vec<Item>) {
    let is_input = part.class.is_empty();
    let fill = Fill::solid(if is_input { INPUT } else { PART });
    items.push(Item::Area { area, fill });
    let corners = [
        Point::new(area.left, area.top),
        Point::new(area.right, area.top),
        Point::new(area.right, area.bottom),
        Point::new(area.left, area.bottom),
        Point::new(area.left, area.top),
    ];
    items.push(Item::Polyline {
        points: corners.to_vec(),
        stroke: Stroke::solid(PALE, 1.0),
    });
    let middle = 0.5 * (area.left + area.right);
    let mut text = |text: &str, below: f64, size: f64, colour: Colour| {
        items.push(Item::Text(Text {
            at: Point::new(middle, area.top + below),
            text: text.to_owned(),
            size,
            anchor: Anchor::Middle,
            upright: false,
            colour,
        }));
    };
    match is_input {
        true => text(&part.name, 22.0, NAME, INK),
        false => {
            text(&part.name, 15.5, NAME, INK);
            text(&part.class, 29.0, CLASS, PALE);
        }
    }
}

#[cfg(test)]
mod tests;
