//! A drive without losses keeps its energy, and swings at its frequency.

use crate::models::{Solved, close, solve_with};
use hyde_experiment::Options;
use std::f64::consts::TAU;

const J1: f64 = 2e-3;
const J2: f64 = 6e-3;
const C: f64 = 1500.0;
const W0: f64 = 10.0;

/// Frequency of the swing in rad/s.
fn omega() -> f64 {
    (C * (1.0 / J1 + 1.0 / J2)).sqrt()
}

/// A hundred periods with a relative tolerance.
fn swing(rtol: f64) -> Solved {
    let options = Options {
        rtol: Some(rtol),
        ..Options::default()
    };
    let swing = solve_with("two_mass", "swing", &options);
    let end = swing.time().last().unwrap();
    assert!(end * omega() >= 100.0 * TAU, "{end} s are no 100 periods");
    swing
}

/// The largest change of the stored energy against that of the start.
fn drift(swing: &Solved) -> f64 {
    let column = |name: &str| swing.column(name);
    let (w1, w2, twist) = (column("one.w"), column("two.w"), column("spring.twist"));
    let energy = |row: usize| {
        let square = |x: f64| x * x;
        0.5 * (J1 * square(w1[row]) + J2 * square(w2[row]) + C * square(twist[row]))
    };
    close(energy(0), 0.5 * J1 * W0 * W0, 1e-15);
    let changes = (0..w1.len()).map(|row| (energy(row) / energy(0) - 1.0).abs());
    changes.fold(0.0, f64::max)
}

#[test]
fn energy_is_kept_to_the_tolerance() {
    // The promise: 1e-6 of the stored energy over 100 periods at rtol 1e-8.
    let drift = drift(&swing(1e-8));
    assert!(drift <= 1e-6, "{drift:e}");
}

#[test]
fn momentum_is_kept_whatever_the_tolerance() {
    let swing = swing(1e-6);
    let (w1, w2) = (swing.column("one.w"), swing.column("two.w"));
    for (w1, w2) in w1.iter().zip(w2.iter()) {
        // Every linear multistep method keeps a linear invariant, but for what Newton's iteration leaves.
        close(J1 * w1 + J2 * w2, J1 * W0, 1e-8 * J1 * W0);
    }
}

#[test]
fn the_swing_is_a_sine() {
    let swing = swing(1e-10);
    let twist = swing.column("spring.twist");
    let largest = W0 / omega();
    for (twist, t) in twist.iter().zip(swing.time()) {
        // The error of the phase adds up over a hundred periods.
        close(*twist, -largest * (omega() * t).sin(), 1e-5 * largest);
    }
}
