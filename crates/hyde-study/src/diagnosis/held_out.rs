//! [`agreed`]: what was found on the records fitted has to hold on every record held out.
//!
//! Each record held out is looked at by itself, channel by channel, in all three measures: a mean over records hides one
//! that got worse. Worse is what grew by more than its own scatter along the record allows, and lies above its floor. A
//! finding that makes one worse is told first, is not claimed, and is not in the file that is written. Of several findings
//! that one goes without which fewest records are worse.

use super::verdict;
use crate::Calibration;
use crate::comparison::{self, Change, RecordErrors};
use hyde_calibrate::{Diagnosis, FoundModel, Hypothesis, Inquiry, Model, Quantity, Unsupported};
use hyde_compiler::Candidate;
use hyde_units::engineering;

/// An error grew if its square did by so many standard deviations of its mean over parts of the record.
const DEVIATIONS: f64 = 3.5;
/// It is worth a word if it grew by this part, and above its floor by this part.
const GROWN: f64 = 0.02;
const ABOVE_FLOOR: f64 = 0.05;
/// Parts of a record, for the scatter of what changes slowly.
const PARTS: usize = 20;

/// An error of a record held out that a finding made larger.
pub struct Worse {
    /// Its record.
    pub record: String,
    /// Its channel.
    pub channel: String,
    /// The measure, as text and JSON call it.
    pub measure: &'static str,
    /// The error before and after.
    pub change: Change,
    unit: hyde_units::Dimension,
}

/// A finding that does not hold on the records held out.
pub struct Refused {
    /// The number of its hypothesis; that of a law is behind the last of the inquiry.
    pub hypothesis: usize,
    /// Its name, with its size as it was found.
    pub effect: String,
    /// Where it acts.
    pub site: String,
    /// Its size as it was found.
    pub size: Quantity,
    /// The errors that it made larger.
    pub worse: Vec<Worse>,
}

impl Refused {
    /// A sentence, without the stop at its end.
    pub fn sentence(&self) -> String {
        let each: Vec<String> = self.worse.iter().map(Worse::text).collect();
        format!(
            "{} at {} ({}) fits the fitted records but is rejected because it makes held-out records worse: {}",
            self.effect,
            self.site,
            verdict::quantity(&self.size),
            each.join("; ")
        )
    }
}

impl Worse {
    /// `the free run of i in validate-a.csv goes from 22.7 mA to 24 mA`
    fn text(&self) -> String {
        format!(
            "the {} of {} in {} grows from {} to {}",
            self.measure,
            self.channel,
            self.record,
            engineering(self.change.before, self.unit),
            engineering(self.change.after, self.unit)
        )
    }
}

/// The errors of what is left of a diagnosis, and what was dropped.
pub(super) type Agreed = (Vec<RecordErrors>, Vec<Refused>);

/// Drops findings until no record held out gets worse by those that are left.
pub fn agreed(
    calibration: &Calibration,
    candidates: &[Candidate],
    inquiry: &Inquiry<'_>,
    found: &mut Diagnosis,
) -> Result<Agreed, Unsupported> {
    let of = |found: &Diagnosis, model: &FoundModel| errors(calibration, candidates, found, model);
    let mut refused = Vec::new();
    let mut here = of(found, &found.model())?;
    loop {
        let worse = worse(calibration, &here);
        if worse.is_empty() || found.findings.is_empty() {
            return Ok((here, refused));
        }
        let mut best = None;
        for number in 0..found.findings.len() {
            let less = found.without(inquiry, number)?;
            let there = of(found, &less)?;
            let rank = (self::worse(calibration, &there).len(), less.cost());
            let is_better = |(_, _, known): &(usize, FoundModel, (usize, f64))| {
                rank.0 < known.0 || (rank.0 == known.0 && rank.1 < known.1)
            };
            if best.as_ref().is_none_or(is_better) {
                best = Some((number, less, rank));
            }
        }
        let Some((number, less, _)) = best else {
            return Ok((here, refused));
        };
        let finding = &found.findings[number];
        let law = found.law().map(|law| &law.hypothesis);
        let hypothesis = inquiry.hypotheses.get(finding.hypothesis).or(law);
        if let Some(Hypothesis { effect, site, .. }) = hypothesis {
            refused.push(Refused {
                hypothesis: finding.hypothesis,
                effect: effect.clone(),
                site: site.clone(),
                size: finding.size.clone(),
                worse,
            });
        }
        found.keep(inquiry, less)?;
        here = of(found, &found.model())?;
    }
}

