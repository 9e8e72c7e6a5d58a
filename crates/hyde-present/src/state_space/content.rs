//! A state space as data: a MAT file of level 5, and JSON.

use super::about;
use hyde_experiment::StateSpaceSignal;
use hyde_signal::mat::Level5;
use hyde_study::state_space::Found;
use serde_json::{Value, json};

/// The variables `A`, `B`, `C`, `D`, `dt`, names, units and values at the operating point.
pub fn mat(found: &Found) -> Vec<u8> {
    let mut file = Level5::new(&format!("{}, Hyde", found.name()));
    let columns = [
        found.system.states.len(),
        found.system.inputs.len(),
        found.system.states.len(),
        found.system.inputs.len(),
    ];
    for ((name, rows), columns) in found.system.matrices().into_iter().zip(columns) {
        let by_columns = (0..columns).flat_map(|column| rows.iter().map(move |row| row[column]));
        let values: Vec<f64> = by_columns.collect();
        file = file.numbers(name, rows.len(), columns, &values);
    }
    let (period, first) = times(found);
    file = file.numbers("dt", 1, 1, &[period]);
    file = file.numbers("t0", 1, 1, &[first]);
    for (name, signals) in groups(found) {
        let names: Vec<String> = signals.iter().map(|own| own.name.clone()).collect();
        let units: Vec<String> = signals.iter().map(unit).collect();
        let values: Vec<f64> = signals.iter().map(|own| own.value).collect();
        file = file.texts(&format!("{name}s"), &names);
        file = file.texts(&format!("{name}_units"), &units);
        file = file.numbers(&format!("{name}_values"), values.len(), 1, &values);
    }
    file.text("about", about(found).trim_end()).into_bytes()
}

/// The same as JSON, matrices by rows.
pub fn json(found: &Found) -> Value {
    let mut value = names(found);
    for (name, rows) in found.system.matrices() {
        value[name] = rows.into();
    }
    value
}

/// All but the matrices.
pub fn names(found: &Found) -> Value {
    let (period, first) = times(found);
    let mut value = json!({ "of": found.name(), "dt": period, "t0": first, "about": about(found) });
    for (name, signals) in groups(found) {
        let listed = signals
            .iter()
            .map(|own| json!({ "name": own.name, "unit": own.unit, "value": own.value }));
        value[format!("{name}s")] = listed.collect();
    }
    value
}

/// The sample time, 0 of a continuous system, and the first instant, in s.
pub fn times(found: &Found) -> (f64, f64) {
    let sampled = found.system.sampled;
    sampled.map_or((0.0, 0.0), |times| (times.period_s, times.first_s))
}

/// States, inputs and outputs.
pub fn groups(found: &Found) -> [(&'static str, &[StateSpaceSignal]); 3] {
    let system = &found.system;
    [
        ("state", &system.states),
        ("input", &system.inputs),
        ("output", &system.outputs),
    ]
}

/// The unit for people; `1` of a bare number, `?` where it is not known.
pub fn unit(signal: &StateSpaceSignal) -> String {
    signal.unit.clone().unwrap_or_else(|| "?".to_owned())
}
