//! From a figure to the list of strokes, areas and texts that both writers draw.
//!
//! Coordinates are CSS pixels from the top left corner, y downwards.

mod clip;
mod columns;
mod drawing;
mod flow;
mod font;
mod geometry;
mod layout;
mod legend;
mod note;
mod palette;
mod panel;
mod range;
mod shown_axis;
mod sizes;
mod strip;
mod thin;
mod ticks;
mod tints;
mod trace;

pub(crate) use drawing::{Anchor, Drawing, Fill, Item, Stroke, Text};
pub(crate) use font::Font;
pub(crate) use geometry::{Point, Rect};
pub(crate) use layout::draw;
pub(crate) use palette::Colour;
