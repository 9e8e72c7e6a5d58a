//! [`Dataset`]: the columns of a batch's results, and its rows.
//!
//! ```text
//! case            the number, from 1
//! …               each input: a number in its unit, or the text of a choice
//! …               each measure in its unit; each expectation, 1 where it holds; null where the case failed
//! status          `done` or `failed`, and of a failed case
//! code reason equation source failed_at
//! steps events    of the solver
//! ```
//! The metadata says of each column in a group what it is, as `role:NAME`: `input`, `measure`, `expectation`.

use super::outcome::{Outcome, Trajectory};
use super::plan::{Plan, Value};
use crate::rtol_of;
use hyde_program::Program;
use hyde_signal::parquet::{Field, Kind, Values};
use hyde_units::{Dimension, NamedUnit};

/// Rows of a group in the files of a data set; the same for whoever writes it.
pub const ROWS: usize = 1024;

/// A column of numbers.
#[derive(Clone, Debug)]
pub struct Measured {
    /// Its name, or the expectation as written.
    pub name: String,
    /// Its unit.
    pub unit: NamedUnit,
    /// Whether it is an expectation.
    pub expectation: bool,
}

/// The columns of a batch.
#[derive(Clone, Debug)]
pub struct Dataset {
    /// The measures and expectations.
    pub measures: Vec<Measured>,
    /// What is kept over time.
    pub kept: Vec<Measured>,
    /// The relative tolerance of its runs.
    pub rtol: f64,
}

impl Dataset {
    /// The columns for a plan: what the program of its first variant measures, and of `keep` what it has over time; `parameters`
    /// are complete.
    ///
    /// # Errors
    /// The name of `keep` that no variable has.
    pub fn new(program: &Program, parameters: &[f64], keep: &[String]) -> Result<Self, String> {
        let measures = program.experiment.measures.iter().map(|measure| Measured {
            name: measure.name.clone(),
            unit: measure.unit.clone(),
            expectation: measure.expectation,
        });
        let mut kept: Vec<Measured> = Vec::new();
        for pattern in keep {
            let fits = |name: &str| match pattern.strip_suffix('*') {
                Some(start) => name.starts_with(start),
                None => name == pattern || is_element(name, pattern),
            };
            let outputs = program.outputs.iter().filter(|output| !output.auxiliary);
            let before = kept.len();
            for output in outputs.filter(|output| fits(&output.name)) {
                if kept.iter().all(|known| known.name != output.name) {
                    kept.push(Measured {
                        name: output.name.clone(),
                        unit: output.unit.clone(),
                        expectation: false,
                    });
                }
            }
            if kept.len() == before {
                return Err(pattern.clone());
            }
        }
        Ok(Self {
            measures: measures.collect(),
            kept,
            rtol: rtol_of(program, parameters),
        })
    }

    /// The columns of the cases.
    #[must_use]
    pub fn fields(&self, plan: &Plan) -> Vec<Field> {
        let mut fields = vec![Field::plain("case", Kind::Integer)];
        fields.extend(plan.inputs.iter().map(|input| match &input.unit {
            Some(unit) => Field::number(input.name.as_str(), Some(unit.clone())),
            None => Field::plain(input.name.as_str(), Kind::Text),
        }));
        let measures = self.measures.iter();
        fields.extend(measures.map(|m| Field::number(m.name.as_str(), Some(m.unit.clone()))));
        let texts = ["status", "code", "reason", "equation", "source"];
        fields.extend(texts.map(|name| Field::plain(name, Kind::Text)));
        fields.push(Field::number(
            "failed_at",
            Some(NamedUnit::usual(Dimension::TIME)),
        ));
        fields.extend(["steps", "events"].map(|name| Field::plain(name, Kind::Integer)));
        // A column of the model's may be called as one of ours: the later one gets a mark.
        for at in 1..fields.len() {
            while fields[..at]
                .iter()
                .any(|before| before.name == fields[at].name)
            {
                fields[at].name.push('_');
            }
        }
        fields
    }

