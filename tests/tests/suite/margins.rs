//! Stability margins against those of python-control, where that is installed (`pip install control`).

use crate::command::report;
use hyde_tests::root;
use serde_json::Value;
use std::io::Write as _;
use std::process::Command;

/// What python-control makes of the loops, if the `python3` of this machine has it.
fn by_python_control() -> Option<Value> {
    let script = root().join("tests/models/spindle.py");
    let output = Command::new("python3").arg(script).output().ok()?;
    serde_json::from_slice(&output.stdout).ok()
}

#[test]
fn margins_are_those_of_python_control() {
    let Some(expected) = by_python_control() else {
        // Past the capture of the test: who reads the log is to know.
        let mut log = std::io::stderr().lock();
        writeln!(
            log,
            "skipped: margins are not compared, python3 has no `control` (pip install control)"
        )
        .unwrap();
        return;
    };
    for name in ["continuous", "sampled"] {
        let arguments = ["bode", "tests/models/spindle.hyde", name, "--margins"];
        let found = report(&root(), &arguments);
        let margins = &found["margins"][0];
        let number = |value: &Value| value.as_f64().unwrap();
        let exact = |at: usize| number(&expected[name][at]);
        let close = |found: f64, exact: f64| (found / exact - 1.0).abs();
        let phase = &margins["phase_margin"];
        // python-control finds crossovers as roots of polynomials, here to about 1e-8.
        assert!(
            close(number(&phase["deg"]), exact(0)) < 1e-6,
            "{name} {phase}"
        );
        assert!(
            close(number(&phase["frequency_hz"]), exact(1)) < 1e-6,
            "{name} {phase}"
        );
        // Its peak is the largest of 20 001 values.
        let peak = &margins["sensitivity_peak"]["value"];
        assert!(close(number(peak), exact(2)) < 1e-6, "{name} {peak}");
        if name == "sampled" {
            let gain = &margins["gain_margin"];
            assert!(
                close(1.0 / number(&gain["factor"]), exact(3)) < 1e-6,
                "{gain}"
            );
        }
    }
}
