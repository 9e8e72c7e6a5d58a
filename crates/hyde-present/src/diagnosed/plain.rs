//! A diagnosis in plain words: what is missing, where, how large, how sure that is, what else it may be, what to record next.

use super::{Diagnosed, named, verdict};
use hyde_calibrate::{Finding, Quantity, Relation, Verdict};
use hyde_study::comparison::{self, Change, RecordErrors};
use hyde_units::{engineering_difference, significant};

/// The paragraph.
pub(super) fn paragraph(told: &Diagnosed<'_>) -> String {
    let mut sentences = Vec::new();
    for finding in &told.found.findings {
        sentences.extend(what(told, finding));
    }
    match told.found.verdict {
        Verdict::None => {
            sentences.push(
                "The calibrated model explains these records: no candidate passes the tests that noise alone fails."
                    .to_owned(),
            );
            sentences.extend(smallest(told));
        }
        Verdict::Unknown if told.found.findings.is_empty() => {
            sentences.push("The records contain something that no candidate explains.".to_owned());
            let like = told
                .found
                .unknown
                .as_ref()
                .and_then(hyde_study::unknown::most_like);
            sentences.extend(like.map(|like| format!("It most resembles {like}.")));
        }
        Verdict::Unknown | Verdict::Effect | Verdict::OneOf => {}
    }
    sentences.extend(sure(told));
    if !told.found.findings.is_empty() {
        sentences.push(else_it_may_be(told));
    }
    sentences.push(next(told));
    sentences.join(" ")
}

/// What it is, where it acts, how large it is.
fn what(told: &Diagnosed<'_>, finding: &Finding) -> Vec<String> {
    let hypothesis = &told.hypotheses[finding.hypothesis];
    let doc = told.candidates.get(finding.hypothesis);
    let doc = doc.map_or("", |own| own.doc.as_str());
    let (effect, site) = (&hypothesis.effect, &hypothesis.site);
    let first = match (told.candidates.get(finding.hypothesis), doc) {
        (None, _) => format!(
            "At {site} acts something that no library has; Hyde wrote it as the effect {effect}, a formula of the model's own variables."
        ),
        (Some(_), "") => format!("The model lacks the effect {effect} at {site}."),
        (Some(_), doc) => format!("The model lacks {effect} at {site}: {doc}."),
    };
    let sizes = verdict::sizes(finding);
    let sizes = match finding.told_sizes().len() {
        1 => format!("Its size is {sizes}, a 95 % interval."),
        _ => format!("Its sizes are {sizes}, 95 % intervals."),
    };
    let mut told = vec![first, sizes];
    let shape = |own: &Quantity| match own.interval.0 < own.interval.1 {
        true => verdict::quantity(own),
        false => format!(
            "{} = {}",
            own.name,
            verdict::number(own.value, 4, &own.unit)
        ),
    };
    let shapes: Vec<String> = finding.shapes.iter().map(shape).collect();
    if !shapes.is_empty() {
        told.push(format!("Its shape is {}.", shapes.join(", ")));
    }
    told
}

/// What the errors say of it, and the interval.
fn sure(told: &Diagnosed<'_>) -> Vec<String> {
    let held_out = told.errors.iter().any(|record| record.holdout);
    let where_ = match held_out {
        true => "on records that were held out of the fit",
        false => "on the fitted records, because no record was held out",
    };
    let Some((before, after)) = comparison::chi(&told.errors, held_out) else {
        return Vec::new();
    };
    let mut said = Vec::new();
    match told.found.findings.is_empty() {
        true => said.push(format!(
            "The mean square of the innovations is {} {where_}; noise alone gives 1.",
            significant(before, 3)
        )),
        false => said.push(format!(
            "With it the mean square of the innovations falls from {} to {} {where_}; noise alone gives 1.",
            significant(before, 3),
            significant(after, 3)
        )),
    }
    said.extend(largest_change(told, held_out));
    for finding in &told.found.findings {
        let half = (finding.size.interval.1 - finding.size.interval.0) / 2.0;
        let times = (finding.size.value / half).abs();
        if times.is_finite() && told.found.findings.len() == 1 {
            let name = match finding.told_sizes().len() {
                1 => "The size",
                _ => &finding.size.name,
            };
            said.push(format!(
                "{name} is {} times its uncertainty.",
                significant(times, 2)
            ));
        }
    }
    if told.found.unexplained && !told.found.findings.is_empty() {
        said.push(
            "A residual remains that is larger, or more autocorrelated, than noise.".to_owned(),
        );
    }
    said
}

