//! A circle as a ball-bar shows it: how far a path is from it, magnified about the circle, and unrolled over the angle.
//!
//! Reversals show as spikes where the path crosses an axis, two axes of unlike gain as an ellipse, a lag of the drives as
//! a circle that is too small (ISO 230-4).

use crate::{Axis, Direction, Figure, Line, LineStyle, Marker, Panel, Reference, number, prefix};
use std::f64::consts::{FRAC_PI_4, TAU};

/// The part of the radius that the largest deviation takes, at most.
const ROOM: f64 = 0.4;
/// Rings on each side of the circle, at most.
const RINGS: f64 = 3.0;
/// Points of a drawn circle.
const POINTS: u32 = 360;
/// The grey of the palette.
const GREY: usize = 7;

/// The path `x`, `y` in m about the origin, beside the circle of `radius` m: magnified above, over the angle below.
///
/// The magnification is 1, 2 or 5 times a power of ten, as large as there is room for.
#[must_use]
pub fn circle_plot(title: impl Into<String>, x: &[f64], y: &[f64], radius: f64) -> Figure {
    let deviations: Vec<f64> = x.iter().zip(y).map(|(x, y)| x.hypot(*y) - radius).collect();
    let largest = deviations
        .iter()
        .filter(|deviation| deviation.is_finite())
        .fold(0.0, |most: f64, deviation| most.max(deviation.abs()));
    let magnification = if largest > 0.0 {
        round_below(ROOM * radius / largest).max(1.0)
    } else {
        1.0
    };
    let mut panel = magnified(x, y, &deviations, radius, magnification);
    // The next larger of 1, 2 and 5: so few rings.
    let step = 1.0 / round_below(RINGS / largest.max(1e-12));
    rings(&mut panel, radius, magnification, (step, largest));
    let caption = format!(
        "The deviation from the circle is magnified {} times; rings are {} apart.",
        number::significant(magnification, 3),
        length(step),
    );
    Figure {
        width: 460.0,
        ..Figure::new(vec![panel, unrolled(x, y, &deviations)])
            .with_title(title)
            .with_caption(caption)
    }
}

fn magnified(x: &[f64], y: &[f64], deviations: &[f64], radius: f64, magnification: f64) -> Panel {
    let shown = |along: &[f64]| {
        let pairs = along.iter().zip(x.iter().zip(y)).zip(deviations);
        pairs
            .map(|((along, (x, y)), deviation)| {
                along / x.hypot(*y) * (radius + magnification * deviation)
            })
            .collect()
    };
    let path = Line::new("path", shown(x), shown(y)).with_colour(0);
    let lines = vec![circle(radius, "circle", LineStyle::Solid), path];
    let span = 1.05 * (1.0 + ROOM) * radius;
    let axis = |label: &str| Axis::scaled(label, "m", &[radius]).with_range(-span, span);
    let centre = |direction| Reference {
        direction,
        at: 0.0,
        label: String::new(),
    };
    Panel {
        references: vec![centre(Direction::Vertical), centre(Direction::Horizontal)],
        height: Some(390.0),
        equal_scales: true,
        ..Panel::new(axis("x"), axis("y"), lines)
    }
}

/// Dashed rings every `step` of deviation out to the largest one, the outermost and the innermost with labels.
fn rings(panel: &mut Panel, radius: f64, magnification: f64, (step, largest): (f64, f64)) {
    let most = (largest / step * (1.0 - 1e-9)).ceil() as i32;
    for number in (-most..=most).filter(|number| *number != 0) {
        let deviation = f64::from(number) * step;
        let shown = radius + magnification * deviation;
        if shown <= 0.0 || shown > (1.0 + 1.3 * ROOM) * radius {
            continue;
        }
        panel.lines.insert(0, circle(shown, "", LineStyle::Dashed));
        if number.abs() != most {
            continue;
        }
        let at = shown * FRAC_PI_4.cos();
        let sign = if number > 0 { "+" } else { "−" };
        panel.markers.push(Marker {
            x: at,
            y: at,
            label: format!("{sign}{}", length(deviation.abs())),
        });
    }
}

fn circle(radius: f64, label: &str, style: LineStyle) -> Line {
    let angle = |k: u32| TAU * f64::from(k) / f64::from(POINTS);
    let x = (0..=POINTS).map(|k| radius * angle(k).cos()).collect();
    let y = (0..=POINTS).map(|k| radius * angle(k).sin()).collect();
    Line::new(label, x, y).with_style(style).with_colour(GREY)
}

