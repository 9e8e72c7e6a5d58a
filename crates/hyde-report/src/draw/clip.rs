//! Cuts lines at the edges of a rectangle (Y.-D. Liang and B. A. Barsky, ACM Trans. Graph. 3 (1984) 1–22).

use super::geometry::{Point, Rect};

/// The parts inside `area` of the line through `points`; a point with NaN interrupts the line.
///
/// A part of one point is a value without neighbours.
pub(crate) fn clip_polyline(points: impl Iterator<Item = Point>, area: &Rect) -> Vec<Vec<Point>> {
    let mut parts = Vec::new();
    let mut part: Vec<Point> = Vec::new();
    let mut last: Option<Point> = None;
    for point in points {
        if point.x.is_nan() || point.y.is_nan() {
            finish(&mut part, &mut parts);
            last = None;
            continue;
        }
        match last.map(|from| (from, clip_segment(from, point, area))) {
            None if area.contains(point) => part.push(point),
            None => {}
            Some((_, None)) => finish(&mut part, &mut parts),
            Some((from, Some((enter, leave)))) => {
                if part.is_empty() || from != enter {
                    finish(&mut part, &mut parts);
                    part.push(enter);
                }
                part.push(leave);
                if leave != point {
                    finish(&mut part, &mut parts);
                }
            }
        }
        last = Some(point);
    }
    finish(&mut part, &mut parts);
    parts
}

/// The part of the segment inside `area`.
pub(crate) fn clip_segment(from: Point, to: Point, area: &Rect) -> Option<(Point, Point)> {
    if area.contains(from) && area.contains(to) {
        return Some((from, to));
    }
    let (dx, dy) = (to.x - from.x, to.y - from.y);
    let edges = [
        (-dx, from.x - area.left),
        (dx, area.right - from.x),
        (-dy, from.y - area.top),
        (dy, area.bottom - from.y),
    ];
    let (mut enter, mut leave) = (0.0_f64, 1.0_f64);
    for (run, room) in edges {
        if run < 0.0 {
            enter = enter.max(room / run);
        } else if run > 0.0 {
            leave = leave.min(room / run);
        } else if room < 0.0 {
            return None;
        }
    }
    if enter > leave {
        return None;
    }
    let at = |part: f64| Point::new(from.x + part * dx, from.y + part * dy);
    let start = if enter > 0.0 { at(enter) } else { from };
    let end = if leave < 1.0 { at(leave) } else { to };
    Some((start, end))
}

fn finish(part: &mut Vec<Point>, parts: &mut Vec<Vec<Point>>) {
    if !part.is_empty() {
        parts.push(std::mem::take(part));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const AREA: Rect = Rect {
        left: 0.0,
        top: 0.0,
        right: 10.0,
        bottom: 10.0,
    };

    fn clip(points: &[(f64, f64)]) -> Vec<Vec<(f64, f64)>> {
        let parts = clip_polyline(points.iter().map(|&(x, y)| Point::new(x, y)), &AREA);
        parts
            .into_iter()
            .map(|part| part.into_iter().map(|point| (point.x, point.y)).collect())
            .collect()
    }

    #[test]
    fn a_line_that_leaves_and_comes_back_has_two_parts() {
        let parts = clip(&[(1.0, 5.0), (3.0, 15.0), (5.0, 5.0)]);
        assert_eq!(
            parts,
            [vec![(1.0, 5.0), (2.0, 10.0)], vec![(4.0, 10.0), (5.0, 5.0)]]
        );
    }

    #[test]
    fn nan_interrupts_and_a_lone_value_stays() {
        let parts = clip(&[
            (1.0, 1.0),
            (2.0, 2.0),
            (f64::NAN, 3.0),
            (4.0, 4.0),
            (5.0, f64::NAN),
            (6.0, 6.0),
            (7.0, 7.0),
        ]);
        assert_eq!(
            parts,
            [
                vec![(1.0, 1.0), (2.0, 2.0)],
                vec![(4.0, 4.0)],
                vec![(6.0, 6.0), (7.0, 7.0)]
            ]
        );
    }

    #[test]
    fn a_line_right_through_is_cut_at_both_edges_and_one_beside_is_gone() {
        assert_eq!(
            clip(&[(-10.0, 5.0), (1e6, 5.0)]),
            [[(0.0, 5.0), (10.0, 5.0)]]
        );
        assert_eq!(
            clip(&[(-10.0, 20.0), (30.0, 20.0)]),
            Vec::<Vec<(f64, f64)>>::new()
        );
        assert_eq!(clip(&[(20.0, 20.0)]), Vec::<Vec<(f64, f64)>>::new());
    }
}
