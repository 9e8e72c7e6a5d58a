//! The linearised response of a loop with two clocks against its difference equations, solved tick by tick until nothing
//! changes from period to period.

use hyde_compiler::Backend;
use hyde_experiment::{BodeError, frequency_response, linearize, parameters};
use hyde_tests::Example;
use nalgebra::Complex;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

const LAG: f64 = 20e-3;
const TICK: f64 = 1e-3;

/// Fourier coefficients of x, y, u under `v = exp(2 pi j f t)`, f a multiple of 1 Hz, over the last of three seconds: by
/// then the loop has forgotten how it began.
fn tick_by_tick(f: f64) -> [Complex<f64>; 3] {
    let jw = Complex::new(0.0, TAU * f);
    let driven = 1.0 / (1.0 + jw * LAG);
    let zero = Complex::new(0.0, 0.0);
    let (mut own, mut y, mut u, mut sum, mut out) = (zero, zero, zero, zero, zero);
    let (mut of_y, mut of_u) = (zero, zero);
    for i in 0..3000 {
        let t = f64::from(i) * TICK;
        if i % 10 == 0 {
            sum += 0.2 * y;
            out = -0.8 * y - sum;
        }
        if i % 2 == 1 {
            y = own + driven * (jw * t).exp();
        }
        if i % 10 == 3 {
            u = out;
        }
        if i >= 2000 {
            let weight = ((-jw * t).exp() - (-jw * (t + TICK)).exp()) / jw;
            of_y += y * weight;
            of_u += u * weight;
        }
        own = u + (own - u) * (-TICK / LAG).exp();
    }
    [driven * (1.0 + of_u), of_y, of_u]
}

#[test]
fn two_clocks_have_the_response_of_their_difference_equations() {
    let example = Example::load("tests/models/multirate.hyde", Some("disturbed")).unwrap();
    let program = example
        .free_inputs()
        .compile(Backend::Native)
        .unwrap()
        .program;
    let p = parameters(&program, &BTreeMap::new(), &[]).unwrap();
    let linear = linearize(&program, &BTreeMap::new(), &p, &["v".to_owned()], &[]).unwrap();
    let outputs: Vec<usize> = program.experiment.bodes[0]
        .outputs
        .iter()
        .map(|(_, output)| *output)
        .collect();
    let frequencies = [1.0, 7.0, 17.0, 33.0, 49.0];
    let found = frequency_response(&linear, 0, &outputs, &frequencies).unwrap();
    for (k, &f) in frequencies.iter().enumerate() {
        for (found, exact) in found.iter().zip(tick_by_tick(f)) {
            // rounding of 3000 steps and of a matrix exponential
            assert!(
                (found[k] - exact).norm() < 1e-9 * exact.norm(),
                "{f} Hz: {} {exact}",
                found[k]
            );
        }
    }
    // The slow clock decides, for what it holds reaches the states.
    let above = frequency_response(&linear, 0, &outputs, &[60.0]);
    assert_eq!(above, Err(BodeError::AboveNyquist(60.0, 50.0)));
}