/// The channel whose free run, or windows, changed most.
fn largest_change(told: &Diagnosed<'_>, held_out: bool) -> Option<String> {
    let measured = &told.calibration.compiled.program.experiment.measured;
    let shown = || told.errors.iter().filter(|own| own.holdout == held_out);
    let of = |number: usize| -> Option<(&'static str, Change)> {
        let free = comparison::over(shown(), |record| record.free(number));
        let windows = || {
            let known = shown().filter(|record| record.windows(number).after.is_finite());
            comparison::over(known, |record: &RecordErrors| Some(record.windows(number)))
        };
        match free {
            Some(change) => Some(("the free run", change)),
            None => windows().map(|change| ("windows of 100 ms", change)),
        }
    };
    let each = measured.iter().enumerate();
    let changes = each.filter_map(|(number, channel)| {
        let (what, change) = of(number)?;
        (change.after < change.before).then_some((channel, what, change))
    });
    let ratio = |change: &Change| change.before / change.after;
    let (channel, what, change) = changes.max_by(|a, b| ratio(&a.2).total_cmp(&ratio(&b.2)))?;
    (!told.found.findings.is_empty()).then(|| {
        format!(
            "The rms error of {} in {what} falls from {} to {} (noise floor {}).",
            channel.name,
            engineering_difference(change.before, &channel.unit),
            engineering_difference(change.after, &channel.unit),
            engineering_difference(change.floor, &channel.unit)
        )
    })
}

/// The alternatives, or what came nearest.
fn else_it_may_be(told: &Diagnosed<'_>) -> String {
    let others = others(told);
    if !others.is_empty() {
        return format!(
            "In these records it cannot be distinguished from {}.",
            others.join(", ")
        );
    }
    match verdict::next_best(told) {
        Some(next) => format!("These records distinguish it from all other candidates; {next}."),
        None => "No other candidate comes near it.".to_owned(),
    }
}

fn others(told: &Diagnosed<'_>) -> Vec<String> {
    let findings = told.found.findings.iter();
    let others = findings.flat_map(|finding| finding.related(Relation::Another));
    others
        .map(|other| named(&told.hypotheses[other.hypothesis]))
        .collect()
}

/// Of what is not there, the best known bound.
fn smallest(told: &Diagnosed<'_>) -> Option<String> {
    let tried = told.tried();
    let first = tried.first()?;
    let size = first.hypothesis.sizes.first()?;
    let seen = first.score.detectable?;
    Some(format!(
        "Of the candidate that came nearest, {}, these records would show {} and more.",
        named(first.hypothesis),
        verdict::number(seen, 2, &size.unit)
    ))
}

/// What to record next.
fn next(told: &Diagnosed<'_>) -> String {
    let excite = |more: &str| {
        let file = told.calibration.project.sources.iter().next();
        let file = file.map_or("FILE", |(_, source)| source.name.as_str());
        format!(
            "`hyde excite {file} {}{more} --travel LENGTH`",
            told.plan.name
        )
    };
    if let [first, ..] = told.found.frozen.as_slice() {
        return format!(
            "Record next: the same motion with {} repaired, because its reading was frozen.",
            told.found.channel(first)
        );
    }
    // A law is in no library that the command could take it from.
    let findings = told.found.findings.iter();
    let mut known = findings.filter(|own| told.candidates.get(own.hypothesis).is_some());
    let first = known.find_map(|own| Some((own, own.related(Relation::Another).next()?)));
    if let Some((finding, other)) = first {
        let named = |number: usize| named(&told.hypotheses[number]).replace(" at ", "@");
        let (own, between) = (named(finding.hypothesis), named(other.hypothesis));
        let motion = match &other.experiment {
            Some(experiment) => format!(
                "the motion of {} {} times as long",
                experiment.record,
                significant(experiment.times.max(1.0), 2)
            ),
            None => {
                "another motion, because no motion in these records distinguishes them".to_owned()
            }
        };
        let designs = excite(&format!(" --between {own},{between}"));
        return format!("Record next: {motion}; {designs} designs one.");
    }
    if !told.errors.iter().any(|record| record.holdout) {
        return "Record next: another motion of the same axis, as a `holdout` record that confirms this.".to_owned();
    }
    match told.found.verdict {
        Verdict::Unknown => format!(
            "Record next: slow strokes over the whole travel and strokes at many constant speeds, in both directions, which separate \
             place, speed and time; {} designs a motion.",
            excite("")
        ),
        Verdict::None => format!(
            "Record next, if smaller effects matter: a motion that shows them better; {} designs one.",
            excite("")
        ),
        Verdict::Effect | Verdict::OneOf => format!(
            "Record next, to narrow its interval: the motion that {} designs.",
            excite("")
        ),
    }
}
