//! What a diagnosis tells, in one order: on the terminal, as JSON, as a page; and the model that has what was missing.
//!
//! ```text
//! held out     what the records held out do not bear out          diagnosis/held_out.rs
//! verdict      one sentence, and what is doubtful about it        diagnosis/verdict.rs
//! terminal     80 columns                                         diagnosis/text.rs
//! JSON         `report.json`: book/src/report.schema.json         diagnosis/json.rs
//! page         `report.html`                                      diagnosis/page.rs, diagnosis/found.rs
//! plain words  its paragraph                                      diagnosis/plain.rs
//! model        the old text with a new model behind               diagnosis/model.rs
//! ```

mod found;
mod held_out;
mod json;
mod model;
mod page;
mod plain;
mod text;
mod verdict;

pub(crate) use held_out::{Refused, agreed};
pub(crate) use json::json;
pub(crate) use page::html;
pub(crate) use text::{text, wrapped};
pub(crate) use verdict::number;

use crate::before_after::RecordErrors;
use crate::project::Project;
use crate::unknown;
use hyde_calibrate::{
    Cause, Diagnosis, FittedParameter, FoundCurve, Hypothesis, Innovations, Rejection, ResidualMap,
    Score, Trial, Whiteness, fitted_parameters, residual_maps, whiteness,
};
use hyde_compiler::{Candidate, DiagnosisPlan, Form, Written};
use hyde_study::Calibration;
use std::collections::BTreeMap;

/// A diagnosis with all that is told of it.
pub(crate) struct Told<'a> {
    pub(crate) plan: &'a DiagnosisPlan,
    pub(crate) calibration: &'a Calibration,
    pub(crate) hypotheses: &'a [Hypothesis],
    /// What the hypotheses are made of; a law has none.
    pub(crate) candidates: &'a [Candidate],
    pub(crate) found: &'a Diagnosis,
    /// Errors of the calibrated model without effects and with them.
    pub(crate) errors: Vec<RecordErrors>,
    /// What was found and does not hold on the records held out.
    pub(crate) refused: Vec<Refused>,
    /// Each parameter of the model: calibrated without effects, and with them.
    pub(crate) parameters: Vec<(FittedParameter, FittedParameter)>,
    /// What innovations depend on in the records fitted, and whether they are white.
    pub(crate) maps: Vec<ResidualMap>,
    pub(crate) whiteness: Vec<Whiteness>,
    /// Each finding as a curve, where it is one; nothing where only a terminal is told.
    pub(crate) curves: Vec<Option<FoundCurve>>,
    /// Why the calibrated model does not follow the records, if it does not.
    pub(crate) causes: Vec<Cause>,
    /// Hypotheses that could not be put on the model, each with the reason.
    pub(crate) hindered: Vec<(usize, String)>,
    /// Hypotheses that were found first and dropped.
    pub(crate) barred: Vec<usize>,
    /// The model that has what was missing.
    pub(crate) written: Written,
}

/// A hypothesis that was tried and not taken in.
pub(crate) struct Tried<'a> {
    pub(crate) hypothesis: &'a Hypothesis,
    /// In the last round: what the scan promised.
    pub(crate) score: &'a Score,
    /// Its fit, if it was worth one: that of the last round that had one.
    pub(crate) trial: Option<&'a Trial>,
}

impl<'a> Told<'a> {
    /// Looks at what is left and writes the model.
    pub(crate) fn new(
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
    pub(crate) fn new_text(&self) -> &str {
        let project = &self.calibration.project;
        let own = project.file.files.first();
        let own = own.map_or(0, |(file, _)| {
            project.sources.get(*file).text.trim_end().len()
        });
        self.written.text[own..].trim()
    }

    /// What was tried and not taken in, the best first.
    pub(crate) fn tried(&self) -> Vec<Tried<'a>> {
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
    let headers = hyde_study::headers(&project.records);
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
    pub(crate) fn reason(&self) -> &'static str {
        match self.trial {
            None => "predicted too small",
            Some(trial) => trial.rejected.map_or("smaller improvement", reason),
        }
    }
}

/// `Stribeck at guide`
pub(crate) fn named(hypothesis: &Hypothesis) -> String {
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
pub(crate) fn suspicion(parameter: &FittedParameter) -> &'static str {
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
