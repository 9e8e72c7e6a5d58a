//! One quantity over another: friction over velocity, hysteresis, contours.

use crate::{Axis, Figure, Line, Panel};

/// `lines` between two axes, each given as label and SI unit.
///
/// Axes of one unit get one prefix. Where they are to have one scale as well (contour and circle tests), set
/// [`Panel::equal_scales`] of the panel.
#[must_use]
pub fn xy_plot(
    title: impl Into<String>,
    x: (&str, &str),
    y: (&str, &str),
    lines: Vec<Line>,
) -> Figure {
    let xs: Vec<f64> = lines
        .iter()
        .flat_map(|line| line.x.iter().copied())
        .collect();
    let ys: Vec<f64> = lines
        .iter()
        .flat_map(|line| line.y.iter().copied())
        .collect();
    let one_unit = x.1 == y.1;
    let axis = |(label, unit): (&str, &str), own: &[f64], other: &[f64]| {
        let other = if one_unit { other } else { &[] };
        Axis::scaled_for(label, unit, own.iter().chain(other).copied())
    };
    let (x, y) = (axis(x, &xs, &ys), axis(y, &ys, &xs));
    Figure {
        width: 460.0,
        panel_height: 290.0,
        ..Figure::new(vec![Panel::new(x, y, lines)]).with_title(title)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_of_one_unit_share_their_prefix() {
        let lines = || vec![Line::new("", vec![0.0, 0.02], vec![0.0, 3e-6])];
        let contour = xy_plot("", ("x", "m"), ("y", "m"), lines());
        assert_eq!(
            (
                contour.panels[0].x.unit.as_str(),
                contour.panels[0].y.unit.as_str()
            ),
            ("mm", "mm")
        );
        let friction = xy_plot("", ("v", "m/s"), ("x", "m"), lines());
        assert_eq!(
            (
                friction.panels[0].x.unit.as_str(),
                friction.panels[0].y.unit.as_str()
            ),
            ("mm/s", "µm")
        );
    }
}
