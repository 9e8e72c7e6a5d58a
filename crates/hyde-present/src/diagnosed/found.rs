//! The curves of a page: what was found over its variable, with what the records say; and channels over frequency.

use super::{Diagnosed, named, verdict};
use crate::compared::judge;
use hyde_calibrate::{FreeMeasure, LatentForce, Panel, Unknown, Variable};
use hyde_report::{FoundCurve, Response};
use hyde_signal::spectrum::power_spectral_density;
use hyde_study::comparison::RecordErrors;
use hyde_units::significant;
use hyde_units::{error_in, shown};

/// Samples of a segment of a spectrum at most; and so many segments at least.
const SEGMENT: usize = 4096;
const SEGMENTS: usize = 6;
/// The best function is drawn as far as it is so many times the largest force from moment to moment.
const BEYOND: f64 = 2.0;
/// Above this the free run is filtered out.
const HIGHEST_HZ: f64 = 150.0;

/// Every effect that was found as a curve; of what no effect explains the best function.
pub(super) fn curves(told: &Diagnosed<'_>) -> Vec<FoundCurve> {
    let each = told.found.findings.iter().zip(&told.curves);
    let found = each.filter_map(|(finding, curve)| {
        let curve = curve.as_ref()?;
        let kind = &curve.site.kind;
        let name = named(&told.hypotheses[finding.hypothesis]);
        let sizes = verdict::sizes(finding);
        let dependence = match curve.share > 0.98 {
            true => String::new(),
            false => format!(
                " The effect also depends on other variables: {} of its square is a function of this one.",
                percent(curve.share)
            ),
        };
        Some(FoundCurve {
            title: format!("{name} ({sizes})"),
            over: (curve.over.name(kind), curve.over.unit(kind)),
            force: (kind.axis(), kind.force_unit()),
            line: "found".to_owned(),
            law: curve.law.clone(),
            data: curve.data.iter().map(|own| (own.at, own.force, own.half)).collect(),
            caption: format!(
                "The line is the effect as it was found. Rings and the grey band: what the records say at each place without the formula, \
                 with a 95 % interval.{} {}{dependence}",
                period(curve.over),
                kind.sign()
            ),
        })
    });
    let found: Vec<FoundCurve> = found.collect();
    if found.is_empty()
        && let Some(unknown) = &told.found.unknown
    {
        return best_function(unknown).into_iter().collect();
    }
    found
}

/// The best function of the site that explains most, over the force that the balance needs there.
fn best_function(unknown: &Unknown) -> Option<FoundCurve> {
    let site = &unknown.map.site;
    let drawn = |panel: &&Panel| {
        !matches!(
            panel.variable,
            Variable::SpeedByPlace | Variable::SpeedByTime
        )
    };
    let best = unknown.map.panels.iter().find(drawn)?;
    let unit = best.variable.unit(&site.kind);
    let at = |latent: &LatentForce, k: usize| match best.variable {
        Variable::Speed if site.kind.is_grip() => latent.speed[k].abs(),
        Variable::Speed => latent.speed[k],
        Variable::Time | Variable::SpeedByTime => latent.time[k],
        Variable::Acceleration => latent.acceleration[k],
        Variable::Signal => latent.signal[k],
        Variable::Turn => latent.place[k].rem_euclid(std::f64::consts::TAU),
        Variable::Place | Variable::SpeedByPlace => latent.place[k],
    };
    // A knot that the records hardly show may have any force.
    let forces = unknown.latent.iter().flat_map(|latent| &latent.force);
    let most = forces.fold(0.0, |most: f64, force| most.max(force.abs()));
    let is_shown = |force: &f64| force.abs() <= BEYOND * most;
    let line = best.force.iter();
    let line = line.map(|force| if is_shown(force) { *force } else { f64::NAN });
    let line: Vec<f64> = line.collect();
    if line.iter().all(|force| force.is_nan()) {
        return None;
    }
    let points = unknown.latent.iter().flat_map(|latent| {
        (0..latent.force.len()).map(move |k| (at(latent, k), latent.force[k], f64::NAN))
    });
    Some(FoundCurve {
        title: format!("{} at {}", site.kind.what(), site.path),
        over: (best.variable.name(&site.kind), unit),
        force: (site.kind.axis(), site.kind.force_unit()),
        line: "best function".to_owned(),
        law: (best.knots.clone(), line),
        data: points.collect(),
        caption: format!(
            "The line is the function of this variable that explains the residual best: improvement {}, by chance {}. Points: the \
             force that the balance needs from moment to moment. {}",
            significant(best.gain, 3),
            significant(best.band, 3),
            site.kind.sign()
        ),
    })
}

fn period(over: hyde_calibrate::Over) -> String {
    match over {
        hyde_calibrate::Over::Period(_) => " All periods are laid over each other.".to_owned(),
        hyde_calibrate::Over::Variable(_) => String::new(),
    }
}

fn percent(part: f64) -> String {
    format!("{} %", significant(100.0 * part, 2))
}

/// The channels of the record that judges, over frequency: the first one held out, if there is one.
pub(super) fn responses(told: &Diagnosed<'_>) -> Vec<Response> {
    let Some(record) = judge(&told.errors) else {
        return Vec::new();
    };
    let measured = &told.calibration.compiled.program.experiment.measured;
    let each = measured.iter().enumerate();
    each.filter_map(|(number, channel)| {
        let (unit, of) = error_in(&channel.unit, record.windows(number).after);
        let mut response = response(record, number)?;
        for list in response.channel.iter_mut().chain(&mut response.error) {
            list.iter_mut().for_each(|si| *si = of.scale.remove(*si));
        }
        Some(Response {
            title: format!("{} in {}", channel.name, record.after.record),
            unit: shown(&unit).to_owned(),
            ..response
        })
    })
    .collect()
}

/// A channel of a record over frequency, SI.
fn response(record: &RecordErrors, number: usize) -> Option<Response> {
    let before: &FreeMeasure = record.before.free.as_ref().ok()?.get(number)?;
    let after: &FreeMeasure = record.after.free.as_ref().ok()?.get(number)?;
    let (old, new) = (&before.channel, &after.channel);
    let [first, .., last] = new.time_s.as_slice() else {
        return None;
    };
    let rate_hz = (new.time_s.len() - 1) as f64 / (last - first);
    let measured: Vec<f64> = new
        .error
        .iter()
        .zip(&new.model)
        .map(|(e, m)| e + m)
        .collect();
    // Segments lie over each other by half.
    let segment = 2 * measured.len() / (SEGMENTS + 1);
    let segment = segment.min(SEGMENT) / 2 * 2;
    let of = |values: &[f64]| power_spectral_density(values, rate_hz, segment).ok();
    let (frequency_hz, density) = of(&measured)?;
    let lines = |(_, density): (Vec<f64>, Vec<f64>)| -> Vec<f64> {
        let inside = frequency_hz.iter().zip(density).skip(1);
        let inside = inside.filter(|(f, _)| **f <= HIGHEST_HZ);
        inside.map(|(_, density)| density.sqrt()).collect()
    };
    let channel = [
        lines((Vec::new(), density)),
        lines(of(&old.model)?),
        lines(of(&new.model)?),
    ];
    let error = [lines(of(&old.error)?), lines(of(&new.error)?)];
    let inside = frequency_hz.iter().skip(1).filter(|f| **f <= HIGHEST_HZ);
    Some(Response {
        frequency_hz: inside.copied().collect(),
        channel,
        error,
        ..Response::default()
    })
}
