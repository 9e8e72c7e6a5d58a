//! Rows that are missing, that stand at one instant, or that are not evenly spaced: told, for nobody sees them in a curve.

use crate::Note;
use crate::statistics::median_of;

/// From this multiple of the usual distance on, a distance of rows that are else even is a gap.
const GAP: f64 = 1.5;

/// The same where rows are not even.
const WIDE_GAP: f64 = 10.0;

/// Rows are even if so large a part of their distances differs from the usual one by no more than [`SLACK`] of it.
const MOST: f64 = 0.9;
const SLACK: f64 = 0.2;

/// So many places are named; the rest is counted.
const NAMED: usize = 3;

/// What is to be told of the instants of rows in s, which never run back.
pub(crate) fn told(time_s: &[f64]) -> Vec<Note> {
    let mut notes = Vec::new();
    let mut steps: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.retain(|step| *step > 0.0);
    let Some(usual) = median_of(&mut steps) else {
        return notes;
    };
    let near = |step: &&f64| (**step - usual).abs() <= SLACK * usual;
    let even = steps.iter().filter(near).count() as f64 >= MOST * steps.len() as f64;
    let limit = usual * if even { GAP } else { WIDE_GAP };
    let pairs = || time_s.windows(2).map(|pair| (pair[0], pair[1]));
    let gaps: Vec<String> = pairs()
        .filter(|(from, to)| to - from > limit)
        .map(|(from, to)| format!("between {} and {}", seconds(from), seconds(to)))
        .collect();
    if !gaps.is_empty() {
        let more = match gaps.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!(" and in {more} more places"),
        };
        let places = gaps[..gaps.len().min(NAMED)].join(", ");
        notes.push(Note::new(format!(
            "samples are missing {places}{more}: they are {} apart elsewhere, and a gap is interpolated linearly",
            seconds(usual)
        )));
    }
    if !even {
        let bounds = (f64::INFINITY, f64::NEG_INFINITY);
        let (least, most) = (steps.iter()).fold(bounds, |(least, most), step| {
            (least.min(*step), most.max(*step))
        });
        notes.push(Note::new(format!(
            "its samples are not evenly spaced: {} to {} apart, median {}",
            seconds(least),
            seconds(most),
            seconds(usual)
        )));
    }
    let repeated: Vec<f64> = pairs()
        .filter(|(from, to)| from.total_cmp(to).is_eq())
        .map(|(from, _)| from)
        .collect();
    if let Some(first) = repeated.first() {
        let rows = match repeated.len() {
            1 => "1 sample has the time of the sample before it,".to_owned(),
            many => format!("{many} samples have the time of the sample before them, the first"),
        };
        notes.push(Note::new(format!(
            "{rows} at {}: columns jump there",
            seconds(*first)
        )));
    }
    notes
}

/// A time with the digits that tell it from its neighbours.
pub(crate) fn seconds(time_s: f64) -> String {
    format!("{} s", hyde_units::significant(time_s, 9))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn notes(time_s: &[f64]) -> String {
        let notes: Vec<String> = told(time_s).iter().map(ToString::to_string).collect();
        notes.join("\n")
    }

    #[test]
    fn gaps_are_told_with_their_places_and_even_rows_without_a_word() {
        let even: Vec<f64> = (0..100).map(|k| f64::from(k) * 0.01).collect();
        assert_eq!(notes(&even), "");
        assert_eq!(notes(&[1.0]), "");
        assert_eq!(notes(&[]), "");
        let gap: Vec<f64> = even
            .iter()
            .copied()
            .filter(|t| !(0.2..0.3).contains(t))
            .collect();
        let text = notes(&gap);
        assert!(
            text.contains("missing between 0.19 s and 0.3 s: they are 0.01 s apart"),
            "{text}"
        );
        let one: Vec<f64> = even
            .iter()
            .copied()
            .filter(|t| (*t - 0.5).abs() > 1e-9)
            .collect();
        assert!(notes(&one).contains("between 0.49 s and 0.51 s"));
        let many: Vec<f64> = (0..100)
            .filter(|k| k % 20 != 7)
            .map(|k| f64::from(k) * 0.01)
            .collect();
        assert!(
            notes(&many).contains("and in 2 more places"),
            "{}",
            notes(&many)
        );
    }

    #[test]
    fn what_repeats_and_what_is_uneven_is_told() {
        assert!(notes(&[0.0, 1.0, 1.0, 2.0]).starts_with("1 sample has the time"));
        let uneven: Vec<f64> = (0..50).map(|k| f64::from(k * k)).collect();
        assert!(notes(&uneven).contains("not evenly spaced: 1 s to 97 s apart"));
        // The shortest and the longest distance, wherever they are.
        let slower = [0.0, 2.0, 3.0, 8.0, 12.0, 15.0];
        assert!(notes(&slower).contains("not evenly spaced: 1 s to 5 s apart, median 3 s"));
    }
}
