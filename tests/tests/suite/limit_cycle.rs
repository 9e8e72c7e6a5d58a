//! A loop with play and its limit cycle, beside what the describing function tells of it.
//!
//! The first harmonic of a table that a motor of amplitude A drags through a play of 2b, and that stands while the motor
//! crosses it, is N(A)*A (Gelb and Vander Velde, *Multiple-Input Describing Functions*, 1968, table B.1). The loop
//! oscillates where G(jw)*N(A) = -1. With G = K/(jw*(1 + jw)^2) the phase gives w by the angle of N, and the gain A.

use crate::models::model;
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Gain and angle of N at A = `a`*b.
fn harmonic(a: f64) -> (f64, f64) {
    let u = 1.0 - 2.0 / a;
    let real = (FRAC_PI_2 + u.asin() + u * (1.0 - u * u).sqrt()) / PI;
    let imaginary = -4.0 / (PI * a) * (1.0 - 1.0 / a);
    (real.hypot(imaginary), imaginary.atan2(real))
}

/// Where the phase of G*N is that of -1, and the gain there.
fn loop_at(a: f64, k: f64) -> (f64, f64) {
    let (gain, angle) = harmonic(a);
    let w = (0.5 * (FRAC_PI_2 + angle)).tan();
    (w, k / (w * (1.0 + w * w)) * gain)
}

/// Amplitude over b and angular frequency of the cycle that is stable: beyond it the gain falls below 1.
fn predicted(k: f64) -> (f64, f64) {
    let (mut low, mut high) = (3.0, 100.0);
    assert!(loop_at(low, k).1 > 1.0 && loop_at(high, k).1 < 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if loop_at(middle, k).1 > 1.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low, loop_at(low, k).0)
}

#[test]
fn a_play_in_the_loop_oscillates_as_its_describing_function_tells() {
    let (compiled, run) = model("limit_cycle", Some("cycle")).run().unwrap();
    let column = |name: &str| {
        run.results
            .column(compiled.program.output(name).unwrap())
            .unwrap()
    };
    let (time, motor) = (&run.results.time, column("motor"));
    // What is left of the start after 100 s is below the tolerance.
    let first = time.partition_point(|t| *t < 100.0);
    let crossings: Vec<f64> = (first + 1..time.len())
        .filter(|&i| motor[i - 1] < 0.0 && motor[i] >= 0.0)
        .map(|i| time[i] - motor[i] * (time[i] - time[i - 1]) / (motor[i] - motor[i - 1]))
        .collect();
    let (from, to) = (crossings[0], *crossings.last().unwrap());
    let w = TAU * (crossings.len() - 1) as f64 / (to - from);
    let amplitude = motor[first..]
        .iter()
        .fold(0.0, |most: f64, x| most.max(x.abs()))
        / 1e-3;
    let (a, w_predicted) = predicted(1.5);
    // The describing function leaves harmonics out. G lets through 4 % of the third, of which the corners of the play
    // have some 7 %: a few tenths of a per cent; 1 % is allowed.
    assert!(
        (amplitude / a - 1.0).abs() < 0.01,
        "{amplitude} mm, not {a}"
    );
    assert!(
        (w / w_predicted - 1.0).abs() < 0.01,
        "{w} rad/s, not {w_predicted}"
    );
}
