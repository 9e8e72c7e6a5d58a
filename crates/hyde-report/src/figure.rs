//! What a figure shows: panels one above the other, each with two axes and what is drawn between them.

use crate::{Axis, EventStrip};

/// Panels one above the other, with a title, an event strip and a caption.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Printed above the panels.
    pub title: Option<String>,
    /// From top to bottom.
    pub panels: Vec<Panel>,
    /// Drawn under the last panel, along its x axis.
    pub events: Option<EventStrip>,
    /// The panels have one x axis, labelled at the bottom only.
    pub shared_x: bool,
    /// Width of the whole figure in CSS pixels, 240 to 4000.
    pub width: f64,
    /// Height of a panel between its axes in CSS pixels, 60 to 4000, where the panel has none of its own.
    pub panel_height: f64,
    /// Printed below; in a page it becomes the caption of the figure.
    pub caption: Option<String>,
}

impl Figure {
    /// As wide as the text of an A4 page (169 mm), each panel 40 mm high.
    #[must_use]
    pub fn new(panels: Vec<Panel>) -> Self {
        Self {
            title: None,
            panels,
            events: None,
            shared_x: false,
            width: 640.0,
            panel_height: 150.0,
            caption: None,
        }
    }

    /// The width, within its limits.
    pub(crate) fn shown_width(&self) -> f64 {
        if self.width.is_nan() {
            640.0
        } else {
            self.width.clamp(240.0, 4000.0)
        }
    }

    /// With a title.
    #[must_use]
    pub fn with_title(self, title: impl Into<String>) -> Self {
        Self {
            title: Some(title.into()),
            ..self
        }
    }

    /// With a caption.
    #[must_use]
    pub fn with_caption(self, caption: impl Into<String>) -> Self {
        Self {
            caption: Some(caption.into()),
            ..self
        }
    }
}

/// Two axes and what is drawn between them.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Drawn in this order, each over the ones before.
    pub lines: Vec<Line>,
    /// Shaded spans of x, behind everything.
    pub bands: Vec<Band>,
    /// Shaded areas between two curves, behind the lines.
    pub between: Vec<Between>,
    /// Straight lines across the panel: resonances, limits.
    pub references: Vec<Reference>,
    /// Single points with a text.
    pub markers: Vec<Marker>,
    /// Height between the axes in CSS pixels; `None`: as the figure says.
    pub height: Option<f64>,
    /// One unit shown on x is as long on paper as one on y (contours); one of the ranges is widened for it. Not on log
    /// axes.
    pub equal_scales: bool,
}

impl Panel {
    /// A panel with lines only.
    #[must_use]
    pub fn new(x: Axis, y: Axis, lines: Vec<Line>) -> Self {
        Self {
            x,
            y,
            lines,
            bands: Vec::new(),
            between: Vec::new(),
            references: Vec::new(),
            markers: Vec::new(),
            height: None,
            equal_scales: false,
        }
    }
}

/// A curve or a cloud of points, in SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Named so in the legend; not listed if empty.
    pub label: String,
    /// Abscissae; where the lengths differ, the shorter of `x` and `y` counts.
    pub x: Vec<f64>,
    /// Ordinates; a value that is not finite leaves a gap.
    pub y: Vec<f64>,
    /// How it is drawn.
    pub style: LineStyle,
    /// Index into the palette; `None`: the line's place in the panel.
    pub colour: Option<usize>,
    /// Weight of each point from 0 (faded) to 1, for [`LineStyle::Points`], [`LineStyle::Rings`] and [`LineStyle::Discs`]: the coherence of a measured response.
    pub weight: Option<Vec<f64>>,
}

impl Line {
    /// A solid line.
    #[must_use]
    pub fn new(label: impl Into<String>, x: Vec<f64>, y: Vec<f64>) -> Self {
        Self {
            label: label.into(),
            x,
            y,
            style: LineStyle::Solid,
            colour: None,
            weight: None,
        }
    }

    /// The same data in another style.
    #[must_use]
    pub fn with_style(self, style: LineStyle) -> Self {
        Self { style, ..self }
    }

    /// The same data in the colour `index` of the palette.
    #[must_use]
    pub fn with_colour(self, index: usize) -> Self {
        Self {
            colour: Some(index),
            ..self
        }
    }

    pub(crate) fn points(&self) -> impl Iterator<Item = (f64, f64)> {
        self.x.iter().copied().zip(self.y.iter().copied())
    }
}

/// How a [`Line`] is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineStyle {
    /// Joined by a solid line.
    Solid,
    /// Joined by a dashed line.
    Dashed,
    /// One dot for each value.
    Points,
    /// One ring for each value, where they are few and single.
    Rings,
    /// One disc for each value, the larger the larger its weight.
    Discs,
    /// Each value holds until the next abscissa: clocked signals.
    Steps,
}

/// A shaded span of x, such as a stick phase; bands of one label are one entry of the legend.
#[derive(Clone, Debug, PartialEq)]
pub struct Band {
    /// Where it begins, in SI.
    pub from: f64,
    /// Where it ends, in SI.
    pub to: f64,
    /// Named so in the legend; not listed if empty.
    pub label: String,
}

/// What lies between two curves over one x, such as most of many trajectories.
///
/// Axes reach as far as the lines of the panel need, not its areas.
#[derive(Clone, Debug, PartialEq)]
pub struct Between {
    /// Abscissae, rising, in SI; the shortest of the three lists counts.
    pub x: Vec<f64>,
    /// Lower ordinates; a value that is not finite leaves a gap.
    pub low: Vec<f64>,
    /// Upper ordinates.
    pub high: Vec<f64>,
    /// Index into the palette of lines.
    pub colour: usize,
    /// 0 to 1.
    pub opacity: f64,
}

/// A thin dashed line across the panel with its label.
#[derive(Clone, Debug, PartialEq)]
pub struct Reference {
    /// Which way the line runs.
    pub direction: Direction,
    /// Its x (vertical) or y (horizontal), in SI.
    pub at: f64,
    /// Printed at its end; may be empty.
    pub label: String,
}

/// Which way a [`Reference`] runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// At one x: a resonance, an instant.
    Vertical,
    /// At one y: a limit, a resolution.
    Horizontal,
}

/// A point with a text beside it.
#[derive(Clone, Debug, PartialEq)]
pub struct Marker {
    /// Its abscissa, in SI.
    pub x: f64,
    /// Its ordinate, in SI.
    pub y: f64,
    /// Printed beside it; may be empty.
    pub label: String,
}
