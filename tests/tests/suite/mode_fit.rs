//! Parameters found again from frequencies and dampings that they made.

use hyde_compiler::Backend;
use hyde_experiment::{
    MeasuredMode, ModeFit, ModeFitError, ModeFitRequest, NaturalMode, fit_modes, linearize, modes,
    parameters,
};
use hyde_program::Program;
use hyde_tests::Example;
use std::collections::BTreeMap;

const SPREAD: f64 = 0.01;

fn program(model: &str) -> Program {
    let example = Example::load("tests/models/chain.hyde", None).unwrap();
    let example = example.model(model).free_inputs();
    example.compile(Backend::Native).unwrap().program
}

fn with(set: &[(&str, f64)]) -> Vec<(String, f64)> {
    set.iter()
        .map(|(name, value)| ((*name).to_owned(), *value))
        .collect()
}

fn natural(program: &Program, set: &[(&str, f64)]) -> Vec<NaturalMode> {
    let p = parameters(program, &BTreeMap::new(), &with(set)).unwrap();
    modes(&linearize(program, &BTreeMap::new(), &p, &[], &[]).unwrap())
}

/// As if measured without error.
fn measured(modes: &[NaturalMode], damping: bool) -> Vec<MeasuredMode> {
    let of = |mode: &NaturalMode| MeasuredMode {
        frequency_hz: mode.frequency_hz,
        spread: SPREAD,
        damping: damping.then_some((mode.damping, 0.1)),
    };
    modes.iter().map(of).collect()
}

fn fit(
    program: &Program,
    set: &[(&str, f64)],
    vary: &[&str],
    measured: &[MeasuredMode],
    numbers: &[usize],
) -> Result<ModeFit, ModeFitError> {
    let vary: Vec<String> = vary.iter().map(|name| (*name).to_owned()).collect();
    fit_modes(&ModeFitRequest {
        program,
        records: &BTreeMap::new(),
        set: &with(set),
        in_modes: &[],
        vary: &vary,
        measured,
        numbers,
    })
}

#[test]
fn stiffnesses_and_dampings_are_found_again() {
    let program = program("Pair");
    let truth = [("k1", 6.5e5), ("k2", 5.5e5), ("d1", 220.0), ("d2", 30.0)];
    let seen = measured(&natural(&program, &truth), true);
    let names = truth.map(|(name, _)| name);
    let found = fit(&program, &[], &names, &seen, &[]).unwrap();
    for (found, (name, value)) in found.parameters.iter().zip(truth) {
        // The iteration ends with steps of 1e-10.
        assert!(
            (found.values.1 / value - 1.0).abs() < 1e-8,
            "{name}: {found:?}"
        );
    }
    assert!(found.left < 1e-6);
}

/// Masses alike and equal springs: w^2 = (3 -+ sqrt 5)/2 k/m. In k2 of an undamped pair the derivative of ln f is half the
/// share of the strain energy that is in k2 (Rayleigh).
#[test]
fn derivatives_are_shares_of_the_strain_energy() {
    let program = program("Pair");
    let set = [
        ("k1", 4e5),
        ("k2", 4e5),
        ("second.M", 10.0),
        ("d1", 0.0),
        ("d2", 0.0),
    ];
    let seen = measured(&natural(&program, &set), false);
    let found = fit(&program, &set, &["k1", "k2"], &seen, &[]).unwrap();
    for (mode, sign) in found.modes.iter().zip([-1.0, 1.0]) {
        let square = 0.5 * (3.0 + sign * 5.0_f64.sqrt());
        let expected = (square * 4e4_f64).sqrt() / std::f64::consts::TAU;
        assert!((mode.modes.0.frequency_hz / expected - 1.0).abs() < 1e-10);
        // Of the second body: (1 - w^2 m/k) x2 = x1.
        let stretch = 1.0 / (1.0 - square) - 1.0;
        let share = stretch.powi(2) / (1.0 + stretch.powi(2));
        assert!((mode.by_parameter[1] - 0.5 * share).abs() < 1e-9);
        assert!((mode.by_parameter[0] - 0.5 * (1.0 - share)).abs() < 1e-9);
    }
}

/// Two frequencies, each of one spring alone: ln k has twice the spread of ln f.
#[test]
fn spreads_of_parameters_follow_from_those_of_frequencies() {
    let program = program("Apart");
    let seen = measured(&natural(&program, &[]), false);
    let found = fit(&program, &[], &["k1", "k2"], &seen, &[]).unwrap();
    for parameter in &found.parameters {
        assert!((parameter.spread.unwrap() / (2.0 * SPREAD) - 1.0).abs() < 1e-9);
    }
}

