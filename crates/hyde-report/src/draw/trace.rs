//! A line of data as strokes and dots in the panel: scaled, cut at the frame, thinned.

use super::clip::{clip_polyline, clip_segment};
use super::geometry::{Point, Rect};
use super::shown_axis::ShownAxis;
use super::thin::{thin_dots, thin_lines};
use crate::{Line, LineStyle};

/// What is drawn of a line, in px from the top left corner of the panel.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Trace {
    pub(crate) strokes: Vec<Vec<Point>>,
    /// Single values, each with its weight from 0 to 1.
    pub(crate) dots: Vec<(Point, f64)>,
}

/// The trace of `line` in a panel of `width` × `height` px.
pub(crate) fn trace(line: &Line, x: &ShownAxis, y: &ShownAxis, width: f64, height: f64) -> Trace {
    let place = |(at, value): (f64, f64)| {
        Point::new(
            x.fraction(at * x.factor) * width,
            (1.0 - y.fraction(value * y.factor)) * height,
        )
    };
    let area = Rect::at(0.0, 0.0, width, height);
    let points = line.points().map(place);
    match line.style {
        LineStyle::Solid | LineStyle::Dashed => stroked(points, &area),
        LineStyle::Steps => stroked(staircase(points), &area),
        LineStyle::Points | LineStyle::Rings | LineStyle::Discs => Trace {
            strokes: Vec::new(),
            dots: dotted(points, line.weight.as_deref(), &area),
        },
    }
}

/// How much of the traces a box would cover: length of line in px, a dot counting as 3.
pub(crate) fn covered(traces: &[Trace], place: &Rect) -> f64 {
    let length = |pair: &[Point]| {
        clip_segment(pair[0], pair[1], place).map_or(0.0, |(from, to)| from.distance(to) + 1e-9)
    };
    let of_stroke = |stroke: &Vec<Point>| stroke.windows(2).map(length).sum::<f64>();
    let of_trace = |trace: &Trace| {
        let dots = trace
            .dots
            .iter()
            .filter(|(at, _)| place.contains(*at))
            .count();
        trace.strokes.iter().map(of_stroke).sum::<f64>() + 3.0 * dots as f64
    };
    traces.iter().map(of_trace).sum()
}

fn stroked(points: impl Iterator<Item = Point>, area: &Rect) -> Trace {
    let (alone, joined): (Vec<_>, Vec<_>) = clip_polyline(points, area)
        .into_iter()
        .partition(|part| part.len() < 2);
    let dots: Vec<_> = alone.concat().into_iter().map(|at| (at, 1.0)).collect();
    Trace {
        strokes: thin_lines(joined),
        dots: thin_dots(&dots),
    }
}

/// Each value held until the next abscissa.
fn staircase(points: impl Iterator<Item = Point>) -> impl Iterator<Item = Point> {
    let mut held = f64::NAN;
    points.flat_map(move |point| {
        let corner = Point::new(point.x, held);
        // The first value, and one after a gap, has no step before it.
        let step = if held.is_nan() { None } else { Some(corner) };
        held = point.y;
        step.into_iter().chain(std::iter::once(point))
    })
}

fn dotted(
    points: impl Iterator<Item = Point>,
    weights: Option<&[f64]>,
    area: &Rect,
) -> Vec<(Point, f64)> {
    let weight = |index: usize| {
        weights
            .and_then(|weights| weights.get(index))
            .map_or(1.0, |w| w.clamp(0.0, 1.0))
    };
    let dots: Vec<_> = points
        .enumerate()
        .map(|(index, point)| (point, weight(index)))
        .collect();
    let inside: Vec<_> = dots
        .into_iter()
        .filter(|(point, weight)| area.contains(*point) && !weight.is_nan())
        .collect();
    thin_dots(&inside)
}

#[cfg(test)]
mod tests {
    use super::super::range::Room;
    use super::*;
    use crate::Axis;

    fn traced(style: LineStyle, y: &[f64]) -> Trace {
        let x: Vec<f64> = (0..y.len()).map(|k| k as f64).collect();
        let axis = |hi: f64| {
            ShownAxis::new(
                &Axis::new("", "").with_range(0.0, hi),
                std::iter::empty(),
                Room::Tight,
            )
        };
        trace(
            &Line::new("", x, y.to_vec()).with_style(style),
            &axis(10.0),
            &axis(1.0),
            100.0,
            10.0,
        )
    }

    fn corners(points: &[Point]) -> Vec<(f64, f64)> {
        points.iter().map(|point| (point.x, point.y)).collect()
    }

    #[test]
    fn steps_hold_the_value() {
        let steps = traced(LineStyle::Steps, &[0.0, 1.0, 0.5]);
        assert_eq!(
            corners(&steps.strokes[0]),
            [
                (0.0, 10.0),
                (10.0, 10.0),
                (10.0, 0.0),
                (20.0, 0.0),
                (20.0, 5.0)
            ]
        );
    }

    #[test]
    fn gaps_split_and_lone_values_become_dots() {
        let gaps = traced(
            LineStyle::Solid,
            &[0.0, 1.0, f64::NAN, 0.5, f64::INFINITY, 0.0, 1.0],
        );
        assert_eq!(gaps.strokes.len(), 2);
        assert_eq!(gaps.dots, [(Point::new(30.0, 5.0), 1.0)]);
    }

    #[test]
    fn points_outside_the_range_are_left_out() {
        assert_eq!(
            traced(LineStyle::Points, &[0.0, 2.0, f64::NAN, 1.0])
                .dots
                .len(),
            2
        );
    }
}
