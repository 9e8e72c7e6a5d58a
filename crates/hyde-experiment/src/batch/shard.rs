//! Shards: which cases are whose, where many processes work on one batch.

use std::ops::RangeInclusive;

/// The cases of each shard, both counted from 1: as equal as can be, in order, none empty.
#[must_use]
pub fn shards(cases: usize, count: usize) -> Vec<RangeInclusive<usize>> {
    let count = count.clamp(1, cases.max(1));
    let end = |shard: usize| shard * cases / count;
    (0..count)
        .map(|shard| end(shard) + 1..=end(shard + 1))
        .collect()
}

/// Numbers as schedulers take them, `2,5,9-12`, in pieces of at most `most` numbers.
#[must_use]
pub fn indices(numbers: &[usize], most: usize) -> Vec<String> {
    let piece = |numbers: &[usize]| {
        let runs = numbers.chunk_by(|a, b| a + 1 == *b);
        let texts: Vec<String> = runs
            .map(|run| match run {
                [only] => only.to_string(),
                [first, .., last] => format!("{first}-{last}"),
                [] => String::new(),
            })
            .collect();
        texts.join(",")
    };
    numbers.chunks(most.max(1)).map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_case_is_in_one_shard() {
        for (cases, count) in [(10, 3), (3, 10), (1, 1), (1000, 7)] {
            let list = shards(cases, count);
            assert_eq!(list.len(), count.min(cases));
            let all: Vec<usize> = list.iter().cloned().flatten().collect();
            assert_eq!(all, (1..=cases).collect::<Vec<_>>());
            let sizes: Vec<usize> = list.iter().map(|shard| shard.clone().count()).collect();
            assert!(sizes.iter().max().unwrap() - sizes.iter().min().unwrap() <= 1);
        }
    }

    #[test]
    fn numbers_are_written_as_schedulers_take_them() {
        assert_eq!(indices(&[2, 5, 9, 10, 11, 12], 1000), ["2,5,9-12"]);
        assert_eq!(indices(&[1, 2, 3], 2), ["1-2", "3"]);
        assert!(indices(&[], 5).is_empty());
    }
}
