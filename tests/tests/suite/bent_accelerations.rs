//! Equations that bend with an acceleration: IDA's norm of a correction leaves out derivatives.

use crate::models::{close, solve_with};
use hyde_experiment::Options;

/// At most tolerances IDA gave up: the second correction of a step was the greater one.
#[test]
fn a_friction_that_goes_with_the_acceleration_is_the_same_by_both_methods() {
    let last = |experiment: &str, rtol: f64| {
        let options = Options {
            rtol: Some(rtol),
            ..Options::default()
        };
        let run = solve_with("bent_acceleration", experiment, &options);
        let end = run.time().len() - 1;
        (run.column("body.s")[end], run.column("body.v")[end])
    };
    let (s, v) = last("one_step", 1e-9);
    for rtol in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8] {
        let found = last("pushed", rtol);
        close(found.0, s, 20.0 * rtol);
        close(found.1, v, 20.0 * rtol);
    }
}
