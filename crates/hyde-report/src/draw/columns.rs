//! The axes of every panel: their ranges and ticks, and where all frames begin and end.

use super::font::Font;
use super::range::Room;
use super::shown_axis::ShownAxis;
use super::sizes::{GAP, LINE, MARGIN, TEXT, TICK};
use super::strip::label_room;
use crate::{Figure, Panel, Scale};

/// The axes of each panel (x and y, with ticks), and where all frames begin and end.
pub(crate) struct Columns {
    pub(crate) axes: Vec<(ShownAxis, ShownAxis)>,
    /// Height of each frame.
    pub(crate) heights: Vec<f64>,
    pub(crate) left: f64,
    pub(crate) right: f64,
}

impl Columns {
    /// Settles the axes of a figure `width` px wide.
    pub(crate) fn new(figure: &Figure, width: f64, font: &Font) -> Self {
        let heights: Vec<f64> = figure
            .panels
            .iter()
            .map(|panel| height(panel, figure))
            .collect();
        let mut axes = ranges(figure);
        for ((_, y), height) in axes.iter_mut().zip(&heights) {
            divide_y(y, *height);
        }
        let left = left_margin(figure, &axes, &heights, width, font);
        let mut right = width - MARGIN;
        // The last label of an x axis may reach over the frame by half its width.
        for (x, _) in &mut axes {
            divide_x(x, right - left, font);
            let half = x
                .ticks
                .labels
                .last()
                .map_or(0.0, |label| 0.5 * font.width(label, TEXT));
            right = right.min(width - 2.0 - half);
        }
        // On the middle of a pixel, so that frames are sharp on a screen too.
        let right = right.floor() - 0.5;
        for (((x, y), panel), height) in axes.iter_mut().zip(&figure.panels).zip(&heights) {
            let comparable = panel.equal_scales && x.scale != Scale::Log && y.scale != Scale::Log;
            if comparable {
                equalize(x, y, right - left, *height);
                divide_y(y, *height);
            }
            divide_x(x, right - left, font);
            if comparable {
                divide_alike(x, y, right - left, font);
            }
        }
        Self {
            axes,
            heights,
            left,
            right,
        }
    }
}

/// The title of a y axis in as many lines as the height needs.
pub(crate) fn title_lines(axis: &ShownAxis, height: f64, font: &Font) -> Vec<String> {
    font.wrap(&axis.title(), TEXT, height + 8.0, 3)
}

fn height(panel: &Panel, figure: &Figure) -> f64 {
    let asked = panel.height.unwrap_or(figure.panel_height);
    if asked.is_nan() {
        150.0
    } else {
        asked.clamp(60.0, 4000.0).round()
    }
}

/// The range of every axis; a shared x axis spans the data of all panels.
fn ranges(figure: &Figure) -> Vec<(ShownAxis, ShownAxis)> {
    let settle = |panel: &Panel| {
        let seen = if figure.shared_x {
            figure.panels.as_slice()
        } else {
            std::slice::from_ref(panel)
        };
        let xs = seen
            .iter()
            .flat_map(|panel| &panel.lines)
            .flat_map(|line| line.points().map(|(x, _)| x));
        let ys = panel
            .lines
            .iter()
            .flat_map(|line| line.points().map(|(_, y)| y));
        let room = if panel.equal_scales {
            Room::Padded
        } else {
            Room::Tight
        };
        (
            ShownAxis::new(&panel.x, xs, room),
            ShownAxis::new(&panel.y, ys, Room::Padded),
        )
    };
    figure.panels.iter().map(settle).collect()
}

/// Room for titles and tick labels of the widest y axis, and for the row labels of the strip.
fn left_margin(
    figure: &Figure,
    axes: &[(ShownAxis, ShownAxis)],
    heights: &[f64],
    width: f64,
    font: &Font,
) -> f64 {
    let of_axis = |((_, axis), height): (&(ShownAxis, ShownAxis), &f64)| {
        let lines = title_lines(axis, *height, font).len() as f64;
        lines * LINE + widest_label(axis, font) + TICK + GAP + 3.0
    };
    let axes = axes.iter().zip(heights).map(of_axis).fold(0.0, f64::max);
    let strip = figure
        .events
        .as_ref()
        .map_or(0.0, |strip| label_room(strip, 0.22 * width, font));
    (MARGIN + axes.max(strip)).min(0.5 * width).round() + 0.5
}

