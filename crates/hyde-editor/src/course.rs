//! What a hover shows of a variable's course: its value at an instant, the least and the largest, and a line of blocks.

use crate::outcome::Course;
use hyde_units::engineering_as;

/// Letters of a line.
const LETTERS: usize = 24;
/// The letters, from the least value to the largest.
const BLOCKS: [char; 8] = ['▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];

/// `` `body.s` = 480 mm, from 0 m to 500 mm, ▁▁▂▃▅▆▇█ ``
pub(crate) fn line(course: &Course, time: &[f64], instant: f64) -> Option<String> {
    let number = |si: f64| engineering_as(si, &course.unit).trim_end().to_owned();
    let name = &course.name;
    let value = number(at(course, time, instant)?);
    let (least, largest) = ends(&course.values)?;
    if least.to_bits() == largest.to_bits() {
        return Some(format!("`{name}` = {value}, constant"));
    }
    let (least_text, largest_text) = (number(least), number(largest));
    let blocks = blocks(time, &course.values, (least, largest));
    Some(format!(
        "`{name}` = {value}, from {least_text} to {largest_text}  \n`{blocks}`"
    ))
}

/// The value at an instant: on a line between two rows, but of whole numbers, as modes and counts are, that of the row before.
fn at(course: &Course, time: &[f64], instant: f64) -> Option<f64> {
    let values = &course.values;
    let after = time.partition_point(|row| *row <= instant);
    let before = after.checked_sub(1)?;
    let (t0, y0) = (*time.get(before)?, *values.get(before)?);
    let whole = values.iter().all(|value| value.fract() == 0.0);
    match (time.get(after), values.get(after)) {
        (Some(t1), Some(y1)) if !whole && *t1 > t0 => {
            Some(y0 + (y1 - y0) * (instant - t0) / (t1 - t0))
        }
        _ => Some(y0),
    }
}

/// The least and the largest value; none where no value is finite.
fn ends(values: &[f64]) -> Option<(f64, f64)> {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    let (least, largest) = (
        finite().fold(f64::INFINITY, f64::min),
        finite().fold(f64::NEG_INFINITY, f64::max),
    );
    (least <= largest).then_some((least, largest))
}

/// A letter for each of equal spans of time: the value in it that is farthest from the middle of all.
fn blocks(time: &[f64], values: &[f64], (least, largest): (f64, f64)) -> String {
    let (Some(first), Some(last)) = (time.first(), time.last()) else {
        return String::new();
    };
    let middle = 0.5 * (least + largest);
    let mut shown: Vec<Option<f64>> = vec![None; LETTERS];
    for (t, value) in time.iter().zip(values) {
        let part = (t - first) / (last - first);
        let letter = ((part * LETTERS as f64) as usize).min(LETTERS - 1);
        let farther = |known: f64| (value - middle).abs() > (known - middle).abs();
        if value.is_finite() && shown[letter].is_none_or(farther) {
            shown[letter] = Some(*value);
        }
    }
    // A span without a row is passed as the one before it.
    let mut last = None;
    let letters = shown.into_iter().map(|own| {
        last = own.or(last);
        let part = last.map_or(0.0, |value| (value - least) / (largest - least));
        let place = (part * BLOCKS.len() as f64) as usize;
        BLOCKS[place.min(BLOCKS.len() - 1)]
    });
    letters.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use hyde_units::{Dimension, NamedUnit};

    fn course(values: Vec<f64>) -> Course {
        Course {
            name: "x".to_owned(),
            unit: NamedUnit::usual(Dimension::LENGTH),
            values,
        }
    }

    #[test]
    fn a_ramp_rises_through_all_letters() {
        let time: Vec<f64> = (0..=240).map(|k| f64::from(k) / 240.0).collect();
        let ramp = course(time.iter().map(|t| 2.0 * t).collect());
        let told = line(&ramp, &time, 0.5).unwrap();
        assert_eq!(
            told,
            "`x` = 1 m, from 0 m to 2 m  \n`▁▁▁▂▂▂▃▃▃▄▄▄▅▅▅▆▆▆▇▇▇███`"
        );
    }

    #[test]
    fn a_short_peak_is_seen_and_whole_numbers_hold() {
        let time: Vec<f64> = (0..1000).map(|k| f64::from(k) * 1e-3).collect();
        let mut values = vec![0.0; 1000];
        values[500] = 1.0;
        let told = line(&course(values), &time, 0.5005).unwrap();
        assert!(told.starts_with("`x` = 1 m,"), "{told}");
        assert_eq!(told.matches('█').count(), 1, "{told}");
        let constant = line(&course(vec![3.0; 1000]), &time, 0.1).unwrap();
        assert_eq!(constant, "`x` = 3 m, constant");
        assert_eq!(line(&course(vec![f64::NAN; 1000]), &time, 0.1), None);
    }
}
