//! A diagnosis from its block to what it found, as the data that text, JSON and page are made of.
//!
//! ```text
//! prepared     its block, and the calibration that it stands on   diagnosis/prepared.rs
//! search       looks for what is missing                          diagnosis/search.rs
//! held out     what the held-out records do not confirm           diagnosis/held_out.rs
//! verdict      one sentence, and what is doubtful about it        diagnosis/verdict.rs
//! timing       a command that is put out at another time          diagnosis/timing.rs
//! model        the old text with a new model behind               diagnosis/model.rs
//! ```

mod held_out;
mod model;
mod prepared;
mod search;
pub mod timing;
pub mod verdict;

pub use held_out::{Refused, Worse, agreed};
pub use prepared::prepared;
pub use search::{hypothesis, search};

use crate::Calibration;
use crate::Project;
use crate::comparison::RecordErrors;
use crate::unknown;
use hyde_calibrate::{
    Cause, Commands, Diagnosis, FittedParameter, FoundCurve, Hypothesis, Innovations, Rejection,
    ResidualMap, Score, Trial, Whiteness, fitted_parameters, residual_maps, whiteness,
};
use hyde_compiler::{Candidate, DiagnosisPlan, Form, Written};
use std::collections::BTreeMap;

/// A diagnosis with all that is told of it.
pub struct Diagnosed<'a> {
    /// What was asked.
    pub plan: &'a DiagnosisPlan,
    /// The calibration that it stands on.
    pub calibration: &'a Calibration,
    /// What was tried, by number.
    pub hypotheses: &'a [Hypothesis],
    /// What the hypotheses are made of; a law has none.
    pub candidates: &'a [Candidate],
    /// What the search found.
    pub found: &'a Diagnosis,
    /// Errors of the calibrated model without effects and with them.
    pub errors: Vec<RecordErrors>,
    /// What was found and does not hold on the records held out.
    pub refused: Vec<Refused>,
    /// Each parameter of the model: calibrated without effects, and with them.
    pub parameters: Vec<(FittedParameter, FittedParameter)>,
    /// What innovations depend on in the records fitted, and whether they are white.
    pub maps: Vec<ResidualMap>,
    /// Whether the innovations are white, channel by channel.
    pub whiteness: Vec<Whiteness>,
    /// Each finding as a curve, where it is one; nothing where only a terminal is told.
    pub curves: Vec<Option<FoundCurve>>,
    /// Why the calibrated model does not follow the records, if it does not.
    pub causes: Vec<Cause>,
    /// When the model puts out the commands that are replayed, beside when they were recorded.
    pub commands: Commands,
    /// Hypotheses that could not be put on the model, each with the reason.
    pub hindered: Vec<(usize, String)>,
    /// Hypotheses that were found first and dropped.
    pub barred: Vec<usize>,
    /// The model that has what was missing.
    pub written: Written,
}

/// A hypothesis that was tried and not taken in.
pub struct Tried<'a> {
    /// The hypothesis.
    pub hypothesis: &'a Hypothesis,
    /// In the last round: what the scan promised.
    pub score: &'a Score,
    /// Its fit, if it was worth one: that of the last round that had one.
    pub trial: Option<&'a Trial>,
}

