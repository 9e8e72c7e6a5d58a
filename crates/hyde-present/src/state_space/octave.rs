//! A state space as a script for Octave and MATLAB.

use super::about;
use super::content::{groups, times, unit};
use super::python::number;
use hyde_study::state_space::Found;
use std::fmt::Write as _;

/// The file for Octave and MATLAB.
pub fn text(found: &Found) -> String {
    let mut text = format!(
        "% The linearised system of {}, written by Hyde {}: `sys` needs the package control of\n\
         % Octave or the Control System Toolbox of MATLAB.\n%\n",
        found.name(),
        env!("CARGO_PKG_VERSION")
    );
    for line in about(found).trim_end().lines() {
        let _ = writeln!(text, "% {line}");
    }
    text.push_str("% Values are deviations from the operating point, in SI units; the values there are in *_values.\n\n");
    for (name, signals) in groups(found) {
        let names = signals.iter().map(|own| own.name.clone());
        let _ = writeln!(text, "{name}s = {};", cell(names));
        let _ = writeln!(text, "{name}_units = {};", cell(signals.iter().map(unit)));
        let values: Vec<String> = signals.iter().map(|own| number(own.value)).collect();
        let _ = writeln!(text, "{name}_values = [{}];", values.join("; "));
    }
    let (states, inputs) = (found.system.states.len(), found.system.inputs.len());
    for (name, rows) in found.system.matrices() {
        let columns = match name {
            "A" | "C" => states,
            _ => inputs,
        };
        let _ = writeln!(text, "{name} = reshape([");
        for row in &rows {
            let row: Vec<String> = row.iter().map(|value| number(*value)).collect();
            let _ = writeln!(text, "  {}", row.join(" "));
        }
        let _ = writeln!(text, "], {}, {columns});", rows.len());
    }
    let (period, first) = times(found);
    let _ = writeln!(text, "dt = {}; % s, 0 is continuous", number(period));
    if period > 0.0 {
        let _ = writeln!(text, "t0 = {}; % s, the first instant", number(first));
    }
    text.push_str(
        "if exist ('OCTAVE_VERSION', 'builtin')\n  pkg load control\nend\n\
         sys = ss (A, B, C, D, dt);\n",
    );
    // Either may be empty, which neither tool takes for names.
    for (property, names) in [
        ("StateName", "states"),
        ("InputName", "inputs"),
        ("OutputName", "outputs"),
    ] {
        let _ = writeln!(
            text,
            "if ~isempty ({names})\n  sys.{property} = {names};\nend"
        );
    }
    text
}

fn cell(texts: impl Iterator<Item = String>) -> String {
    let quoted: Vec<String> = texts
        .map(|text| format!("'{}'", text.replace('\'', "''")))
        .collect();
    format!("{{{}}}", quoted.join("; "))
}
