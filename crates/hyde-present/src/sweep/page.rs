//! What the page of a batch shows, from its data set, its trajectories and its summary: no model is needed.

use super::over_time::{OverTime, drawn, in_si, whole_numbers};
use crate::head;
use crate::lines::shell_word;
use hyde_report::{
    BatchReport, CaseColumn, CaseMeasure, ChoiceColumn, FailedCase, Outcome, Verdict, WorstCase,
};
use hyde_signal::{Field, Frame, Values};
use hyde_study::sweep::Finished;
use hyde_units::{NamedUnit, Unit, counted, engineering_as, significant};
use serde_json::Value;

/// The columns of a case behind its inputs and measures: status, code, reason, equation, source, failed_at, steps, events.
const BEHIND: usize = 8;
/// Inputs told of a case in words.
const TOLD: usize = 6;

/// The report of a finished batch; `folder` is where it is, as the user writes it, and `made` says when the page is made.
///
/// # Errors
/// Its data set is not that of a batch.
pub fn report(finished: &Finished, folder: &str, made: &str) -> Result<BatchReport, String> {
    let again = format!("hyde sweep {}", shell_word(folder));
    let summary = &finished.summary;
    let cases = Cases::new(finished.cases.clone(), summary)
        .ok_or_else(|| format!("the data set in `{folder}` is not that of a batch"))?;
    let text = |key: &str| summary[key].as_str().unwrap_or_default().to_owned();
    let count = |key: &str| summary[key].as_u64().unwrap_or_default();
    let (mut facts, about) = match &finished.project {
        Some(project) => (
            head::facts(project, made),
            head::model(project).into_iter().collect(),
        ),
        None => (
            vec![("Experiment".to_owned(), text("experiment"))],
            Vec::new(),
        ),
    };
    let own = [
        ("Sweep", text("sweep")),
        (
            "Cases",
            format!("{}, {} failed", count("cases"), count("failed")),
        ),
        ("Batch", text("batch")),
    ];
    let own = own.map(|(name, value)| (name.to_owned(), value));
    facts.splice(0..0, own);
    let (inputs, choices) = cases.inputs();
    let over_time = finished.trajectories.clone().and_then(OverTime::of);
    Ok(BatchReport {
        title: format!(
            "{} of {} of {}",
            text("sweep"),
            text("experiment"),
            text("model")
        ),
        facts,
        about,
        verdicts: verdicts(summary),
        inputs,
        choices,
        measures: cases.measures(summary),
        failed: cases.failed.clone(),
        envelopes: over_time.map_or(Vec::new(), |over| over.envelopes(None)),
        worst: cases.worst(summary, &again),
        failures: cases.failures(&again),
        footer: format!("Hyde {}, {again}", env!("CARGO_PKG_VERSION")),
    })
}

fn verdicts(summary: &Value) -> Vec<Verdict> {
    let expectations = summary["expectations"].as_array().into_iter().flatten();
    let verdict = |expectation: &Value| {
        let text = expectation["text"].as_str().unwrap_or_default();
        match expectation["first"].as_u64() {
            None => Verdict {
                outcome: Outcome::Passed,
                text: format!("{text}: in all solved cases"),
            },
            Some(first) => Verdict {
                outcome: Outcome::Failed,
                text: format!(
                    "{text}: not in {}, the first is {first}",
                    counted(&expectation["broken"], "case")
                ),
            },
        }
    };
    expectations.map(verdict).collect()
}

/// The rows of the cases.
struct Cases {
    frame: Frame,
    numbers: Vec<usize>,
    failed: Vec<bool>,
    /// Places of the columns behind inputs and measures, of the inputs, and of the measures without expectations.
    behind: usize,
    inputs: std::ops::Range<usize>,
    measures: Vec<usize>,
}

impl Cases {
    fn new(frame: Frame, summary: &Value) -> Option<Self> {
        let behind = frame.fields.len().checked_sub(BEHIND)?;
        let listed = |key: &str| summary[key].as_array().map_or(0, Vec::len);
        let measured = listed("measures") + listed("expectations");
        let inputs = 1..behind.checked_sub(measured)?;
        let expectations: Vec<&str> = summary["expectations"]
            .as_array()
            .into_iter()
            .flatten()
            .filter_map(|expectation| expectation["text"].as_str())
            .collect();
        // A column that would be called as one before it has a mark behind its name.
        let is_measure = |at: &usize| {
            let name = &frame.fields[*at].name;
            let plain = name.trim_end_matches('_');
            !expectations
                .iter()
                .any(|text| *text == name || *text == plain)
        };
        let measures: Vec<usize> = (inputs.end..behind).filter(is_measure).collect();
        let numbers = whole_numbers(frame.values.first()?);
        let status = texts(frame.values.get(behind)?);
        let failed: Vec<bool> = status?.iter().map(|status| status == "failed").collect();
        Some(Self {
            numbers,
            failed,
            behind,
            inputs,
            measures,
            frame,
        })
    }

