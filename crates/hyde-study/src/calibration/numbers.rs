//! [`Number`]: what a calibration of several experiments searches for: a parameter that all share, or its value for some
//! records.

use super::vary::Own;
use crate::refusals::calibrations as refused;
use hyde_calibrate::{Label, LabelValue, Per, Varied};
use hyde_diag::{Diagnostic, Span};
use hyde_program::Program;
use hyde_units::significant;
use std::path::PathBuf;

/// The records that a number is of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Local {
    /// `record`, `experiment` or the name of a label.
    pub label: String,
    /// The value that these records have of it, as it was written.
    pub value: String,
}

/// A number that is searched for.
#[derive(Clone, Debug)]
pub struct Number {
    /// The parameter, its name that of the model.
    pub varied: Varied,
    /// The records that it is of; all where nothing is said.
    pub local: Option<Local>,
}

impl Number {
    /// How it is called: `saddle.M at load = 200 kg`.
    #[must_use]
    pub fn name(&self) -> String {
        match &self.local {
            None => self.varied.name.clone(),
            Some(local) => format!("{} at {} = {}", self.varied.name, local.label, local.value),
        }
    }
}

/// The files of one reading of an experiment, and what is known of them.
pub(super) struct RecordSet {
    /// Record and file.
    pub(super) files: Vec<(String, PathBuf)>,
    /// As messages call it.
    pub(super) name: String,
    pub(super) labels: Vec<Label>,
    pub(super) holdout: bool,
    /// Where it is asked for.
    pub(super) span: Span,
}

/// An experiment with its records and what is varied of its model.
pub(super) struct Rows<'a> {
    pub(super) experiment: &'a str,
    pub(super) model: &'a str,
    pub(super) program: &'a Program,
    pub(super) own: Vec<Own>,
    pub(super) sets: Vec<RecordSet>,
}

/// All numbers, and of each record of each experiment which of them its parameters are.
#[derive(Default)]
pub(super) struct Numbered {
    pub(super) numbers: Vec<Number>,
    pub(super) of: Vec<Vec<Vec<usize>>>,
    /// What was taken for granted.
    pub(super) notes: Vec<String>,
}

