//! Initial equations behind limiters, relations of the time and derivatives of variables that are no states.

use crate::models::{Solved, close, solve};
use hyde_program::Firmness;

#[test]
fn a_steady_state_is_found_inside_the_limits_of_a_limiter() {
    let drive = solve("starts", "steady");
    // 10 N through the spring and against the force: both follow from the balance of two bodies at rest.
    close(drive.column("stretch")[0], 0.01, 1e-14);
    close(drive.column("F")[0], 10.0, 1e-11);
    close(drive.column("wish")[0], 10.0, 1e-11);
    // It stays there: rtol 1e-8 of metres.
    let last = drive.time().len() - 1;
    close(drive.column("x2")[last], 0.01, 1e-9);
}

#[test]
fn initial_equations_hold_with_the_relations_as_they_are_at_the_start() {
    let controller = solve("starts", "ramp");
    close(controller.column("u")[0], 2.0, 0.0);
    close(controller.column("x")[0], -2.0, 1e-14);
    close(controller.column("y")[0], 0.0, 1e-13);
    let last = controller.time().len() - 1;
    // The integral of 2 + t over 1 s; rtol 1e-8.
    close(controller.column("x")[last], 0.5, 1e-7);
}

#[test]
fn a_start_given_for_the_model_counts_before_a_part_s_own() {
    let train = solve("starts", "gear");
    close(train.column("motor.phi")[0], 6.0, 1e-12);
    close(train.column("motor.w")[0], 1.5, 1e-12);
    close(train.column("table.w")[0], 0.5, 1e-12);
    let pair = solve("starts", "strained");
    close(pair.column("right.s")[0], 0.4, 1e-12);
    close(pair.column("left.s")[0], 0.3, 1e-12);
}

#[test]
fn what_begins_at_a_start_alone_is_listed() {
    let guess = solve("starts", "guess");
    assert_eq!(guess.compiled.states.filled, ["y"]);
    close(guess.column("y")[0], 2.0, 0.0);
}

#[test]
fn free_states_yield_to_initial_equations_before_what_parts_fix() {
    let hung = solve("starts", "hung");
    // 50 N on the upper spring, 30 N on the lower one.
    close(hung.column("upper.s")[0], 0.05, 1e-14);
    close(hung.column("lower.s")[0], 0.065, 1e-14);
    close(hung.column("upper.v")[0], 0.0, 0.0);
    close(hung.column("lower.v")[0], 0.0, 0.0);
    let last = hung.time().len() - 1;
    close(hung.column("lower.s")[last], 0.065, 1e-9);
    let yielded: Vec<&str> = hung
        .run
        .results
        .yielded
        .iter()
        .map(|y| y.name.as_str())
        .collect();
    assert_eq!(yielded, ["upper.s", "lower.s"]);
}

#[test]
fn what_parts_fix_yields_to_initial_equations_if_nothing_else_does() {
    let supply = solve("starts", "supply");
    // 10 V over 5 and 20 ohm.
    close(supply.column("choke.i")[0], 0.4, 1e-14);
    close(supply.column("buffer.v")[0], 8.0, 1e-13);
    let told = supply.run.results.yielded.iter();
    assert!(told.clone().count() == 2 && told.into_iter().all(|y| y.firmness == Firmness::Default));
}

#[test]
fn a_parameter_is_found_with_all_that_follows_from_it() {
    let stiffened = solve("starts", "stiffened");
    close(stiffened.column("body.s")[0], 1.0, 0.0);
    close(stiffened.column("body.v")[0], 0.0, 0.0);
    let found = &stiffened.run.results.yielded;
    assert_eq!(found.len(), 1);
    close(found[0].value, 9.81, 1e-11);
    // It stays a parameter: 9.81 N hold the weight in place.
    let last = stiffened.time().len() - 1;
    close(stiffened.column("body.s")[last], 1.0, 1e-9);
    close(stiffened.run.measures[0].value, 9.81, 1e-11);
}

#[test]
fn a_guess_reaches_the_unknown_that_stands_for_its_variable() {
    let latched = solve("starts", "latched");
    close(latched.column("u")[0], 6.0, 1e-13);
    let behind = solve("starts", "behind");
    close(behind.column("x")[0], 10.0, 1e-11);
}

#[test]
fn roots_at_zero_have_a_value() {
    let drained = solve("starts", "drained");
    let last = drained.time().len() - 1;
    // With s = sqrt(p): t = -2 s - 4 log(1 - s/2). At 1 s by Newton's method.
    let mut s: f64 = 1.0;
    for _ in 0..50 {
        let t = -2.0 * s - 4.0 * (1.0 - s / 2.0).ln();
        s -= (t - 1.0) / (s / (1.0 - s / 2.0));
    }
    close(drained.column("p")[last], s * s, 1e-6);
    // Along the direction (3, 4)/5: der(v) = 5 - 0.1 v^2.
    let terminal = 50.0_f64.sqrt();
    let v = terminal * (5.0 / terminal).tanh();
    close(drained.column("vx")[last], 0.6 * v, 1e-6);
    close(drained.column("vy")[last], 0.8 * v, 1e-6);
}

/// By dense elimination, or by lists of all elements for each, they would take minutes.
#[test]
fn an_array_of_initial_equations_determines_its_elements_and_is_told_once() {
    let rod = solve("starts", "rod");
    for (name, cell) in [("first", 1.0), ("middle", 1000.0), ("last", 2000.0)] {
        let found = rod.column(name);
        close(found[0], cell / 2001.0, 1e-12);
        close(found[found.len() - 1], found[0], 1e-9);
    }
    let told = |solved: &Solved| {
        let results = &solved.run.results;
        hyde_present::start::lines(&solved.compiled.program, &results.yielded)
    };
    assert_eq!(
        told(&rod),
        ["found at the start: x[1..2000] = 4.998e-4 to 0.9995 (free)"]
    );
    let counted = solve("starts", "counted");
    close(counted.column("first")[0], 1.0, 0.0);
    close(counted.column("last")[0], 2000.0, 0.0);
    // 7 = x[3] - y
    close(counted.column("y")[0], -4.0, 1e-14);
    assert_eq!(
        told(&counted),
        [
            "found at the start: x[1..2000] = 1 to 2000 (free)",
            "found at the start: y = -4 (free)"
        ]
    );
}
