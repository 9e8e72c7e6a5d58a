//! Natural frequencies of torsion bars against those of the wave equation, c = sqrt(G/rho).

use crate::models::{close, model};
use crate::points::parameters;
use hyde_compiler::Backend;
use hyde_experiment::{linearize, modes};
use std::collections::BTreeMap;
use std::f64::consts::PI;

const LEN: f64 = 1.0;
const RHO: f64 = 7850.0;
const G: f64 = 80e9;
const D: f64 = 0.04;

/// The lowest frequencies of a model of `bar.hyde` with n cells, in Hz, without the free rotation.
fn frequencies(name: &str, cells: u32) -> Vec<f64> {
    let bar = model("bar", None).model(name).set("n", f64::from(cells));
    let program = bar.compile(Backend::Native).unwrap().program;
    let p = parameters(&program, &[]);
    let linear = linearize(&program, &BTreeMap::new(), &p, &[], &[]).unwrap();
    let found = modes(&linear).into_iter().map(|mode| mode.frequency_hz);
    // The free rotation has the double eigenvalue zero, which rounding moves by its root.
    found.filter(|frequency| *frequency > 1.0).collect()
}

#[test]
fn a_free_bar_has_the_frequencies_k_c_over_2_len() {
    let c = (G / RHO).sqrt();
    let coarse = frequencies("Free", 16);
    let fine = frequencies("Free", 32);
    for k in 1..=4_u8 {
        let exact = f64::from(k) * c / (2.0 * LEN);
        let error = |found: &[f64]| (found[usize::from(k) - 1] - exact).abs() / exact;
        // Linear elements, their mass half lumped: the error is (k*pi/n)^4/480.
        let expected = (f64::from(k) * PI / 32.0).powi(4) / 480.0;
        close(error(&fine), expected, 0.1 * expected);
        // Half the width, a sixteenth of the error.
        let ratio = error(&coarse) / error(&fine);
        assert!((14.0..18.0).contains(&ratio), "mode {k}: {ratio}");
    }
}

#[test]
fn cells_are_chosen_by_the_highest_frequency() {
    let chosen = model("bar", None).model("Resolved");
    let program = chosen.compile(Backend::Native).unwrap().program;
    // 10 kHz on a bar with c = 3192 m/s: k*h = (480*1e-3)^(1/4) asks for 23.6 cells, 24 is the next even number.
    let angles = program.unknowns.iter().filter(|block| block.name == "th");
    assert_eq!(angles.map(|block| block.len).sum::<usize>(), 25);
    let p = parameters(&program, &[]);
    let linear = linearize(&program, &BTreeMap::new(), &p, &[], &[]).unwrap();
    let c = (G / RHO).sqrt();
    let found = modes(&linear).into_iter().map(|mode| mode.frequency_hz);
    let mut found: Vec<f64> = found.filter(|frequency| *frequency > 1.0).collect();
    found.truncate(6);
    for (number, frequency) in (1_u8..).zip(found) {
        let exact = f64::from(number) * c / (2.0 * LEN);
        // 0.1 % at 10 kHz is what `f_max` promises; the sixth mode is at 9577 Hz.
        assert!(
            (frequency / exact - 1.0).abs() < 1e-3,
            "{number}: {frequency} Hz"
        );
    }
}

#[test]
fn a_loaded_bar_has_the_roots_of_its_frequency_equation() {
    // Equal inertias J at both ends: (J^2*b^2 - Jb^2)*tan(b) = 2*J*Jb*b with b = 2*pi*f*len/c and Jb the bar's inertia.
    let c = (G / RHO).sqrt();
    let own = RHO * PI * D.powi(4) / 32.0 * LEN;
    let load = 2e-3;
    let equation =
        |b: f64| (load * load * b * b - own * own) * b.sin() - 2.0 * load * own * b * b.cos();
    let (coarse, fine) = (frequencies("Loaded", 16), frequencies("Loaded", 32));
    let step = 1e-3;
    let brackets = (1..).map(|k| f64::from(k) * step);
    let mut brackets = brackets.filter(|&b| equation(b) * equation(b + step) < 0.0);
    for number in 0..3 {
        let low = brackets.next().unwrap();
        let exact = bisect(&equation, low, low + step) * c / (2.0 * PI * LEN);
        let error = |found: &[f64]| (found[number] - exact).abs() / exact;
        // An inertia at the end makes it second order: the half lumped mass is of fourth order where the flux is zero.
        assert!(error(&fine) < 2e-4, "mode {number}: {}", error(&fine));
        let ratio = error(&coarse) / error(&fine);
        assert!((3.5..4.5).contains(&ratio), "mode {number}: {ratio}");
    }
}

fn bisect(f: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if f(low) * f(middle) <= 0.0 {
            high = middle;
        } else {
            low = middle;
        }
    }
    0.5 * (low + high)
}
