//! The cases of one shard of a batch, as `--shard` names it.

use hyde_experiment::batch::shards;
use std::ops::RangeInclusive;

/// The cases of `3/16`, or of `auto/16` with the number that a scheduler gives its task.
#[allow(
    clippy::disallowed_methods,
    reason = "schedulers give the number of a task in the environment"
)]
pub(crate) fn shard_range(text: &str, cases: usize) -> Result<RangeInclusive<usize>, String> {
    let wrong = || {
        format!("`--shard {text}`: write `3/16`, or `auto/16` for the number from the scheduler")
    };
    let (number, count) = text.split_once('/').ok_or_else(wrong)?;
    let count: usize = count
        .parse()
        .ok()
        .filter(|count| *count > 0)
        .ok_or_else(wrong)?;
    let number = if number == "auto" {
        let names = [
            "SLURM_ARRAY_TASK_ID",
            "PBS_ARRAY_INDEX",
            "LSB_JOBINDEX",
            "SGE_TASK_ID",
        ];
        let found = names.iter().find_map(|name| std::env::var(name).ok());
        found.ok_or_else(|| format!("`--shard {text}`: none of {} is set", names.join(", ")))?
    } else {
        number.to_owned()
    };
    let number: usize = number
        .parse()
        .ok()
        .filter(|number| (1..=count).contains(number))
        .ok_or_else(wrong)?;
    // A batch of few cases has fewer shards.
    let empty = RangeInclusive::new(1, 0);
    Ok(shards(cases, count)
        .get(number - 1)
        .cloned()
        .unwrap_or(empty))
}
