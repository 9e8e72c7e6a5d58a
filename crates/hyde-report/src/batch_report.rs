//! The report of a batch: what the inputs do to the measures, how these spread, what failed, and which cases to look at.

mod figures;

pub use self::figures::envelope_panel;

use self::figures::{distribution, envelope, scatter};
use crate::number::significant;
use crate::page::{Block, Page, Section, Table, Verdict};
use crate::{prefix, to_html};

/// No more failed cases than these are listed; the rest is counted.
const FAILURES_SHOWN: usize = 100;
/// Inputs shown against each measure: those that matter most.
const INPUTS_SHOWN: usize = 6;
/// Pairs shown in all.
const PAIRS_SHOWN: usize = 48;

/// Everything the report of a batch shows. Parts that are empty are left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BatchReport {
    /// Heading of the page.
    pub title: String,
    /// Pairs of name and value under the heading.
    pub facts: Vec<(String, String)>,
    /// What the model is, in words and as a picture.
    pub about: Vec<Section>,
    /// What was to hold in all cases, and whether it did.
    pub verdicts: Vec<Verdict>,
    /// What varies, as numbers.
    pub inputs: Vec<CaseColumn>,
    /// What varies, as texts.
    pub choices: Vec<ChoiceColumn>,
    /// What was measured of each case.
    pub measures: Vec<CaseMeasure>,
    /// Which cases failed; as many entries as each column has values.
    pub failed: Vec<bool>,
    /// Trajectories of all cases.
    pub envelopes: Vec<Envelope>,
    /// The cases to look at.
    pub worst: Vec<WorstCase>,
    /// The failed cases, in their order.
    pub failures: Vec<FailedCase>,
    /// Last line: by what the page was made.
    pub footer: String,
}

/// A number of every case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CaseColumn {
    /// Its name.
    pub name: String,
    /// Its SI unit; empty for a bare number.
    pub unit: String,
    /// SI values in the order of cases; NaN where there is none.
    pub values: Vec<f64>,
}

/// A choice of every case.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ChoiceColumn {
    /// What is chosen.
    pub name: String,
    /// What was chosen, in the order of cases.
    pub values: Vec<String>,
}

/// A measure over all cases.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CaseMeasure {
    /// Its values.
    pub column: CaseColumn,
    /// Probability and quantile, SI, rising.
    pub quantiles: Vec<(f64, f64)>,
    /// Spearman's rank correlation with inputs, by their names.
    pub correlations: Vec<(String, f64)>,
}

/// A variable over time in all cases.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Envelope {
    /// Its name.
    pub name: String,
    /// Its SI unit; empty for a bare number.
    pub unit: String,
    /// Instants in s.
    pub time: Vec<f64>,
    /// Least value at each instant, quantiles at 5, 25, 50, 75 and 95 %, and the largest, SI.
    pub quantiles: [Vec<f64>; 7],
}

/// A case to look at.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WorstCase {
    /// Why: measure and value.
    pub what: String,
    /// Its number.
    pub case: usize,
    /// What it was given: inputs with their values.
    pub inputs: String,
    /// What reruns it.
    pub command: String,
}

/// A case that has no result.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FailedCase {
    /// Its number.
    pub case: usize,
    /// Code of the diagnostic and reason.
    pub reason: String,
    /// The equation or component, with its place in the source.
    pub place: String,
    /// When, in s; NaN before the start.
    pub time_s: f64,
    /// What it was given: inputs with their values.
    pub inputs: String,
    /// What reruns it.
    pub command: String,
}

impl BatchReport {
    /// The report as one HTML text that needs no other file.
    #[must_use]
    pub fn to_html(&self) -> String {
        to_html(&self.page())
    }

