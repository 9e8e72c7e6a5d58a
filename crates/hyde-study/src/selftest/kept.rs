//! An outcome as the store keeps it.

use hyde_calibrate::{Claim, Designed, Outcome, Relation, Verdict};
use serde::{Deserialize, Serialize};

/// An outcome, or why there is none.
pub type Kept = Result<Outcome, String>;

#[derive(Serialize, Deserialize)]
enum Stored {
    Outcome(Box<StoredOutcome>),
    Failed(String),
}

/// Hypothesis, alternatives, size and interval.
type StoredClaim = (Option<usize>, Vec<(usize, String)>, f64, (f64, f64));

#[derive(Serialize, Deserialize)]
struct StoredOutcome {
    planted: (Vec<f64>, Vec<f64>),
    size: f64,
    detectable: Option<f64>,
    expected: Option<(f64, f64)>,
    verdict: String,
    claims: Vec<StoredClaim>,
    unexplained: bool,
    designed: Option<StoredDesigned>,
    equivalent: bool,
}

#[derive(Serialize, Deserialize)]
enum StoredDesigned {
    NoSignal,
    Unrecorded(String),
    Diagnosed(String, f64, String, Vec<StoredClaim>),
}

/// The word of a verdict, as reports have it.
pub fn word(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::None => "none",
        Verdict::Effect => "effect",
        Verdict::OneOf => "one_of",
        Verdict::Unknown => "unknown",
    }
}

/// The verdict of a word.
fn verdict(text: &str) -> Option<Verdict> {
    let verdicts = [
        Verdict::None,
        Verdict::Effect,
        Verdict::OneOf,
        Verdict::Unknown,
    ];
    verdicts.into_iter().find(|&v| word(v) == text)
}

/// The word of a relation, as reports have it.
pub fn relation_word(relation: Relation) -> &'static str {
    match relation {
        Relation::Another => "another",
        Relation::Joined => "joined",
        Relation::Repeats => "repeats",
    }
}

/// The relation of a word.
fn relation(text: &str) -> Option<Relation> {
    let relations = [Relation::Another, Relation::Joined, Relation::Repeats];
    relations.into_iter().find(|&r| relation_word(r) == text)
}

fn stored(claims: &[Claim]) -> Vec<StoredClaim> {
    let others = |claim: &Claim| {
        let all = claim.alternatives.iter();
        all.map(|(number, own)| (*number, relation_word(*own).to_owned()))
            .collect()
    };
    claims
        .iter()
        .map(|claim| (claim.hypothesis, others(claim), claim.size, claim.interval))
        .collect()
}

fn claims(stored: Vec<StoredClaim>) -> Result<Vec<Claim>, String> {
    let others = |list: Vec<(usize, String)>| -> Result<Vec<(usize, Relation)>, String> {
        let all = list.into_iter();
        all.map(|(number, word)| Ok((number, relation(&word).ok_or_else(|| wrong(&word))?)))
            .collect()
    };
    stored
        .into_iter()
        .map(|(hypothesis, alternatives, size, interval)| {
            Ok(Claim {
                hypothesis,
                alternatives: others(alternatives)?,
                size,
                interval,
            })
        })
        .collect()
}

fn wrong(cause: &str) -> String {
    format!("the journal is not that of a self-test: {cause}")
}

/// The bytes of an outcome.
pub(super) fn encoded(kept: &Kept) -> Vec<u8> {
    let kept = match kept {
        Err(reason) => Stored::Failed(reason.clone()),
        Ok(outcome) => Stored::Outcome(Box::new(StoredOutcome {
            planted: outcome.planted.clone(),
            size: outcome.size,
            detectable: outcome.detectable,
            expected: outcome.expected,
            verdict: word(outcome.verdict).to_owned(),
            claims: stored(&outcome.claims),
            unexplained: outcome.unexplained,
            equivalent: outcome.equivalent,
            designed: outcome.designed.as_ref().map(|designed| match designed {
                Designed::NoSignal => StoredDesigned::NoSignal,
                Designed::Unrecorded(signal) => StoredDesigned::Unrecorded(signal.clone()),
                Designed::Diagnosed {
                    signal,
                    apart,
                    verdict,
                    claims,
                } => StoredDesigned::Diagnosed(
                    signal.clone(),
                    *apart,
                    word(*verdict).to_owned(),
                    stored(claims),
                ),
            }),
        })),
    };
    serde_json::to_vec(&kept).unwrap_or_default()
}

/// An outcome of bytes.
pub(super) fn decoded(bytes: &[u8]) -> Result<Kept, String> {
    let kept = serde_json::from_slice(bytes).map_err(|error| wrong(&error.to_string()))?;
    let known = |word: &str| verdict(word).ok_or_else(|| wrong(word));
    Ok(match kept {
        Stored::Failed(reason) => Err(reason),
        Stored::Outcome(own) => Ok(Outcome {
            planted: own.planted,
            size: own.size,
            detectable: own.detectable,
            expected: own.expected,
            verdict: known(&own.verdict)?,
            claims: claims(own.claims)?,
            unexplained: own.unexplained,
            equivalent: own.equivalent,
            designed: match own.designed {
                None => None,
                Some(StoredDesigned::NoSignal) => Some(Designed::NoSignal),
                Some(StoredDesigned::Unrecorded(signal)) => Some(Designed::Unrecorded(signal)),
                Some(StoredDesigned::Diagnosed(signal, apart, verdict, list)) => {
                    Some(Designed::Diagnosed {
                        signal,
                        apart,
                        verdict: known(&verdict)?,
                        claims: claims(list)?,
                    })
                }
            },
        }),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_comes_back() {
        let claim = Claim {
            hypothesis: Some(7),
            alternatives: vec![(1, Relation::Another), (2, Relation::Joined)],
            size: 0.3,
            interval: (0.25, 0.35),
        };
        let outcome = Outcome {
            planted: (vec![0.1, -2.5e-7], vec![3.0]),
            size: 0.1 + 0.2,
            detectable: Some(1.0 / 3.0),
            expected: Some((123.456, 70.0)),
            verdict: Verdict::OneOf,
            claims: vec![claim.clone()],
            unexplained: true,
            designed: None,
            equivalent: true,
        };
        let designed = [
            Designed::NoSignal,
            Designed::Unrecorded("jogs".to_owned()),
            Designed::Diagnosed {
                signal: "jogs".to_owned(),
                apart: 1.0 / 7.0,
                verdict: Verdict::Effect,
                claims: vec![claim],
            },
        ];
        let with = designed.into_iter().map(|designed| Outcome {
            designed: Some(designed),
            ..outcome.clone()
        });
        let all = std::iter::once(outcome.clone()).chain(with);
        for kept in all.map(Ok).chain([Err("no model".to_owned())]) {
            assert_eq!(decoded(&encoded(&kept)), Ok(kept));
        }
        assert!(decoded(b"{}").is_err());
    }
}
