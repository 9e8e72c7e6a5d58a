//! [`JointCalibration`]: a calibration of one or several experiments and models, its parameters shared or of some records alone.

use super::files::{files_of, recording};
use super::numbers::{Number, Numbered, RecordSet, Rows, numbered};
use super::vary::{Own, varied};
use super::{Calibration, Prepared, plan, prepared};
use crate::asked::Asked;
use crate::project::Loaded;
use crate::record_settings::called;
use crate::records::Records;
use crate::refusals::calibrations as refused;
use crate::refused::{Fault, Refused};
use crate::unobservable::unsupported;
use hyde_calibrate::{CalibrationPlan, Joint, Observer, Part, Problem, Recording, Varied};
use hyde_diag::Diagnostic;
use hyde_sim::Reached;
use hyde_syntax::ast::Experiment;
use std::ops::Range;

/// Everything a calibration of one or several experiments is made of.
pub struct JointCalibration {
    /// The block.
    pub plan: CalibrationPlan,
    /// Each experiment: the names of the experiment and of its model, and what a calibration of it alone is made of.
    pub experiments: Vec<Calibration>,
    /// Records of an experiment that share all values; those of an experiment beside each other, in the order of its records.
    pub parts: Vec<JointPart>,
    /// What is searched for.
    pub numbers: Vec<Number>,
    /// The same, as least squares take it.
    pub varied: Vec<Varied>,
    /// What was taken for granted of parameters.
    pub notes: Vec<String>,
}

/// Records of an experiment that share all values.
pub struct JointPart {
    /// The number of the experiment.
    pub experiment: usize,
    /// Which of its fitted records these are.
    pub fitted: Range<usize>,
    /// Which of its held-out records these are.
    pub holdout: Range<usize>,
    /// The parameters that its model has, at their places.
    pub varied: Vec<Varied>,
    /// Which number of all each of them is.
    pub of: Vec<usize>,
}

impl JointCalibration {
    /// The numbers of the parts that records are fitted of.
    pub fn fitted_parts(&self) -> impl Iterator<Item = usize> {
        let parts = self.parts.iter().enumerate();
        parts.filter_map(|(number, part)| (!part.fitted.is_empty()).then_some(number))
    }

    /// What least squares minimise: the parts that records are fitted of.
    #[must_use]
    pub fn joint<'a>(&'a self, reached: Option<&'a Reached>) -> Joint<'a> {
        let part = |number: usize| {
            let part = &self.parts[number];
            let own = &self.experiments[part.experiment];
            Part {
                problem: Problem {
                    program: &own.compiled.program,
                    recordings: &own.fitted[part.fitted.clone()],
                    observer: &own.observer,
                    varied: &part.varied,
                    set: &own.set,
                    fold: None,
                    reached: None,
                },
                of: part.of.clone(),
            }
        };
        Joint {
            parts: self.fitted_parts().map(part).collect(),
            varied: &self.varied,
            reached,
        }
    }

    /// Looks again where the records begin whose start is not that of the model, with these values of what is searched for;
    /// whether some start moved.
    pub fn begin(&mut self, values: &[f64]) -> bool {
        let mut moved = false;
        for part in &self.parts {
            let own = &mut self.experiments[part.experiment];
            let mut set = own.set.clone();
            let pairs = part.varied.iter().zip(&part.of);
            set.extend(pairs.map(|(own, &number)| (own.place, values[number])));
            let fitted = own.fitted[part.fitted.clone()].iter_mut();
            let recordings = fitted.chain(&mut own.holdout[part.holdout.clone()]);
            for recording in recordings.filter(|own| !own.beginning.is_empty()) {
                let before = recording.beginning.clone();
                recording.begin(&own.compiled.program, &set);
                moved |= recording.beginning != before;
            }
        }
        moved
    }

    /// A value each of what is searched for, as the parameters of a part are called.
    #[must_use]
    pub fn settings(&self, part: usize, values: &[f64]) -> Vec<(String, f64)> {
        let part = &self.parts[part];
        let pairs = part.varied.iter().zip(&part.of);
        pairs
            .map(|(own, &number)| (own.name.clone(), values[number]))
            .collect()
    }
}