    /// The report as a page.
    #[must_use]
    pub fn page(&self) -> Page {
        let verdicts = Some(Block::Verdicts(self.verdicts.clone()));
        let blocks: [(&str, Vec<Block>); 7] = [
            (
                "Verdict",
                verdicts
                    .filter(|_| !self.verdicts.is_empty())
                    .into_iter()
                    .collect(),
            ),
            ("Measures", self.measure_blocks()),
            ("Inputs against measures", self.pair_blocks()),
            (
                "Over time",
                self.envelopes
                    .iter()
                    .map(|over| Block::Figure(envelope(over)))
                    .collect(),
            ),
            ("Cases to look at", table(self.worst_table())),
            ("Failed cases", table(self.failure_table())),
            ("Inputs", table(self.input_table())),
        ];
        Page {
            title: self.title.clone(),
            facts: self.facts.clone(),
            sections: [self.about.clone(), Section::all(blocks)].concat(),
            footer: self.footer.clone(),
        }
    }

    /// Quantiles as a table, then the distributions.
    fn measure_blocks(&self) -> Vec<Block> {
        let Some(first) = self.measures.first() else {
            return Vec::new();
        };
        let mut heads = vec!["measure".to_owned(), "unit".to_owned()];
        heads.extend(first.quantiles.iter().map(|(p, _)| quantile_name(*p)));
        let numbers = |head: &String| format!(">{head}");
        let marked: Vec<String> = heads[..2]
            .iter()
            .cloned()
            .chain(heads[2..].iter().map(numbers))
            .collect();
        let marked: Vec<&str> = marked.iter().map(String::as_str).collect();
        let row = |measure: &CaseMeasure| {
            let (unit, factor) = measure.column.shown();
            let cells = measure.quantiles.iter().map(|(_, si)| si * factor);
            let cells = cells.map(|value| significant(value, 4));
            [measure.column.name.clone(), unit]
                .into_iter()
                .chain(cells)
                .collect()
        };
        let mut blocks = vec![Block::Table(Table {
            rows: self.measures.iter().map(row).collect(),
            ..Table::with_columns(&marked)
        })];
        for measure in &self.measures {
            blocks.push(Block::Figure(distribution(&measure.column, None)));
            for choice in &self.choices {
                blocks.push(Block::Figure(distribution(&measure.column, Some(choice))));
            }
        }
        blocks
    }

    /// Correlations as a table, then each measure over the inputs that matter most to it.
    fn pair_blocks(&self) -> Vec<Block> {
        let mut blocks = table(self.correlation_table());
        let mut pairs = 0;
        for measure in &self.measures {
            for (input, correlation) in strongest(&measure.correlations) {
                let Some(input) = self.inputs.iter().find(|known| known.name == *input) else {
                    continue;
                };
                if pairs == PAIRS_SHOWN {
                    return blocks;
                }
                pairs += 1;
                let choice = self.choices.first();
                let figure = scatter(input, &measure.column, &self.failed, *correlation, choice);
                blocks.push(Block::Figure(figure));
            }
        }
        blocks
    }

    fn correlation_table(&self) -> Table {
        let heads = self
            .measures
            .iter()
            .map(|measure| format!(">{}", measure.column.name));
        let heads: Vec<String> = std::iter::once("rank correlation".to_owned())
            .chain(heads)
            .collect();
        let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
        let of = |measure: &CaseMeasure, input: &str| {
            let known = measure.correlations.iter().find(|(name, _)| name == input);
            known.map(|(_, value)| *value)
        };
        let mut rows: Vec<(f64, Vec<String>)> = Vec::new();
        for input in &self.inputs {
            let values: Vec<Option<f64>> = self
                .measures
                .iter()
                .map(|measure| of(measure, &input.name))
                .collect();
            let strength = values.iter().flatten().map(|value| value.abs());
            let strength = strength.fold(f64::NEG_INFINITY, f64::max);
            if strength.is_finite() {
                let cells = values
                    .iter()
                    .map(|value| value.map_or_else(String::new, signed));
                let row = std::iter::once(input.name.clone()).chain(cells).collect();
                rows.push((strength, row));
            }
        }
        rows.sort_by(|a, b| b.0.total_cmp(&a.0));
        Table {
            rows: rows.into_iter().map(|(_, row)| row).collect(),
            note: Some(
                "Spearman's: +1 where the measure rises whenever the input does, −1 where it falls. Empty where all cases have \
                 one value, as far as the tolerance of their runs can tell."
                    .to_owned(),
            ),
            ..Table::with_columns(&heads)
        }
    }

