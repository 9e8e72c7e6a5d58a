//! Sizes of text and the widths of lines, in CSS pixels (96 to the inch; 1 pt is 4/3 px).

use super::drawing::Stroke;
use super::palette::{AXIS, FINE_GRID, GRID, REFERENCE};

/// Axis titles, tick labels, legend: 8.5 pt.
pub(crate) const TEXT: f64 = 8.5 * 4.0 / 3.0;
/// Labels of reference lines, markers and modes: 7.5 pt.
pub(crate) const SMALL: f64 = 7.5 * 4.0 / 3.0;
/// Titles: 10 pt.
pub(crate) const TITLE: f64 = 10.0 * 4.0 / 3.0;
/// Distance of base lines, in em.
pub(crate) const LEADING: f64 = 1.3;
/// Distance of base lines of [`TEXT`].
pub(crate) const LINE: f64 = TEXT * LEADING;
/// White at the edges of the figure.
pub(crate) const MARGIN: f64 = 8.0;
/// Length of a tick at a label; the others are half as long.
pub(crate) const TICK: f64 = 4.0;
/// Between a tick and its label.
pub(crate) const GAP: f64 = 4.0;
/// Width of a curve: 0.95 pt.
pub(crate) const CURVE: f64 = 1.25;
/// Radius of a dot.
pub(crate) const DOT: f64 = 1.4;
/// Radius of the smallest of five discs; the others are so much larger, one after the other.
pub(crate) const DISC: f64 = 1.6;
/// Outer and inner radius of a ring.
pub(crate) const RING: (f64, f64) = (3.4, 2.4);

pub(crate) const FRAME_STROKE: Stroke = Stroke {
    colour: AXIS,
    width: 0.8,
    dash: &[],
};
pub(crate) const GRID_STROKE: Stroke = Stroke {
    colour: GRID,
    width: 0.6,
    dash: &[],
};
pub(crate) const FINE_GRID_STROKE: Stroke = Stroke {
    colour: FINE_GRID,
    width: 0.6,
    dash: &[],
};
pub(crate) const REFERENCE_STROKE: Stroke = Stroke {
    colour: REFERENCE,
    width: 0.8,
    dash: &[4.0, 3.0],
};
