//! The models of `tests/benches/models`, which `./dev bench` runs beside peers, against closed forms and the end states of
//! the reference programs at rtol 1e-11. No peer is built here.

use hyde_tests::Example;
use std::f64::consts::{PI, TAU};

const FOLDER: &str = "tests/benches/models";

/// Last values of columns.
fn ends(file: &str, experiment: &str, columns: &[&str]) -> Vec<f64> {
    let example = Example::load(format!("{FOLDER}/{file}"), Some(experiment)).unwrap();
    let (compiled, run) = example.run().unwrap();
    columns
        .iter()
        .map(|name| {
            let output = compiled.program.output(name).unwrap();
            *run.results.column(output).unwrap().last().unwrap()
        })
        .collect()
}

#[track_caller]
fn assert_near(found: f64, expected: f64, relative: f64) {
    let off = (found - expected).abs();
    assert!(
        off <= relative * expected.abs(),
        "{found} instead of {expected}"
    );
}

/// After 46 time constants the brake takes the whole torque, and the shaft is twisted by it.
#[test]
fn a_driven_shaft_ends_at_the_speed_of_its_brake() {
    for file in ["shaft.hyde", "shaft_torques.hyde"] {
        let found = ends(file, "step", &["w_motor", "w_load", "twist"]);
        let twist = 10.0 / (80e9 * PI * 0.032f64.powi(4) / 32.0);
        // 100 times the relative tolerance of the models.
        assert_near(found[0], 20.0, 1e-4);
        assert_near(found[1], 20.0, 1e-4);
        assert_near(found[2], twist, 1e-3); // ten times its error beside the reference
    }
}

/// The torque of the motor is that of the brake and of the friction of all 102 nodes.
#[test]
fn a_shaft_with_friction_ends_where_torques_balance() {
    let friction = |w: f64| (2e-3 + 2e-3 * (-w * w).exp()) * (w / 0.01).tanh();
    let (mut low, mut high) = (0.0, 20.0);
    for _ in 0..60 {
        let w = 0.5 * (low + high);
        if 0.5 * w + 102.0 * friction(w) < 10.0 {
            low = w;
        } else {
            high = w;
        }
    }
    for file in ["stiffening_shaft.hyde", "implicit_shaft.hyde"] {
        let found = ends(file, "step", &["w_motor", "w_load"]);
        assert_near(found[0], low, 1e-4);
        assert_near(found[1], low, 1e-4);
    }
}

/// The first slip begins where the pull of spring and damper reaches the static friction.
#[test]
fn a_saddle_slips_when_the_pull_is_that_of_static_friction() {
    let found = event_times("stick_slip.hyde", "drawn");
    assert_eq!(found.len(), 65);
    let (spring, damper): (f64, f64) = (1e6 * 2e-3, 500.0 * 2e-3 * TAU);
    let first = ((400.0 / spring.hypot(damper)).asin() - damper.atan2(spring)) / TAU;
    assert!(
        (found[0] - first).abs() < 1e-6,
        "{} instead of {first}",
        found[0]
    );
}

#[test]
fn masses_with_backlash_end_where_the_reference_ends() {
    assert_eq!(event_times("backlash.hyde", "reversing").len(), 91);
    let found = ends("backlash.hyde", "reversing", &["x2", "s"]);
    // Positions of about 10 mm: 1e-6 of it.
    assert!((found[0] + 4.697_630_66e-5).abs() < 1e-8, "{}", found[0]);
    assert!((found[1] - 2.126_175_67e-5).abs() < 1e-8, "{}", found[1]);
}

#[test]
fn a_sampled_loop_ends_where_the_reference_ends() {
    let found = ends(
        "controlled_shaft.hyde",
        "positioned",
        &["w_motor", "w_load"],
    );
    // Relative to the speed of 4.2 rad/s on the way, 240 times the relative tolerance of the model.
    assert!((found[0] + 0.067_135_481).abs() < 1e-3, "{}", found[0]);
    assert!((found[1] + 0.066_851_396).abs() < 1e-3, "{}", found[1]);
}

/// From tick to tick the same few lengths of steps come back, and with them their factors.
#[test]
fn a_sampled_loop_is_factored_less_often_than_it_ticks() {
    let example = Example::load(
        format!("{FOLDER}/controlled_shaft.hyde"),
        Some("positioned"),
    );
    let example = example.unwrap().set("Ts", 1e-3);
    let (_, run) = example.run().unwrap();
    let counts = &run.results.statistics;
    assert_eq!(counts.ticks, 1000);
    assert!(counts.jacobian_evaluations < 200, "{counts:?}");
    assert!(counts.steps < 4000, "{counts:?}");
}

fn event_times(file: &str, experiment: &str) -> Vec<f64> {
    let example = Example::load(format!("{FOLDER}/{file}"), Some(experiment)).unwrap();
    let (_, run) = example.run().unwrap();
    run.results.events.iter().map(|event| event.t).collect()
}
