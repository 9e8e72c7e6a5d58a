//! [`Designs`]: signals within the limits of an axis, of which a self-test takes the one that best distinguishes some effects.

use crate::asked::Asked;
use crate::calibration::Calibration;
use crate::excitation::{Bench, Effects, Options, Signals, Wished, apart, driven, none, signals};
use crate::excitation::{bench, wished};
use crate::project::Loaded;
use crate::refused::Refused;
use hyde_calibrate::{Hypothesis, Linearised, Point, Signal};
use hyde_compiler::Candidate;
use hyde_signal::excite::Design;
use hyde_signal::{Column, Table};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Signals within the limits of an axis, each recorded without any effect.
pub struct Designs {
    bench: Bench,
    wished: Wished,
    all: Vec<(String, Design, Linearised)>,
    unmade: Vec<(String, String)>,
}

impl Designs {
    /// Makes and records the signals that the options allow on the model of a calibration. They have the sampling period of
    /// its records.
    ///
    /// # Errors
    /// The model or the options are at fault, or no signal is possible.
    pub fn new(
        loaded: Loaded,
        asked: &Asked,
        calibration: &Calibration,
        options: Options,
    ) -> Result<Self, Refused> {
        let options = Options {
            every: period_s(calibration, options.column.as_deref()).map(|own| format!("{own} [s]")),
            of_model: true,
            ..options
        };
        let wished = wished(&options).map_err(Refused::Asked)?;
        let name = Some(calibration.plan.name.as_str());
        let (wish, column) = (&wished.wish, options.column.as_deref());
        let bench = bench(loaded, asked, name, wish.step_s, column, &wish.unit)?;
        let Signals {
            all: made,
            mut unmade,
            mut failed,
        } = signals(&bench, &options, &wished).map_err(Refused::Asked)?;
        let mut all = Vec::new();
        for (own, recording) in made {
            match bench.linearised(recording) {
                Ok(record) => all.push((own.name, own.design, record)),
                Err(wrong) => {
                    let diagnostic = bench.diagnostic(&own.name, &wrong);
                    unmade.push((own.name, diagnostic.message.clone()));
                    failed.get_or_insert(diagnostic);
                }
            }
        }
        if all.is_empty() {
            return Err(none(bench, &unmade, failed));
        }
        Ok(Self {
            bench,
            wished,
            all,
            unmade,
        })
    }

    /// What was asked for, and what is assumed.
    #[must_use]
    pub fn wished(&self) -> &Wished {
        &self.wished
    }

    /// Signals that cannot be made or recorded, with the reason.
    #[must_use]
    pub fn unmade(&self) -> &[(String, String)] {
        &self.unmade
    }

    /// The column that the signals are for.
    #[must_use]
    pub fn column(&self) -> &str {
        &self.bench.column.1
    }

    /// The signal that best distinguishes effects, as a record like those given; `None` if no model with one of the effects
    /// can be observed on any signal.
    pub(super) fn best(
        &self,
        (candidates, hypotheses): (&[Candidate], &[Hypothesis]),
        points: &[Point],
        like: &BTreeMap<String, Table>,
    ) -> Option<Signal> {
        let effects = Effects {
            candidates: Cow::Borrowed(candidates),
            hypotheses: Cow::Borrowed(hypotheses),
            points: points.to_vec(),
        };
        let each = self.all.iter().filter_map(|(name, design, record)| {
            let apart = apart(&self.bench, &effects, record)?;
            Some((name, design, apart.least))
        });
        let (name, design, apart) = each.max_by(|a, b| a.2.total_cmp(&b.2))?;
        let (record, column) = &self.bench.column;
        let values = design.values();
        let step_s = design.wish.step_s;
        let records = like.iter().map(|(name, table)| {
            let own = (name == record).then_some((column.as_str(), values.as_slice()));
            let span_s = (values.len() - 1) as f64 * step_s;
            Some((name.clone(), shaped(table, own, step_s, span_s)?))
        });
        Some(Signal {
            name: name.clone(),
            apart,
            records: records.collect::<Option<_>>()?,
        })
    }
}

/// The sampling period of the column that a signal is for in the records of a calibration, s.
fn period_s(calibration: &Calibration, column: Option<&str>) -> Option<f64> {
    let project = &calibration.project;
    let mut experiments = project.file.experiments();
    let own = experiments.find(|own| Some(&own.name.text) == project.experiment.as_ref())?;
    let mut driven = driven(own).into_iter();
    let (record, column) = driven.find(|(_, own)| column.is_none_or(|column| column == own))?;
    let tables = &calibration.fitted.first()?.tables;
    tables.get(&record)?.reading(&column).mean_step()
}

/// A record with the columns of another one for some time: all 0, but the column that is given.
fn shaped(like: &Table, given: Option<(&str, &[f64])>, step_s: f64, span_s: f64) -> Option<Table> {
    let made = like.mapped(|part, column| {
        let given = given.filter(|(name, _)| part.column(name).is_some());
        let (step_s, rows) = match given {
            Some((_, values)) => (step_s, values.len()),
            None => {
                let step_s = part.mean_step().unwrap_or(step_s);
                (step_s, (span_s / step_s + 1e-9).floor() as usize + 1)
            }
        };
        let values = if std::ptr::eq(column.values(), part.time()) {
            let instants = (0..rows).map(|row| (row as f64 * step_s * 1e9).round() / 1e9);
            instants.collect()
        } else {
            let own = given.filter(|(name, _)| *name == column.name());
            own.map_or_else(|| vec![0.0; rows], |(_, values)| values.to_vec())
        };
        match column.unit() {
            Some(unit) => Column::new(column.name(), unit.clone(), values),
            None => Column::raw(column.name(), values),
        }
    });
    made.ok()
}
