//! [`telling`]: the experiment that would tell two effects apart which the records cannot.
//!
//! Two fitted models predict different innovations. Were one of them the axis, the other would be behind it by the sum of
//! squares of the difference; where that is below the gate, records of the same motions are asked for as many times as are
//! missing, of the motion that tells most (discrimination of models; Hunter and Reiner, Technometrics 7, 1965, 307).

use super::trial::Trial;
use crate::fit::rows_of_a_block;
use crate::records::Recording;

/// A hypothesis that the records cannot tell from the one taken in.
#[derive(Clone, Debug, PartialEq)]
pub struct Alternative {
    /// Its number.
    pub hypothesis: usize,
    /// What would tell; `None` where no motion of the records does.
    pub experiment: Option<Experiment>,
}

/// Motions of which more would tell two effects apart.
#[derive(Clone, Debug, PartialEq)]
pub struct Experiment {
    /// The record whose motion tells most.
    pub record: String,
    /// How many such records it would take.
    pub times: f64,
    /// The second of it in which the two differ most, in s from its start.
    pub second_s: f64,
}

/// What would tell two trials apart, for a gain that is to be reached, with so many records at most.
pub(super) fn telling(
    recordings: &[Recording],
    one: &Trial,
    other: &Trial,
    gate: f64,
    most_records: f64,
) -> Option<Experiment> {
    let pairs = one.stage.solution.innovations.iter();
    let pairs = pairs.zip(&other.stage.solution.innovations);
    let each = recordings.iter().zip(pairs).map(|(recording, (a, b))| {
        let length = rows_of_a_block(recording);
        let rows = a.channels.first().map_or(0, Vec::len);
        let mut seconds = vec![0.0; rows.div_ceil(length)];
        for (a, b) in a.channels.iter().zip(&b.channels) {
            for (row, (a, b)) in a.iter().zip(b).enumerate() {
                seconds[row / length] += (a - b).powi(2);
            }
        }
        let most = (0..seconds.len()).max_by(|&i, &j| seconds[i].total_cmp(&seconds[j]));
        let first = (recording.first_row + most.unwrap_or(0) * length) as f64 * recording.step_s;
        Experiment {
            record: recording.name.clone(),
            times: gate / seconds.iter().sum::<f64>().max(f64::MIN_POSITIVE),
            second_s: first,
        }
    });
    each.min_by(|a, b| a.times.total_cmp(&b.times))
        .filter(|best| best.times <= most_records)
}
