//! Leaves out points that nobody would see, and keeps every peak.

use super::geometry::Point;
use std::collections::BTreeSet;

/// How far a left-out point may lie from the line drawn instead, in px: 13 µm on paper.
const TOLERANCE: f64 = 0.05;

/// Columns of a pixel each for a screen of two device pixels to the CSS pixel.
const COLUMN: f64 = 0.5;

/// In a trace that goes back and forth and has more points than this, what is under ink already is left out.
const MANY: usize = 5000;

/// The parts of a line with at most four points in each passage of a column, less those on a straight run.
///
/// Where x goes back and forth (loops, contours) and there are many points, passes over the same place are drawn once.
pub(crate) fn thin_lines(parts: Vec<Vec<Point>>) -> Vec<Vec<Point>> {
    let thin = |part: &Vec<Point>| straighten(&extremes_by_column(part));
    let thinned: Vec<Vec<Point>> = parts.iter().map(thin).collect();
    let goes_back = |part: &Vec<Point>| part.windows(2).any(|pair| pair[1].x < pair[0].x);
    let many = thinned.iter().map(Vec::len).sum::<usize>() > MANY;
    if many && thinned.iter().any(goes_back) {
        visible(&thinned)
    } else {
        thinned
    }
}

/// At most one dot in each cell of half a pixel; larger cells while more than 8000 dots remain.
pub(crate) fn thin_dots(dots: &[(Point, f64)]) -> Vec<(Point, f64)> {
    let mut cell = 0.5;
    loop {
        let mut taken = BTreeSet::new();
        let free =
            |(at, _): &&(Point, f64)| taken.insert(((at.x / cell) as i64, (at.y / cell) as i64));
        let kept: Vec<_> = dots.iter().filter(free).copied().collect();
        if kept.len() <= 8000 || cell > 8.0 {
            return kept;
        }
        cell *= 1.5;
    }
}

/// First, lowest, highest and last point of each run of points in one column: drawn at one pixel per column, the line is
/// the same (U. Jugel et al., "M4", Proc. VLDB 7 (2014) 797–808).
fn extremes_by_column(points: &[Point]) -> Vec<Point> {
    let column = |at: &Point| (at.x / COLUMN).floor() as i64;
    let mut kept = Vec::new();
    for run in points.chunk_by(|a, b| column(a) == column(b)) {
        let by_y = |a: &usize, b: &usize| run[*a].y.total_cmp(&run[*b].y);
        let lowest = (0..run.len()).min_by(by_y).unwrap_or(0);
        let highest = (0..run.len()).max_by(by_y).unwrap_or(0);
        let mut order = [0, lowest, highest, run.len() - 1];
        order.sort_unstable();
        let distinct = order
            .iter()
            .enumerate()
            .filter(|(place, index)| *place == 0 || order[place - 1] != **index);
        kept.extend(distinct.map(|(_, index)| run[*index]));
    }
    kept
}

/// Leaves out points that lie on the segment drawn past them, within [`TOLERANCE`].
///
/// From the last point kept, the directions that pass near enough to all points since are an angle; a point outside it,
/// or nearer than the one before, ends the run (sleeve fitting, Zhao and Saalfeld 1997).
fn straighten(points: &[Point]) -> Vec<Point> {
    let Some(&first) = points.first() else {
        return Vec::new();
    };
    let mut kept = vec![first];
    let mut anchor = first;
    let mut sleeve: Option<Sleeve> = None;
    let mut last = first;
    for &point in &points[1..] {
        let fits = sleeve
            .as_ref()
            .is_none_or(|sleeve| sleeve.holds(anchor, point));
        if !fits {
            kept.push(last);
            anchor = last;
            sleeve = None;
        }
        sleeve = Some(Sleeve::around(anchor, point).within(sleeve));
        last = point;
    }
    if points.len() > 1 {
        kept.push(last);
    }
    kept
}

/// Directions from the anchor, as a middle and the room to its left and right in rad, and how far the run has come.
struct Sleeve {
    middle: f64,
    left: f64,
    right: f64,
    reach: f64,
}

