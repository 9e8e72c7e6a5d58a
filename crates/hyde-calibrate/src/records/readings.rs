//! [`at_rows`]: readings of channels at the rows of an observer, each channel at its own times.
//!
//! An observer steps evenly, as fast as its fastest channel is read. A reading goes to the row that is nearest, interpolated
//! between its neighbours; rows that no reading is nearest to have none, and correct nothing there.

use super::recording::Recording;
use hyde_signal::Signal;
use std::sync::Arc;

/// A reading this part of a row off its row stays as it is.
const EVEN: f64 = 0.01;
/// A neighbour that is so many usual spacings away says nothing of what is between.
const GAP: f64 = 10.0;

/// Which channels have a reading in a row.
pub(crate) type Readings = Vec<bool>;

/// Values at rows, NaN in rows without a reading.
pub(crate) fn at_rows(own: &[f64], values: &[f64], rows: &[f64]) -> Vec<f64> {
    let mut placed = vec![f64::NAN; rows.len()];
    let mut off = vec![f64::INFINITY; rows.len()];
    let step = (rows[rows.len() - 1] - rows[0]) / (rows.len() - 1) as f64;
    let spacing = (own[own.len() - 1] - own[0]) / (own.len() - 1).max(1) as f64;
    for (reading, &t) in own.iter().enumerate() {
        let Some(row) = nearest(rows, t, step) else {
            continue;
        };
        let behind = rows[row] - t;
        if behind.abs() >= off[row] {
            continue;
        }
        let value = match behind.abs() <= EVEN * step {
            true => Some(values[reading]),
            false => towards(own, values, reading, behind, GAP * spacing),
        };
        if let Some(value) = value {
            (placed[row], off[row]) = (value, behind.abs());
        }
    }
    placed
}

/// The row that a time is nearest to; none beyond half a step of the first and the last.
fn nearest(rows: &[f64], t: f64, step: f64) -> Option<usize> {
    let after = rows.partition_point(|row| *row < t);
    let closer = |row: &usize| rows.get(*row).map_or(f64::INFINITY, |at| (at - t).abs());
    let row = match after.checked_sub(1) {
        Some(before) if closer(&before) <= closer(&after) => before,
        Some(_) | None => after,
    };
    (closer(&row) <= 0.5 * step * (1.0 + EVEN)).then_some(row)
}

/// The value a little later or earlier than a reading: on the cubic through the two readings on either side if these are
/// about evenly spaced, else on the straight line to the neighbour there.
fn towards(own: &[f64], values: &[f64], reading: usize, by: f64, gap: f64) -> Option<f64> {
    let before = match by > 0.0 {
        true => reading,
        false => reading.checked_sub(1)?,
    };
    let apart = own.get(before + 1)? - own[before];
    if !(apart > 0.0 && apart <= gap) {
        return None;
    }
    let t = own[reading] + by;
    let four = before.checked_sub(1).and_then(|first| {
        let times = own.get(first..first + 4)?;
        let mut spacings = times.windows(2).map(|pair| pair[1] - pair[0]);
        let alike = spacings.all(|own| (0.5 * apart..=2.0 * apart).contains(&own));
        alike.then(|| (times, &values[first..first + 4]))
    });
    Some(match four {
        Some((times, values)) => cubic(times, values, t),
        None => values[before] + (values[before + 1] - values[before]) * (t - own[before]) / apart,
    })
}

/// The polynomial through some points (Lagrange's form).
fn cubic(times: &[f64], values: &[f64], t: f64) -> f64 {
    let part = |(at, value): (usize, &f64)| {
        let others = times.iter().enumerate().filter(|(other, _)| *other != at);
        let weight: f64 = others
            .map(|(_, other)| (t - other) / (times[at] - other))
            .product();
        weight * value
    };
    values.iter().enumerate().map(part).sum()
}

/// Every row of a channel on straight lines between its readings, and held before the first and after the last.
pub(crate) fn filled(values: &[f64]) -> Vec<f64> {
    let known = values.iter().enumerate().filter(|(_, v)| v.is_finite());
    let (rows, known): (Vec<f64>, Vec<f64>) = known.map(|(row, v)| (row as f64, *v)).unzip();
    if known.len() == values.len() {
        return known;
    }
    let Some(signal) = Signal::new(&rows, &known) else {
        return values.to_vec();
    };
    let mut cursor = hyde_signal::Cursor::default();
    let each = (0..values.len()).map(|row| signal.linear(row as f64, &mut cursor));
    each.collect()
}

