//! The list of strokes, areas and texts a figure is made of.

use super::geometry::{Point, Rect};
use super::palette::Colour;

/// A laid-out figure: what the writers draw, in this order, on white.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Drawing {
    pub(crate) width: f64,
    pub(crate) height: f64,
    pub(crate) items: Vec<Item>,
}

/// One thing to draw. Curves are cut at the edges of their panel before they come here.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Item {
    /// An open polygon with round joints, and round ends if it is not dashed.
    Polyline { points: Vec<Point>, stroke: Stroke },
    /// Upright or level line of an axis, drawn on whole device pixels so that it stays sharp.
    Rule {
        from: Point,
        to: Point,
        stroke: Stroke,
    },
    /// A filled polygon.
    Polygon { points: Vec<Point>, fill: Fill },
    /// A filled rectangle.
    Area { area: Rect, fill: Fill },
    /// Filled circles.
    Dots {
        centres: Vec<Point>,
        radius: f64,
        fill: Fill,
    },
    /// One line of text.
    Text(Text),
}

/// How a line is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Stroke {
    pub(crate) colour: Colour,
    /// In px.
    pub(crate) width: f64,
    /// Lengths drawn and left out in turn, in px; empty: solid.
    pub(crate) dash: &'static [f64],
}

impl Stroke {
    pub(crate) fn solid(colour: Colour, width: f64) -> Self {
        Self {
            colour,
            width,
            dash: &[],
        }
    }
}

/// How an area is filled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fill {
    pub(crate) colour: Colour,
    /// 0 to 1.
    pub(crate) opacity: f64,
}

impl Fill {
    pub(crate) fn solid(colour: Colour) -> Self {
        Self {
            colour,
            opacity: 1.0,
        }
    }
}

/// One line of text.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Text {
    /// The point on the base line that `anchor` speaks of.
    pub(crate) at: Point,
    pub(crate) text: String,
    /// Height of the em in px.
    pub(crate) size: f64,
    pub(crate) anchor: Anchor,
    /// Reads from bottom to top.
    pub(crate) upright: bool,
    pub(crate) colour: Colour,
}

/// Which part of a text is at its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Anchor {
    Start,
    Middle,
    End,
}
