//! Effects that a record is to distinguish: those named by `--between`, or those that a diagnosis could not distinguish.

use super::options::Options;
use crate::diagnosis;
use crate::excitation::Bench;
use crate::unknown;
use hyde_calibrate::{Hypothesis, Linearised, Point, Separation};
use hyde_compiler::{Candidate, Form};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// The effects of the model, and those to distinguish at their sizes.
pub(crate) struct Effects<'a> {
    pub(crate) candidates: Cow<'a, [Candidate]>,
    pub(crate) hypotheses: Cow<'a, [Hypothesis]>,
    pub(crate) points: Vec<Point>,
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
pub(super) fn of(
    options: &Options,
    candidates: Vec<Candidate>,
) -> Result<Effects<'static>, String> {
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
    let points = numbers
        .into_iter()
        .map(|number| Point::at_part(number, &hypotheses[number], options.size));
    Ok(Effects {
        points: points.collect(),
        candidates: Cow::Owned(candidates),
        hypotheses: Cow::Owned(hypotheses),
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

/// How far a record would set the effects apart; `None` if a model with one of them cannot be observed.
pub(crate) fn apart(bench: &Bench, effects: &Effects<'_>, record: &Linearised) -> Option<Apart> {
    let project = &bench.project;
    let settings: BTreeMap<String, f64> = project.set().into_iter().collect();
    let headers = crate::headers(&project.records);
    let request = project.request(&settings, &headers, Form::Observed);
    let author = |known: &[usize], written: &[hyde_calibrate::Written]| {
        unknown::built(&request, &effects.candidates, known, written)
    };
    let separation = record.separation(&effects.hypotheses, &effects.points, &author);
    let names = effects.points.iter().map(|point| {
        let own = &effects.hypotheses[point.hypothesis];
        format!("{} at {}", own.effect, own.site)
    });
    Some(Apart {
        least: separation.least()?,
        names: names.collect(),
        separation,
    })
}
