//! The experiments that answer a question run to their end: what they expect holds, and their measures are kept.

use hyde_experiment::Options;
use hyde_tests::Example;
use std::fmt::Write as _;

/// Files and experiments.
const EXPERIMENTS: [(&str, &str); 4] = [
    ("examples/friction/friction.hyde", "beside"),
    ("examples/machine/machine.hyde", "circle"),
    ("examples/machine/machine.hyde", "creeping"),
    ("examples/machine/machine.hyde", "hunting"),
];

#[test]
fn experiments_come_out_as_they_did() {
    let mut out = String::new();
    for (file, experiment) in EXPERIMENTS {
        let (compiled, run) = Example::load(file, Some(experiment))
            .unwrap()
            .run()
            .unwrap();
        let _ = writeln!(out, "{experiment}");
        for (measure, known) in run
            .measures
            .iter()
            .zip(&compiled.program.experiment.measures)
        {
            assert!(measure.holds, "{experiment}: {}", measure.name);
            if !measure.expectation {
                let value = known.unit.unit().from_si(measure.value);
                let _ = writeln!(
                    out,
                    "  {} = {value:.3e} {}",
                    measure.name,
                    known.unit.text()
                );
            }
        }
        let figures = &compiled.program.experiment.figures;
        for figure in figures {
            let _ = writeln!(out, "  figure {}: {}", figure.name, figure.title);
        }
    }
    insta::assert_snapshot!(out);
}

#[test]
fn exact_friction_costs_less_than_the_smoothed_one() {
    let evaluations = |model: &str| {
        let example = Example::load("examples/friction/friction.hyde", None).unwrap();
        let options = Options {
            stop_s: Some(1.9),
            ..Options::default()
        };
        let (_, run) = example.model(model).run_with(&options).unwrap();
        run.results.statistics.residual_evaluations
    };
    let (exact, smoothed) = (evaluations("ExactAlone"), evaluations("SmoothedAlone"));
    // A block that ticks every millisecond restarts the solver a thousand times a second.
    assert!(3 * exact < smoothed, "{exact} and {smoothed}");
}

#[test]
fn what_sticks_takes_steps_of_a_record() {
    let example = Example::load("tests/models/pushed.hyde", Some("steps")).unwrap();
    let example = example.record("file", "tests/records/pushed.csv");
    let (_, run) = example.run().unwrap();
    let measures: Vec<f64> = run.measures.iter().map(|measure| measure.value).collect();
    for (value, expected) in measures.iter().zip([0.5, -0.5, 0.01]) {
        assert!((value - expected).abs() < 1e-8, "{measures:?}");
    }
}

/// All frictions of the machine are set to nothing, as `hyde budget` does. The axes rest until the controller ticks, and the
/// speeds begin with derivatives so high that rounding decides in which direction a bearing that holds nothing breaks away.
#[test]
fn a_machine_without_friction_runs_by_both_methods() {
    let machine = Example::load("examples/machine/machine.hyde", Some("circle")).unwrap();
    let mut machine = machine.set("table.F", 0.0).set("table.b", 0.0);
    machine = machine
        .set("saddle.saddle.F", 0.0)
        .set("saddle.saddle.b", 0.0);
    for axis in ["X", "Y"] {
        for friction in [
            "motor.mu_1",
            "motor.c_theta",
            "belt.mu_1",
            "screw.T_nut",
            "screw.mu_1",
        ] {
            machine = machine.set(&format!("{axis}.{friction}"), 0.0);
        }
    }
    let solve = "solve ida(rtol = 1e-4, atol = 1e-8) stop 4.6 [s]";
    let places = ["esdirk", "ida"].map(|method| {
        let short = format!("solve {method}(rtol = 1e-6, atol = 1e-8) stop 0.3 [s]");
        let (compiled, run) = machine.clone().rewritten(solve, &short).run().unwrap();
        let place = compiled.program.output("table.s").unwrap();
        *run.results.column(place).unwrap().last().unwrap()
    });
    assert!((places[0] - places[1]).abs() < 1e-6, "{places:?}");
    assert!(places[0].abs() > 1e-3, "{places:?}");
}