/// The errors of a model without effects, and of a model found, on all records of a calibration.
fn errors(
    calibration: &Calibration,
    candidates: &[Candidate],
    found: &Diagnosis,
    model: &FoundModel,
) -> Result<Vec<RecordErrors>, Unsupported> {
    let project = &calibration.project;
    let numbers = model.hypotheses();
    let is_known = |number: &&usize| **number < candidates.len();
    let known: Vec<usize> = numbers.iter().filter(is_known).copied().collect();
    let law = found.law().filter(|_| known.len() < numbers.len());
    let written: Vec<&hyde_calibrate::Written> = law.iter().map(|law| &law.written).collect();
    let varied = calibration.varied.iter().zip(&found.before.values);
    let mut before = project.set();
    before.extend(varied.map(|(varied, &value)| (varied.name.clone(), value)));
    let mut after = project.set();
    after.extend(model.values());
    let plain = comparison::closed(project, candidates, &[], &[], &before);
    let with_effects = comparison::closed(project, candidates, &known, &written, &after);
    comparison::errors(
        calibration,
        found.observer.as_ref().unwrap_or(&calibration.observer),
        (!numbers.is_empty()).then_some(Model {
            observed: &calibration.compiled.program,
            closed: plain.as_ref().map(|(own, _)| own),
            shifted: None,
            set: &before,
        }),
        Model {
            observed: model.program(),
            closed: with_effects.as_ref().map(|(own, _)| own),
            shifted: with_effects.as_ref().map(|(_, shifted)| shifted),
            set: &after,
        },
    )
}

/// What got worse on the records held out.
fn worse(calibration: &Calibration, errors: &[RecordErrors]) -> Vec<Worse> {
    let measured = &calibration.compiled.program.experiment.measured;
    let deviations = &calibration.observer.deviations;
    let mut found = Vec::new();
    for record in errors.iter().filter(|record| record.holdout) {
        for (number, channel) in measured.iter().enumerate() {
            let mut look = |measure, change: Option<Change>, grown: bool| {
                let worth = |change: &Change| {
                    change.after > (1.0 + GROWN) * change.before
                        && change.after > (1.0 + ABOVE_FLOOR) * change.floor
                };
                if let Some(change) = change.filter(|change| grown && worth(change)) {
                    found.push(Worse {
                        record: record.after.record.clone(),
                        channel: channel.name.clone(),
                        measure,
                        change,
                        unit: channel.unit.unit().dimension,
                    });
                }
            };
            let (before, after) = (&record.before, &record.after);
            let [old, new] = [before, after].map(|own| own.whitened.of_readings(number));
            look(
                "innovations",
                Some(record.innovations(number, deviations)),
                grew([&old, &new]),
            );
            let windows = [before, after].map(|own| own.windows.rms[number].as_slice());
            look(
                "100 ms windows",
                Some(record.windows(number)),
                grew(windows),
            );
            let free = [before, after].map(|own| {
                let channels = own.free.as_ref().ok();
                let channel = channels.and_then(|channels| channels.get(number));
                channel.map_or(&[][..], |own| own.channel.error.as_slice())
            });
            look("free run", record.free(number), grew(free));
        }
    }
    found
}

/// Whether the square of an error grew by more than its scatter over parts of the record.
fn grew([before, after]: [&[f64]; 2]) -> bool {
    let rows = before.len().min(after.len());
    let length = rows.div_ceil(PARTS).max(1);
    let square = |part: &[f64]| {
        part.iter()
            .filter(|e| e.is_finite())
            .map(|e| e * e)
            .sum::<f64>()
    };
    let parts = before[..rows]
        .chunks(length)
        .zip(after[..rows].chunks(length));
    let grown: Vec<f64> = parts
        .map(|(before, after)| square(after) - square(before))
        .collect();
    let count = grown.len() as f64;
    let mean = grown.iter().sum::<f64>() / count;
    let variance = grown.iter().map(|own| (own - mean).powi(2)).sum::<f64>() / (count - 1.0);
    count >= 2.0 && mean > DEVIATIONS * (variance / count).sqrt()
}

#[cfg(test)]
mod tests {
    use super::grew;

    #[test]
    fn an_error_grew_where_it_did_all_along() {
        let noise = |row: usize| (12.9898 * row as f64).sin();
        let before: Vec<f64> = (0..2000).map(noise).collect();
        let by = |factor: f64| -> Vec<f64> { before.iter().map(|own| factor * own).collect() };
        assert!(grew([&before, &by(1.05)]));
        assert!(!grew([&before, &by(0.95)]) && !grew([&before, &before]));
        // One part of twenty that is off is a chance event.
        let mut once = before.clone();
        once[300..350].iter_mut().for_each(|own| *own *= 3.0);
        assert!(!grew([&before, &once]));
        assert!(!grew([&[], &[]]));
    }
}