    /// What each column is, for the metadata: `role:NAME` and the role.
    #[must_use]
    pub fn roles(&self, plan: &Plan) -> Vec<(String, String)> {
        let fields = self.fields(plan);
        let inputs = plan.inputs.iter().map(|_| "input");
        let measures = self.measures.iter().map(|m| {
            if m.expectation {
                "expectation"
            } else {
                "measure"
            }
        });
        let roles = inputs.chain(measures);
        fields[1..]
            .iter()
            .zip(roles)
            .map(|(f, role)| (format!("role:{}", f.name), role.to_owned()))
            .collect()
    }

    /// The rows of some cases.
    #[must_use]
    pub fn rows(&self, plan: &Plan, cases: &[(usize, Outcome)]) -> Vec<Values> {
        let mut columns: Vec<Values> = self
            .fields(plan)
            .iter()
            .map(|field| Values::empty(field.kind))
            .collect();
        for (number, outcome) in cases {
            let case = plan.case(*number);
            let mut cells = Vec::with_capacity(columns.len());
            cells.push(integer(*number as u64));
            for (input, value) in plan.inputs.iter().zip(&case.values) {
                cells.push(match (value, &input.unit) {
                    (Value::Number(si), Some(unit)) => {
                        Cell::Number(hyde_signal::in_unit(*si, unit.unit()))
                    }
                    (Value::Number(si), None) => Cell::Number(*si),
                    (Value::Option(option), _) => Cell::Text(input.options[*option].clone()),
                });
            }
            for (at, measure) in self.measures.iter().enumerate() {
                let si = outcome.measures.get(at).copied().unwrap_or(f64::NAN);
                cells.push(Cell::Number(hyde_signal::in_unit(si, measure.unit.unit())));
            }
            let fault = outcome.fault.clone().unwrap_or_default();
            let status = if outcome.fault.is_some() {
                "failed"
            } else {
                "done"
            };
            let texts = [
                status.to_owned(),
                fault.code,
                fault.reason,
                fault.equation,
                fault.source,
            ];
            cells.extend(texts.map(Cell::Text));
            cells.push(Cell::Number(if outcome.fault.is_some() {
                fault.time_s
            } else {
                f64::NAN
            }));
            cells.extend([integer(outcome.steps), integer(outcome.events)]);
            for (column, cell) in columns.iter_mut().zip(cells) {
                match (column, cell) {
                    (Values::Numbers(values), Cell::Number(value)) => values.push(value),
                    (Values::Integers(values), Cell::Integer(value)) => values.push(value),
                    (Values::Texts(values), Cell::Text(value)) => values.push(value),
                    (Values::Numbers(_) | Values::Integers(_) | Values::Texts(_), _) => {}
                }
            }
        }
        columns
    }

    /// The columns over time: the case, the time, and each variable kept.
    #[must_use]
    pub fn trajectory_fields(&self) -> Vec<Field> {
        let mut fields = vec![
            Field::plain("case", Kind::Integer),
            Field::number("t", Some(NamedUnit::usual(Dimension::TIME))),
        ];
        fields.extend(
            self.kept
                .iter()
                .map(|k| Field::number(k.name.as_str(), Some(k.unit.clone()))),
        );
        fields
    }

    /// The rows over time of a case.
    #[must_use]
    pub fn trajectory_rows(&self, number: usize, trajectory: &Trajectory) -> Vec<Values> {
        let rows = trajectory.time.len();
        let mut columns = vec![
            Values::Integers(vec![i64::try_from(number).unwrap_or(i64::MAX); rows]),
            Values::Numbers(trajectory.time.clone()),
        ];
        columns.extend(
            self.kept
                .iter()
                .zip(&trajectory.columns)
                .map(|(kept, column)| {
                    let unit = kept.unit.unit();
                    Values::Numbers(
                        column
                            .iter()
                            .map(|&si| hyde_signal::in_unit(si, unit))
                            .collect(),
                    )
                }),
        );
        columns
    }
}

enum Cell {
    Number(f64),
    Integer(i64),
    Text(String),
}

fn integer(number: u64) -> Cell {
    Cell::Integer(i64::try_from(number).unwrap_or(i64::MAX))
}

/// Whether a name is that of an element of an array.
fn is_element(name: &str, array: &str) -> bool {
    let rest = name.strip_prefix(array);
    let inside = rest.and_then(|rest| rest.strip_prefix('[')?.strip_suffix(']'));
    inside.is_some_and(|number| number.parse::<usize>().is_ok())
}
