//! The parameters that can be moved: those that are uncertain, and those whose value the user's file gives.

use hyde_diag::FileId;
use hyde_program::{Parameter, Prior, Program};
use hyde_units::{Kind, significant};
use serde_json::{Value, json};

/// Steps from one end of a slider to the other.
const STEPS: f64 = 200.0;

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
        (None, None) if si == 0.0 => (unit.to_si(-1.0), unit.to_si(1.0)),
        (None, None) => (si.min(2.0 * si), si.max(2.0 * si)),
    };
    if parameter.range.is_none() && spread.is_none() && si > 0.0 {
        low = 0.0;
    } else if parameter.range.is_none() && spread.is_none() && si < 0.0 {
        high = 0.0;
    }
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