impl Sleeve {
    fn around(anchor: Point, point: Point) -> Self {
        let reach = anchor.distance(point);
        let room = if reach > TOLERANCE {
            (TOLERANCE / reach).asin()
        } else {
            std::f64::consts::PI
        };
        Self {
            middle: (point.y - anchor.y).atan2(point.x - anchor.x),
            left: room,
            right: room,
            reach,
        }
    }

    fn holds(&self, anchor: Point, point: Point) -> bool {
        let turn = turn(self.middle, (point.y - anchor.y).atan2(point.x - anchor.x));
        anchor.distance(point) >= self.reach && turn <= self.left && -turn <= self.right
    }

    /// The directions in this sleeve and in the one before.
    fn within(self, before: Option<Self>) -> Self {
        let Some(before) = before else { return self };
        let turn = turn(before.middle, self.middle);
        Self {
            left: self.left.min(before.left - turn),
            right: self.right.min(before.right + turn),
            ..self
        }
    }
}

/// From one direction to the other, −π to π.
fn turn(from: f64, to: f64) -> f64 {
    let turn = to - from;
    turn - std::f64::consts::TAU * (turn / std::f64::consts::TAU).round()
}

/// The segments of which at least a part is not under the ink of those before: the hundredth turn of a hysteresis loop
/// adds nothing, noise or not.
fn visible(parts: &[Vec<Point>]) -> Vec<Vec<Point>> {
    // Cells of half a pixel; a curve of 1.25 px covers those of its path and their neighbours.
    let cell = |x: f64, y: f64| ((x * 2.0).floor() as i32, (y * 2.0).floor() as i32);
    let mut inked = BTreeSet::new();
    let mut kept: Vec<Vec<Point>> = Vec::new();
    for part in parts {
        let mut joined = false;
        for pair in part.windows(2) {
            let path = || along(pair[0], pair[1]);
            let seen = path().any(|at| !inked.contains(&cell(at.x, at.y)));
            if seen {
                for at in path() {
                    let near = [(0.0, 0.0), (0.5, 0.0), (-0.5, 0.0), (0.0, 0.5), (0.0, -0.5)];
                    inked.extend(near.map(|(dx, dy)| cell(at.x + dx, at.y + dy)));
                }
                match kept.last_mut() {
                    Some(line) if joined => line.push(pair[1]),
                    Some(_) | None => kept.push(pair.to_vec()),
                }
            }
            joined = seen;
        }
    }
    kept
}