    fn worst_table(&self) -> Table {
        let row = |worst: &WorstCase| {
            vec![
                worst.what.clone(),
                worst.case.to_string(),
                worst.inputs.clone(),
                worst.command.clone(),
            ]
        };
        Table {
            rows: self.worst.iter().map(row).collect(),
            ..Table::with_columns(&["largest magnitudes", ">case", "inputs", "run again with"])
        }
    }

    fn failure_table(&self) -> Table {
        let row = |failed: &FailedCase| {
            vec![
                failed.case.to_string(),
                failed.reason.clone(),
                failed.place.clone(),
                significant(failed.time_s, 4),
                failed.inputs.clone(),
                failed.command.clone(),
            ]
        };
        let heads = [
            ">case",
            "reason",
            "place",
            ">at [s]",
            "inputs",
            "run again with",
        ];
        let more = self.failures.len().saturating_sub(FAILURES_SHOWN);
        Table {
            rows: self.failures.iter().take(FAILURES_SHOWN).map(row).collect(),
            note: (more > 0).then(|| format!("{more} later ones are not shown.")),
            ..Table::with_columns(&heads)
        }
    }

    fn input_table(&self) -> Table {
        let number = |input: &CaseColumn| {
            let (unit, factor) = input.shown();
            let (low, high) = input.ends();
            let range = format!(
                "{} .. {}",
                significant(low * factor, 4),
                significant(high * factor, 4)
            );
            vec![input.name.clone(), range, unit]
        };
        let choice = |choice: &ChoiceColumn| {
            let list = choice.options().join(", ");
            vec![choice.name.clone(), list, String::new()]
        };
        let rows = self.inputs.iter().map(number);
        Table {
            rows: rows.chain(self.choices.iter().map(choice)).collect(),
            ..Table::with_columns(&["input", "between", "unit"])
        }
    }
}

impl CaseColumn {
    /// Least and largest value; infinite without any.
    fn ends(&self) -> (f64, f64) {
        let finite = self
            .values
            .iter()
            .copied()
            .filter(|value| value.is_finite());
        finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
    }

    /// The unit that suits the values, and its factor.
    fn shown(&self) -> (String, f64) {
        let (low, high) = self.ends();
        prefix::shown_unit(&self.unit, low.abs().max(high.abs()))
    }
}

impl ChoiceColumn {
    /// What there is to choose, in the order of first use.
    fn options(&self) -> Vec<&str> {
        let mut options: Vec<&str> = Vec::new();
        for value in &self.values {
            if !options.contains(&value.as_str()) {
                options.push(value);
            }
        }
        options
    }
}

/// The correlations of largest magnitude, those first.
fn strongest(correlations: &[(String, f64)]) -> Vec<&(String, f64)> {
    let mut order: Vec<&(String, f64)> = correlations.iter().collect();
    order.sort_by(|a, b| b.1.abs().total_cmp(&a.1.abs()));
    order.truncate(INPUTS_SHOWN);
    order
}

fn quantile_name(p: f64) -> String {
    let percent = (p * 1000.0).round();
    match percent as u32 {
        0 => "least".to_owned(),
        500 => "median".to_owned(),
        1000 => "largest".to_owned(),
        tenths => format!("{} %", f64::from(tenths) / 10.0),
    }
}

/// A correlation with its sign.
fn signed(value: f64) -> String {
    format!("{value:+.2}").replace('-', "−")
}

fn table(table: Table) -> Vec<Block> {
    if table.rows.is_empty() {
        Vec::new()
    } else {
        vec![Block::Table(table)]
    }
}

#[cfg(test)]
mod tests;
