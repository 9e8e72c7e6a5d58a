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

/// How the circle of the machine is solved.
const SOLVE: &str = "solve ida(rtol = 1e-6, atol = 1e-8) stop 4.6 [s] every 2 [ms];";

/// All frictions of the machine are set to nothing, as `hyde budget` does.
fn machine_without_friction() -> Example {
    let mut machine = Example::load("examples/machine/machine.hyde", Some("circle")).unwrap();
    for friction in ["table.F", "table.b", "saddle.saddle.F", "saddle.saddle.b"] {
        machine = machine.set(friction, 0.0);
    }
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
    machine
}

/// The axes rest until the controller ticks, and the speeds begin with derivatives so high that rounding decides in which
/// direction a bearing that holds nothing breaks away.
#[test]
fn a_machine_without_friction_runs_by_both_methods() {
    let places = ["esdirk", "ida"].map(|method| {
        let short = format!("solve {method}(rtol = 1e-6, atol = 1e-8) stop 0.3 [s] every 2 [ms];");
        let machine = machine_without_friction().rewritten(SOLVE, &short);
        let (compiled, run) = machine.run().unwrap();
        let place = compiled.program.output("table.s").unwrap();
        *run.results.column(place).unwrap().last().unwrap()
    });
    assert!((places[0] - places[1]).abs() < 1e-6, "{places:?}");
    assert!(places[0].abs() > 1e-3, "{places:?}");
}

/// With all but the belts ideal, the Y axis stands still before its first motion, but for noise: speeds of 1e-21 rad/s turn
/// there, and a friction without a force, stuck and slipping, contradicts itself.
#[test]
fn frictions_without_a_force_are_no_endless_events_at_rest() {
    let ends = |tolerances: &str| {
        let mut machine = machine_without_friction().set("saddle.table.k", 1e10);
        for axis in ["X", "Y"] {
            for (part, ideal) in [
                ("gap", 0.0),
                ("screw.kb", 3e9),
                ("screw.E", 2.06e12),
                ("screw.G", 7.92e11),
                ("screw.c_axial", 3.8e5),
                ("screw.K_nut", 5e9),
                ("screw.c_nut", 5.4e5),
                ("cnc.tau", 1e-3),
                ("K_v", 100.0),
            ] {
                machine = machine.set(&format!("{axis}.{part}"), ideal);
            }
        }
        let short = format!("solve ida({tolerances}) stop 0.2 [s] every 10 [ms];");
        let run = machine.rewritten(SOLVE, &short).run();
        let (compiled, run) = run.unwrap_or_else(|error| panic!("{tolerances}: {error}"));
        ["x", "y"].map(|place| {
            let place = compiled.program.output(place).unwrap();
            *run.results.column(place).unwrap().last().unwrap()
        })
    };
    let exact = ends("rtol = 1e-9, atol = 1e-12");
    for tolerances in ["rtol = 1e-5", "rtol = 3e-5", "rtol = 1e-6"] {
        for (found, exact) in ends(tolerances).iter().zip(&exact) {
            let off = (found - exact).abs();
            assert!(off < 1e-8, "{tolerances}: {found:e} {exact:e}");
        }
    }
}