/// Numbers what is varied; what is wrong is reported.
pub(super) fn numbered(all: &[Rows<'_>], wrong: &mut Vec<Diagnostic>) -> Numbered {
    let mut found = Numbered::default();
    let mut values: Vec<Option<LabelValue>> = Vec::new();
    for (number, rows) in all.iter().enumerate() {
        for (own, per) in &rows.own {
            let known = |rows: &Rows<'_>| rows.own.iter().any(|(other, _)| other.name == own.name);
            if let Some(first) = all[..number].iter().find(|rows| known(rows)) {
                same_declaration(first, rows, own, per.is_none(), wrong, &mut found.notes);
                continue;
            }
            let Some(per) = per else {
                values.push(None);
                found.numbers.push(Number {
                    varied: own.clone(),
                    local: None,
                });
                continue;
            };
            let before = wrong.len();
            let first = found.numbers.len();
            for rows in all.iter().filter(|rows| known(rows)) {
                for set in rows.sets.iter().filter(|set| !set.holdout) {
                    let Some((value, shown)) = value(rows, set, &per.label) else {
                        wrong.push(without_value(own, per, set));
                        continue;
                    };
                    let known = values[first..].iter().flatten();
                    if known.into_iter().any(|known| known.same(&value)) {
                        continue;
                    }
                    let declared = rows.own.iter().find(|(other, _)| other.name == own.name);
                    values.push(Some(value));
                    found.numbers.push(Number {
                        varied: declared.map_or_else(|| own.clone(), |(own, _)| own.clone()),
                        local: Some(Local {
                            label: per.label.clone(),
                            value: shown,
                        }),
                    });
                }
            }
            if wrong.len() == before && found.numbers.len() < first + 2 {
                wrong.push(one_value(own, per, found.numbers.get(first)));
            }
        }
    }
    if wrong.is_empty() {
        for rows in all {
            let each = rows.sets.iter();
            let each = each.map(|set| of_set(rows, set, &found.numbers, &values, wrong));
            found.of.push(each.collect());
        }
    }
    found
}

/// Which number each parameter of a record is.
fn of_set(
    rows: &Rows<'_>,
    set: &RecordSet,
    numbers: &[Number],
    values: &[Option<LabelValue>],
    wrong: &mut Vec<Diagnostic>,
) -> Vec<usize> {
    let mut found = Vec::new();
    for (own, per) in &rows.own {
        let own_value = per.as_ref().and_then(|per| value(rows, set, &per.label));
        let each = numbers.iter().zip(values);
        let place = each.into_iter().position(|(number, value)| {
            number.varied.name == own.name
                && match (value, &own_value) {
                    (None, _) => true,
                    (Some(value), Some((own, _))) => value.same(own),
                    (Some(_), None) => false,
                }
        });
        match (place, per) {
            (Some(place), _) => found.push(place),
            (None, Some(per)) => wrong.push(not_fitted(own, per, set, own_value.map(|own| own.1))),
            (None, None) => {}
        }
    }
    found
}

/// The value that a record has of a label, and how it is written.
fn value(rows: &Rows<'_>, set: &RecordSet, label: &str) -> Option<(LabelValue, String)> {
    match label {
        "experiment" => {
            let name = rows.experiment.to_owned();
            Some((LabelValue::Text(name.clone()), name))
        }
        "record" => {
            let files = set.files.iter();
            let files = files.map(|(_, path)| path.display().to_string());
            let files: Vec<String> = files.collect();
            Some((LabelValue::Text(files.join(" + ")), set.name.clone()))
        }
        _ => {
            let own = set.labels.iter().find(|own| own.name == label)?;
            Some((own.value.clone(), own.shown.clone()))
        }
    }
}

fn without_value(own: &Varied, per: &Per, set: &RecordSet) -> Diagnostic {
    refused::no_label((&own.name, &per.label), (&set.name, set.span), per.span)
}

fn one_value(own: &Varied, per: &Per, only: Option<&Number>) -> Diagnostic {
    let value = only.and_then(|only| only.local.as_ref());
    let value = value.map(|local| local.value.to_string());
    refused::same_label((&own.name, &per.label), per.span, value.as_deref())
}

fn not_fitted(own: &Varied, per: &Per, set: &RecordSet, value: Option<String>) -> Diagnostic {
    let (names, here) = ((&*own.name, &*per.label), set.span);
    match value {
        Some(_) if per.label == "record" => {
            refused::each_record_held_out(&own.name, (&set.name, here), per.span)
        }
        Some(value) => refused::label_not_fitted(names, &value, here, per.span),
        None => refused::no_label_held_out(names, (&set.name, here), per.span),
    }
}

/// A parameter of two experiments is one number only if it is the same quantity; its first declaration counts.
fn same_declaration(
    first: &Rows<'_>,
    rows: &Rows<'_>,
    own: &Varied,
    shared: bool,
    wrong: &mut Vec<Diagnostic>,
    notes: &mut Vec<String>,
) {
    let Some((known, _)) = first.own.iter().find(|(other, _)| other.name == own.name) else {
        return;
    };
    let of = |rows: &Rows<'_>| rows.program.parameter(&own.name).map(|(p, _)| p.dimension);
    if of(first) != of(rows) {
        let unit = |rows: &Rows<'_>| of(rows).map_or_else(String::new, |own| own.usual_unit());
        let span = rows.sets.first().map(|set| set.span);
        wrong.push(refused::units_differ(
            &own.name,
            (&unit(first), first.model),
            (&unit(rows), rows.model),
            span,
        ));
        return;
    }
    let same = known.nominal.to_bits() == own.nominal.to_bits()
        && known.prior == own.prior
        && known.bounds == own.bounds;
    if shared && !same {
        let number = |own: &Varied| significant(own.nominal, 5);
        notes.push(format!(
            "`{}` is one parameter of the experiments `{}` and `{}`, but declared with {} and {} (SI) or with other spreads: the first \
             declaration counts",
            own.name,
            first.experiment,
            rows.experiment,
            number(known),
            number(own)
        ));
    }
}