/// The kinds of rows by which channels have a reading, that with all of them first, and the kind of each row.
pub(crate) fn kinds(channels: &[Vec<f64>]) -> (Vec<Readings>, Vec<usize>) {
    let rows = channels.first().map_or(0, Vec::len);
    let mut found = vec![vec![true; channels.len()]];
    let mut last = 0;
    let kind = (0..rows).map(|row| {
        let is = |readings: &Readings| {
            let each = readings.iter().zip(channels);
            each.into_iter()
                .all(|(has, list)| *has != list[row].is_nan())
        };
        if !is(&found[last]) {
            last = found.iter().position(is).unwrap_or_else(|| {
                found.push(channels.iter().map(|list| !list[row].is_nan()).collect());
                found.len() - 1
            });
        }
        last
    });
    let kind = kind.collect();
    (found, kind)
}

/// How often channels are read over some records: the kinds of rows, and the part of all rows in which each has a reading.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Rates {
    pub(crate) kinds: Vec<Readings>,
    pub(crate) parts: Vec<f64>,
}

impl Rates {
    /// Over records of the same channels.
    pub(crate) fn of(recordings: &[Recording]) -> Self {
        let mut kinds: Vec<Readings> = Vec::new();
        for own in recordings.iter().flat_map(|recording| &recording.kinds) {
            if !kinds.contains(own) {
                kinds.push(own.clone());
            }
        }
        let rows: usize = recordings.iter().map(Recording::rows).sum();
        let channels = recordings.first().map_or(0, |own| own.channels.len());
        let read = |channel: usize| {
            let lists = recordings.iter().map(|own| &own.channels[channel]);
            lists.flatten().filter(|value| !value.is_nan()).count()
        };
        let part = |channel| read(channel).max(1) as f64 / rows.max(1) as f64;
        Self {
            kinds,
            parts: (0..channels).map(part).collect(),
        }
    }
}

/// The rows without a reading of each channel, counted from the first that counts.
pub(crate) fn absent(channels: &[Vec<f64>], first_row: usize) -> Vec<Arc<[usize]>> {
    let of = |list: &Vec<f64>| {
        let counted = list.iter().skip(first_row).enumerate();
        let absent = counted.filter(|(_, value)| value.is_nan());
        absent.map(|(row, _)| row).collect()
    };
    channels.iter().map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readings_go_to_the_nearest_row_along_their_own_course() {
        let rows: Vec<f64> = (0..10).map(f64::from).collect();
        // Every third row, four tenths of a row late, on 2 t - 0.1 t^3.
        let course = |t: f64| 2.0 * t - 0.1 * t * t * t;
        let own: Vec<f64> = (0..4).map(|k| 3.0 * f64::from(k) + 0.4).collect();
        let values: Vec<f64> = own.iter().map(|t| course(*t)).collect();
        let placed = at_rows(&own, &values, &rows);
        for (row, value) in placed.iter().enumerate() {
            let line =
                |a: f64, b: f64| course(a) + (course(b) - course(a)) * (row as f64 - a) / 3.0;
            match row {
                // One neighbour before these alone, or one behind: on the line.
                3 => assert!((value - line(0.4, 3.4)).abs() < 1e-12),
                9 => assert!((value - line(6.4, 9.4)).abs() < 1e-12),
                6 => assert!((value - course(6.0)).abs() < 1e-12),
                // The first has no neighbour before it.
                _ => assert!(value.is_nan(), "{row}: {value}"),
            }
        }
        let filled = filled(&placed);
        assert!((filled[6] - placed[6]).abs() < 1e-12 && (filled[0] - placed[3]).abs() < 1e-12);
        assert!((filled[4] - (2.0 * placed[3] + placed[6]) / 3.0).abs() < 1e-12);
    }

    #[test]
    fn a_lost_row_is_missing_and_the_others_stay_as_they_are() {
        let rows: Vec<f64> = (0..6).map(|k| 0.1 * f64::from(k)).collect();
        let own = [0.0, 0.1, 0.3, 0.4, 0.5];
        let placed = at_rows(&own, &[1.0, 2.0, 4.0, 5.0, 6.0], &rows);
        assert!(placed[2].is_nan());
        assert_eq!(
            [placed[1], placed[3], placed[5]].map(f64::to_bits),
            [2.0, 4.0, 6.0].map(f64::to_bits)
        );
        let (kinds, of_rows) = kinds(&[placed, vec![0.0; 6]]);
        assert_eq!(kinds, [vec![true, true], vec![false, true]]);
        assert_eq!(of_rows, [0, 0, 1, 0, 0, 0]);
    }
}
