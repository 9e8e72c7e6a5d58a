//! Errors before and after a calibration or a diagnosis, record by record and channel by channel, over the noise floor (L1).

use crate::Calibration;
use crate::Project;
use crate::assumptions::of_record;
use crate::run_failure::instant;
use crate::unknown;
use hyde_calibrate::{FreeMeasure, Measures, Model, Observer, Recording, Unsupported, Written};
use hyde_compiler::{Additions, Candidate, Form, Request};
use hyde_diag::Diagnostics;
use hyde_program::Program;
use hyde_units::{Dimension, engineering, significant};
use std::collections::BTreeMap;

/// A record with its errors.
pub struct RecordErrors {
    /// Nothing was fitted to it.
    pub holdout: bool,
    /// Its measures before.
    pub before: Measures,
    /// Its measures after.
    pub after: Measures,
}

/// One measure of one channel: before and after, SI, and what would be left if the model were the axis.
#[derive(Clone, Copy)]
pub struct Change {
    /// Before.
    pub before: f64,
    /// After.
    pub after: f64,
    /// If the model were the axis.
    pub floor: f64,
}

impl RecordErrors {
    /// Innovations of a channel.
    pub fn innovations(&self, channel: usize, deviations: &[f64]) -> Change {
        Change {
            before: self.before.innovations[channel].rms,
            after: self.after.innovations[channel].rms,
            floor: deviations[channel],
        }
    }

    /// Open-loop windows of a channel.
    pub fn windows(&self, channel: usize) -> Change {
        Change {
            before: self.before.windows.total(channel),
            after: self.after.windows.total(channel),
            floor: self.after.noise[channel],
        }
    }

    /// The free run of a channel; `None` where either has none.
    pub fn free(&self, channel: usize) -> Option<Change> {
        let of = |measures: &Measures| -> Option<FreeMeasure> {
            measures.free.as_ref().ok()?.get(channel).cloned()
        };
        let (before, after) = (of(&self.before)?, of(&self.after)?);
        Some(Change {
            before: before.channel.rms(),
            after: after.channel.rms(),
            floor: after.floor?,
        })
    }

    /// Why there is no free run, if there is none.
    pub fn no_free_run(&self) -> Option<&str> {
        let each = [&self.before, &self.after];
        each.into_iter()
            .find_map(|measures| measures.free.as_ref().err())
            .map(String::as_str)
    }
}

/// The program of a project with its loop closed, candidates, by number, and written effects put on, and the same with
/// quantisers shifted; `None` where that has errors. What of the values (by name, SI) shapes the equations is set.
pub fn closed(
    project: &Project,
    candidates: &[Candidate],
    known: &[usize],
    written: &[&Written],
    values: &[(String, f64)],
) -> Option<(Program, Program)> {
    let all = project.set().into_iter().chain(values.iter().cloned());
    let settings: BTreeMap<String, f64> = all.collect();
    let headers = crate::headers(&project.records);
    let texts = written.iter().map(|one| one.text.as_str());
    let (sources, file) = hyde_compiler::with_written(&project.sources, &project.file, texts)?;
    let own = file.files.first()?.0;
    let mut additions = Additions::kept();
    for &number in known {
        additions.put(own, &candidates[number]);
    }
    for &one in written {
        additions.put(own, &unknown::candidate(one));
    }
    let request = Request {
        sources: &sources,
        file: &file,
        ..project.request(&settings, &headers, Form::Run)
    };
    let program = |additions: &Additions| {
        let compiled = hyde_compiler::compile_with(&request, additions, &mut Diagnostics::new())?;
        Some(compiled.program)
    };
    let shifted = additions.clone().with_shifted_quantisers();
    Some((program(&additions)?, program(&shifted)?))
}

/// The errors of two models by an observer on all records of a calibration, of one model where nothing changed; those held out are read
/// here and nowhere before.
pub fn errors(
    calibration: &Calibration,
    observer: &Observer,
    before: Option<Model<'_>>,
    after: Model<'_>,
) -> Result<Vec<RecordErrors>, Unsupported> {
    let mut found = Vec::new();
    for (holdout, recordings) in [(false, &calibration.fitted), (true, &calibration.holdout)] {
        found.extend(errors_on(recordings, holdout, observer, before, after)?);
    }
    Ok(found)
}

/// The same on some records, held out or not.
pub fn errors_on(
    recordings: &[Recording],
    holdout: bool,
    observer: &Observer,
    before: Option<Model<'_>>,
    after: Model<'_>,
) -> Result<Vec<RecordErrors>, Unsupported> {
    let (new, old) = rayon::join(
        || after.measures(recordings, observer),
        || before.map(|before| before.measures(recordings, observer)),
    );
    let new = new?;
    let old = old.transpose()?.unwrap_or_else(|| new.clone());
    let pairs = old.into_iter().zip(new);
    let found = pairs.map(|(before, after)| RecordErrors {
        holdout,
        before,
        after,
    });
    Ok(found.collect())
}

/// The mean square of innovations over all channels of several records: before and after.
pub fn chi(records: &[RecordErrors], holdout: bool) -> Option<(f64, f64)> {
    let (mut sums, mut count) = ((0.0, 0.0), 0.0);
    for record in records.iter().filter(|record| record.holdout == holdout) {
        let readings = record.before.whitened.count() as f64;
        sums.0 += record.before.chi * readings;
        sums.1 += record.after.chi * readings;
        count += readings;
    }
    (count > 0.0).then(|| (sums.0 / count, sums.1 / count))
}

