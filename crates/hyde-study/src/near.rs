//! Names that are like one that is not there: `table.M` for `tabel.M`, `table.m` or `saddle.M`.

/// How alike two names are at least, 0 to 1.
const ALIKE: f64 = 0.8;
/// Names that are told at most.
const MOST: usize = 3;

/// The name that is most like a word, if one is.
pub(crate) fn nearest<'a>(word: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let like = |name: &str| strsim::jaro_winkler(&word.to_lowercase(), &name.to_lowercase());
    let best = names
        .map(|name| (like(name), name))
        .max_by(|a, b| a.0.total_cmp(&b.0))?;
    (best.0 > ALIKE).then_some(best.1)
}

/// What stands behind a sentence about a name of a component's part that there is not: `; did you mean …?`. Those that end in
/// the same word, the one that is most like it first; or else only that one.
pub(crate) fn did_you_mean<'a>(path: &str, names: impl Iterator<Item = &'a str>) -> String {
    let names: Vec<&str> = names.collect();
    let first = nearest(path, names.iter().copied());
    let last = |name: &str| name.rsplit('.').next().unwrap_or_default().to_owned();
    let word = last(path);
    let same = names.iter().copied().filter(|name| last(name) == word);
    let mut near: Vec<&str> = first.into_iter().collect();
    near.extend(same.filter(|name| Some(*name) != first));
    near.truncate(MOST);
    match near.as_slice() {
        [] => String::new(),
        near => format!("; did you mean `{}`?", near.join("`, `")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_are_alike_and_those_with_the_same_end_are_told() {
        let names = ["table.M", "table.a.s", "screw.J", "motor.J", "pulley.J"];
        let told = |path| did_you_mean(path, names.iter().copied());
        assert_eq!(told("tabel.M"), "; did you mean `table.M`?");
        assert_eq!(told("table.m"), "; did you mean `table.M`?");
        assert_eq!(
            told("J"),
            "; did you mean `screw.J`, `motor.J`, `pulley.J`?"
        );
        assert_eq!(told("xyz"), "");
    }
}
