//! The verdict in one sentence, and its doubt.

use super::{Diagnosed, Refused, named, timing};
use crate::comparison::{self, RecordErrors};
use crate::unobservable::reason;
use hyde_calibrate::{Finding, Frozen, Quantity, Relation, Verdict};
use hyde_units::{NamedUnit, drawn_in, shown, significant};

/// One sentence, without the stop at its end.
pub fn sentence(told: &Diagnosed<'_>) -> String {
    let timings = timing::wrong(told).map(|own| timing::short(told, own));
    let all = std::iter::once(missing(told)).chain(timings);
    all.collect::<Vec<String>>().join("; ")
}

/// What is missing.
fn missing(told: &Diagnosed<'_>) -> String {
    let names: Vec<String> = told
        .found
        .findings
        .iter()
        .map(|finding| sized(told, finding))
        .collect();
    match told.found.verdict {
        Verdict::None => "no missing effect detected".to_owned(),
        Verdict::Unknown if names.is_empty() => match told.found.frozen.as_slice() {
            [] => {
                let hint = told
                    .found
                    .unknown
                    .as_ref()
                    .and_then(crate::unknown::most_like);
                let hint =
                    hint.map_or_else(String::new, |hint| format!("; it most resembles {hint}"));
                format!("the model is incomplete: no known effect explains the residual{hint}")
            }
            _ => "a sensor reading was frozen; these records cannot be diagnosed".to_owned(),
        },
        Verdict::Unknown => {
            let names = names.join(", then ");
            match told.found.law() {
                Some(_) => {
                    let more = match told.found.unexplained {
                        true => ", and it does not explain the whole residual",
                        false => "",
                    };
                    format!("missing effect: {names}; no library has this effect{more}")
                }
                None => format!(
                    "the model is incomplete: no known effect explains the residual; a part of it resembles {names}"
                ),
            }
        }
        Verdict::Effect => format!("missing effect: {}", names.join(", then ")),
        Verdict::OneOf => format!(
            "missing effect: {}, or another that cannot be distinguished from it",
            names.join(", then ")
        ),
    }
}

/// `Stribeck at guide (dF = 12.1 ± 0.3 N)`, `Cogging at pulley.a or screw.b (…)`
fn sized(told: &Diagnosed<'_>, finding: &Finding) -> String {
    format!("{} ({})", at_places(told, finding), sizes(finding))
}

/// `F1 = 12.1 ± 0.3 N, F2 = -3.2 ± 0.1 N`
pub fn sizes(finding: &Finding) -> String {
    let each = finding.told_sizes().iter().map(quantity);
    each.collect::<Vec<_>>().join(", ")
}

/// An effect at all places where no record tells it from itself.
fn at_places(told: &Diagnosed<'_>, finding: &Finding) -> String {
    let own = std::iter::once(named(&told.hypotheses[finding.hypothesis]));
    let joined = finding.related(Relation::Joined);
    let joined = joined.map(|other| {
        let other = &told.hypotheses[other.hypothesis];
        let same = other.effect == told.hypotheses[finding.hypothesis].effect;
        if same {
            other.site.clone()
        } else {
            named(other)
        }
    });
    own.chain(joined).collect::<Vec<_>>().join(" or ")
}

/// What a finding cannot be told from and is no other answer: a sentence each, without the stop at its end.
pub fn repeated(told: &Diagnosed<'_>, finding: &Finding) -> Vec<String> {
    let mut found = Vec::new();
    if finding.related(Relation::Joined).next().is_some() {
        found.push(format!(
            "{}: these places move together, and no record tells what acts at one of them from what acts at another",
            at_places(told, finding)
        ));
    }
    let general = finding.related(Relation::Repeats);
    let general: Vec<String> = general
        .map(|other| named(&told.hypotheses[other.hypothesis]))
        .collect();
    if !general.is_empty() {
        found.push(format!(
            "{} with more constants predicts the same as {} in these records",
            general.join(" or "),
            named(&told.hypotheses[finding.hypothesis])
        ));
    }
    found
}

/// The part of its width by which an interval may lie off the value and is still told as `±`.
const OFF: f64 = 0.02;

