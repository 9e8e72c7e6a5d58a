//! A calibration as JSON; numbers are SI.

use super::{Fitted, experiment_name, identified, si_unit};
use crate::comparison;
use hyde_study::Calibration;
use serde_json::{Value, json};

/// The calibration.
pub fn report(told: &Fitted<'_>) -> Value {
    let (calibration, fit) = (told.calibration, told.fit);
    let names = |numbers: &[usize]| -> Vec<String> {
        let each = numbers.iter();
        each.map(|&number| calibration.numbers[number].name())
            .collect()
    };
    let parameters: Vec<Value> = fit
        .parameters
        .iter()
        .enumerate()
        .map(|(number, parameter)| {
            let local = calibration.numbers[number].local.as_ref();
            json!({
                "name": parameter.name,
                "at": local.map(|local| json!({ &local.label: local.value })),
                "unit": si_unit(calibration, number),
                "declared": parameter.nominal,
                "value": parameter.value,
                "interval": [parameter.interval.0, parameter.interval.1],
                "prior_deviation": parameter.prior,
                "deviation": parameter.deviation,
                "left_range": parameter.left_range,
                "at_bound": parameter.at_bound,
                "not_told": parameter.untold,
                "no_effect": parameter.silent,
            })
        })
        .collect();
    let groups: Vec<Vec<String>> = fit.groups.iter().map(|group| names(group)).collect();
    let together = told.before.together.iter().map(|own| {
        json!({
            "parameters": names(&own.parameters),
            "combinations": own.determined,
        })
    });
    let profiles = told.profiles.iter().map(|profile| {
        let (low, high) = profile.interval;
        json!({
            "parameter": calibration.numbers[profile.parameter].name(),
            "interval": [low, high],
            "limit": hyde_calibrate::LIMIT,
            "values": profile.points.iter().map(|point| point.0).collect::<Vec<_>>(),
            "changes": profile.points.iter().map(|point| point.1).collect::<Vec<_>>(),
        })
    });
    let first = calibration.experiments.first();
    json!({
        "ok": true,
        "calibration": calibration.plan.name,
        "model": calibration.plan.model,
        "models": calibration.plan.models,
        "model_hash": first.map(|own| own.project.hash.clone()),
        "identifiability": {
            "no_effect": names(&told.before.unmoved),
            "weak": names(&told.before.weak),
            "together": together.collect::<Vec<_>>(),
            "advice": identified::sentences(calibration, told.before),
        },
        "converged": fit.converged && fit.causes.is_empty(),
        "causes": told.reasons(),
        "notes": calibration.notes,
        "steps": fit.steps,
        "starts": fit.agreeing_starts.1,
        "agreeing_starts": fit.agreeing_starts.0,
        "parameters": parameters,
        "groups": groups,
        "correlation": {
            "names": names(&(0..fit.parameters.len()).collect::<Vec<_>>()),
            "matrix": fit.correlation,
        },
        "profiles": profiles.collect::<Vec<_>>(),
        "experiments": experiments(told),
        "records": records(told),
        "inflation": fit.inflation,
    })
}

/// The experiments with what they weigh by.
fn experiments(told: &Fitted<'_>) -> Vec<Value> {
    let each = told.calibration.experiments.iter().zip(told.weights());
    let of = |(own, weight): (&Calibration, super::Weight)| {
        let measured = own.compiled.program.experiment.measured.iter();
        let noise = measured.zip(&own.observer.noise).map(|(channel, noise)| {
            json!({
                "channel": channel.name,
                "unit": channel.unit.unit().dimension.usual_unit(),
                "noise": noise,
            })
        });
        json!({
            "experiment": experiment_name(own),
            "model": own.project.model,
            "readings": weight.count,
            "mean_square": (weight.count > 0).then_some(weight.mean_square),
            "noise": noise.collect::<Vec<_>>(),
        })
    };
    each.map(of).collect()
}

/// The records of all experiments.
fn records(told: &Fitted<'_>) -> Vec<Value> {
    let mut found = Vec::new();
    for (own, errors) in told.calibration.experiments.iter().zip(told.errors) {
        let Value::Array(records) = comparison::json(errors, own) else {
            continue;
        };
        for mut record in records {
            if let Some(entries) = record.as_object_mut() {
                entries.insert("experiment".to_owned(), json!(experiment_name(own)));
            }
            found.push(record);
        }
    }
    found
}