/// Makes a calibration of a file that is loaded: the one named, or the file's only one.
///
/// # Errors
/// There is none of that name; its block, its models or its records are at fault.
pub fn joint_calibration(
    loaded: Loaded,
    asked: &Asked,
    name: Option<&str>,
) -> Result<JointCalibration, Refused> {
    let mut loaded = loaded;
    if loaded.diagnostics.has_errors() {
        return Err(loaded.refused());
    }
    let Some((plan, experiments)) = plan(&mut loaded, name).map_err(Refused::Asked)? else {
        return Err(loaded.refused());
    };
    made(loaded, asked, plan, &experiments)
}

/// Makes it of these experiments.
pub(super) fn made(
    mut loaded: Loaded,
    asked: &Asked,
    plan: CalibrationPlan,
    experiments: &[Experiment],
) -> Result<JointCalibration, Refused> {
    let sets = experiments.iter();
    let sets: Vec<Vec<RecordSet>> = sets
        .map(|experiment| record_sets(&plan, experiment, asked, &mut loaded))
        .collect();
    if loaded.diagnostics.has_errors() {
        return Err(loaded.refused());
    }
    let mut prepared_all = Vec::new();
    for (experiment, sets) in experiments.iter().zip(&sets) {
        let fitted = sets.iter().find(|set| !set.holdout).or(sets.first());
        let of_first = Asked {
            experiment: Some(experiment.name.text.clone()),
            records: fitted.map(|set| set.files.clone()).unwrap_or_default(),
            ..asked.clone()
        };
        let project = loaded.clone().choose(&of_first, Records::Needed);
        prepared_all.push(prepared(project.map_err(Refused::Asked)?)?);
    }
    let mut wrong = Vec::new();
    let own: Vec<Vec<Own>> = (0..prepared_all.len())
        .map(|number| own(&plan, &prepared_all, number, &mut wrong))
        .collect();
    let models: Vec<String> = experiments.iter().map(|own| own.model.dotted()).collect();
    let each = experiments.iter().zip(&models).zip(&prepared_all);
    let rows = each.zip(own.into_iter().zip(sets));
    let rows: Vec<Rows<'_>> = rows
        .map(|(((experiment, model), prepared), (own, sets))| Rows {
            experiment: &experiment.name.text,
            model,
            program: &prepared.compiled.program,
            own,
            sets,
        })
        .collect();
    let numbered = match wrong.is_empty() {
        true => numbered(&rows, &mut wrong),
        false => Numbered::default(),
    };
    if !wrong.is_empty() {
        return Err(refused(prepared_all, wrong));
    }
    let mut found = JointCalibration {
        plan,
        experiments: Vec::new(),
        parts: Vec::new(),
        varied: Vec::new(),
        numbers: numbered.numbers,
        notes: numbered.notes,
    };
    found.varied = found.numbers.iter().map(|own| own.varied.clone()).collect();
    let mut read = Vec::new();
    for (number, (rows, of)) in rows.iter().zip(&numbered.of).enumerate() {
        let mut lists = [Vec::new(), Vec::new()];
        for (of, sets) in grouped(rows, of) {
            let mut ranges = [0..0, 0..0];
            for (list, holdout) in [false, true].into_iter().enumerate() {
                let first = lists[list].len();
                for set in sets.iter().filter(|set| set.holdout == holdout) {
                    let experiment = &experiments[number];
                    let own = &prepared_all[number];
                    let own = (&own.compiled.program, own.set.as_slice());
                    let world = asked.world.as_ref();
                    match recording(world, &set.files, experiment, own, found.plan.span) {
                        Ok(recording) => lists[list].push(recording),
                        Err(diagnostic) => wrong.push(*diagnostic),
                    }
                }
                ranges[list] = first..lists[list].len();
            }
            let [fitted, holdout] = ranges;
            let pairs = rows.own.iter().zip(&of);
            let varied = pairs.map(|((own, _), &number)| Varied {
                place: own.place,
                ..found.varied[number].clone()
            });
            found.parts.push(JointPart {
                experiment: number,
                fitted,
                holdout,
                varied: varied.collect(),
                of,
            });
        }
        read.push(lists);
    }
    let span = found.plan.span;
    let mut observers = Vec::new();
    for (prepared, [fitted, holdout]) in prepared_all.iter().zip(&read) {
        if !wrong.is_empty() {
            break;
        }
        let seen: &[Recording] = if fitted.is_empty() { holdout } else { fitted };
        match Observer::new(&prepared.compiled.program, seen, &prepared.set) {
            Ok(observer) => observers.push(observer),
            Err(error) => wrong.push(unsupported(&error, span)),
        }
    }
    let varied: Vec<Vec<Varied>> = rows
        .iter()
        .map(|rows| rows.own.iter().map(|(own, _)| own.clone()).collect())
        .collect();
    drop(rows);
    if !wrong.is_empty() {
        return Err(refused(prepared_all, wrong));
    }
    let each = prepared_all.into_iter().zip(read).zip(observers);
    for (((prepared, [fitted, holdout]), observer), varied) in each.zip(varied) {
        found.experiments.push(Calibration {
            project: prepared.project,
            compiled: prepared.compiled,
            plan: found.plan.clone(),
            fitted,
            holdout,
            varied,
            set: prepared.set,
            observer,
        });
    }
    Ok(found)
}

