//! Initial equations behind limiters, relations of the time and derivatives of variables that are no states.

use crate::models::{close, solve};

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
