//! `msl_matched`: how many models of the Modelica Standard Library, written anew, match its reference trajectories.

use super::promise::{Figure, Measured, Promise, Session};
use crate::msl;

pub(super) const FIGURE: Figure = Figure {
    name: "msl_matched",
    unit: "models",
    promise: Promise::AtLeast(25.0),
    measure,
};

fn measure(session: &Session) -> Result<Measured, String> {
    let Some(folder) = msl::reference(&session.data) else {
        return Ok(Measured::Absent(msl::ABSENT.to_owned()));
    };
    let mut matched = 0_u32;
    for case in msl::cases()? {
        let verdict = case.compare(&folder);
        matched += u32::from(verdict.is_ok_and(|verdict| verdict.matches()));
    }
    Ok(Measured::Value(f64::from(matched)))
}