/// One measure of a channel over several records, by the mean of squares.
pub fn over<'r>(
    records: impl Iterator<Item = &'r RecordErrors>,
    of: impl Fn(&RecordErrors) -> Option<Change>,
) -> Option<Change> {
    let (mut sums, mut count) = ([0.0; 3], 0.0);
    for record in records {
        let change = of(record)?;
        for (sum, value) in sums
            .iter_mut()
            .zip([change.before, change.after, change.floor])
        {
            *sum += value * value;
        }
        count += 1.0;
    }
    let root = |sum: f64| (sum / count).sqrt();
    (count > 0.0).then(|| Change {
        before: root(sums[0]),
        after: root(sums[1]),
        floor: root(sums[2]),
    })
}

/// The records of a calibration in the order of their errors.
pub fn recordings(calibration: &Calibration) -> impl Iterator<Item = &Recording> {
    calibration.fitted.iter().chain(&calibration.holdout)
}

/// What was taken for granted of all records: each with the files of which it is true.
pub fn assumptions(calibration: &Calibration) -> Vec<String> {
    let count = recordings(calibration).count();
    let mut found: Vec<(String, Vec<&str>)> = Vec::new();
    for recording in recordings(calibration) {
        for text in told(calibration, recording) {
            match found.iter_mut().find(|(known, _)| *known == text) {
                Some((_, of)) => of.push(&recording.name),
                None => found.push((text, vec![&recording.name])),
            }
        }
    }
    let with_files = found.into_iter().map(|(text, of)| {
        let whose = match of.as_slice() {
            all if all.len() == count && count > 1 => "all records".to_owned(),
            [first, rest @ ..] if rest.len() > 2 => format!("{first} and {} more", rest.len()),
            some => some.join(", "),
        };
        format!("{whose}: {text}")
    });
    with_files.collect()
}

/// What was taken for granted of a record's files, and what its observer takes otherwise than it is written: that it begins
/// elsewhere than the model, other rows, and rows behind the stop of the experiment.
pub fn told(calibration: &Calibration, recording: &Recording) -> Vec<String> {
    let program = &calibration.compiled.program;
    let tables = recording.tables.iter();
    let mut found: Vec<String> = tables
        .flat_map(|(name, table)| of_record(program, name, table))
        .collect();
    if let [first, others @ ..] = recording.beginning.as_slice() {
        let (name, value) = (&first.0, significant(first.1, 4));
        let others = match others.len() {
            0 => String::new(),
            1 => " and another state".to_owned(),
            count => format!(" and {count} other states"),
        };
        found.push(format!(
            "its first samples differ from the initial state of the model: the observer starts with {name} = {value} (SI){others} taken from \
             them"
        ));
    }
    let time = |seconds: f64| engineering(seconds, Dimension::TIME);
    if let Some((stop_s, end_s)) = recording.behind_stop(program, &calibration.set) {
        found.push(format!(
            "it counts to its end at {}: the stop of `{}` at {} bounds its runs alone; to leave out the rest, cut the file",
            instant(end_s),
            calibration.project.experiment.as_deref().unwrap_or_default(),
            instant(stop_s)
        ));
    }
    if let Some(own) = &recording.uneven {
        found.push(format!(
            "the samples of `{}` are {} to {} apart, unevenly spaced from {} on: the observer steps every {} and uses each reading at the \
             nearest step, interpolated between neighbours",
            own.record,
            time(own.spacing_s.0),
            time(own.spacing_s.1),
            time(own.from_s),
            time(own.step_s)
        ));
    }
    for (channel, measured) in program.experiment.measured.iter().enumerate() {
        let (readings, steps) = (recording.readings_of(channel), recording.rows());
        let name = &measured.name;
        if 2 * readings < steps {
            found.push(format!(
                "`{name}` has a reading every {}, the observer steps every {}: it corrects by `{name}` only where there is a reading",
                time(recording.spacings_s[channel]),
                time(recording.step_s)
            ));
        } else if readings < steps {
            found.push(format!(
                "`{name}` has no reading at {} of {steps} steps: the observer corrects nothing by it there",
                steps - readings
            ));
        }
    }
    found.extend(inputs(calibration));
    found.extend(linearised(&calibration.observer));
    found
}

/// What the columns that drive the model are not known to, where that is said or follows from the model's clocks.
fn inputs(calibration: &Calibration) -> Vec<String> {
    let program = &calibration.compiled.program;
    let each = program.columns.iter().zip(&calibration.observer.inputs);
    let told = each.filter_map(|(column, deviation)| {
        let name = format!("`{}.{}`", column.record, column.column);
        let known = significant(*deviation, 3);
        match column.ticks_s {
            Some(period_s) => Some(format!(
                "{name} comes from a clock that ticks every {}, several times between two samples, and the record does not contain these \
                 values: each sample is held until the next, with an uncertainty of {known} (SI) estimated from the innovations; to reduce it, \
                 drive the model with a measured column, or record faster",
                engineering(period_s, Dimension::TIME)
            )),
            None if column.noise > 0.0 => Some(format!("{name} drives the model, with an uncertainty of {known} (SI)")),
            None => None,
        }
    });
    told.collect()
}

/// The modes in which the model was linearised for the gain, where it begins in others.
fn linearised(observer: &Observer) -> Option<String> {
    let each = observer.taken.iter().map(|own| {
        format!(
            "`{}` in `{}` (begins in `{}`)",
            own.automaton, own.taken, own.begins
        )
    });
    let each: Vec<String> = each.collect();
    (!each.is_empty()).then(|| {
        format!(
            "the gain of the observer is computed for {}",
            each.join(", ")
        )
    })
}
