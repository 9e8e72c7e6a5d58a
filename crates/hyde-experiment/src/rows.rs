//! The rows of a run that spectra are made of.

use hyde_sim::Results;

/// Instants that follow each other by the same time; what lies between them, events and ticks, is left out.
pub(crate) struct EvenRows {
    /// In s.
    pub(crate) time: Vec<f64>,
    /// The first and the last row of each.
    rows: Vec<(usize, usize)>,
}

impl EvenRows {
    /// Those that follow each other by `spacing` s, one of them at `origin` s.
    pub(crate) fn of(results: &Results, origin: f64, spacing: f64) -> Self {
        let (mut time, mut rows): (Vec<f64>, Vec<(usize, usize)>) = (Vec::new(), Vec::new());
        for (row, &t) in results.time.iter().enumerate() {
            let number = (t - origin) / spacing;
            if (number - number.round()).abs() > 1e-6 {
                continue;
            }
            let same = time.last().is_some_and(|&last| t - last < 0.5 * spacing);
            if let Some(last) = rows.last_mut().filter(|_| same) {
                last.1 = row;
            } else {
                time.push(t);
                rows.push((row, row));
            }
        }
        Self { time, rows }
    }

    /// The values of a column there: where it jumps the mean of both limits, as in a Fourier series. With one of them a
    /// held value would come half a spacing early or late.
    pub(crate) fn values(&self, column: &[f64]) -> Vec<f64> {
        let mean = |&(first, last): &(usize, usize)| 0.5 * (column[first] + column[last]);
        self.rows.iter().map(mean).collect()
    }
}
