//! The page of a diagnosis.

use super::{Diagnosed, found, named, plain, suspicion, verdict};
use crate::assumptions;
use crate::compared;
use crate::head;
use hyde_calibrate::{FittedParameter, Relation, ResidualMap, Whiteness};
use hyde_report::{
    ChannelChange, DiagnosisReport, ErrorChange, MovedParameter, RecordChange, Section, TriedEffect,
};
use hyde_study::comparison::{self, Change, RecordErrors};
use hyde_units::{Unit, significant};
use hyde_units::{drawn_in, error_in, shown};

/// The page as one HTML text; `made` says when it is made.
pub fn html(told: &Diagnosed<'_>, made: &str) -> String {
    let calibration = told.calibration;
    let measured = &calibration.compiled.program.experiment.measured;
    let report = DiagnosisReport {
        title: format!("{} of {}", told.plan.name, calibration.plan.model),
        facts: facts(told, made),
        about: about(told),
        sentence: verdict::sentence(told),
        plain: plain::paragraph(told),
        curves: found::curves(told),
        compared: compared::figure(&told.errors, measured),
        responses: found::responses(told),
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
        footer: format!("Hyde {}", env!("CARGO_PKG_VERSION")),
    };
    report.to_html()
}

/// File, model, experiment, date, and what was asked.
fn facts(told: &Diagnosed<'_>, made: &str) -> Vec<(String, String)> {
    let calibration = told.calibration;
    let mut facts = head::facts(&calibration.project, made);
    let own = |name: &str, value: &str| (name.to_owned(), value.to_owned());
    let asked = format!("{} of calibrate {}", told.plan.name, calibration.plan.name);
    facts.insert(0, own("Diagnosis", &asked));
    facts.push(own("New model", &told.written.model));
    facts
}

/// The model in words and as a picture, and what was taken for granted of the records.
fn about(told: &Diagnosed<'_>) -> Vec<Section> {
    let assumed = comparison::assumptions(told.calibration);
    let model = head::model(&told.calibration.project);
    model
        .into_iter()
        .chain(assumptions::section(&assumed))
        .collect()
}

fn effects(told: &Diagnosed<'_>) -> Vec<[String; 4]> {
    let of = |finding: &hyde_calibrate::Finding| {
        let hypothesis = &told.hypotheses[finding.hypothesis];
        let quantities = finding.told_sizes().iter().chain(&finding.shapes);
        let quantities: Vec<String> = quantities.map(verdict::quantity).collect();
        let others: Vec<String> = finding
            .related(Relation::Another)
            .map(|other| verdict::alternative(told, other))
            .chain(verdict::repeated(told, finding))
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
fn unknown(told: &Diagnosed<'_>) -> Vec<[String; 3]> {
    let own = told.found.unknown.iter();
    own.flat_map(|own| {
        let site = &own.map.site;
        let panels = own.map.panels.iter().map(move |panel| {
            [
                format!("{} at {}", panel.variable.name(&site.kind), site.path),
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

fn errors(told: &Diagnosed<'_>, record: &RecordErrors) -> RecordChange {
    let deviations = &told.calibration.observer.deviations;
    let measured = &told.calibration.compiled.program.experiment.measured;
    let channel = |(number, measured): (usize, &hyde_program::Measured)| {
        let innovations = record.innovations(number, deviations);
        let windows = record.windows(number).after;
        let typical = match windows.is_finite() {
            true => windows,
            false => innovations.after,
        };
        let (unit, of) = error_in(&measured.unit, typical);
        let change = |change: Change| ErrorChange {
            before: of.from_si(change.before),
            after: of.from_si(change.after),
            floor: of.from_si(change.floor),
        };
        let rms = |windows: &[Vec<f64>]| windows[number].iter().map(|si| of.from_si(*si)).collect();
        ChannelChange {
            name: measured.name.clone(),
            unit: shown(&unit).to_owned(),
            innovations: change(innovations),
            windows: change(record.windows(number)),
            free: record.free(number).map(change),
            over_time: (
                rms(&record.before.windows.rms),
                rms(&record.after.windows.rms),
            ),
        }
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

fn moved(told: &Diagnosed<'_>, old: &FittedParameter, new: &FittedParameter) -> MovedParameter {
    let program = &told.calibration.compiled.program;
    let unit = program.parameter(&new.name).map(|(own, _)| &own.unit);
    let (unit, drawn) = unit.map_or((String::new(), Unit::ONE), drawn_in);
    let of = |own: &FittedParameter| {
        let half = (own.interval.1 - own.interval.0) / 2.0;
        (drawn.from_si(own.value), drawn.scale.remove(half))
    };
    MovedParameter {
        name: new.name.clone(),
        unit: shown(&unit).to_owned(),
        declared: drawn.from_si(new.nominal),
        // A prior stands for a uniform distribution of the same variance.
        spread: new
            .prior
            .map_or(f64::NAN, |sd| 3.0_f64.sqrt() * drawn.scale.remove(sd)),
        before: of(old),
        after: of(new),
        suspicion: suspicion(new).to_lowercase(),
    }
}

/// The maps that say something, so many that a reader looks at them.
fn maps(told: &Diagnosed<'_>) -> Vec<hyde_report::ResidualMap> {
    const SHOWN: usize = 12;
    let beyond = |map: &&ResidualMap| map.excess.0.max(map.excess.1) > 1.0;
    let listed = told.maps.iter().filter(beyond).take(SHOWN);
    listed
        .map(|map| {
            let (unit, of) = drawn_in(&map.unit);
            (map, shown(&unit).to_owned(), of)
        })
        .map(|(map, unit, of)| hyde_report::ResidualMap {
            channel: map.channel.clone(),
            over: map.over.clone(),
            unit,
            bins: map.bins.iter().map(|si| of.from_si(*si)).collect(),
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

fn tried(told: &Diagnosed<'_>) -> Vec<TriedEffect> {
    let of = |tried: super::Tried<'_>| {
        let size = tried.hypothesis.sizes.first();
        let visible = tried
            .score
            .detectable
            .zip(size)
            .map(|(value, size)| verdict::number(value, 2, &size.unit));
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