/// Points on a segment, at most a quarter of a pixel apart.
fn along(from: Point, to: Point) -> impl Iterator<Item = Point> {
    let steps = (4.0 * from.distance(to)).ceil().max(1.0);
    let at = move |k: u32| {
        let part = f64::from(k) / steps;
        Point::new(
            from.x + part * (to.x - from.x),
            from.y + part * (to.y - from.y),
        )
    };
    (0..=steps as u32).map(at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(count: usize, y: impl Fn(f64) -> f64) -> Vec<Point> {
        (0..count)
            .map(|k| k as f64 * 500.0 / count as f64)
            .map(|x| Point::new(x, y(x)))
            .collect()
    }

    fn range(points: &[Point]) -> (f64, f64) {
        let ys = || points.iter().map(|point| point.y);
        (
            ys().fold(f64::INFINITY, f64::min),
            ys().fold(f64::NEG_INFINITY, f64::max),
        )
    }

    #[test]
    fn a_single_sample_peak_survives() {
        let mut points = line(100_000, |x| (x * 0.1).sin());
        points[54_321].y = 77.0;
        points[54_400].y = -55.0;
        let thinned = thin_lines(vec![points]).concat();
        assert!(thinned.len() < 3000, "{}", thinned.len());
        assert_eq!(range(&thinned), (-55.0, 77.0));
    }

    #[test]
    fn noise_keeps_the_extremes_of_every_column() {
        // 7919 is prime: values that look random, without a generator.
        let noisy = |x: f64| ((x * 7919.0).sin() * 43758.5453).fract() * 100.0;
        let points = line(50_000, noisy);
        let thinned = extremes_by_column(&points);
        assert!(thinned.len() <= 4 * 1000);
        for column in 0..1000 {
            let inside = |point: &&Point| (point.x / COLUMN).floor() as i32 == column;
            let before: Vec<_> = points.iter().filter(inside).copied().collect();
            let after: Vec<_> = thinned.iter().filter(inside).copied().collect();
            assert_eq!(range(&before), range(&after));
        }
    }

    #[test]
    fn no_left_out_point_is_farther_than_the_tolerance() {
        let points = line(3000, |x| 60.0 * (x * 0.05).sin());
        let kept = straighten(&points);
        assert!(kept.len() < 300, "{}", kept.len());
        for point in &points {
            let segment = kept
                .windows(2)
                .find(|pair| pair[0].x <= point.x && point.x <= pair[1].x)
                .unwrap();
            let (a, b) = (segment[0], segment[1]);
            let off = ((b.x - a.x) * (a.y - point.y) - (a.x - point.x) * (b.y - a.y)).abs()
                / a.distance(b);
            // The last point kept lies inside the sleeve, not in its middle: up to twice the tolerance.
            assert!(off <= 2.0 * TOLERANCE, "{off}");
        }
    }

    #[test]
    fn a_turning_point_on_a_retraced_line_is_kept() {
        let there_and_back: Vec<_> = [0.0, 5.0, 10.0, 5.0, 0.0]
            .iter()
            .map(|y| Point::new(1.0, *y))
            .collect();
        let kept: Vec<_> = straighten(&there_and_back)
            .iter()
            .map(|point| point.y)
            .collect();
        assert_eq!(kept, [0.0, 10.0, 0.0]);
    }

    #[test]
    fn a_hundred_turns_of_a_loop_cost_as_much_as_a_few() {
        let turns = |count: usize| {
            let angle = |k: usize| k as f64 * std::f64::consts::TAU / 1000.0;
            let points = (0..count * 1000)
                .map(|k| Point::new(200.0 + 150.0 * angle(k).cos(), 150.0 * angle(k).sin()));
            thin_lines(vec![points.collect()]).concat().len()
        };
        assert!(
            turns(100) < 3 * turns(1).max(1000),
            "{} {}",
            turns(100),
            turns(1)
        );
    }

    #[test]
    fn noisy_turns_of_a_loop_stay_small() {
        let angle = |k: usize| k as f64 * std::f64::consts::TAU / 10_000.0;
        let noise = |k: usize| ((k as f64 * 7919.0).sin() * 43758.5453).fract() * 3.0;
        let place = |k| {
            Point::new(
                200.0 + 150.0 * angle(k).cos(),
                150.0 * angle(k).sin() + noise(k),
            )
        };
        let kept = thin_lines(vec![(0..200_000).map(place).collect()]);
        assert!(kept.concat().len() < 12_000, "{}", kept.concat().len());
    }

    #[test]
    fn a_wide_noisy_plot_over_time_keeps_all_its_columns() {
        let noise = |k: usize| ((k as f64 * 7919.0).sin() * 43758.5453).fract() * 100.0;
        let points: Vec<_> = (0..60_000)
            .map(|k| Point::new(k as f64 / 20.0, noise(k)))
            .collect();
        let columns: BTreeSet<i64> = thin_lines(vec![points])
            .concat()
            .iter()
            .map(|at| at.x as i64)
            .collect();
        assert_eq!(columns.len(), 3000);
    }

    #[test]
    fn dots_in_one_cell_are_one() {
        let dots: Vec<_> = (0..10_000)
            .map(|k| (Point::new(3.1 + f64::from(k) * 1e-6, 4.1), 1.0))
            .collect();
        assert_eq!(thin_dots(&dots).len(), 1);
        let cloud: Vec<_> = (0..200_000)
            .map(|k| {
                (
                    Point::new(f64::from(k % 500), f64::from(k / 500) * 0.5),
                    1.0,
                )
            })
            .collect();
        assert!(thin_dots(&cloud).len() <= 8000);
    }

    #[test]
    fn empty_and_single() {
        assert_eq!(thin_lines(Vec::new()), Vec::<Vec<Point>>::new());
        let alone = vec![vec![Point::new(1.0, 2.0)]];
        assert_eq!(thin_lines(alone.clone()), alone);
    }
}