/// `dF = 12.1 ± 0.3 N`, or `drift = 2.1 um, 0.34 um to 47 um`
pub fn quantity(quantity: &Quantity) -> String {
    let (low, high) = quantity.interval;
    let half = (high - low) / 2.0;
    let (_, of) = drawn_in(&quantity.unit);
    if half == 0.0 {
        // A count that was tried: 12 periods.
        let value = number(quantity.value, 4, &quantity.unit);
        return format!("{} = {value}", quantity.name);
    }
    if ((low + high) / 2.0 - quantity.value).abs() > OFF * half {
        let [value, low, high] = [(quantity.value, 4), (low, 2), (high, 2)]
            .map(|(si, digits)| number(si, digits, &quantity.unit));
        return format!("{} = {value}, {low} to {high}", quantity.name);
    }
    format!(
        "{} = {} ± {}",
        quantity.name,
        significant(of.from_si(quantity.value), 4),
        number(of.to_si(of.scale.remove(half)), 2, &quantity.unit)
    )
}

/// A value in the unit that it is shown in: `0.012 m`, `6 bar`.
pub fn number(si: f64, digits: usize, unit: &NamedUnit) -> String {
    let (unit, of) = drawn_in(unit);
    let text = format!("{} {}", significant(of.from_si(si), digits), shown(&unit));
    text.trim_end().to_owned()
}

/// What the verdict stands on.
pub fn grounds(told: &Diagnosed<'_>) -> Vec<String> {
    let held_out = comparison::chi(&told.errors, true);
    let seen = comparison::chi(&told.errors, false);
    let Some((before, after)) = held_out.or(seen) else {
        return Vec::new();
    };
    let which = if held_out.is_some() {
        "on the held-out records"
    } else {
        "on the fitted records (no record was held out)"
    };
    let change = match told.found.findings.is_empty() {
        true => format!("is {}", significant(before, 4)),
        false => format!(
            "changes from {} to {}",
            significant(before, 4),
            significant(after, 4)
        ),
    };
    let observer = told.found.observer.as_ref().map(|_| {
        "all models are compared with the observer of the model with the effects, because the observer of the declared \
         model is not stable in all modes"
            .to_owned()
    });
    let change = format!(
        "the mean square of the innovations {change} {which}; a complete model gives about 1"
    );
    let uncompared = timing::uncompared(told).map(|(command, why)| {
        format!("whether the model puts out {command} at the right time is not known: {why}")
    });
    let all = [change].into_iter().chain(observer);
    all.chain(uncompared).collect()
}

/// What speaks against the verdict.
pub fn doubts(told: &Diagnosed<'_>) -> Vec<String> {
    let timings = timing::wrong(told).flat_map(|own| timing::about(told, own));
    let mut doubts: Vec<String> = timings.collect();
    doubts.extend(told.refused.iter().map(Refused::sentence));
    doubts.extend(told.found.frozen.iter().map(|own| frozen(told, own)));
    let causes = told.causes.iter();
    doubts.extend(causes.map(|cause| reason(told.calibration, cause)));
    let held_out = comparison::chi(&told.errors, true);
    let seen = comparison::chi(&told.errors, false);
    if let Some((before, after)) = held_out.or(seen) {
        if after > before && !told.found.findings.is_empty() {
            doubts.push("the held-out records do not confirm it".to_owned());
        }
        doubts.extend(beyond_the_fitted(&told.errors));
    }
    for finding in &told.found.findings {
        let others: Vec<String> = finding
            .related(Relation::Another)
            .map(|other| named(&told.hypotheses[other.hypothesis]))
            .collect();
        if !others.is_empty() {
            doubts.push(format!(
                "in these records {} cannot be distinguished from {}",
                named(&told.hypotheses[finding.hypothesis]),
                others.join(", ")
            ));
        }
    }
    for finding in &told.found.findings {
        doubts.extend(repeated(told, finding));
        let hypothesis = &told.hypotheses[finding.hypothesis];
        let shapes = finding.shapes.iter().zip(&hypothesis.shapes);
        for (shape, _) in shapes.filter(|(shape, knob)| knob.is_at_bound(shape.value)) {
            doubts.push(format!(
                "{} of {} is at its bound: the missing effect is probably a similar one",
                shape.name,
                named(hypothesis)
            ));
        }
        let mut sizes = finding.sizes.iter().zip(&hypothesis.sizes);
        if sizes.any(|(size, knob)| knob.is_beyond(size.value)) {
            doubts.push(format!(
                "{} is larger than the range that its library gives",
                named(hypothesis)
            ));
        }
    }
    if let Some(next) = next_best(told) {
        doubts.push(next);
    }
    if told.found.unexplained {
        doubts.push("the residuals are larger, or more autocorrelated, than noise".to_owned());
    }
    for (_, new) in &told.parameters {
        if new.left_range || new.at_bound {
            doubts.push(format!(
                "{} is outside its declared range: it may compensate for a missing effect",
                new.name
            ));
        }
    }
    for number in &told.barred {
        let effect = named(&told.hypotheses[*number]);
        doubts.push(format!(
            "{effect} was found first and dropped, because the records do not determine its size; the search was repeated without it"
        ));
    }
    for (number, because) in &told.hindered {
        let effect = named(&told.hypotheses[*number]);
        doubts.push(format!(
            "{effect} was not tried because it cannot be added to the model: {because}"
        ));
    }
    if !told.found.after.converged {
        doubts.push("the last fit did not converge".to_owned());
    }
    doubts
}

