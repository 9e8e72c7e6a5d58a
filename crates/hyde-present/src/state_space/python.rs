//! A state space as a Python file that makes a system of python-control.

use super::about;
use super::content::{groups, times, unit};
use hyde_study::state_space::Found;
use std::fmt::Write as _;

/// The file for python-control.
pub fn text(found: &Found) -> String {
    let mut text = format!(
        "\"\"\"The linearised system of {}, written by Hyde {}: `system` is a StateSpace of python-control.\n\n{}\n",
        found.name(),
        env!("CARGO_PKG_VERSION"),
        about(found).trim_end().replace('\\', "/").replace('"', "'")
    );
    text.push_str(
        "Values are deviations from the operating point, in SI units; the values there are in `*_values`.\n\"\"\"\n\n",
    );
    text.push_str("import control\nimport numpy as np\n\n");
    for (name, signals) in groups(found) {
        let names = signals.iter().map(|own| own.name.clone());
        let _ = writeln!(text, "{name}s = {}", list(names));
        let _ = writeln!(text, "{name}_units = {}", list(signals.iter().map(unit)));
        let values: Vec<String> = signals.iter().map(|own| number(own.value)).collect();
        let _ = writeln!(text, "{name}_values = np.array([{}])", values.join(", "));
    }
    let (states, inputs) = (found.system.states.len(), found.system.inputs.len());
    for (name, rows) in found.system.matrices() {
        let columns = match name {
            "A" | "C" => states,
            _ => inputs,
        };
        let _ = writeln!(text, "{name} = np.array([");
        for row in &rows {
            let row: Vec<String> = row.iter().map(|value| number(*value)).collect();
            let _ = writeln!(text, "    [{}],", row.join(", "));
        }
        let _ = writeln!(text, "], dtype=float).reshape({}, {columns})", rows.len());
    }
    let (period, first) = times(found);
    let _ = writeln!(text, "dt = {}  # s, 0 is continuous", number(period));
    if period > 0.0 {
        let _ = writeln!(text, "t0 = {}  # s, the first instant", number(first));
    }
    text.push_str(
        "\nsystem = control.ss(A, B, C, D, dt, states=states, inputs=inputs, outputs=outputs)\n",
    );
    text
}

fn list(texts: impl Iterator<Item = String>) -> String {
    let quoted: Vec<String> = texts.map(|text| format!("\"{text}\"")).collect();
    format!("[{}]", quoted.join(", "))
}

/// A number with all its digits.
pub fn number(value: f64) -> String {
    // No negative zero.
    format!("{:?}", value + 0.0)
}