impl<'a> Diagnosed<'a> {
    /// Looks at what is left and writes the model.
    pub fn new(
        plan: &'a DiagnosisPlan,
        calibration: &'a Calibration,
        candidates: &'a [Candidate],
        hypotheses: &'a [Hypothesis],
        found: &'a Diagnosis,
        (errors, refused): (Vec<RecordErrors>, Vec<Refused>),
    ) -> Self {
        let project = &calibration.project;
        let law = found.law();
        let is_law = |finding: &hyde_calibrate::Finding| finding.hypothesis >= candidates.len();
        let law = law.filter(|_| found.findings.iter().any(is_law));
        let written: Vec<&hyde_calibrate::Written> = law.iter().map(|law| &law.written).collect();
        let old = fitted_parameters(&calibration.varied, &found.before);
        let new = fitted_parameters(&found.varied, &found.after);
        let parameters = old
            .into_iter()
            .filter_map(|old| {
                let new = new.iter().find(|new| new.name == old.name)?.clone();
                Some((old, new))
            })
            .collect();
        let fitted = || errors.iter().filter(|record| !record.holdout);
        let before: Vec<&Innovations> = fitted().map(|own| &own.before.whitened).collect();
        let after: Vec<&Innovations> = fitted().map(|own| &own.after.whitened).collect();
        let program = &calibration.compiled.program;
        let maps = residual_maps(program, &calibration.fitted, &before, &after);
        let whiteness = whiteness(program, &before, &after);
        let mut told = Self {
            plan,
            calibration,
            hypotheses,
            candidates,
            found,
            errors,
            refused,
            parameters,
            maps,
            whiteness,
            curves: Vec::new(),
            causes: Vec::new(),
            commands: Commands::default(),
            hindered: hindered(project, candidates, found),
            barred: {
                let barred = found.barred.iter().copied();
                barred.filter(|number| *number < hypotheses.len()).collect()
            },
            written: Written {
                text: String::new(),
                model: String::new(),
                experiment: None,
            },
        };
        told.written = model::written(&told, candidates, &written);
        told
    }

    /// What was written behind the text of the user's file.
    pub fn new_text(&self) -> &str {
        let project = &self.calibration.project;
        let own = project.file.files.first();
        let own = own.map_or(0, |(file, _)| {
            project.sources.get(*file).text.trim_end().len()
        });
        self.written.text[own..].trim()
    }

    /// What was tried and not taken in, the best first.
    pub fn tried(&self) -> Vec<Tried<'a>> {
        let taken = |number: usize| {
            let mut findings = self.found.findings.iter();
            findings.any(|finding| finding.hypothesis == number)
        };
        let Some(last) = self.found.rounds.last() else {
            return Vec::new();
        };
        let scores = last.scores.iter().filter(|score| !taken(score.hypothesis));
        scores
            .map(|score| {
                let rounds = self.found.rounds.iter().rev();
                let mut trials = rounds.flat_map(|round| &round.trials);
                Tried {
                    hypothesis: &self.hypotheses[score.hypothesis],
                    score,
                    trial: trials.find(|trial| trial.hypothesis == score.hypothesis),
                }
            })
            .collect()
    }
}

/// The candidates that the first round could not try.
fn hindered(
    project: &Project,
    candidates: &[Candidate],
    found: &Diagnosis,
) -> Vec<(usize, String)> {
    let settings: BTreeMap<String, f64> = project.set().into_iter().collect();
    let headers = crate::headers(&project.records);
    let request = project.request(&settings, &headers, Form::Observed);
    let scores = || {
        found
            .rounds
            .first()
            .into_iter()
            .flat_map(|round| &round.scores)
    };
    (0..candidates.len())
        .filter(|number| scores().all(|score| score.hypothesis != *number))
        .filter(|number| !found.barred.contains(number))
        .map(|number| (number, unknown::hindrance(&request, candidates, number)))
        .collect()
}

impl Tried<'_> {
    /// Why it was not taken in.
    pub fn reason(&self) -> &'static str {
        match self.trial {
            None => "predicted too small",
            Some(trial) => trial.rejected.map_or("smaller improvement", reason),
        }
    }
}

/// `Stribeck at guide`
pub fn named(hypothesis: &Hypothesis) -> String {
    format!("{} at {}", hypothesis.effect, hypothesis.site)
}

fn reason(rejection: Rejection) -> &'static str {
    match rejection {
        Rejection::Score => "predicted too small",
        Rejection::Gain => "below the threshold",
        Rejection::Folds => "not cross-validated",
        Rejection::Bound => "at a bound",
        Rejection::Behind => "worse than the best",
        Rejection::TooGood => "implausibly large",
        Rejection::Twice => "already in the model",
    }
}

/// What a parameter is suspected of.
pub fn suspicion(parameter: &FittedParameter) -> &'static str {
    if parameter.at_bound {
        "AT ITS BOUND"
    } else if parameter.left_range {
        "OUT OF RANGE"
    } else if parameter.silent {
        "NO EFFECT"
    } else if parameter.untold {
        "prior only"
    } else {
        ""
    }
}
