//! Words of messages: names in short, a few of them, the one that was meant.

/// The last part of a dotted name; all of a reduction, `max(table.s)`, which is named as it is written.
pub(crate) fn short(name: &str) -> &str {
    let last = name.rsplit('.').next();
    last.filter(|_| !name.contains('(')).unwrap_or(name)
}

/// A few names for a message.
pub(crate) fn listed(names: &[&str]) -> String {
    let mut sorted: Vec<&str> = names.to_vec();
    sorted.sort_unstable();
    sorted.dedup();
    let shown: Vec<String> = sorted
        .iter()
        .take(8)
        .map(|name| format!("`{name}`"))
        .collect();
    let more = if sorted.len() > 8 { ", …" } else { "" };
    format!("{}{more}", shown.join(", "))
}

/// The known name nearest to a misspelt one, if one is near.
pub fn nearest<'n>(name: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    let word = name.rsplit('.').next().unwrap_or(name);
    known
        .map(|candidate| {
            (
                strsim::damerau_levenshtein(&word.to_lowercase(), &candidate.to_lowercase()),
                candidate.len().abs_diff(word.len()),
                candidate,
            )
        })
        .filter(|(distance, _, candidate)| {
            let longer = candidate.len().max(word.len());
            // With every letter another one, it is another name.
            *distance <= longer.div_ceil(3) && *distance < longer
        })
        .min()
        .map(|(.., candidate)| candidate)
}
