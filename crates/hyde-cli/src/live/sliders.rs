//! The parameters that can be moved: those that are uncertain, and those whose value the user's file gives.

use hyde_diag::FileId;
use hyde_program::{Parameter, Prior, Program};
use hyde_units::{Kind, NamedUnit, significant};
use serde_json::{Value, json};

/// Steps from one end of a slider to the other.
const STEPS: f64 = 200.0;

/// A slider of a temperature goes so far to both sides, K: twice the value has no meaning for one.
const TEMPERATURE_K: f64 = 50.0;
/// Values in K from here on are temperatures, smaller ones may be differences.
const LEAST_TEMPERATURE_K: f64 = 150.0;

/// The sliders of a program with the values that it has, uncertain parameters first.
pub(super) fn sliders(program: &Program, values: &[f64], own: Option<FileId>) -> Vec<Value> {
    let chosen = |parameter: &&Parameter| {
        let given = Some(parameter.origin.span.file) == own;
        can_move(parameter) && (parameter.prior.is_some() || given)
    };
    let mut all: Vec<&Parameter> = program.parameters.iter().filter(chosen).collect();
    all.sort_by_key(|parameter| parameter.prior.is_none());
    all.into_iter()
        .filter_map(|parameter| Some(slider(parameter, *values.get(parameter.place)?)))
        .collect()
}

/// A number that can be set without compiling anew.
fn can_move(parameter: &Parameter) -> bool {
    parameter.len == 1
        && !parameter.structural
        && !parameter.is_final
        && !parameter.found
        && parameter.allowed.kind == Kind::Real
}

/// A slider in the unit of its parameter.
fn slider(parameter: &Parameter, si: f64) -> Value {
    let unit = parameter.unit.unit();
    let shown = |si: f64| unit.from_si(si);
    let spread = parameter.prior.map(|prior| match prior {
        Prior::Relative(part) => (si * part).abs(),
        Prior::Absolute(spread) => spread,
    });
    let (mut low, mut high) = match (parameter.range, spread) {
        (Some(range), _) => range,
        (None, Some(spread)) => (si - 4.0 * spread, si + 4.0 * spread),
        (None, None) => around(&parameter.unit, si),
    };
    low = parameter
        .allowed
        .min
        .map_or(low, |least| low.max(least))
        .min(si);
    high = parameter
        .allowed
        .max
        .map_or(high, |most| high.min(most))
        .max(si);
    let (low, high) = (shown(low), shown(high));
    let text = match parameter.unit.text() {
        "1" => "",
        text => text,
    };
    json!({
        "name": parameter.name,
        "value": shown(si),
        "text": significant(shown(si), 6),
        "unit": text,
        "min": low,
        "max": high,
        "step": ((high - low) / STEPS).abs(),
        "spread": spread.map(|spread| [shown(si - spread), shown(si + spread)]),
        "source": parameter.source,
    })
}

/// From where to where a value without a range and a spread can be moved, SI: from 0 to twice the value.
fn around(unit: &NamedUnit, si: f64) -> (f64, f64) {
    let is_temperature =
        unit.unit().is_absolute() || (unit.text() == "K" && si >= LEAST_TEMPERATURE_K);
    match (is_temperature, si == 0.0) {
        (true, _) => ((si - TEMPERATURE_K).max(0.0), si + TEMPERATURE_K),
        (false, true) => (unit.unit().to_si(-1.0), unit.unit().to_si(1.0)),
        (false, false) => (0.0_f64.min(2.0 * si), 0.0_f64.max(2.0 * si)),
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "tests unwrap what must be there")]
mod tests {
    use super::around;
    use hyde_units::{NamedUnit, significant};

    #[test]
    fn a_temperature_is_moved_about_its_value() {
        let ends = |unit: &str, value: f64| {
            let unit = NamedUnit::parse(unit).unwrap();
            let (low, high) = around(&unit, unit.unit().to_si(value));
            [low, high].map(|end| significant(unit.unit().from_si(end), 3))
        };
        assert_eq!(ends("degC", 20.0), ["-30", "70"]);
        assert_eq!(ends("degC", 0.0), ["-50", "50"]);
        assert_eq!(ends("K", 293.0), ["243", "343"]);
        assert_eq!(ends("degC", -270.0), ["-273", "-220"]);
        // A difference, and a length.
        assert_eq!(ends("K", 20.0), ["0", "40"]);
        assert_eq!(ends("mm", 3.0), ["0", "6"]);
        assert_eq!(ends("mm", -3.0), ["-6", "0"]);
        assert_eq!(ends("mm", 0.0), ["-1", "1"]);
    }
}
