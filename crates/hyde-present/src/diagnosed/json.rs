//! `report.json`, as book/src/report.schema.json says. Numbers are SI.

use super::{Diagnosed, suspicion, timing, verdict};
use crate::comparison;
use crate::unknown;
use hyde_calibrate::{CurvePoint, FittedParameter, FoundCurve, Quantity, Relation, Verdict};
use hyde_study::selftest::relation_word;
use serde_json::{Map, Value, json};

/// The whole report.
pub fn json(told: &Diagnosed<'_>) -> Value {
    let verdict = match told.found.verdict {
        Verdict::None => "none",
        Verdict::Effect => "effect",
        Verdict::OneOf => "one_of",
        Verdict::Unknown => "unknown",
    };
    json!({
        "ok": true,
        "report": 1,
        "diagnosis": told.plan.name,
        "calibration": told.calibration.plan.name,
        "model": told.calibration.plan.model,
        "model_hash": told.calibration.project.hash,
        "verdict": verdict,
        "sentence": verdict::sentence(told),
        "grounds": verdict::grounds(told),
        "doubts": verdict::doubts(told),
        "refused": refused(told),
        "frozen": frozen(told),
        "command_timings": command_timings(told),
        "commands_not_compared": commands_not_compared(told),
        "effects": effects(told),
        "unexplained": told.found.unexplained,
        "unknown": told
            .found
            .unknown
            .as_ref()
            .map(|own| unknown::report(own, told.found)),
        "records": comparison::json(&told.errors, told.calibration),
        "parameters": parameters(told),
        "maps": maps(told),
        "whiteness": whiteness(told),
        "rejected": rejected(told),
        "new_model": told.written.model,
        "new_experiment": told.written.experiment,
    })
}

/// What the records held out do not bear out.
fn refused(told: &Diagnosed<'_>) -> Value {
    let each = told.refused.iter().map(|own| {
        let worse = own.worse.iter().map(|worse| {
            json!({
                "record": worse.record,
                "channel": worse.channel,
                "measure": worse.measure,
                "before": worse.change.before,
                "after": worse.change.after,
                "floor": worse.change.floor,
            })
        });
        json!({
            "effect": own.effect,
            "site": own.site,
            "size": quantity(&own.size),
            "worse": worse.collect::<Vec<Value>>(),
        })
    });
    each.collect()
}

/// When the model puts out replayed commands.
fn command_timings(told: &Diagnosed<'_>) -> Value {
    let each = told.commands.timings.iter().map(|own| {
        let edit = timing::edit(told, own).map(
            |own| json!({ "file": own.file, "line": own.line, "from": own.from, "to": own.to }),
        );
        json!({
            "command": timing::command(told, own),
            "clock": told.found.program.clocks[own.clock].name,
            "period_s": own.period_s,
            "late_s": own.late_s,
            "error": own.error,
            "error_moved": own.error_moved,
            "of_column": own.of_column,
            "edit": edit,
        })
    });
    each.collect()
}

/// Replayed commands whose time is not known, with the reason.
fn commands_not_compared(told: &Diagnosed<'_>) -> Value {
    let each = timing::uncompared(told);
    each.map(|(command, why)| json!({ "command": command, "why": why }))
        .collect()
}

/// Readings that were held for a while.
fn frozen(told: &Diagnosed<'_>) -> Value {
    let each = told.found.frozen.iter().map(|own| {
        json!({
            "channel": told.found.channel(own),
            "record": own.record,
            "from_s": own.time_s.0,
            "to_s": own.time_s.1,
        })
    });
    each.collect()
}

/// An effect over its variable.
fn curve(own: &FoundCurve) -> Value {
    let kind = &own.site.kind;
    let data = |of: fn(&CurvePoint) -> f64| own.data.iter().map(of).collect::<Vec<f64>>();
    json!({
        "over": own.over.name(kind),
        "over_unit": own.over.unit(kind),
        "unit": kind.force_unit(),
        "share": own.share,
        "at": own.law.0,
        "force": own.law.1,
        "records": {
            "at": data(|own| own.at),
            "force": data(|own| own.force),
            "half": data(|own| own.half),
        },
    })
}