/// The project with what is wrong.
fn refused(prepared: Vec<Prepared>, wrong: Vec<Diagnostic>) -> Refused {
    match prepared.into_iter().next() {
        None => Refused::Asked("the calibration has no records".to_owned()),
        Some(first) => {
            let mut project = first.project;
            let each = wrong.into_iter();
            each.for_each(|diagnostic| project.diagnostics.push(diagnostic));
            project.refused(Fault::Model)
        }
    }
}

/// What is varied of one of several models. What is wrong with a parameter is told once.
fn own(
    plan: &CalibrationPlan,
    all: &[Prepared],
    number: usize,
    wrong: &mut Vec<Diagnostic>,
) -> Vec<Own> {
    let others = || all.iter().enumerate().filter(|(other, _)| *other != number);
    let elsewhere = |name: Option<&str>| {
        others().any(|(_, other)| match name {
            Some(name) => other.compiled.program.parameter(name).is_some(),
            None => !Varied::uncertain(&other.compiled.program, &other.p).is_empty(),
        })
    };
    let before = wrong.len();
    let Prepared { compiled, p, .. } = &all[number];
    let found = varied(plan, &compiled.program, p, &elsewhere, wrong);
    let mut late = wrong.split_off(before);
    late.retain(|own| !wrong.iter().any(|known| known.message == own.message));
    wrong.extend(late);
    found
}

/// The records of an experiment, those to fit first; a record that is named twice, or fitted and held out, is reported.
fn record_sets(
    plan: &CalibrationPlan,
    experiment: &Experiment,
    asked: &Asked,
    loaded: &mut Loaded,
) -> Vec<RecordSet> {
    let mut found: Vec<RecordSet> = Vec::new();
    for (holdout, sources) in [(false, &plan.fit), (true, &plan.holdout)] {
        let own = sources.iter();
        for source in own.filter(|own| own.experiment == experiment.name.text) {
            for files in files_of(source, experiment, asked, &mut loaded.diagnostics) {
                let name = files.first().map_or_else(String::new, |(_, path)| {
                    called(asked.world.as_ref(), &path.to_string_lossy())
                });
                if let Some(known) = found.iter().find(|own| own.files == files) {
                    let record = (&*name, &*experiment.name.text);
                    let word = if holdout { "holdout" } else { "fit" };
                    let (first, again) = (known.span, source.span);
                    loaded.diagnostics.push(match known.holdout == holdout {
                        true => refused::record_twice(record, first, again, word),
                        false => refused::fitted_and_held_out(record, first, again),
                    });
                    return found;
                }
                found.push(RecordSet {
                    files,
                    name,
                    labels: source.labels.clone(),
                    holdout,
                    span: source.span,
                });
            }
        }
    }
    found
}

/// Records of an experiment that share all numbers, in the order in which these appear.
fn grouped<'r>(rows: &'r Rows<'_>, of: &[Vec<usize>]) -> Vec<(Vec<usize>, Vec<&'r RecordSet>)> {
    let mut found: Vec<(Vec<usize>, Vec<&RecordSet>)> = Vec::new();
    for (set, of) in rows.sets.iter().zip(of) {
        match found.iter_mut().find(|(known, _)| known == of) {
            Some((_, sets)) => sets.push(set),
            None => found.push((of.clone(), vec![set])),
        }
    }
    found
}
