//! Stepped sines of quantities whose response is known.

use hyde_compiler::{Backend, Compiled};
use hyde_experiment::{Level, Options, SteppedPoint, Steps, stepped_response};
use hyde_tests::Example;
use nalgebra::Complex;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

fn compiled(experiment: &str, input: &str) -> Compiled {
    let example = Example::load("tests/models/stepped.hyde", Some(experiment)).unwrap();
    let example = example.set(&format!("{input}.frequency"), 1.0);
    example.compile(Backend::Native).unwrap()
}

fn stepped(compiled: &Compiled, steps: &Steps, threads: usize) -> Vec<SteppedPoint> {
    let program = &compiled.program;
    let bode = &program.experiment.bodes[0];
    let found = stepped_response(
        program,
        &BTreeMap::new(),
        &Options::default(),
        bode,
        steps,
        threads,
    );
    found.unwrap()
}

fn steps(amplitude: f64, level: Option<Level>) -> Steps {
    Steps {
        frequencies_hz: vec![1.0, 3.1, 9.7, 30.0],
        amplitude,
        settle_s: 0.3,
        periods: 4,
        level,
    }
}

/// Of a lag 1/(1 + jwT), and of sin^3 = 3/4 sin(wt) - 1/4 sin(3wt): fundamental, distortion, share of the power.
#[test]
fn a_lag_and_a_cube_have_their_response() {
    let points = stepped(&compiled("plain", "u"), &steps(2.0, None), 1);
    for point in &points {
        let lag = 1.0 / Complex::new(1.0, TAU * point.frequency_hz * 20e-3);
        let [x, y] = point.outputs[..] else {
            panic!("two outputs")
        };
        // 15 time constants have passed: 3e-7 is left of the start
        assert!((x.response - lag).norm() < 1e-6, "{} {lag}", x.response);
        assert!(x.distortion < 1e-6 && x.coherence > 1.0 - 1e-9, "{x:?}");
        // 3/4*2^2; the drift that a fit over four periods takes out has a little of the third harmonic
        let three = Complex::new(3.0, 0.0);
        assert!((y.response - three).norm() < 1e-4, "{}", y.response);
        assert!((y.distortion - 1.0 / 3.0).abs() < 1e-4);
        assert!((y.coherence - 0.9).abs() < 1e-4);
        // 2^3 at the top, where there is a row
        assert!((point.measures[0].value - 8.0).abs() < 1e-6);
        assert!(!point.measures[1].holds);
    }
}

#[test]
fn the_amplitude_is_lowered_until_a_response_is_at_its_level() {
    let level = Level {
        output: 1,
        most: 1.5,
    };
    let points = stepped(&compiled("kept", "u"), &steps(2.0, Some(level)), 2);
    for point in &points {
        let of_y = point.outputs[1].response.norm() * point.amplitude;
        assert!((of_y / 1.5 - 1.0).abs() < 0.03, "{of_y}"); // as near as is asked for
        assert!((point.amplitude - 2.0_f64.cbrt()).abs() < 0.02); // 3/4*a^3 = 1.5
    }
    // Where it is not reached the amplitude stays.
    let level = Level {
        output: 1,
        most: 100.0,
    };
    let points = stepped(&compiled("kept", "u"), &steps(2.0, Some(level)), 1);
    assert!(
        points
            .iter()
            .all(|point| point.amplitude.to_bits() == 2.0_f64.to_bits())
    );
}

#[test]
fn side_by_side_gives_the_same() {
    let compiled = compiled("plain", "u");
    let (one, three) = (
        stepped(&compiled, &steps(2.0, None), 1),
        stepped(&compiled, &steps(2.0, None), 3),
    );
    assert_eq!(one, three);
}

/// Less than the breakaway force moves nothing, to the last bit.
#[test]
fn a_stuck_body_has_no_response() {
    let points = stepped(&compiled("stuck", "F"), &steps(90.0, None), 1);
    for point in &points {
        assert_eq!(point.outputs[0].response, Complex::new(0.0, 0.0));
        assert!(point.outputs[0].coherence.is_nan() && point.outputs[0].distortion.is_nan());
    }
}

/// Without a frequency asked for the stimulus drives the input as ever.
#[test]
fn a_run_has_its_stimulus() {
    let (compiled, run) = Example::load("tests/models/stepped.hyde", Some("plain"))
        .unwrap()
        .run()
        .unwrap();
    assert!(compiled.program.parameter("u.frequency").is_none());
    assert!((run.measures[0].value - 1.0).abs() < 1e-12); // 1^3
}
