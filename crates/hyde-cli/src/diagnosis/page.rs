//! The page of a diagnosis.

use super::{Told, named, suspicion, verdict};
use crate::before_after::{Change, RecordErrors};
use crate::figures::shown;
use hyde_calibrate::FittedParameter;
use hyde_report::{
    ChannelChange, DiagnosisReport, ErrorChange, MovedParameter, RecordChange, TriedEffect,
};
use hyde_units::significant;

/// The page as one HTML text.
pub(crate) fn html(told: &Told<'_>) -> String {
    let calibration = told.calibration;
    let own_text = told
        .calibration
        .project
        .file
        .files
        .first()
        .map_or(0, |(file, _)| {
            calibration.project.sources.get(*file).text.trim_end().len()
        });
    let report = DiagnosisReport {
        title: format!("{} of {}", told.plan.name, calibration.plan.model),
        facts: vec![
            ("model".to_owned(), calibration.plan.model.clone()),
            ("calibration".to_owned(), calibration.plan.name.clone()),
            ("new model".to_owned(), told.written.model.clone()),
            (
                "SHA-256 of the file".to_owned(),
                calibration.project.hash.clone(),
            ),
        ],
        sentence: verdict::sentence(told),
        doubts: verdict::doubts(told),
        effects: effects(told),
        records: told
            .errors
            .iter()
            .map(|record| errors(told, record))
            .collect(),
        parameters: told
            .parameters
            .iter()
            .map(|(old, new)| moved(told, old, new))
            .collect(),
        tried: tried(told),
        maps: Vec::new(),
        model: told.written.text[own_text..].trim().to_owned(),
        footer: format!("hyde {}", env!("CARGO_PKG_VERSION")),
    };
    report.to_html()
}

fn effects(told: &Told<'_>) -> Vec<[String; 4]> {
    let of = |finding: &hyde_calibrate::Finding| {
        let hypothesis = &told.hypotheses[finding.hypothesis];
        let quantities: Vec<String> = std::iter::once(&finding.size)
            .chain(&finding.shapes)
            .map(verdict::quantity)
            .collect();
        let others: Vec<String> = finding
            .alternatives
            .iter()
            .map(|&other| named(&told.hypotheses[other]))
            .collect();
        [
            hypothesis.effect.clone(),
            hypothesis.site.clone(),
            quantities.join("; "),
            others.join(", "),
        ]
    };
    told.found.findings.iter().map(of).collect()
}

fn errors(told: &Told<'_>, record: &RecordErrors) -> RecordChange {
    let change = |change: Change| ErrorChange {
        before: change.before,
        after: change.after,
        floor: change.floor,
    };
    let deviations = &told.calibration.observer.deviations;
    let measured = &told.calibration.compiled.program.experiment.measured;
    let channel = |(number, measured): (usize, &hyde_program::Measured)| ChannelChange {
        name: measured.name.clone(),
        unit: shown(&measured.unit.unit().dimension.usual_unit()).to_owned(),
        innovations: change(record.innovations(number, deviations)),
        windows: change(record.windows(number)),
        free: record.free(number).map(change),
        over_time: (
            record.before.windows.rms[number].clone(),
            record.after.windows.rms[number].clone(),
        ),
    };
    RecordChange {
        name: record.after.record.clone(),
        holdout: record.holdout,
        chi: (record.before.chi, record.after.chi),
        channels: measured.iter().enumerate().map(channel).collect(),
        window_s: record.after.windows.start_s.clone(),
        no_free_run: record.no_free_run().unwrap_or_default().to_owned(),
    }
}

fn moved(told: &Told<'_>, old: &FittedParameter, new: &FittedParameter) -> MovedParameter {
    let program = &told.calibration.compiled.program;
    let unit = program
        .parameter(&new.name)
        .map(|(parameter, _)| parameter.dimension.usual_unit());
    let of = |own: &FittedParameter| (own.value, (own.interval.1 - own.interval.0) / 2.0);
    MovedParameter {
        name: new.name.clone(),
        unit: shown(unit.as_deref().unwrap_or("1")).to_owned(),
        declared: new.nominal,
        // A prior stands for a uniform distribution of the same variance.
        spread: new.prior.map_or(f64::NAN, |sd| 3.0_f64.sqrt() * sd),
        before: of(old),
        after: of(new),
        suspicion: suspicion(new).to_lowercase(),
    }
}

fn tried(told: &Told<'_>) -> Vec<TriedEffect> {
    let of = |tried: super::Tried<'_>| {
        let size = tried.hypothesis.sizes.first();
        let visible = tried.score.detectable.zip(size).map(|(value, size)| {
            let text = format!("{} {}", significant(value, 2), shown(&size.unit));
            text.trim_end().to_owned()
        });
        TriedEffect {
            name: named(tried.hypothesis),
            score: tried.score.gain(),
            gain: tried.trial.map_or(f64::NAN, |trial| trial.gain),
            unseen: tried
                .trial
                .and_then(|trial| trial.fold_gain)
                .unwrap_or(f64::NAN),
            reason: tried.reason().to_owned(),
            visible: visible.unwrap_or_default(),
        }
    };
    told.tried().into_iter().map(of).collect()
}
