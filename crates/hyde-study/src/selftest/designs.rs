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
use hyde_units::{Agreement, NamedUnit};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Signals within the limits of an axis, each recorded without any effect: those of a motion, those of an effort, or both.
pub struct Designs {
    kinds: Vec<Kind>,
    unmade: Vec<(String, String)>,
}

/// The signals for one column.
struct Kind {
    bench: Bench,
    wished: Wished,
    all: Vec<(String, Design, Linearised)>,
}

impl Designs {
    /// Makes and records the signals that the options allow on the model of a calibration. They have the sampling period of
    /// its records, and are for the first column that fits their unit, if none is named. Where the options limit an effort and
    /// the acceleration or jerk of a motion, there are signals of both.
    ///
    /// # Errors
    /// The model or the options are at fault, or no signal is possible.
    pub fn new(
        loaded: &Loaded,
        asked: &Asked,
        calibration: &Calibration,
        options: Options,
    ) -> Result<Self, Refused> {
        let both = options.effort.is_some() && options.motion[2..].iter().any(Option::is_some);
        let motion = both.then(|| Options {
            effort: None,
            ..options.clone()
        });
        let mut all = Self {
            kinds: Vec::new(),
            unmade: Vec::new(),
        };
        let mut refused = None;
        for options in motion.into_iter().chain([options]) {
            match all.kind(loaded.clone(), asked, calibration, options)? {
                Ok(kind) => all.kinds.push(kind),
                Err(none) => refused = refused.or(Some(none)),
            }
        }
        match refused {
            Some(none) if all.kinds.is_empty() => Err(none),
            Some(_) | None => Ok(all),
        }
    }

    /// The signals for one column, or why there are none.
    fn kind(
        &mut self,
        loaded: Loaded,
        asked: &Asked,
        calibration: &Calibration,
        options: Options,
    ) -> Result<Result<Kind, Refused>, Refused> {
        let mut options = Options {
            of_model: true,
            ..options
        };
        let unit = wished(&options).map_err(Refused::Asked)?.wish.unit;
        let found = column(calibration, options.column.as_deref(), &unit);
        if let Some((column, period_s)) = found {
            options.every = period_s.map(|own| format!("{own} [s]"));
            options.column = Some(column);
        }
        let wished = wished(&options).map_err(Refused::Asked)?;
        let name = Some(calibration.plan.name.as_str());
        let (wish, column) = (&wished.wish, options.column.as_deref());
        let bench = bench(loaded, asked, name, wish.step_s, column, &wish.unit)?;
        let Signals {
            all: made,
            unmade,
            mut failed,
        } = signals(&bench, &options, &wished).map_err(Refused::Asked)?;
        let named = |name: &str| format!("{name} of `{}`", bench.column.1);
        let mut all = Vec::new();
        let unmade = unmade.into_iter().map(|(name, why)| (named(&name), why));
        let mut unmade: Vec<(String, String)> = unmade.collect();
        for (own, recording) in made {
            let name = named(&own.name);
            match bench.linearised(recording) {
                Ok(record) => all.push((name, own.design, record)),
                Err(wrong) => {
                    let diagnostic = bench.diagnostic(&own.name, &wrong);
                    unmade.push((name, diagnostic.message.clone()));
                    failed.get_or_insert(diagnostic);
                }
            }
        }
        if all.is_empty() {
            let none = none(bench, &unmade, failed);
            self.unmade.extend(unmade);
            return Ok(Err(none));
        }
        self.unmade.extend(unmade);
        Ok(Ok(Kind { bench, wished, all }))
    }

    /// What is assumed, in the words of the command line.
    #[must_use]
    pub fn assumed(&self) -> Vec<&str> {
        let each = self.kinds.iter().flat_map(|kind| &kind.wished.assumed);
        let mut all: Vec<&str> = Vec::new();
        for option in each {
            if !all.contains(&option.as_str()) {
                all.push(option);
            }
        }
        all
    }

    /// Signals that cannot be made or recorded, with the reason.
    #[must_use]
    pub fn unmade(&self) -> &[(String, String)] {
        &self.unmade
    }

    /// All that the signals are made of, as a text.
    pub(super) fn identity(&self) -> String {
        let each = self.kinds.iter();
        let each = each.map(|kind| format!("{:?} {:?}", kind.bench.column, kind.wished.wish));
        each.collect::<Vec<_>>().join("; ")
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
        let all = self.kinds.iter();
        let all = all.flat_map(|kind| kind.all.iter().map(move |own| (&kind.bench, own)));
        let each = all.filter_map(|(bench, (name, design, record))| {
            let apart = apart(bench, &effects, record)?;
            Some((bench, name, design, apart.least))
        });
        let (bench, name, design, apart) = each.max_by(|a, b| a.3.total_cmp(&b.3))?;
        let (record, column) = &bench.column;
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

/// The column that a signal in a unit is for, the one named or the first that fits, and its sampling period in the records of a
/// calibration, s.
fn column(
    calibration: &Calibration,
    named: Option<&str>,
    unit: &NamedUnit,
) -> Option<(String, Option<f64>)> {
    let project = &calibration.project;
    let mut experiments = project.file.experiments();
    let own = experiments.find(|own| Some(&own.name.text) == project.experiment.as_ref())?;
    let tables = &calibration.fitted.first()?.tables;
    let dimension = unit.unit().dimension;
    driven(own).into_iter().find_map(|(record, name)| {
        let table = tables.get(&record)?.reading(&name);
        let own = table.column(&name)?.dimension();
        let fits = own.is_none_or(|own| own.agreement(dimension) == Agreement::Same);
        let is_meant = named.map_or(fits, |named| named == name);
        is_meant.then(|| (name, table.mean_step()))
    })
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