#[test]
fn what_frequencies_do_not_determine_is_told_and_left() {
    let program = program("Parallel");
    let seen = measured(&natural(&program, &[("k1", 2e5), ("k2", 4e5)]), false);
    let found = fit(&program, &[], &["k1", "k2"], &seen, &[]).unwrap();
    // The sum is found.
    let sum: f64 = found.parameters.iter().map(|p| p.values.1).sum();
    assert!((sum / 6e5 - 1.0).abs() < 1e-8, "{found:?}");
    assert!(found.parameters.iter().all(|p| p.spread.is_none()));
    assert!(found.combinations[0].spread < 0.1 && found.combinations[1].spread > 1e6);
    // Along k1^a k2^b with a k1 + b k2 = 0 the sum does not change.
    let open = &found.combinations[1].exponents;
    let ratio = found.parameters[1].values.1 / found.parameters[0].values.1;
    assert!((open[0] / open[1] + ratio).abs() < 1e-6);
}

/// The lower body becomes the faster one: each measurement stays with its body, for the shapes do.
#[test]
fn modes_that_cross_keep_their_measurement() {
    let program = program("Apart");
    let truth = natural(&program, &[("k1", 3e5), ("k2", 1.1e5)]);
    // By its number before: the first mode is that of the body on k1, and is measured as the faster.
    let seen = measured(&[truth[1], truth[0]], false);
    let found = fit(&program, &[], &["k1", "k2"], &seen, &[0, 1]).unwrap();
    assert!(
        (found.parameters[0].values.1 / 3e5 - 1.0).abs() < 1e-8,
        "{found:?}"
    );
    assert!((found.parameters[1].values.1 / 1.1e5 - 1.0).abs() < 1e-8);
    assert!((found.modes[0].modes.1.frequency_hz / truth[1].frequency_hz - 1.0).abs() < 1e-9);
}

#[test]
fn measurements_are_paired_with_the_nearest_in_order() {
    let program = program("Pair");
    let all = natural(&program, &[]);
    let mut seen = measured(&all[1..], false);
    seen[0].frequency_hz *= 1.03;
    let found = fit(&program, &[], &["k2"], &seen, &[]).unwrap();
    assert_eq!(found.modes[0].number, 1);
    assert!((found.modes[0].modes.1.frequency_hz / seen[0].frequency_hz - 1.0).abs() < 1e-9);
}

/// The vibration behind a delay is a root of s^2 m + s b + k exp(-sT): its derivative by ln k in closed form.
#[test]
fn derivatives_know_of_delays() {
    use nalgebra::Complex;
    let program = program("Late");
    let mode = natural(&program, &[])[0];
    let (m, b, k, t) = (10.0, 900.0, 1e5, 5e-3);
    let s = mode.eigenvalue;
    let back = (-s * t).exp() * k;
    assert!((s * s * m + s * b + back).norm() < 1e-6 * back.norm());
    let by = -back / (s * 2.0 * m + Complex::from(b) - back * t);
    let seen = measured(&[mode], true);
    let found = fit(&program, &[], &["k"], &seen, &[0]).unwrap();
    // A difference over 1e-3 in a bilinear equation: rounding alone.
    assert!((found.modes[0].by_parameter[0] - (by / s).re).abs() < 1e-8);
    let far = fit(&program, &[("k", 6e4)], &["k"], &seen, &[0]).unwrap();
    assert!(
        (far.parameters[0].values.1 / k - 1.0).abs() < 1e-8,
        "{far:?}"
    );
}

#[test]
fn what_cannot_be_fitted_is_refused() {
    let program = program("Pair");
    let seen = measured(&natural(&program, &[]), false);
    let error = |set: &[(&str, f64)], vary: &[&str], numbers: &[usize]| {
        fit(&program, set, vary, &seen, numbers).unwrap_err()
    };
    assert!(matches!(
        error(&[], &["k9"], &[]),
        ModeFitError::Parameter(_)
    ));
    assert!(matches!(
        error(&[("k1", 0.0)], &["k1"], &[]),
        ModeFitError::NotPositive(..)
    ));
    assert!(matches!(
        error(&[], &["k1"], &[0, 7]),
        ModeFitError::TooFewModes(2)
    ));
    let three = [seen[0], seen[1], seen[1]];
    let error = fit(&program, &[], &["k1"], &three, &[]).unwrap_err();
    assert!(matches!(error, ModeFitError::TooFewModes(2)));
}
