//! The page of a diagnosis.

use super::{Told, named, suspicion, verdict};
use crate::before_after::{self, Change, RecordErrors};
use crate::figures::shown;
use hyde_calibrate::{FittedParameter, ResidualMap, Whiteness};
use hyde_report::{
    ChannelChange, DiagnosisReport, ErrorChange, MovedParameter, RecordChange, TriedEffect,
};
use hyde_units::significant;

/// The page as one HTML text.
pub(crate) fn html(told: &Told<'_>) -> String {
    let calibration = told.calibration;
    let report = DiagnosisReport {
        title: format!("{} of {}", told.plan.name, calibration.plan.model),
        facts: [
            vec![
                ("model".to_owned(), calibration.plan.model.clone()),
                ("calibration".to_owned(), calibration.plan.name.clone()),
                ("new model".to_owned(), told.written.model.clone()),
                (
                    "SHA-256 of the file".to_owned(),
                    calibration.project.hash.clone(),
                ),
            ],
            before_after::assumptions(calibration)
                .into_iter()
                .map(|text| ("assumed of the records".to_owned(), text))
                .collect(),
        ]
        .concat(),
        sentence: verdict::sentence(told),
        doubts: [verdict::grounds(told), verdict::doubts(told)].concat(),
        effects: effects(told),
        unknown: unknown(told),
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
        maps: maps(told),
        whiteness: told.whiteness.iter().map(white).collect(),
        model: told.new_text().to_owned(),
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
            .map(|other| verdict::alternative(told, other))
            .collect();
        [
            hypothesis.effect.clone(),
            hypothesis.site.clone(),
            quantities.join("; "),
            others.join("; "),
        ]
    };
    told.found.findings.iter().map(of).collect()
}

/// The map of what is missing and in no library.
fn unknown(told: &Told<'_>) -> Vec<[String; 3]> {
    let own = told.found.unknown.iter();
    own.flat_map(|own| {
        let site = &own.map.site;
        let panels = own.map.panels.iter().map(move |panel| {
            [
                format!("{} at {}", panel.variable.name(site.kind), site.path),
                significant(panel.gain, 3),
                significant(panel.band, 3),
            ]
        });
        let waves = significant(own.map.waves, 3);
        let wave = format!("{} at {}", crate::unknown::wave(&own.map), site.path);
        panels.chain([[wave, waves, "-".to_owned()]])
    })
    .collect()
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

/// The maps that say something, so many that a reader looks at them.
fn maps(told: &Told<'_>) -> Vec<hyde_report::ResidualMap> {
    const SHOWN: usize = 12;
    let beyond = |map: &&ResidualMap| map.excess.0.max(map.excess.1) > 1.0;
    let shown = told.maps.iter().filter(beyond).take(SHOWN);
    shown
        .map(|map| hyde_report::ResidualMap {
            channel: map.channel.clone(),
            over: map.over.clone(),
            unit: shown_unit(&map.unit),
            bins: map.bins.clone(),
            before: map.before.clone(),
            after: map.after.clone(),
            band: map.band.clone(),
            excess: map.excess,
        })
        .collect()
}

fn white(own: &Whiteness) -> [String; 5] {
    let (other, correlation) = match &own.cross {
        Some((channel, rows, correlation)) => (
            format!("{channel}, {rows} rows later"),
            significant(*correlation, 2),
        ),
        None => (String::new(), String::new()),
    };
    [
        own.channel.clone(),
        significant(own.correlation.0, 2),
        significant(own.correlation.1, 2),
        other,
        correlation,
    ]
}

fn shown_unit(unit: &str) -> String {
    shown(unit).to_owned()
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
