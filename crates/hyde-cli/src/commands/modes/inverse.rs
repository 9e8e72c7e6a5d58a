//! `hyde modes --measured … --vary …`: parameters from measured natural frequencies.

use super::{Prepared, prepared};
use crate::args::ModesArgs;
use crate::exit::Exit;
use crate::project::Told as _;
use crate::project::complain;
use hyde_experiment::{
    Combination, MeasuredMode, ModeFit, ModeFitError, ModeFitRequest, fit_modes,
};
use hyde_program::Program;
use hyde_study::operating_point;
use hyde_study::run_failure;
use hyde_units::significant;
use serde_json::json;
use std::fmt::Write as _;

/// Exponents below this part of the largest are not printed.
const LEAST_EXPONENT: f64 = 0.05;

/// Finds parameters, and prints them with what determines them.
pub(super) fn fitted(args: &ModesArgs) -> Result<String, Exit> {
    let wrong = |reason: String| complain(&args.model, Exit::CommandLine, &reason);
    let (measured, numbers) = asked(args).map_err(wrong)?;
    let Prepared {
        mut project,
        compiled,
        tables,
        chosen,
        ..
    } = prepared(&args.about, &args.model, None)?;
    let program = &compiled.program;
    let request = ModeFitRequest {
        program,
        records: &tables,
        set: &project.set(),
        in_modes: &chosen,
        vary: &args.vary,
        measured: &measured,
        numbers: &numbers,
    };
    let fit = match fit_modes(&request) {
        Ok(fit) => fit,
        Err(ModeFitError::Parameter(error)) => {
            let (diagnostic, fault) = run_failure::diagnostic(&error, program, None);
            project.diagnostics.push(diagnostic);
            project.finish_with_errors(&args.model);
            return Err(fault.into());
        }
        Err(error) => return Err(wrong(reason(&error, &measured))),
    };
    if args.model.json {
        return Ok(format!("{:#}", found_json(args, &fit, &measured)));
    }
    let mut text = text(args, program, &fit, &measured);
    if !program.holds.is_empty() {
        text.push_str("modes are those of the plant alone, as `hyde modes --open` lists them\n");
    }
    Ok(text)
}

/// The measurement in rising order, and the numbers of its modes from 0.
fn asked(args: &ModesArgs) -> Result<(Vec<MeasuredMode>, Vec<usize>), String> {
    if args.vary.is_empty() {
        return Err(
            "`--measured` needs the parameters to find: `--vary belt.k,screw.contact.k`".to_owned(),
        );
    }
    let positive = |what: &str, text: &str| {
        let value: Option<f64> = text.parse().ok();
        let fine = value.filter(|value| *value > 0.0 && value.is_finite());
        fine.ok_or_else(|| format!("`{text}` is not a positive {what}"))
    };
    let mut measured = Vec::new();
    for text in &args.measured {
        let (frequency, damping) = match text.split_once(':') {
            Some((frequency, damping)) => (frequency, Some(positive("damping ratio", damping)?)),
            None => (text.as_str(), None),
        };
        measured.push(MeasuredMode {
            frequency_hz: positive("frequency in Hz", frequency)?,
            spread: 0.01 * args.spread,
            damping: damping.map(|ratio| (ratio, 0.01 * args.damping_spread)),
        });
    }
    if args.spread.is_nan()
        || args.spread <= 0.0
        || args.damping_spread.is_nan()
        || args.damping_spread <= 0.0
    {
        return Err("`--spread` and `--damping-spread` must be positive".to_owned());
    }
    let mut numbers = Vec::new();
    for &number in &args.pair {
        let twice = numbers.contains(&(number.wrapping_sub(1)));
        if number == 0 || twice {
            return Err(
                "`--pair` takes the number of a mode for each frequency, from 1, each once"
                    .to_owned(),
            );
        }
        numbers.push(number - 1);
    }
    if !numbers.is_empty() && numbers.len() != measured.len() {
        let (pairs, count) = (numbers.len(), measured.len());
        return Err(format!(
            "`--pair` names {pairs} modes for {count} frequencies"
        ));
    }
    if numbers.is_empty() {
        measured.sort_by(|a, b| a.frequency_hz.total_cmp(&b.frequency_hz));
    }
    Ok((measured, numbers))
}

fn reason(error: &ModeFitError, measured: &[MeasuredMode]) -> String {
    match error {
        ModeFitError::Parameter(_) => "a parameter cannot be set".to_owned(),
        ModeFitError::Structural(name) => {
            format!(
                "`{name}` changes the structure of the equations, so it cannot be found by small steps"
            )
        }
        ModeFitError::NotPositive(name, value) => {
            format!(
                "`{name}` is {value}: its logarithm is varied, so start it from a positive value with `--set`"
            )
        }
        ModeFitError::TooFewModes(count) => format!("the model has {count} modes that oscillate"),
        ModeFitError::Linearize(error) => {
            format!(
                "the model is not linearised: {}",
                operating_point::why_not(error)
            )
        }
        ModeFitError::Lost(at) => {
            let f = significant(measured[*at].frequency_hz, 4);
            format!(
                "the mode measured at {f} Hz was lost on the way: its shape changes too much; name it with `--pair`, or start nearer with `--set`"
            )
        }
        ModeFitError::NotConverged => {
            "no end of the steps was found: start nearer with `--set`".to_owned()
        }
    }
}

