//! A calibration in lines of at most 80 columns.

use super::page::rounded;
use super::{Fitted, experiment_name, named, shown, shown_difference};
use crate::comparison::{self, shortened};
use crate::diagnosed::wrapped;
use hyde_calibrate::{FittedParameter, Profile};
use hyde_study::diagnosis::suspicion;
use hyde_units::{counted, engineering_difference, significant};
use std::fmt::Write as _;

/// Parameters of which a table of correlations has a column each.
const COLUMNS: usize = 10;

/// The calibration.
pub fn text(told: &Fitted<'_>, correlation: bool) -> String {
    let (calibration, fit) = (told.calibration, told.fit);
    let mut out = String::new();
    let end = match fit.converged {
        _ if !fit.causes.is_empty() => "MODEL DOES NOT FOLLOW THEM".to_owned(),
        true => format!("converged in {}", counted(fit.steps, "step")),
        false => format!("NOT CONVERGED in {}", counted(fit.steps, "step")),
    };
    let records = calibration.experiments.iter().map(|own| own.fitted.len());
    let mut head = format!(
        "{}: {} on {}",
        calibration.plan.models.join(", "),
        counted(fit.parameters.len(), "parameter"),
        counted(records.sum::<usize>(), "record"),
    );
    if calibration.experiments.len() > 1 {
        let count = counted(calibration.experiments.len(), "experiment");
        let _ = write!(head, " of {count}");
    }
    let name = format!("{} of", calibration.plan.name);
    wrapped(&mut out, &name, &format!("{head}, {end}"));
    for reason in told.reasons() {
        wrapped(&mut out, "  -", &reason);
    }
    for note in &calibration.notes {
        wrapped(&mut out, "  -", note);
    }
    if fit.agreeing_starts.1 > 1 {
        let (agreeing, all) = fit.agreeing_starts;
        let _ = writeln!(
            out,
            "  {agreeing} of {all} starts converged to these values"
        );
    }
    let _ = writeln!(
        out,
        "\n  {:<24} {:>13} {:>13} {:>7}  {:<10}",
        "parameter", "declared", "calibrated", "±", ""
    );
    let mut group = String::new();
    for (number, parameter) in fit.parameters.iter().enumerate() {
        let name = match &calibration.numbers[number].local {
            None => parameter.name.clone(),
            Some(local) => {
                let own = format!("{} per {}", parameter.name, local.label);
                if own != group {
                    let _ = writeln!(out, "  {own}");
                    group = own;
                }
                format!("  {}", shortened(&local.value, 22))
            }
        };
        let _ = writeln!(out, "{}", row(told, number, &name, parameter));
    }
    for group in &fit.groups {
        let names = named(calibration, group).replace('`', "");
        wrapped(&mut out, "  strongly correlated:", &names);
    }
    if correlation {
        correlations(&mut out, told);
    }
    for profile in told.profiles {
        profiled(&mut out, told, profile);
    }
    weights(&mut out, told);
    for (own, errors) in calibration.experiments.iter().zip(told.errors) {
        out.push('\n');
        if calibration.experiments.len() > 1 {
            let _ = writeln!(
                out,
                "  experiment {} of {}",
                experiment_name(own),
                own.project.model
            );
        }
        out.push_str(&comparison::text(errors, own));
    }
    out
}

fn row(told: &Fitted<'_>, number: usize, name: &str, parameter: &FittedParameter) -> String {
    let value = |value: f64| shown(told.calibration, number, value);
    let half = (parameter.interval.1 - parameter.interval.0) / 2.0;
    let line = format!(
        "  {name:<24} {:>13} {:>13} {:>7}  {}",
        value(parameter.nominal),
        value(parameter.value),
        comparison::spread(half, parameter.value, |half| {
            shown_difference(told.calibration, number, half)
        }),
        suspicion(parameter)
    );
    line.trim_end().to_owned()
}

/// The correlations: a line a parameter, in blocks of columns.
fn correlations(out: &mut String, told: &Fitted<'_>) {
    let all = &told.fit.correlation;
    for first in (0..all.len()).step_by(COLUMNS) {
        let columns = first..all.len().min(first + COLUMNS);
        let heads = columns.clone().map(|number| format!("{:>5}", number + 1));
        let _ = writeln!(
            out,
            "\n  {:<23}{}",
            "correlation",
            heads.collect::<String>()
        );
        for (number, row) in all.iter().enumerate() {
            let name = format!("{} {}", number + 1, told.calibration.numbers[number].name());
            let cells = columns.clone().map(|column| match column {
                own if own > number => String::new(),
                own => format!("{:>5}", rounded(row[own])),
            });
            let line = format!(
                "  {:<23}{}",
                shortened(&name, 23),
                cells.collect::<String>()
            );
            let _ = writeln!(out, "{}", line.trim_end());
        }
    }
}

/// The interval of a profile.
fn profiled(out: &mut String, told: &Fitted<'_>, profile: &Profile) {
    let number = profile.parameter;
    let name = told.calibration.numbers[number].name();
    let sentence = interval(told, profile);
    out.push('\n');
    wrapped(out, &format!("  profile of {name}:"), &sentence);
}

/// The interval of a profile in words.
pub fn interval(told: &Fitted<'_>, profile: &Profile) -> String {
    let number = profile.parameter;
    let value = |value: f64| shown(told.calibration, number, value);
    let best = told.fit.parameters[number].value;
    match profile.interval {
        (Some(low), Some(high)) => format!(
            "95 % interval {0} - {1} to {0} + {2}",
            value(best),
            shown_difference(told.calibration, number, best - low),
            shown_difference(told.calibration, number, high - best),
        ),
        (Some(low), None) => format!(
            "95 % interval from {} up; no larger value up to {} contradicts the records",
            value(low),
            value(end(profile, true))
        ),
        (None, Some(high)) => format!(
            "95 % interval up to {}; no smaller value down to {} contradicts the records",
            value(high),
            value(end(profile, false))
        ),
        (None, None) => format!(
            "no value from {} to {} contradicts the records",
            value(end(profile, false)),
            value(end(profile, true))
        ),
    }
}

fn end(profile: &Profile, last: bool) -> f64 {
    let point = if last {
        profile.points.last()
    } else {
        profile.points.first()
    };
    point.map_or(f64::NAN, |point| point.0)
}

/// By what each of several experiments weighs.
fn weights(out: &mut String, told: &Fitted<'_>) {
    let calibration = told.calibration;
    if calibration.experiments.len() < 2 {
        return;
    }
    let _ = writeln!(
        out,
        "\n  {:<24} {:>9} {:>12}  noise that it is weighed by",
        "experiment", "readings", "mean square"
    );
    for (own, weight) in calibration.experiments.iter().zip(told.weights()) {
        let (count, mean) = match weight.count {
            0 => ("held out".to_owned(), String::new()),
            count => (count.to_string(), significant(weight.mean_square, 4)),
        };
        let _ = writeln!(
            out,
            "  {:<24} {count:>9} {mean:>12}  {}",
            shortened(experiment_name(own), 24),
            shortened(&noise(own), 27)
        );
    }
    for sentence in told.doubtful_weights() {
        wrapped(out, "  -", &sentence);
    }
}

/// The declared noise of the channels of an experiment.
pub fn noise(own: &hyde_study::Calibration) -> String {
    let measured = own.compiled.program.experiment.measured.iter();
    let each = measured.zip(&own.observer.noise);
    let each = each.map(|(channel, noise)| engineering_difference(*noise, &channel.unit));
    each.collect::<Vec<_>>().join(", ")
}
