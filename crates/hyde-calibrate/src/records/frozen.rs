//! [`frozen`]: spells in which a channel of a record stands still and then jumps: a sensor or its line, not a drive.
//!
//! An axis that sticks, or is within its play, goes on from where it held. A reading that was held is at once where the axis
//! has gone meanwhile. Nothing of the model is asked.

use super::recording::Recording;
use hyde_signal::statistics::median;

/// Rows that a reading stands still, to the last bit, at least.
const ROWS: usize = 20;
/// It moves from row to row before and afterwards, and jumps so many times further in between.
const FURTHER: f64 = 10.0;
/// Of more rows than this part it is a reading that comes seldom.
const SELDOM: f64 = 0.1;

/// A channel that stood still.
#[derive(Clone, Debug, PartialEq)]
pub struct Frozen {
    /// The record's name.
    pub record: String,
    /// Number of the channel.
    pub channel: usize,
    /// The first and the last time with the same reading, in s.
    pub time_s: (f64, f64),
}

/// The spells of all records.
#[must_use]
pub fn frozen(recordings: &[Recording]) -> Vec<Frozen> {
    let each = recordings.iter().flat_map(|recording| {
        let channels = recording.channels.iter().enumerate();
        channels.flat_map(move |(channel, values)| {
            let rows = (0..values.len()).filter(|&row| !values[row].is_nan());
            let rows: Vec<usize> = rows.collect();
            let known: Vec<f64> = rows.iter().map(|&row| values[row]).collect();
            let time =
                move |reading: usize| recording.start_s + rows[reading] as f64 * recording.step_s;
            let spells = spells(&known).into_iter();
            spells.map(move |(first, last)| Frozen {
                record: recording.name.clone(),
                channel,
                time_s: (time(first), time(last)),
            })
        })
    });
    each.collect()
}

/// First and last readings of the spells of a channel.
fn spells(values: &[f64]) -> Vec<(usize, usize)> {
    let pairs = values.windows(2);
    let steps: Vec<f64> = pairs.map(|pair| (pair[1] - pair[0]).abs()).collect();
    let mut found = Vec::new();
    let mut first = 0_usize;
    for (row, &step) in steps.iter().enumerate() {
        if step == 0.0 {
            continue;
        }
        let start = std::mem::replace(&mut first, row + 1);
        if first - start < ROWS {
            continue;
        }
        let usual = |steps: &[f64]| median(steps).unwrap_or(0.0);
        let before = usual(&steps[start.saturating_sub(ROWS)..start]);
        let after = usual(&steps[first..steps.len().min(first + ROWS)]);
        let moves = before > 0.0 && after > 0.0;
        if moves && step > FURTHER * before.max(after) {
            found.push((start, row));
        }
    }
    let rows: usize = found.iter().map(|(first, last)| last + 1 - first).sum();
    if rows as f64 > SELDOM * values.len() as f64 {
        found.clear();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A way to and fro, in counts.
    fn counts() -> Vec<f64> {
        let way = |row: usize| 2000.0 * (row as f64 * 0.01).sin();
        (0..1000).map(|row| way(row).round()).collect()
    }

    #[test]
    fn a_reading_that_is_held_jumps() {
        let mut values = counts();
        let held = values[300];
        values[300..350].fill(held);
        assert_eq!(spells(&values), [(300, 349)]);
    }

    #[test]
    fn an_axis_that_stands_goes_on_from_there() {
        // It rests at first, and sticks where it turns.
        let mut values = vec![0.0; 100];
        values.extend(counts());
        let top = values.iter().copied().fold(0.0, f64::max);
        values
            .iter_mut()
            .for_each(|value| *value = value.min(top - 40.0));
        assert_eq!(spells(&values), []);
    }

    #[test]
    fn a_demand_in_steps_is_not_frozen() {
        let mut values = vec![0.0; 400];
        values[100..200].fill(3.0);
        assert_eq!(spells(&values), []);
    }

    #[test]
    fn a_reading_that_comes_seldom_is_not_frozen() {
        let all = counts();
        let values: Vec<f64> = (0..all.len()).map(|row| all[row / 30 * 30]).collect();
        assert_eq!(spells(&values), []);
    }
}