fn text(args: &ModesArgs, program: &Program, fit: &ModeFit, measured: &[MeasuredMode]) -> String {
    let mut text = format!(
        "{:<24} {:>18} {:>18}   95 %\n",
        "parameter", "before", "found"
    );
    for (name, found) in args.vary.iter().zip(&fit.parameters) {
        let unit = program.parameter(name).map(|(p, _)| p.unit.clone());
        let shown = |value: f64| match &unit {
            Some(unit) if unit.text() != "1" => {
                format!("{} {unit}", significant(unit.unit().from_si(value), 4))
            }
            Some(_) | None => significant(value, 4),
        };
        let interval = match found.spread {
            Some(spread) => {
                let factor = (1.96 * spread).exp();
                let (low, high) = (found.values.1 / factor, found.values.1 * factor);
                format!("{} .. {}", shown(low), shown(high))
            }
            None => "not determined".to_owned(),
        };
        let (before, after) = (shown(found.values.0), shown(found.values.1));
        let _ = writeln!(text, "{name:<24} {before:>18} {after:>18}   {interval}");
    }
    let _ = writeln!(
        text,
        "\n{:>6} {:>14} {:>12} {:>12}   % of f for 1 % of a parameter",
        "mode", "measured [Hz]", "before", "found"
    );
    for (mode, measured) in fit.modes.iter().zip(measured) {
        let parts = args.vary.iter().zip(&mode.by_parameter);
        let parts: Vec<String> = parts
            .map(|(name, by)| format!("{name} {}", significant(*by, 2)))
            .collect();
        let _ = writeln!(
            text,
            "{:>6} {:>14} {:>12} {:>12}   {}",
            mode.number + 1,
            significant(measured.frequency_hz, 5),
            significant(mode.modes.0.frequency_hz, 5),
            significant(mode.modes.1.frequency_hz, 5),
            parts.join(", ")
        );
        if let Some((ratio, _)) = measured.damping {
            let _ = writeln!(
                text,
                "{:>6} {:>14} {:>12} {:>12}",
                "",
                format!("damping {}", significant(ratio, 3)),
                significant(mode.modes.0.damping, 3),
                significant(mode.modes.1.damping, 3)
            );
        }
    }
    // What the steps leave of nothing is their end.
    let left = if fit.left < 1e-6 { 0.0 } else { fit.left };
    let left = significant(left, 2);
    let _ = writeln!(text, "\nresidual: {left} of the spread (rms)");
    for combination in fit.combinations.iter().filter(|c| c.spread >= 1.0) {
        let product = product(&args.vary, combination);
        let _ = writeln!(
            text,
            "not determined, and left unchanged: {product}; measure another frequency that depends on it"
        );
    }
    text
}

/// `belt.k^0.71 * pulley.J^-0.71`
fn product(names: &[String], combination: &Combination) -> String {
    let largest = combination
        .exponents
        .iter()
        .fold(0.0_f64, |a, b| a.max(b.abs()));
    let parts = names.iter().zip(&combination.exponents);
    let parts = parts.filter(|(_, exponent)| exponent.abs() > LEAST_EXPONENT * largest);
    let parts: Vec<String> = parts
        .map(|(name, exponent)| match (exponent - 1.0).abs() < 5e-3 {
            true => name.clone(),
            false => format!("{name}^{}", significant(*exponent, 2)),
        })
        .collect();
    parts.join(" * ")
}

fn found_json(args: &ModesArgs, fit: &ModeFit, measured: &[MeasuredMode]) -> serde_json::Value {
    let parameters = args.vary.iter().zip(&fit.parameters).map(|(name, found)| {
        json!({ "name": name, "before": found.values.0, "found": found.values.1, "spread": found.spread })
    });
    let modes = fit.modes.iter().zip(measured).map(|(mode, measured)| {
        let of = |m: &hyde_experiment::NaturalMode| json!({ "frequency_hz": m.frequency_hz, "damping": m.damping });
        json!({
            "mode": mode.number + 1,
            "measured_hz": measured.frequency_hz,
            "measured_damping": measured.damping.map(|(ratio, _)| ratio),
            "before": of(&mode.modes.0),
            "found": of(&mode.modes.1),
            "by_parameter": mode.by_parameter,
        })
    });
    let combinations = fit.combinations.iter().map(|combination| {
        let spread = combination.spread.is_finite().then_some(combination.spread);
        json!({ "spread": spread, "exponents": combination.exponents })
    });
    json!({
        "ok": true,
        "parameters": parameters.collect::<Vec<_>>(),
        "modes": modes.collect::<Vec<_>>(),
        "combinations": combinations.collect::<Vec<_>>(),
        "left": fit.left,
    })
}
