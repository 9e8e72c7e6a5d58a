//! The calibrated models as text: shared values in one, and one on top of it for each set of values that some records have.

use super::unit;
use crate::{Calibration, JointCalibration};
use hyde_calibrate::Fit;
use hyde_compiler::{Calibrated, modifications};
use hyde_program::Program;
use hyde_units::{Dimension, NamedUnit};

/// The name of the file's first model, and of the file.
pub fn name(calibration: &JointCalibration) -> String {
    of_model(&calibration.plan.model)
}

fn of_model(model: &str) -> String {
    format!("{}_fitted", model.replace('.', "_"))
}

/// The models.
pub fn text(calibration: &JointCalibration, fit: &Fit) -> String {
    let mut out = Vec::new();
    let mut used: Vec<String> = Vec::new();
    for model in &calibration.plan.models {
        let experiments = &calibration.experiments;
        let parts = calibration.parts.iter();
        let own = parts.filter(|part| experiments[part.experiment].project.model == *model);
        let (mut shared, mut sets): (Vec<usize>, Vec<Vec<usize>>) = (Vec::new(), Vec::new());
        for part in own {
            let local = |number: &usize| calibration.numbers[*number].local.is_some();
            let (own, all): (Vec<usize>, Vec<usize>) = part.of.iter().copied().partition(local);
            for number in all {
                if !shared.contains(&number) {
                    shared.push(number);
                }
            }
            if !own.is_empty() && !sets.contains(&own) {
                sets.push(own);
            }
        }
        let base = of_model(model);
        let doc = format!("calibrated by `{}`", calibration.plan.name);
        let Some(own) = experiments.iter().find(|own| own.project.model == *model) else {
            continue;
        };
        let program = &own.compiled.program;
        let mut p = vec![0.0; program.n_parameters];
        program.kernels.parameters(&own.set, &mut p);
        let mut values = found(calibration, fit, &shared);
        for value in &values {
            if let Some((parameter, element)) = program.parameter(&value.path) {
                p[parameter.place + element] = value.value;
            }
        }
        values.extend(settings(own, &values));
        out.push(one((&base, model), &values, (program, &p), &doc));
        used.push(base.clone());
        for set in sets {
            let (name, at) = called(calibration, &set, &base, &used);
            let doc = format!("{doc} at {at}");
            let values = found(calibration, fit, &set);
            out.push(one((&name, &base), &values, (program, &p), &doc));
            used.push(name);
        }
    }
    out.join("\n")
}

/// The name of a model with these values, and the values of labels that they are for.
fn called(
    calibration: &JointCalibration,
    set: &[usize],
    base: &str,
    used: &[String],
) -> (String, String) {
    let mut at: Vec<(String, String)> = Vec::new();
    for &number in set {
        if let Some(local) = &calibration.numbers[number].local {
            let own = (local.label.clone(), local.value.clone());
            if !at.contains(&own) {
                at.push(own);
            }
        }
    }
    let mut name = base.to_owned();
    for (label, value) in &at {
        name = format!("{name}_{}_{}", word(label), word(value));
    }
    let mut free = name.clone();
    let mut number = 2;
    while used.contains(&free) {
        free = format!("{name}_{number}");
        number += 1;
    }
    let at = at.iter().map(|(label, value)| format!("{label} = {value}"));
    (free, at.collect::<Vec<_>>().join(", "))
}

/// A text as a part of a name.
pub fn word(text: &str) -> String {
    let letters = match text.strip_prefix('-') {
        Some(rest) => format!("minus_{rest}"),
        None => text.to_owned(),
    };
    let letters = letters
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '_' });
    let joined: String = letters.collect();
    let parts = joined.split('_').filter(|part| !part.is_empty());
    parts.collect::<Vec<_>>().join("_")
}

/// What is set from outside and not calibrated, of what the model has.
fn settings(own: &Calibration, found: &[Calibrated]) -> Vec<Calibrated> {
    let set = own.project.set().into_iter();
    let set = set.filter(|(path, _)| found.iter().all(|own| own.path != *path));
    let set = set.filter_map(|(path, value)| {
        let (parameter, _) = own.compiled.program.parameter(&path)?;
        let unit = NamedUnit::usual(parameter.unit.unit().dimension);
        Some(Calibrated { path, value, unit })
    });
    set.collect()
}

/// Some of the numbers as parameters with their values, in SI units.
fn found(calibration: &JointCalibration, fit: &Fit, numbers: &[usize]) -> Vec<Calibrated> {
    let one = |number: &usize| {
        let parameter = &fit.parameters[*number];
        let unit = unit(calibration, *number);
        let dimension = unit.map_or(Dimension::DIMENSIONLESS, |own| own.unit().dimension);
        Calibrated {
            path: parameter.name.clone(),
            value: parameter.value,
            unit: NamedUnit::usual(dimension),
        }
    };
    numbers.iter().map(one).collect()
}

/// A model with some values; `at` is its program, with the parameter vector that it has before.
fn one(
    (name, of): (&str, &str),
    values: &[Calibrated],
    at: (&Program, &[f64]),
    doc: &str,
) -> String {
    let values = modifications(values, at, &|value| format!("{value:?}"));
    let values = match values.is_empty() {
        true => String::new(),
        false => format!("(\n  {}\n)", values.join(",\n  ")),
    };
    let doc = doc.replace('"', "'");
    format!("model {name} = {of}{values} \"{doc}\";\n")
}

#[cfg(test)]
mod tests {
    use super::word;

    #[test]
    fn values_become_parts_of_names() {
        assert_eq!(word("200.5 kg"), "200_5_kg");
        assert_eq!(word("-5 degC"), "minus_5_degC");
        assert_eq!(word("fit-empty.csv"), "fit_empty_csv");
    }
}