/// A tick for every 28 px; one for every 20 px of degrees, whose steps are coarse.
fn divide_y(axis: &mut ShownAxis, height: f64) {
    let apart = if axis.scale == Scale::Degrees {
        20.0
    } else {
        28.0
    };
    axis.divide((height / apart) as usize);
}

/// As many ticks as have room for their labels.
fn divide_x(axis: &mut ShownAxis, width: f64, font: &Font) {
    let most = ((width / 50.0) as usize).clamp(2, 12);
    for at_most in (2..=most).rev() {
        axis.divide(at_most);
        if labels_have_room(axis, width, font) {
            return;
        }
    }
}

/// The step of the y axis along x too, if its labels have room.
fn divide_alike(x: &mut ShownAxis, y: &ShownAxis, width: f64, font: &Font) {
    let [first, second, ..] = y.ticks.major[..] else {
        return;
    };
    let before = x.ticks.clone();
    x.divide(((x.hi - x.lo) / (second - first)).ceil() as usize);
    if !labels_have_room(x, width, font) {
        x.ticks = before;
    }
}

fn labels_have_room(axis: &ShownAxis, width: f64, font: &Font) -> bool {
    let widest = widest_label(axis, font);
    let places: Vec<f64> = axis
        .ticks
        .major
        .iter()
        .map(|value| axis.fraction(*value) * width)
        .collect();
    places
        .windows(2)
        .all(|pair| pair[1] - pair[0] >= widest + 12.0)
}

fn widest_label(axis: &ShownAxis, font: &Font) -> f64 {
    axis.ticks
        .labels
        .iter()
        .map(|label| font.width(label, TEXT))
        .fold(0.0, f64::max)
}

/// Widens one range so that a unit shown is as long on both axes.
fn equalize(x: &mut ShownAxis, y: &mut ShownAxis, width: f64, height: f64) {
    let (per_x, per_y) = ((x.hi - x.lo) / width, (y.hi - y.lo) / height);
    let widen = |axis: &mut ShownAxis, span: f64| {
        let middle = 0.5 * (axis.lo + axis.hi);
        (axis.lo, axis.hi) = (middle - 0.5 * span, middle + 0.5 * span);
    };
    if per_x < per_y {
        widen(x, per_y * width)
    } else {
        widen(y, per_x * height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Line, time_panel, time_plot, xy_plot};

    #[test]
    fn a_shared_axis_spans_all_panels() {
        let line = |to: f64| vec![Line::new("", vec![0.0, to], vec![0.0, 1.0])];
        let figure = time_plot(
            "",
            vec![
                time_panel("a", "m", line(1.0)),
                time_panel("b", "A", line(2.0)),
            ],
            None,
        );
        let columns = Columns::new(&figure, 640.0, &Font::new());
        let range = |place: usize| (columns.axes[place].0.lo, columns.axes[place].0.hi);
        assert_eq!((range(0), range(1)), ((0.0, 2.0), (0.0, 2.0)));
    }

    #[test]
    fn equal_scales_are_equal_and_have_equal_steps() {
        let lines = vec![Line::new("", vec![-0.05, 0.05], vec![-0.05, 0.05])];
        let mut figure = xy_plot("", ("x", "m"), ("y", "m"), lines);
        figure.panels[0].equal_scales = true;
        let columns = Columns::new(&figure, 460.0, &Font::new());
        let (x, y) = &columns.axes[0];
        let per_px = (
            (x.hi - x.lo) / (columns.right - columns.left),
            (y.hi - y.lo) / columns.heights[0],
        );
        assert!((per_px.0 / per_px.1 - 1.0).abs() < 1e-12); // rounding only
        let step = |axis: &ShownAxis| axis.ticks.major[1] - axis.ticks.major[0];
        assert!((step(x) - step(y)).abs() < 1e-9); // rounding only
    }

    #[test]
    fn labels_of_x_never_touch() {
        let font = Font::new();
        for end in [1e-9, 0.02, 1.0, 1234.5678, 99_999.0, 1e7] {
            for width in [240.0, 460.0, 640.0, 1400.0] {
                let lines = vec![Line::new("", vec![0.7 * end, end], vec![0.0, 1.0])];
                let columns = Columns::new(&xy_plot("", ("x", ""), ("y", ""), lines), width, &font);
                let axis = &columns.axes[0].0;
                assert!(
                    labels_have_room(axis, columns.right - columns.left, &font),
                    "{end} {width}"
                );
            }
        }
    }
}
