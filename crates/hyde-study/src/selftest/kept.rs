//! An outcome as the store keeps it.

use hyde_calibrate::{Claim, Outcome, Verdict};
use serde::{Deserialize, Serialize};

/// An outcome, or why there is none.
pub type Kept = Result<Outcome, String>;

#[derive(Serialize, Deserialize)]
enum Stored {
    Outcome(StoredOutcome),
    Failed(String),
}

/// Hypothesis, alternatives, size and interval.
type StoredClaim = (Option<usize>, Vec<usize>, f64, (f64, f64));

#[derive(Serialize, Deserialize)]
struct StoredOutcome {
    planted: (Vec<f64>, Vec<f64>),
    size: f64,
    detectable: Option<f64>,
    expected: Option<(f64, f64)>,
    verdict: String,
    claims: Vec<StoredClaim>,
    unexplained: bool,
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

/// The bytes of an outcome.
pub(super) fn encoded(kept: &Kept) -> Vec<u8> {
    let stored = match kept {
        Err(reason) => Stored::Failed(reason.clone()),
        Ok(outcome) => Stored::Outcome(StoredOutcome {
            planted: outcome.planted.clone(),
            size: outcome.size,
            detectable: outcome.detectable,
            expected: outcome.expected,
            verdict: word(outcome.verdict).to_owned(),
            claims: outcome
                .claims
                .iter()
                .map(|c| (c.hypothesis, c.alternatives.clone(), c.size, c.interval))
                .collect(),
            unexplained: outcome.unexplained,
        }),
    };
    serde_json::to_vec(&stored).unwrap_or_default()
}

/// An outcome of bytes.
pub(super) fn decoded(bytes: &[u8]) -> Result<Kept, String> {
    let wrong = |cause: &str| format!("the journal is not that of a self-test: {cause}");
    let stored = serde_json::from_slice(bytes).map_err(|error| wrong(&error.to_string()))?;
    Ok(match stored {
        Stored::Failed(reason) => Err(reason),
        Stored::Outcome(stored) => {
            let verdicts = [
                Verdict::None,
                Verdict::Effect,
                Verdict::OneOf,
                Verdict::Unknown,
            ];
            let verdict = verdicts.into_iter().find(|&v| word(v) == stored.verdict);
            let claims = stored.claims.into_iter();
            Ok(Outcome {
                planted: stored.planted,
                size: stored.size,
                detectable: stored.detectable,
                expected: stored.expected,
                verdict: verdict.ok_or_else(|| wrong(&stored.verdict))?,
                claims: claims
                    .map(|(hypothesis, alternatives, size, interval)| Claim {
                        hypothesis,
                        alternatives,
                        size,
                        interval,
                    })
                    .collect(),
                unexplained: stored.unexplained,
            })
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_comes_back() {
        let outcome = Outcome {
            planted: (vec![0.1, -2.5e-7], vec![3.0]),
            size: 0.1 + 0.2,
            detectable: Some(1.0 / 3.0),
            expected: Some((123.456, 70.0)),
            verdict: Verdict::OneOf,
            claims: vec![Claim {
                hypothesis: Some(7),
                alternatives: vec![1, 2],
                size: 0.3,
                interval: (0.25, 0.35),
            }],
            unexplained: true,
        };
        for kept in [Ok(outcome), Err("no model".to_owned())] {
            assert_eq!(decoded(&encoded(&kept)), Ok(kept));
        }
        assert!(decoded(b"{}").is_err());
    }
}