/// The deviation over the angle from the x axis, anticlockwise, in degrees; several turns lie over each other.
fn unrolled(x: &[f64], y: &[f64], deviations: &[f64]) -> Panel {
    let angle = x
        .iter()
        .zip(y)
        .map(|(x, y)| y.atan2(*x).rem_euclid(TAU).to_degrees());
    let (mut angles, mut shown) = (Vec::new(), Vec::new());
    for (angle, deviation) in angle.zip(deviations) {
        if let Some(before) = angles.last()
            && f64::abs(angle - before) > 180.0
        {
            // Where a turn begins anew, nothing joins the ends.
            angles.push(angle);
            shown.push(f64::NAN);
        }
        angles.push(angle);
        shown.push(*deviation);
    }
    let y = Axis::scaled("deviation", "m", &shown);
    let x = Axis::new("angle", "°").with_scale(crate::Scale::Degrees);
    Panel {
        height: Some(110.0),
        ..Panel::new(
            x.with_range(0.0, 360.0),
            y,
            vec![Line::new("", angles, shown)],
        )
    }
}

/// The largest of 1, 2 and 5 times a power of ten that is not above `value`.
fn round_below(value: f64) -> f64 {
    let decade = 10f64.powf(value.log10().floor());
    // What is a power of ten up to rounding is that.
    let part = value / decade * (1.0 + 1e-9);
    let step = if part >= 10.0 {
        10.0
    } else if part >= 5.0 {
        5.0
    } else if part >= 2.0 {
        2.0
    } else {
        1.0
    };
    step * decade
}

fn length(metres: f64) -> String {
    let (unit, factor) = prefix::shown_unit("m", metres);
    format!("{} {unit}", number::significant(metres * factor, 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn path(radius: f64, bump: f64) -> Figure {
        let angles: Vec<f64> = (0..2000).map(|k| TAU * f64::from(k) / 2000.0).collect();
        let r = |angle: f64| radius + bump * (4.0 * angle).cos();
        let x: Vec<f64> = angles.iter().map(|&a| r(a) * a.cos()).collect();
        let y: Vec<f64> = angles.iter().map(|&a| r(a) * a.sin()).collect();
        circle_plot("", &x, &y, radius)
    }

    #[test]
    fn the_deviation_is_magnified_about_the_circle() {
        let figure = path(0.05, 30e-6);
        // 0.4*50 mm over 30 um are 667: 500
        let path = figure.panels[0].lines.last().unwrap();
        let r = |k: usize| path.x[k].hypot(path.y[k]);
        // Rounding of one hypot at a magnification of 500 on 50 mm.
        assert!((r(0) - (0.05 + 500.0 * 30e-6)).abs() < 1e-12);
        assert!((r(250) - (0.05 - 500.0 * 30e-6)).abs() < 1e-12);
        assert!(
            figure
                .caption
                .unwrap()
                .contains("500 times; rings are 10 µm apart")
        );
    }

    #[test]
    fn rings_reach_the_largest_deviation_on_both_sides() {
        let panel = path(0.05, 30e-6).panels.swap_remove(0);
        let labels: Vec<&str> = panel.markers.iter().map(|m| m.label.as_str()).collect();
        assert_eq!(labels, ["−30 µm", "+30 µm"]);
        let rings = panel
            .lines
            .iter()
            .filter(|line| line.style == LineStyle::Dashed);
        assert_eq!(rings.count(), 6);
    }

    #[test]
    fn a_turn_unrolled_has_no_line_back() {
        let line = &path(0.05, 30e-6).panels[1].lines[0];
        let joined = line.points().collect::<Vec<_>>();
        let far = |pair: &[(f64, f64)]| {
            (pair[1].0 - pair[0].0).abs() > 180.0 && pair.iter().all(|(_, d)| d.is_finite())
        };
        assert!(!joined.windows(2).any(far));
    }

    #[test]
    fn a_perfect_circle_is_drawn_as_it_is() {
        let figure = path(0.05, 0.0);
        let line = figure.panels[0].lines.last().unwrap();
        assert!((line.x[0] - 0.05).abs() < 1e-12); // rounding only
    }
}
