//! Even rows for a record whose own are not: an observer's steps are all of one length.
//!
//! A drive polled over a bus stamps its rows as they come. The rows of an observer are then those of an even grid as fine as
//! the rows usually are, and readings go to the nearest of these ([`super::readings`]); columns that drive the model are read
//! there as they always are. [`Uneven`] tells of it. Over a long gap nothing is known of what drives the model: such a record
//! is refused.

use super::recording::RecordError;
use hyde_signal::statistics::median;
use hyde_signal::{Column, Signal, Table};

/// Rows are even that are this part of their spacing off at most.
const EVEN: f64 = 0.01;
/// So many usual spacings without a row are a gap.
const GAP: f64 = 10.0;

/// That the rows of a record are not evenly spaced, where those of an observer are.
#[derive(Clone, Debug, PartialEq)]
pub struct Uneven {
    /// The record, as the experiment calls it.
    pub record: String,
    /// The closest and the widest spacing of its rows, s.
    pub spacing_s: (f64, f64),
    /// Where they first are not evenly spaced, s.
    pub from_s: f64,
    /// The spacing of the rows that the observer has, s.
    pub step_s: f64,
}

/// Even rows for the times of a record; its own if these are even. A gap is refused unless what drives the model is `known`
/// from its begin to its end.
pub(crate) fn evenly(
    record: &str,
    time: &[f64],
    known: impl Fn(f64, f64) -> bool,
) -> Result<(Vec<f64>, Option<Uneven>), RecordError> {
    let (first, last) = (time[0], time[time.len() - 1]);
    let mean = (last - first) / (time.len() - 1) as f64;
    let spacings: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut uneven = spacings.iter().map(|spacing| (spacing - mean).abs());
    if uneven.all(|off| off <= EVEN * mean) {
        return Ok((time.to_vec(), None));
    }
    let apart: Vec<f64> = spacings.iter().copied().filter(|s| *s > 0.0).collect();
    let step_s = median(&apart).unwrap_or(mean);
    let usual = |spacing: &f64| (spacing - step_s).abs() <= EVEN * step_s;
    let place = spacings.iter().position(|s| !usual(s)).unwrap_or(0);
    let is_gap = |row: &usize| spacings[*row] > GAP * step_s && !known(time[*row], time[*row + 1]);
    if let Some(row) = (0..spacings.len()).find(is_gap) {
        return Err(RecordError::Gap {
            record: record.to_owned(),
            from_s: time[row],
            to_s: time[row + 1],
            usual_s: step_s,
        });
    }
    let rows = ((last - first) / step_s * (1.0 + 1e-12)).floor() as usize;
    let even = (0..=rows).map(|row| first + step_s * row as f64);
    let uneven = Uneven {
        record: record.to_owned(),
        spacing_s: (
            spacings.iter().copied().fold(f64::INFINITY, f64::min),
            spacings.iter().copied().fold(0.0, f64::max),
        ),
        from_s: time[place],
        step_s,
    };
    Ok((even.collect(), Some(uneven)))
}

/// Values of a table's rows at other instants, and a table of the instants.
pub(crate) fn resample(table: &Table, values: &[f64], time: &[f64]) -> Option<(Table, Vec<f64>)> {
    let signal = Signal::new(table.time(), values)?;
    let mut cursor = hyde_signal::Cursor::default();
    let read = |&t: &f64| signal.linear(t, &mut cursor);
    let values = time.iter().map(read).collect();
    let even = Table::new(vec![Column::raw("t", time.to_vec())]).ok()?;
    Some((even, values))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(time: &[f64]) -> Table {
        let way = time.iter().map(|t| 3.0 * t).collect();
        Table::new(vec![Column::raw("t", time.to_vec()), Column::raw("x", way)]).unwrap()
    }

    #[test]
    fn rows_as_they_come_are_read_on_straight_lines() {
        let time: Vec<f64> = (0..200)
            .map(|row| 0.01 * f64::from(row) + 0.002 * f64::from(row % 3))
            .collect();
        let table = table(&time);
        let (even, told) = evenly("log", table.time(), |_, _| false).unwrap();
        let told = told.unwrap();
        assert!((told.spacing_s.0 - 0.006).abs() < 1e-9, "{told:?}");
        assert!((told.spacing_s.1 - 0.012).abs() < 1e-9, "{told:?}");
        let pairs = even.windows(2);
        assert!(
            pairs
                .into_iter()
                .all(|pair| (pair[1] - pair[0] - told.step_s).abs() < 1e-12)
        );
        assert!(*even.last().unwrap() <= *time.last().unwrap() + 1e-12);
        let (_, values) = resample(&table, table.columns()[1].values(), &even).unwrap();
        let off = values.iter().zip(&even).map(|(x, t)| (x - 3.0 * t).abs());
        assert!(off.fold(0.0, f64::max) < 1e-12);
    }

    #[test]
    fn even_rows_stay_and_a_gap_is_told_with_its_place() {
        let mut time: Vec<f64> = (0..200).map(|row| 0.01 * f64::from(row)).collect();
        let never = |_, _| false;
        assert_eq!(evenly("log", &time, never), Ok((time.clone(), None)));
        time[120..].iter_mut().for_each(|t| *t += 0.3);
        let gap = evenly("log", &time, never).unwrap_err();
        let RecordError::Gap { from_s, to_s, .. } = gap else {
            panic!("{gap:?}");
        };
        assert!((from_s - 1.19).abs() < 1e-9 && (to_s - 1.5).abs() < 1e-9);
        let (even, _) = evenly("log", &time, |_, _| true).unwrap();
        assert_eq!(even.len(), 230);
    }
}
