//! Distance of a trajectory from its reference: within 2e-3 of the reference's range at all its rows; near events the time
//! may be off by 1e-4 of the stop time.

/// Share of a signal's range within which it matches.
const TOLERANCE: f64 = 2e-3;
/// Share of the stop time by which events may be shifted.
const SHIFT: f64 = 1e-4;

/// A trajectory, piecewise linear; a jump is two points at one time.
#[derive(Clone, Debug)]
pub(super) struct Curve {
    time: Vec<f64>,
    values: Vec<f64>,
}

/// The largest distance of two curves, over the tolerance, and where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fit {
    pub(super) worst: f64,
    pub(super) at: f64,
}

/// The trajectories of a file.
pub(super) struct Reference {
    pub(super) time: Vec<f64>,
    columns: Vec<(String, Vec<f64>)>,
}

/// Compares at every row of the reference.
pub(super) fn fit(reference: &Curve, own: &Curve, stop: f64) -> Fit {
    let (low, high) = reference.bounds(f64::NEG_INFINITY, f64::INFINITY);
    let size = low.abs().max(high.abs());
    // What does not move has no range: it is compared within a millionth of its size, or of one unit.
    let tolerance = TOLERANCE * (high - low).max(1e-6 * size.max(1.0));
    let shift = SHIFT * stop;
    let mut events = reference.jumps();
    events.extend(own.jumps());
    events.sort_by(f64::total_cmp);
    let mut fit = Fit {
        worst: 0.0,
        at: 0.0,
    };
    for (&t, &value) in reference.time.iter().zip(&reference.values) {
        let next = events.partition_point(|&event| event < t - shift);
        let near = events.get(next).is_some_and(|&event| event <= t + shift);
        // At the instant of a jump both limits are values of the curve.
        let (low, high) = own.bounds(t, t);
        let mut distance = outside(value, low, high);
        if near {
            // One of the two curves is taken at another time.
            let (low, high) = own.bounds(t - shift, t + shift);
            distance = distance.min(outside(value, low, high));
            let (low, high) = reference.bounds(t - shift, t + shift);
            let (own_low, own_high) = own.bounds(t, t);
            distance = distance.min(outside(own_low, low, high).max(outside(own_high, low, high)));
        }
        let over = distance / tolerance;
        if over.is_nan() || over > fit.worst {
            fit = Fit {
                worst: if over.is_nan() { f64::INFINITY } else { over },
                at: t,
            };
        }
    }
    fit
}

fn outside(value: f64, low: f64, high: f64) -> f64 {
    if value.is_nan() || low.is_nan() || high.is_nan() {
        return f64::NAN;
    }
    (low - value).max(value - high).max(0.0)
}

impl Curve {
    pub(super) fn new(time: Vec<f64>, values: Vec<f64>) -> Self {
        Self { time, values }
    }

    pub(super) fn constant(value: f64, stop: f64) -> Self {
        Self::new(vec![0.0, stop], vec![value, value])
    }

    /// Times at which two points stand.
    #[allow(clippy::float_cmp, reason = "the two rows of an event have one time")]
    fn jumps(&self) -> Vec<f64> {
        let pairs = self.time.windows(2).filter(|pair| pair[0] == pair[1]);
        pairs.map(|pair| pair[0]).collect()
    }

    /// The smallest and the largest value between two times, held beyond its ends.
    fn bounds(&self, from: f64, to: f64) -> (f64, f64) {
        let first = self.time.partition_point(|&t| t < from);
        let end = self.time.partition_point(|&t| t <= to);
        let inside = self.values[first..end].iter().copied();
        let ends = [(from, first), (to, end)].into_iter();
        let ends = ends.filter(|(t, _)| t.is_finite());
        let ends = ends.map(|(t, after)| self.between(t, after));
        inside
            .chain(ends)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
                if value.is_nan() {
                    (value, value)
                } else {
                    (low.min(value), high.max(value))
                }
            })
    }

    /// The value at t on the line that ends at the point `after`.
    fn between(&self, t: f64, after: usize) -> f64 {
        let last = self.time.len() - 1;
        if after == 0 {
            return self.values[0];
        }
        if after > last {
            return self.values[last];
        }
        let (t0, t1) = (self.time[after - 1], self.time[after]);
        let (v0, v1) = (self.values[after - 1], self.values[after]);
        if t1 > t0 {
            v0 + (v1 - v0) * ((t - t0) / (t1 - t0)).clamp(0.0, 1.0)
        } else {
            v1
        }
    }
}

