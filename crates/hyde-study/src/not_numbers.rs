//! Which columns of a run have rows without a number: the root of something negative, 0 by 0. Each as a sentence.

use hyde_experiment::Run;
use hyde_program::Program;
use hyde_units::{counted, significant};

/// So many variables are told by name.
const NAMED: usize = 3;

/// The variables of the model that are not a number in some row of a run, with the first time.
pub(crate) fn of_run(program: &Program, run: &Run) -> Vec<String> {
    let results = &run.results;
    let mut found = Vec::new();
    for (number, series) in results.kept() {
        let output = &program.outputs[number];
        if output.auxiliary || output.same_as.is_some() {
            continue;
        }
        let values = series.values();
        let mut rows = values.iter().enumerate().filter(|(_, own)| own.is_nan());
        if let Some((first, _)) = rows.next() {
            found.push((&output.name, results.time[first], rows.count()));
        }
    }
    let sentence = |(name, t, more): &(&String, f64, usize)| {
        let more = match more {
            0 => String::new(),
            more => format!(" and in {}", counted(*more, "more row")),
        };
        let t = significant(*t, 6);
        format!("`{name}` is not a number at {t} s{more}: its equation has no value there")
    };
    let mut sentences: Vec<String> = found.iter().take(NAMED).map(sentence).collect();
    if found.len() > NAMED {
        let rest = counted(found.len() - NAMED, "more variable");
        sentences.push(format!("{rest} without a number in some rows"));
    }
    sentences
}
