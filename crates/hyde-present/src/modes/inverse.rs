//! Parameters from measured natural frequencies, as text and as JSON.

use hyde_experiment::Combination;
use hyde_signal::statistics::distributions::TWO_SIDED;
use hyde_study::modes::Found;
use hyde_units::significant;
use serde_json::{Value, json};
use std::fmt::Write as _;

/// The parameters with what determines them.
#[must_use]
pub fn text(found: &Found) -> String {
    let Found {
        prepared,
        vary,
        measured,
        fit,
    } = found;
    let program = &prepared.compiled.program;
    let mut text = format!(
        "{:<24} {:>18} {:>18}   95 %\n",
        "parameter", "before", "found"
    );
    for (name, found) in vary.iter().zip(&fit.parameters) {
        let unit = program.parameter(name).map(|(p, _)| p.unit.clone());
        let shown = |value: f64| match &unit {
            Some(unit) if unit.text() != "1" => {
                format!("{} {unit}", significant(unit.unit().from_si(value), 4))
            }
            Some(_) | None => significant(value, 4),
        };
        let interval = match found.spread {
            Some(spread) => {
                let factor = (TWO_SIDED * spread).exp();
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
        let parts = vary.iter().zip(&mode.by_parameter);
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
        let product = product(vary, combination);
        let _ = writeln!(
            text,
            "not determined, and left unchanged: {product}; measure another frequency that depends on it"
        );
    }
    if !program.holds.is_empty() {
        text.push_str("modes are those of the plant alone, as `hyde modes --open` lists them\n");
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

/// The same as JSON.
#[must_use]
pub fn json(found: &Found) -> Value {
    let Found {
        vary,
        measured,
        fit,
        ..
    } = found;
    let parameters = vary.iter().zip(&fit.parameters).map(|(name, found)| {
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

/// Exponents below this part of the largest are not printed.
const LEAST_EXPONENT: f64 = 0.05;