impl Reference {
    pub(super) fn column(&self, name: &str) -> Result<&[f64], String> {
        let found = self.columns.iter().find(|(known, _)| known == name);
        found
            .map(|(_, values)| values.as_slice())
            .ok_or_else(|| format!("the reference has no `{name}`"))
    }

    /// The median of the steps in time.
    pub(super) fn usual_step(&self) -> f64 {
        let steps = self.time.windows(2).map(|pair| pair[1] - pair[0]);
        let mut steps: Vec<f64> = steps.filter(|step| *step > 0.0).collect();
        steps.sort_by(f64::total_cmp);
        steps.get(steps.len() / 2).copied().unwrap_or(1.0)
    }
}

/// Reads a file of trajectories: names in quotes, then rows of numbers; the first column is the time.
pub(super) fn read_table(text: &str) -> Result<Reference, String> {
    let mut lines = text.lines();
    let header = lines
        .next()
        .unwrap_or_default()
        .trim_start_matches('\u{feff}');
    let mut names: Vec<String> = Vec::new();
    // Commas stand in names too: `x[1,2]`.
    for (number, part) in header.split('"').enumerate() {
        if number % 2 == 1 {
            names.push(part.to_owned());
        }
    }
    if names.is_empty() {
        names = header
            .split(',')
            .map(|name| name.trim().to_owned())
            .collect();
    }
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); names.len()];
    for (row, line) in lines
        .enumerate()
        .filter(|(_, line)| !line.trim().is_empty())
    {
        let bad = || format!("row {} of the reference is no row of numbers", row + 2);
        let cells: Vec<&str> = line.split(',').collect();
        if cells.len() != names.len() {
            return Err(bad());
        }
        for (column, cell) in columns.iter_mut().zip(cells) {
            column.push(cell.trim().parse().map_err(|_| bad())?);
        }
    }
    let mut columns: Vec<(String, Vec<f64>)> = names.into_iter().zip(columns).collect();
    let (_, time) = columns.remove(0);
    if time.len() < 2 {
        return Err("the reference has no rows".to_owned());
    }
    Ok(Reference { time, columns })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp(to: f64) -> Curve {
        Curve::new(vec![0.0, 1.0], vec![0.0, to])
    }

    fn step(at: f64) -> Curve {
        Curve::new(vec![0.0, at, at, 1.0], vec![0.0, 0.0, 1.0, 1.0])
    }

    #[test]
    #[expect(clippy::float_cmp, reason = "a row's time is kept as it is")]
    fn the_distance_counts_by_the_range() {
        // 0.1 % and 0.3 % of the range.
        assert!(fit(&ramp(10.0), &ramp(10.01), 1.0).worst <= 1.0);
        let far = fit(&ramp(10.0), &ramp(10.03), 1.0);
        assert!((far.worst - 1.5).abs() < 1e-9 && far.at == 1.0);
        let lost = Curve::new(vec![0.0, 1.0], vec![0.0, f64::NAN]);
        assert!(fit(&ramp(10.0), &lost, 1.0).worst > 1.0);
    }

    #[test]
    fn events_may_be_shifted_a_little() {
        assert!(fit(&step(0.5), &step(0.500_09), 1.0).worst <= 1.0);
        // The next row of the reference tells that the jump is not there yet.
        let rows = Curve::new(
            vec![0.0, 0.5, 0.5, 0.5005, 1.0],
            vec![0.0, 0.0, 1.0, 1.0, 1.0],
        );
        assert!(fit(&rows, &step(0.500_7), 1.0).worst > 1.0);
        // A pulse shorter than the shift is none.
        let pulse = Curve::new(
            vec![0.0, 0.5, 0.5, 0.500_01, 0.500_01, 1.0],
            vec![0.0, 0.0, 1.0, 1.0, 0.0, 0.0],
        );
        assert!(fit(&pulse, &Curve::constant(0.0, 1.0), 1.0).worst <= 1.0);
        // Far from events no shift is allowed: 1e-4 s at a slope of 100 ranges a second.
        let steep = Curve::new(vec![0.0, 0.5, 0.51, 1.0], vec![0.0, 0.0, 1.0, 1.0]);
        let late = Curve::new(vec![0.0, 0.5001, 0.5101, 1.0], vec![0.0, 0.0, 1.0, 1.0]);
        assert!(fit(&steep, &late, 1.0).worst > 1.0);
    }

    #[test]
    fn tables_have_quoted_names() {
        let table = read_table("\"time\",\"x[1,2]\"\n0,1\n0.5,2\n").unwrap();
        assert_eq!(table.column("x[1,2]").unwrap(), [1.0, 2.0]);
        assert!(read_table("\"time\",\"x\"\n0,1\n0.5\n").is_err());
    }
}
