//! [`Designed`]: a diagnosis that cannot distinguish several effects, repeated with one more record, which is designed to
//! distinguish them and simulated as the others are.

use super::case::Case;
use super::separation::Point;
use super::trial::{Axis, Claim, Judged, Planted, Records, SelftestError, judged, tables};
use crate::diagnosis::{Diagnosis, Finding, Hypothesis, Relation, Verdict};
use std::sync::atomic::Ordering;

/// A signal that is to distinguish effects.
#[derive(Clone, Debug)]
pub struct Signal {
    /// Its name.
    pub name: String,
    /// The least gain of an effect over another one on it, as a part of the threshold.
    pub apart: f64,
    /// The record: the signal in the column that it is for, 0 in all others.
    pub records: Records,
}

/// Designs the signal that best distinguishes effects, each at the size and with the shapes that were fitted; `None` if no
/// signal within the limits can be made and observed with each of them.
pub type Designer<'a> = dyn Fn(&[Point]) -> Option<Signal> + Sync + 'a;

/// What became of a verdict `one of` with one designed record more.
#[derive(Clone, Debug, PartialEq)]
pub enum Designed {
    /// There is no signal.
    NoSignal,
    /// The axis cannot be simulated on the signal of this name, or what it leaves cannot be observed.
    Unrecorded(String),
    /// The records were diagnosed again, with that of a signal.
    Diagnosed {
        /// The name of the signal.
        signal: String,
        /// The least gain of an effect over another one on it, as a part of the threshold.
        apart: f64,
        /// The new verdict.
        verdict: Verdict,
        /// What is claimed now.
        claims: Vec<Claim>,
    },
}

impl Designed {
    /// Whether the new verdict names a hypothesis, and no other answer.
    #[must_use]
    pub fn resolves(&self, hypothesis: usize) -> bool {
        match self {
            Self::NoSignal | Self::Unrecorded(_) => false,
            Self::Diagnosed {
                verdict, claims, ..
            } => match claims.as_slice() {
                [only] => *verdict == Verdict::Effect && only.is_alone(hypothesis),
                _ => false,
            },
        }
    }
}

/// Designs a record for effects that a diagnosis of `made` cannot distinguish, simulates it and diagnoses again.
pub(super) fn designed(
    axis: &Axis<'_>,
    designer: &Designer<'_>,
    case: &Case,
    planted: &Planted,
    mut made: Vec<Records>,
    points: &[Point],
) -> Result<Designed, SelftestError> {
    let Some(signal) = designer(points) else {
        return Ok(Designed::NoSignal);
    };
    let number = made.len();
    let again = tables(axis, case, planted, &[signal.records], number).and_then(|own| {
        made.extend(own);
        judged(axis, case, &made)
    });
    match again {
        Ok(Judged {
            verdict, claims, ..
        }) => Ok(Designed::Diagnosed {
            signal: signal.name,
            apart: signal.apart,
            verdict,
            claims,
        }),
        Err(SelftestError::Interrupted) => Err(SelftestError::Interrupted),
        Err(_) if axis.interrupted.load(Ordering::Relaxed) => Err(SelftestError::Interrupted),
        Err(
            SelftestError::Simulation(_)
            | SelftestError::Model
            | SelftestError::Record(_)
            | SelftestError::Unsupported(_),
        ) => Ok(Designed::Unrecorded(signal.name)),
    }
}

/// The effects of the first finding that is not alone, itself first, as they were fitted.
pub(super) fn ambiguous(found: &Diagnosis, hypotheses: &[Hypothesis]) -> Vec<Point> {
    let of = |finding: &Finding| {
        let others = finding.related(Relation::Another);
        others.map(|other| other.hypothesis).collect::<Vec<usize>>()
    };
    let mut findings = found.findings.iter().map(|finding| (finding, of(finding)));
    let Some((finding, others)) = findings.find(|(_, others)| !others.is_empty()) else {
        return Vec::new();
    };
    let numbers = std::iter::once(finding.hypothesis).chain(others);
    numbers
        .filter_map(|number| Some(fitted(found, finding, number, hypotheses.get(number)?)))
        .collect()
}

/// A hypothesis as it was fitted in the round of a finding.
fn fitted(found: &Diagnosis, finding: &Finding, number: usize, hypothesis: &Hypothesis) -> Point {
    let round = found.rounds.get(finding.round);
    let mut trials = round.into_iter().flat_map(|round| &round.trials);
    let (sizes, shapes) = (hypothesis.sizes.len(), hypothesis.shapes.len());
    let trial = trials.find(|trial| {
        trial.hypothesis == number
            && trial.values.len() == sizes + shapes
            && trial.values.iter().all(|value| value.is_finite())
    });
    let part = finding.size.value / hypothesis.sizes.first().map_or(1.0, super::case::largest);
    trial.map_or_else(
        || Point::at_part(number, hypothesis, part),
        |trial| Point {
            hypothesis: number,
            sizes: trial.values[..sizes].to_vec(),
            shapes: trial.values[sizes..].to_vec(),
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_planted_effect_alone_resolves_a_verdict() {
        let claim = |hypothesis: usize, alternatives: &[(usize, Relation)]| Claim {
            hypothesis: Some(hypothesis),
            alternatives: alternatives.to_vec(),
            size: 1.0,
            interval: (0.9, 1.1),
        };
        let diagnosed = |verdict, claims: &[Claim]| Designed::Diagnosed {
            signal: "jogs".to_owned(),
            apart: 2.0,
            verdict,
            claims: claims.to_vec(),
        };
        assert!(diagnosed(Verdict::Effect, &[claim(3, &[])]).resolves(3));
        // The place is one of several that move together; a law that repeats the planted one with more constants is no other answer.
        let joined = claim(4, &[(3, Relation::Joined), (6, Relation::Repeats)]);
        assert!(diagnosed(Verdict::Effect, std::slice::from_ref(&joined)).resolves(3));
        assert!(!diagnosed(Verdict::Effect, &[joined]).resolves(6));
        for other in [
            diagnosed(Verdict::Effect, &[claim(4, &[])]),
            diagnosed(Verdict::OneOf, &[claim(3, &[(4, Relation::Another)])]),
            diagnosed(Verdict::Effect, &[claim(3, &[]), claim(5, &[])]),
            diagnosed(Verdict::Unknown, &[claim(3, &[])]),
            diagnosed(Verdict::None, &[]),
            Designed::Unrecorded("jogs".to_owned()),
            Designed::NoSignal,
        ] {
            assert!(!other.resolves(3), "{other:?}");
        }
    }
}
