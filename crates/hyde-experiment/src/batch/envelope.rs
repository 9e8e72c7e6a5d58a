//! [`envelope`]: a variable over time in all cases, as quantiles at common instants.

use super::summary::QUANTILES;
use hyde_signal::statistics::quantile;

/// Quantiles at [`QUANTILES`] over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Enveloped {
    /// The common instants in s, evenly spaced.
    pub time: Vec<f64>,
    /// At each of the probabilities a value an instant.
    pub quantiles: [Vec<f64>; QUANTILES.len()],
}

/// The quantiles over `cases`, each the instants in s, never running back, and the values at them, at `count` instants
/// from the first to the last of all. A case is read linearly between its rows and counts where it has any; at an instant
/// with an event its value before it counts. The least and the largest are those of all rows nearer to this instant than to
/// any other, too: a peak between two instants is not lost.
#[must_use]
pub fn envelope(cases: &[(&[f64], &[f64])], count: usize) -> Enveloped {
    let firsts = cases.iter().filter_map(|(time, _)| time.first());
    let lasts = cases.iter().filter_map(|(time, _)| time.last());
    let first = firsts.copied().fold(f64::INFINITY, f64::min);
    let last = lasts.copied().fold(f64::NEG_INFINITY, f64::max);
    let mut found = Enveloped::default();
    if count < 2 || first >= last || !(last - first).is_finite() {
        return found;
    }
    for at in 0..count {
        let part = at as f64 / (count - 1) as f64;
        let t = first + part * (last - first);
        let values = cases
            .iter()
            .filter_map(|(time, values)| read(time, values, t));
        let mut sorted: Vec<f64> = values.filter(|value| value.is_finite()).collect();
        sorted.sort_unstable_by(f64::total_cmp);
        found.time.push(t);
        let half = 0.5 * (last - first) / (count - 1) as f64;
        let near = cases
            .iter()
            .flat_map(|own| rows_between(own, t - half, t + half));
        let near = near.filter(|value| value.is_finite());
        let (least, largest) = near.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), own| {
            (low.min(own), high.max(own))
        });
        for (column, p) in found.quantiles.iter_mut().zip(QUANTILES) {
            let own = quantile(&sorted, p);
            column.push(if p <= 0.0 {
                own.min(least)
            } else if p >= 1.0 {
                own.max(largest)
            } else {
                own
            });
        }
    }
    found
}

/// The values of a case in the rows of a span of time.
fn rows_between<'c>(
    (time, values): &(&'c [f64], &'c [f64]),
    from: f64,
    to: f64,
) -> impl Iterator<Item = f64> + use<'c> {
    let first = time.partition_point(|row| *row < from);
    let last = time.partition_point(|row| *row <= to).min(values.len());
    values[first.min(last)..last].iter().copied()
}

/// The value at an instant, none before the first row and after the last.
fn read(time: &[f64], values: &[f64], t: f64) -> Option<f64> {
    let after = time.partition_point(|row| *row < t);
    let (t1, y1) = (*time.get(after)?, *values.get(after)?);
    if after == 0 {
        return (t1 <= t).then_some(y1);
    }
    let (t0, y0) = (time[after - 1], values[after - 1]);
    let part = (t - t0) / (t1 - t0);
    Some(y0 + part * (y1 - y0))
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "halves and quarters are exact")]
mod tests {
    use super::*;

    #[test]
    fn lines_give_the_quantiles_of_their_slopes() {
        // y = k t for k = 0 .. 4: the quantile at p is 4 p t.
        let time = [0.0, 1.0];
        let values: Vec<[f64; 2]> = (0..5).map(|k| [0.0, f64::from(k)]).collect();
        let cases: Vec<(&[f64], &[f64])> = values.iter().map(|y| (&time[..], &y[..])).collect();
        let found = envelope(&cases, 5);
        assert_eq!(found.time, [0.0, 0.25, 0.5, 0.75, 1.0]);
        assert_eq!(found.quantiles[3], [0.0, 0.5, 1.0, 1.5, 2.0]);
        assert_eq!(found.quantiles[4], [0.0, 0.75, 1.5, 2.25, 3.0]);
        assert_eq!(found.quantiles[6], [0.0, 1.0, 2.0, 3.0, 4.0]);
    }

    #[test]
    fn a_case_counts_where_it_has_rows_and_an_event_is_a_jump() {
        let short: (&[f64], &[f64]) = (&[0.0, 1.0], &[8.0, 8.0]);
        let jumps: (&[f64], &[f64]) = (&[0.0, 1.0, 1.0, 2.0], &[0.0, 0.0, 4.0, 4.0]);
        let found = envelope(&[short, jumps], 5);
        assert_eq!(found.quantiles[0], [0.0, 0.0, 0.0, 4.0, 4.0]);
        assert_eq!(found.quantiles[6], [8.0, 8.0, 8.0, 4.0, 4.0]);
        assert!(envelope(&[], 5).time.is_empty());
    }

    #[test]
    fn a_peak_between_two_instants_is_the_largest() {
        let time: Vec<f64> = (0..=100).map(|k| 0.01 * f64::from(k)).collect();
        let mut values = vec![0.0; 101];
        (values[33], values[61]) = (7.0, -3.0);
        // Instants 0.25 apart: 0.33 is nearest to 0.25, 0.61 to 0.5.
        let found = envelope(&[(&time, &values)], 5);
        assert_eq!(found.quantiles[6], [0.0, 7.0, 0.0, 0.0, 0.0]);
        assert_eq!(found.quantiles[0], [0.0, 0.0, -3.0, 0.0, 0.0]);
        assert_eq!(found.quantiles[3], [0.0; 5]);
    }
}
