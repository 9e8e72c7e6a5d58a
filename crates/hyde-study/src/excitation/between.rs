//! Effects that a record is to distinguish: those named by `--between`.

use super::options::Options;
use crate::diagnosis;
use crate::excitation::{Bench, Failed};
use crate::unknown;
use hyde_calibrate::{Hypothesis, Recording, Separation, separation};
use hyde_compiler::{Candidate, Form};
use std::collections::BTreeMap;

/// The effects of the model, and the numbers of those to distinguish.
pub(super) struct Effects {
    candidates: Vec<Candidate>,
    hypotheses: Vec<Hypothesis>,
    numbers: Vec<usize>,
}

/// How far effects are apart.
pub struct Apart {
    /// The least gain of an effect over another one, as a part of its threshold.
    pub least: f64,
    /// Names and gains.
    pub names: Vec<String>,
    /// All gains.
    pub separation: Separation,
}

/// The effects that are named, by the candidates of the model.
///
/// # Errors
/// A name is not one effect of the model, or there is one only.
pub(super) fn of(options: &Options, candidates: Vec<Candidate>) -> Result<Effects, String> {
    let hypotheses: Vec<Hypothesis> = candidates.iter().map(diagnosis::hypothesis).collect();
    let mut numbers = Vec::new();
    for name in &options.between {
        let number = number_of(name, &hypotheses)?;
        if !numbers.contains(&number) {
            numbers.push(number);
        }
    }
    if numbers.len() < 2 {
        return Err(
            "one effect has nothing to be distinguished from\n  help: write two or more, `--between Backlash@nut,Cogging@motor.shaft`"
                .to_owned(),
        );
    }
    Ok(Effects {
        candidates,
        hypotheses,
        numbers,
    })
}

/// The number of an effect, with its site after `@` if there are several.
fn number_of(name: &str, hypotheses: &[Hypothesis]) -> Result<usize, String> {
    let (effect, site) = match name.split_once('@') {
        Some((effect, site)) => (effect, Some(site)),
        None => (name, None),
    };
    let effect = effect.rsplit('.').next().unwrap_or(effect);
    let own = |h: &Hypothesis| h.effect == effect;
    let at = |h: &Hypothesis| {
        site.is_none_or(|site| h.site == site || h.aliases.iter().any(|alias| alias == site))
    };
    let all: Vec<usize> = (0..hypotheses.len())
        .filter(|&number| own(&hypotheses[number]) && at(&hypotheses[number]))
        .collect();
    match all.as_slice() {
        [only] => Ok(*only),
        [] => Err(format!(
            "the model has no effect `{name}`\n  help: `hyde effects FILE` lists the effects and their sites"
        )),
        several => {
            let sites: Vec<String> = several
                .iter()
                .map(|&number| format!("`{effect}@{}`", hypotheses[number].site))
                .collect();
            Err(format!(
                "`{name}` fits at several sites\n  help: write one of {}",
                sites.join(", ")
            ))
        }
    }
}

/// How far a record would set the effects apart, each at a part of its range; `None` if a model with one of them cannot be
/// observed.
pub(super) fn apart(
    bench: &Bench,
    effects: &Effects,
    recording: Recording,
    part: f64,
) -> Result<Option<Apart>, Failed> {
    let project = &bench.project;
    let settings: BTreeMap<String, f64> = project.set().into_iter().collect();
    let headers = crate::headers(&project.records);
    let request = project.request(&settings, &headers, Form::Observed);
    let author = |known: &[usize], written: &[hyde_calibrate::Written]| {
        unknown::built(&request, &effects.candidates, known, written)
    };
    let found = separation(
        &bench.compiled.program,
        vec![recording],
        (&bench.varied, &project.set()),
        &effects.hypotheses,
        &effects.numbers,
        part,
        &author,
    );
    let separation = found.map_err(Failed::Unsupported)?;
    let names = effects.numbers.iter().map(|&number| {
        let own = &effects.hypotheses[number];
        format!("{} at {}", own.effect, own.site)
    });
    Ok(separation.least().map(|least| Apart {
        least,
        names: names.collect(),
        separation,
    }))
}