/// A reading that was held.
fn frozen(told: &Diagnosed<'_>, own: &Frozen) -> String {
    let (from, to) = own.time_s;
    format!(
        "{} of {} is constant from {} to {} s and then jumps: the sensor or its cable froze, not the drive",
        told.found.channel(own),
        own.record,
        significant(from, 4),
        significant(to, 4)
    )
}

/// An alternative, and the experiment that would tell.
pub fn alternative(told: &Diagnosed<'_>, other: &hyde_calibrate::Alternative) -> String {
    let name = named(&told.hypotheses[other.hypothesis]);
    match &other.experiment {
        Some(experiment) => format!(
            "{name}: recording the motion of {1} {0} times as long would distinguish them, above all its part from {2} s on",
            significant(experiment.times.max(1.0), 2),
            experiment.record,
            significant(experiment.second_s, 3)
        ),
        None => format!("{name}: no motion in these records distinguishes them"),
    }
}

/// A record held out is not explained if its innovations are so many times those of any record that was fitted.
const BEYOND: f64 = 1.2;

/// Records held out that show what those fitted did not.
fn beyond_the_fitted(errors: &[RecordErrors]) -> Option<String> {
    let chi = |held: bool| {
        let own = errors.iter().filter(move |record| record.holdout == held);
        own.map(|record| (record.after.record.as_str(), record.after.chi))
    };
    let most = chi(false).map(|(_, chi)| chi).fold(0.0, f64::max);
    let beyond = chi(true).filter(|(_, chi)| most > 0.0 && *chi > BEYOND * most);
    let each: Vec<String> = beyond
        .map(|(record, chi)| format!("{record} ({})", significant(chi, 3)))
        .collect();
    (!each.is_empty()).then(|| {
        format!(
            "the mean square of the innovations stays larger in {} than in any fitted record (at most {}): those records \
             contain behaviour that the fitted records do not",
            each.join(", "),
            significant(most, 3)
        )
    })
}

/// From so many percent on what is missing to all tells more than the share.
const NEARLY_ALL: f64 = 99.0;

/// Of the round that took in the last effect, the hypothesis that came nearest to it.
pub fn next_best(told: &Diagnosed<'_>) -> Option<String> {
    let finding = told.found.findings.last()?;
    let round = told.found.rounds.get(finding.round)?;
    let mut trials = round.trials.iter();
    let own =
        trials.find(|trial| trial.hypothesis == finding.hypothesis && trial.rejected.is_none())?;
    let taken = |number: usize| {
        let mut findings = told.found.findings.iter();
        findings.any(|other| other.hypothesis == number)
    };
    let is_alternative = |number: usize| {
        let mut alternatives = finding.alternatives.iter();
        alternatives.any(|other| other.hypothesis == number)
    };
    let next = round
        .trials
        .iter()
        .filter(|trial| !taken(trial.hypothesis) && !is_alternative(trial.hypothesis))
        .max_by(|a, b| a.gain.total_cmp(&b.gain))?;
    let share = 100.0 * next.gain / own.gain;
    let gains = match share > NEARLY_ALL && share < 100.0 {
        true => format!(
            "improves the fit by {} % less",
            significant(100.0 - share, 2)
        ),
        false => format!("reaches {} % of its improvement", significant(share, 3)),
    };
    let name = named(&told.hypotheses[next.hypothesis]);
    Some(format!("the next best candidate, {name}, {gains}"))
}