fn effects(told: &Diagnosed<'_>) -> Value {
    let curves = told.curves.iter().map(Option::as_ref);
    let curves = curves.chain(std::iter::repeat(None));
    let findings = told.found.findings.iter().zip(curves);
    let findings = findings.map(|(finding, own)| {
        let hypothesis = &told.hypotheses[finding.hypothesis];
        let all = |list: &[Quantity]| -> Map<String, Value> {
            list.iter()
                .map(|own| (own.name.clone(), quantity(own)))
                .collect()
        };
        let one_of: Vec<Value> = finding
            .related(Relation::Another)
            .map(|other| {
                let hypothesis = &told.hypotheses[other.hypothesis];
                let experiment = other.experiment.as_ref().map(|experiment| {
                    json!({
                        "record": experiment.record,
                        "times": experiment.times,
                        "second_s": experiment.second_s,
                    })
                });
                json!({ "effect": hypothesis.effect, "site": hypothesis.site, "experiment": experiment })
            })
            .collect();
        let equivalents = finding.alternatives.iter();
        let equivalents = equivalents.filter(|other| other.relation != Relation::Another);
        let equivalents: Vec<Value> = equivalents
            .map(|other| {
                let hypothesis = &told.hypotheses[other.hypothesis];
                let relation = relation_word(other.relation);
                json!({ "effect": hypothesis.effect, "site": hypothesis.site, "relation": relation })
            })
            .collect();
        json!({
            "effect": hypothesis.effect,
            "site": hypothesis.site,
            "aliases": hypothesis.aliases,
            "size": finding.size.value,
            "unit": finding.size.unit.si().text(),
            "interval": [finding.size.interval.0, finding.size.interval.1],
            "sizes": all(&finding.sizes),
            "shape": all(&finding.shapes),
            "curve": own.map(curve),
            "one_of": one_of,
            "equivalents": equivalents,
        })
    });
    Value::Array(findings.collect())
}

fn quantity(own: &Quantity) -> Value {
    json!({ "value": own.value, "unit": own.unit.si().text(), "interval": [own.interval.0, own.interval.1] })
}

fn parameters(told: &Diagnosed<'_>) -> Value {
    let program = &told.calibration.compiled.program;
    let each = told.parameters.iter().map(|(old, new)| {
        let of = |own: &FittedParameter| {
            json!({
                "value": own.value,
                "interval": [own.interval.0, own.interval.1],
                "left_range": own.left_range,
                "at_bound": own.at_bound,
                "not_told": own.untold,
            })
        };
        let unit = program
            .parameter(&new.name)
            .map(|(parameter, _)| parameter.dimension.usual_unit());
        json!({
            "name": new.name,
            "unit": unit,
            "declared": new.nominal,
            "prior_deviation": new.prior,
            "before": of(old),
            "after": of(new),
            "suspicion": suspicion(new).to_lowercase(),
        })
    });
    Value::Array(each.collect())
}

fn maps(told: &Diagnosed<'_>) -> Value {
    let each = told.maps.iter().map(|map| {
        json!({
            "channel": map.channel,
            "over": map.over,
            "unit": map.unit.si().text(),
            "bins": map.bins,
            "before": map.before,
            "after": map.after,
            "band": map.band,
            "excess": { "before": map.excess.0, "after": map.excess.1 },
        })
    });
    Value::Array(each.collect())
}

fn whiteness(told: &Diagnosed<'_>) -> Value {
    let each = told.whiteness.iter().map(|own| {
        let cross = own.cross.as_ref().map(|(channel, rows, correlation)| {
            json!({ "channel": channel, "rows_later": rows, "correlation": correlation })
        });
        json!({
            "channel": own.channel,
            "correlation": { "before": own.correlation.0, "after": own.correlation.1 },
            "cross": cross,
            "limit": own.limit,
        })
    });
    Value::Array(each.collect())
}

fn rejected(told: &Diagnosed<'_>) -> Value {
    let each = told.tried().into_iter().map(|tried| {
        let size = tried.hypothesis.sizes.first();
        let seen =
            tried.score.detectable.zip(size).map(
                |(value, size)| json!({ "name": size.name, "value": value, "unit": size.unit.si().text() }),
            );
        json!({
            "effect": tried.hypothesis.effect,
            "site": tried.hypothesis.site,
            "score": finite(tried.score.gain()),
            "gain": tried.trial.and_then(|trial| finite(trial.gain)),
            "unseen_gain": tried.trial.and_then(|trial| trial.fold_gain).and_then(finite),
            "reason": tried.reason(),
            "smallest_seen": seen,
        })
    });
    Value::Array(each.collect())
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
