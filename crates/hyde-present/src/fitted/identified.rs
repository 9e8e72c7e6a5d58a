//! Which parameters the records determine, in sentences that say what to do.

use super::named;
use crate::diagnosed::wrapped;
use hyde_calibrate::Identifiability;
use hyde_study::JointCalibration;
use std::fmt::Write as _;

/// What is not determined, a sentence each; nothing where all is.
pub fn sentences(calibration: &JointCalibration, before: &Identifiability) -> Vec<String> {
    let mut found = Vec::new();
    if !before.unmoved.is_empty() {
        found.push(format!(
            "no record depends on {}: leave out of `vary` what no record shows, or record a motion that it influences; `hyde excite` designs one",
            named(calibration, &before.unmoved)
        ));
    }
    if !before.weak.is_empty() {
        found.push(format!(
            "the records determine {} less closely than the declared spread, or than 20 % without one: record a motion with more influence of \
             these parameters, or leave them out of `vary`",
            named(calibration, &before.weak)
        ));
    }
    for own in &before.together {
        let without = own.parameters.iter().copied();
        let without = without.filter(|&number| calibration.varied[number].prior.is_none());
        let without: Vec<usize> = without.collect();
        let divided = match without.as_slice() {
            [] => "the declared spreads divide it between them".to_owned(),
            some => format!(
                "{} without a spread may take any value",
                named(calibration, some)
            ),
        };
        found.push(format!(
            "the records determine {} only together: {} of these {} parameters; {divided}. Record a motion or a load in which they differ, declare \
             a narrower spread, or fix one: leave it out of `vary`",
            named(calibration, &own.parameters),
            combinations(own.determined),
            own.parameters.len(),
        ));
    }
    found
}

fn combinations(count: usize) -> String {
    match count {
        1 => "1 combination".to_owned(),
        count => format!("{count} combinations"),
    }
}

/// The sentences in lines of at most 80 columns, under a heading; empty where there is none.
pub fn text(calibration: &JointCalibration, before: &Identifiability) -> String {
    let sentences = sentences(calibration, before);
    let mut out = String::new();
    if sentences.is_empty() {
        return out;
    }
    let _ = writeln!(out, "before the fit, {}:", calibration.plan.name);
    for sentence in sentences {
        wrapped(&mut out, "  -", &sentence);
    }
    out
}