    /// What varies, as numbers and as choices.
    fn inputs(&self) -> (Vec<CaseColumn>, Vec<ChoiceColumn>) {
        let (mut numbers, mut choices) = (Vec::new(), Vec::new());
        for at in self.inputs.clone() {
            let (field, values) = (&self.frame.fields[at], &self.frame.values[at]);
            match values {
                Values::Texts(values) => choices.push(ChoiceColumn {
                    name: field.name.clone(),
                    values: values.clone(),
                }),
                Values::Numbers(_) | Values::Integers(_) => {
                    numbers.push(column(field, values, self.failed.len()));
                }
            }
        }
        (numbers, choices)
    }

    fn measures(&self, summary: &Value) -> Vec<CaseMeasure> {
        let known = summary["measures"].as_array().into_iter().flatten();
        let measure = |(at, known): (&usize, &Value)| {
            let field = &self.frame.fields[*at];
            let own = field.unit.as_ref().map_or(Unit::ONE, NamedUnit::unit);
            let (_, of) = drawn(field);
            let in_drawn = |value: f64| of.from_si(own.to_si(value));
            // JSON has no word for infinite.
            let some = known["count"].as_u64().unwrap_or_default() > 0;
            let absent = if some { f64::INFINITY } else { f64::NAN };
            let number = |value: &Value| value.as_f64().unwrap_or(absent);
            let quantiles = known["quantiles"].as_array().into_iter().flatten();
            let correlations = known["rank_correlations"].as_array().into_iter().flatten();
            CaseMeasure {
                column: column(field, &self.frame.values[*at], self.failed.len()),
                quantiles: quantiles
                    .map(|known| (number(&known["p"]), in_drawn(number(&known["value"]))))
                    .collect(),
                correlations: correlations
                    .filter_map(|known| {
                        let input = known["input"].as_str()?;
                        Some((input.to_owned(), known["spearman"].as_f64()?))
                    })
                    .collect(),
            }
        };
        self.measures.iter().zip(known).map(measure).collect()
    }

    fn worst(&self, summary: &Value, again: &str) -> Vec<WorstCase> {
        let worst = summary["worst"].as_array().into_iter().flatten();
        let case = |worst: &Value| {
            let case = usize::try_from(worst["case"].as_u64()?).ok()?;
            let unit = NamedUnit::parse(worst["unit"].as_str()?).ok()?;
            let value = worst["value"].as_f64().unwrap_or(f64::INFINITY);
            let value = unit.unit().to_si(value);
            let value = engineering_as(value, &unit);
            Some(WorstCase {
                what: format!("{} = {value}", worst["measure"].as_str()?),
                case,
                inputs: self.told(self.numbers.iter().position(|known| *known == case)?),
                command: format!("{again} --case {case}"),
            })
        };
        worst.filter_map(case).collect()
    }

    fn failures(&self, again: &str) -> Vec<FailedCase> {
        let cell = |behind: usize, row: usize| {
            let values = self.frame.values.get(self.behind + behind);
            let texts = values.and_then(texts).unwrap_or_default();
            texts.get(row).cloned().unwrap_or_default()
        };
        let times = self.frame.values.get(self.behind + 5).and_then(numbers);
        let joined = |parts: [String; 2], between: &str| {
            let parts = parts.into_iter().filter(|part| !part.is_empty());
            parts.collect::<Vec<_>>().join(between)
        };
        let rows = (0..self.failed.len()).filter(|row| self.failed[*row]);
        rows.map(|row| FailedCase {
            case: self.numbers[row],
            reason: joined([cell(1, row), cell(2, row)], ": "),
            place: joined(
                [cell(3, row).trim_end_matches(';').to_owned(), cell(4, row)],
                ", ",
            ),
            time_s: times.map_or(f64::NAN, |times| times[row]),
            inputs: self.told(row),
            command: format!("{again} --case {}", self.numbers[row]),
        })
        .collect()
    }

    /// What a case was given, in words.
    fn told(&self, row: usize) -> String {
        let one = |at: usize| {
            let field = &self.frame.fields[at];
            let value = match (&self.frame.values[at], &field.unit) {
                (Values::Numbers(values), Some(unit)) => {
                    engineering_as(unit.unit().to_si(values[row]), unit)
                }
                (Values::Numbers(values), None) => significant(values[row], 4),
                (Values::Integers(values), _) => values[row].to_string(),
                (Values::Texts(values), _) => values[row].clone(),
            };
            format!("{} = {value}", field.name)
        };
        let mut list: Vec<String> = self.inputs.clone().take(TOLD).map(one).collect();
        if self.inputs.len() > TOLD {
            list.push("…".to_owned());
        }
        list.join(", ")
    }
}

/// A column as it is drawn; without numbers, as of a batch of which all cases failed, there are none.
fn column(field: &Field, values: &Values, rows: usize) -> CaseColumn {
    let (unit, of) = drawn(field);
    let values = in_si(field, values).unwrap_or_else(|| vec![f64::NAN; rows]);
    CaseColumn {
        name: field.name.clone(),
        unit,
        values: values.into_iter().map(|si| of.from_si(si)).collect(),
    }
}

fn numbers(values: &Values) -> Option<&[f64]> {
    match values {
        Values::Numbers(values) => Some(values),
        Values::Integers(_) | Values::Texts(_) => None,
    }
}

fn texts(values: &Values) -> Option<&[String]> {
    match values {
        Values::Texts(values) => Some(values),
        Values::Numbers(_) | Values::Integers(_) => None,
    }
}
