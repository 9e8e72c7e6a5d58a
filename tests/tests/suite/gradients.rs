//! Derivatives of runs through events (S1), against closed forms and differences.

use hyde_compiler::Backend;
use hyde_experiment::{Options, Run};
use hyde_sim::GradientEndKind;
use hyde_tests::Example;
use hyde_tests::gradient::{BENCH, CASES, Case, compare_bench};
use std::collections::BTreeMap;

/// The promise (S1): a relative difference of 1e-4 at most. It is that of the differences mostly: their runs are solved to
/// 1e-10, so that a relative step of 1e-4 leaves 1e-6 of a state, and more of a force.
const AT_MOST: f64 = 1e-4;

#[test]
fn every_model_agrees_with_differences() {
    for case in CASES {
        agrees(case);
    }
}

fn agrees(case: &Case) {
    for compared in case.compare().unwrap() {
        assert!(compared.error < AT_MOST, "{}: {compared:?}", case.model);
        // A derivative that is zero, or rows that are left out, would show nothing.
        assert!(compared.largest > 0.0, "{}: {compared:?}", case.model);
        assert!(10 * compared.rows.0 > 9 * compared.rows.1, "{compared:?}");
    }
}

#[test]
fn the_bench_axis_agrees_with_differences() {
    // The figure takes all of them.
    let some: Vec<&str> = BENCH.into_iter().step_by(3).collect();
    for compared in compare_bench(&some).unwrap() {
        assert!(compared.error < AT_MOST, "{compared:?}");
    }
}

#[test]
fn a_decay_has_its_closed_form() {
    let run = solved("Decay", 2.0, &["a", "b", "x0"]);
    let gradient = run.results.gradient.unwrap();
    let (a, b, x0) = (2.0_f64, 3.0, 1.5);
    for (row, &t) in run.results.time.iter().enumerate() {
        let e = (-a * t).exp();
        let closed = [
            -t * x0 * e - b / a.powi(2) * (1.0 - e) + b / a * t * e,
            (1.0 - e) / a,
            e,
        ];
        for (columns, closed) in gradient.columns.iter().zip(closed) {
            // The tolerance of sensitivities is 1e-5 by the embedded formula; the method is two orders better.
            assert!((columns[0][row] - closed).abs() < 1e-6, "at {t} s");
        }
    }
}

#[test]
fn a_run_without_gradient_is_the_same_to_the_last_bit() {
    for case in CASES {
        let with = solved(case.model, case.stop_s, case.parameters).results;
        let without = solved(case.model, case.stop_s, &[]).results;
        assert_eq!(without.gradient, None);
        assert_eq!(with.time, without.time, "{}", case.model);
        assert_eq!(with.columns, without.columns, "{}", case.model);
        assert_eq!(with.statistics, without.statistics, "{}", case.model);
    }
}

#[test]
fn a_crossing_that_grazes_ends_the_gradient_and_says_so() {
    let run = solved("Grazing", 2.0, &["bound"]);
    let gradient = run.results.gradient.as_ref().unwrap();
    let end = gradient.end.as_ref().unwrap();
    assert_eq!(end.kind, GradientEndKind::Grazing);
    assert_eq!(end.cause, "height > bound");
    // The parabola is higher than the bound by 1e-9 and the run solved to 1e-8. The instant is located to rounding, of a
    // slope of 6e-5.
    assert!((end.t - (1.0 - 1e-9_f64.sqrt())).abs() < 1e-10, "{end:?}");
    // The left limit of the event is the last row with a value.
    let (left, _) = run.results.rows_at(end.t).unwrap();
    for (row, slope) in gradient.columns[0][0].iter().enumerate() {
        assert_eq!(slope.is_nan(), row > left, "row {row}: {slope}");
    }
}

fn solved(model: &str, stop_s: f64, gradient: &[&str]) -> Run {
    let example = Example::load("tests/models/gradients.hyde", None).unwrap();
    let compiled = example.model(model).compile(Backend::Native).unwrap();
    let options = Options {
        stop_s: Some(stop_s),
        rtol: Some(1e-8),
        atol: Some(1e-11),
        gradient: gradient.iter().map(|name| (*name).to_owned()).collect(),
        ..Options::default()
    };
    hyde_experiment::run(&compiled.program, &BTreeMap::new(), &options).unwrap()
}
