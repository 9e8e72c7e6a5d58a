//! `ivp_…`: how near the problems of the Test Set for IVP Solvers come to its reference end values.

use super::promise::{Figure, Measured, Promise, Session};
use crate::ivp;

pub(super) const PROBLEMS: Figure = Figure {
    name: "ivp_problems",
    unit: "problems",
    promise: Promise::AtLeast(5.0),
    measure: |session| {
        measured(session, |digits| {
            #[allow(clippy::cast_precision_loss, reason = "a few problems")]
            let count = digits.iter().filter(|d| **d >= ivp::ENOUGH_DIGITS).count() as f64;
            count
        })
    },
};

pub(super) const MIN_DIGITS: Figure = Figure {
    name: "ivp_min_digits",
    unit: "digits",
    promise: Promise::AtLeast(ivp::ENOUGH_DIGITS),
    measure: |session| {
        measured(session, |digits| {
            digits.iter().copied().fold(f64::INFINITY, f64::min)
        })
    },
};

fn measured(session: &Session, number: fn(&[f64]) -> f64) -> Result<Measured, String> {
    let digits = session.ivp.get_or_init(|| digits(session)).clone()?;
    Ok(digits.map_or_else(
        || Measured::Absent(ivp::ABSENT.to_owned()),
        |digits| Measured::Value(number(&digits)),
    ))
}

/// Correct digits at the tolerance of the files, of every problem that does not say why it is short of them.
fn digits(session: &Session) -> Result<Option<Vec<f64>>, String> {
    let Some(reference) = ivp::reference(&session.data)? else {
        return Ok(None);
    };
    let mut found = Vec::new();
    for problem in ivp::problems()? {
        if problem.short.is_some() {
            continue;
        }
        let solved = problem.solve(&reference, ivp::RTOL);
        found.push(
            solved
                .map_err(|error| format!("{}: {error}", problem.name))?
                .digits,
        );
    }
    Ok(Some(found))
}
