//! What a measure makes of a signal over a run: of the continuous solution, whatever rows the results have.

use crate::models::{Solved, solve, solve_with};
use hyde_experiment::Options;
use std::f64::consts::{FRAC_1_SQRT_2, PI};

/// The value of a measure.
fn measured(solved: &Solved, name: &str) -> f64 {
    let mut measures = solved.run.measures.iter();
    let found = measures.find(|measure| measure.name == name);
    found.unwrap_or_else(|| panic!("no measure `{name}`")).value
}

fn close(solved: &Solved, name: &str, expected: f64, tolerance: f64) {
    let found = measured(solved, name);
    assert!(
        (found - expected).abs() <= tolerance,
        "{name}: {found}, not {expected}"
    );
}

/// The last root of a falling or rising function below `high`, by halving.
fn root(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if (f(middle) > 0.0) == (f(low) > 0.0) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

#[test]
fn a_lag_settles_as_its_exponential_does() {
    const T: f64 = 0.02;
    let solved = solve("numbers_of_a_run", "step");
    // x = 1 - exp(-t/T); rtol 2e-9, whose errors add up over some hundred steps, over its slope of 1 a second where it settles.
    close(&solved, "settled", T * 50.0_f64.ln(), 1e-7);
    close(&solved, "half", T * 2.0_f64.ln(), 1e-8);
    close(&solved, "early", 1.0 - (-0.03 / T).exp(), 1e-7);
    close(&solved, "short", T * (1.0 - (-0.2 / T).exp()), 1e-9);
    close(&solved, "over", 0.0, 1e-12); // It rises to the end.
    // A condition changes somewhere in a step.
    let behind = T * ((-0.03 / T).exp() - (-0.2 / T).exp()) / 0.17;
    close(&solved, "behind", behind, 1e-8);
    let half = T * 2.0_f64.ln();
    let near = (0.5 * T * (0.25 - (-0.4 / T).exp()) / (0.2 - half)).sqrt();
    close(&solved, "near", near, 1e-8);
    close(&solved, "gap", (-0.03 / T).exp(), 1e-7);
    close(&solved, "late", T * (0.5 - (-0.2 / T).exp()), 1e-9);
    assert!(measured(&solved, "beyond").is_nan());
    assert!(measured(&solved, "nothing").is_nan());
    assert!(measured(&solved, "never").is_nan());
    let never = solved.run.measures.iter().find(|m| m.name == "never");
    let why = never.unwrap().missing.as_ref().unwrap().text();
    assert_eq!(why, "`first(x, x > 2)` has no value in this run");
    let holds = |name| measured(&solved, name);
    assert!(holds("it settles") > 0.5);
    assert!(holds("it does not settle so closely") < 0.5);
}

#[test]
fn what_is_struck_tells_its_frequency_and_loses_its_energy() {
    // The spectrum of a free vibration is highest at the resonance, wr^2 = k/m - d^2/(2 m^2).
    let resonance = (8e4_f64 / 2.0 - 16.0_f64.powi(2) / 8.0).sqrt() / std::f64::consts::TAU;
    let solved = solve("numbers_of_a_run", "ringing");
    let rings = measured(&solved, "rings");
    // exp(-8) of it is cut off: 3e-4 of the width of the peak, d/m/(2 pi) = 1.3 Hz, and the lines are 0.1 Hz apart.
    assert!((rings - resonance).abs() < 2e-3, "{rings} {resonance}");
    // All of m v^2/2 = 10 mJ but the energy that is left at 2 s, exp(-2*4*2) of it times what the phase makes of that.
    close(&solved, "lost", 0.01 * (1.0 - (-16.0_f64).exp()), 5e-9);
}

/// y = sin(wt) over 1.3 s, and x = exp(-dt) sin(wt).
fn check_swing(solved: &Solved, all: bool) {
    const W: f64 = 44.0;
    const D: f64 = 3.0;
    const END: f64 = 1.3;
    // Nine periods at rtol 1e-9 err by 1e-7 or less.
    close(solved, "most", 1.0, 1e-7);
    let square = 0.5 - (2.0 * W * END).sin() / (4.0 * W * END);
    close(solved, "effective", square.sqrt(), 1e-7);
    // The integral of exp(-dt) sin(wt).
    let grown = |t: f64| -(-D * t).exp() * (D * (W * t).sin() + W * (W * t).cos());
    close(
        solved,
        "area",
        (grown(END) - grown(0.0)) / (D * D + W * W),
        1e-8,
    );
    // |x| falls below 0.1 for the last time behind its last peak above.
    let x = |t: f64| (-D * t).exp() * (W * t).sin();
    let mut peaks = (0..20).map(|k| ((W / D).atan() + PI * f64::from(k)) / W);
    let last = peaks.rfind(|t| x(*t).abs() > 0.1).unwrap();
    let settled = root(last, last + 0.5 * PI / W, |t| x(t).abs() - 0.1);
    close(solved, "settled", settled, 1e-7);
    if !all {
        return;
    }
    close(solved, "least", -1.0, 1e-7);
    close(solved, "nearest", 0.0, 1e-9);
    close(solved, "average", square, 1e-7);
    // Of each half period 2/w, and of the last part what is left: 18 half periods end at 1.285 s.
    let halves = (W * END / PI).floor();
    let rest = (1.0 - (W * END - PI * halves).cos()) / W;
    close(solved, "rectified", (2.0 * halves / W + rest) / END, 1e-5);
    close(solved, "rise", 0.5_f64.asin() / W, 1e-9);
    let mut positive = (0..10).map(|k| ((W / D).atan() + 2.0 * PI * f64::from(k)) / W);
    let last = positive.rfind(|t| x(*t) > 0.1).unwrap();
    close(
        solved,
        "fallen",
        root(last, last + 0.5 * PI / W, |t| x(t) - 0.1),
        1e-7,
    );
    close(solved, "ended", (W * END).cos(), 1e-6);
    // Nine periods: a hundredth of 1/1.3 s.
    close(solved, "rings", W / (2.0 * PI), 0.02);
}

#[test]
fn measures_of_a_swing_are_exact_whatever_rows_it_has() {
    for every_s in [None, Some(0.01), Some(1e-3)] {
        let options = Options {
            every_s,
            ..Options::default()
        };
        check_swing(
            &solve_with("measures_of_a_solution", "swing", &options),
            true,
        );
        let solved = solve_with("measures_of_a_solution", "swing_esdirk", &options);
        check_swing(&solved, false);
    }
}

#[test]
fn a_rate_is_measured_as_exactly_as_a_state() {
    for experiment in ["lead", "lead_esdirk"] {
        let solved = solve("measures_of_a_solution", experiment);
        // A step of some microseconds of order 1 has a rate that is 2e-4 off in between.
        close(&solved, "off", 0.0, 5e-7);
        // T times the way of x.
        let x = |t: f64| 1.0 - (-t / 0.02).exp();
        close(&solved, "area", 0.02 * (x(0.1) + 2.0 * x(0.0686)), 1e-9);
    }
}

#[test]
fn a_function_of_time_alone_is_measured_between_two_rows() {
    let solved = solve("measures_of_a_solution", "given");
    close(&solved, "most", 1.0, 1e-6);
    close(&solved, "effective", FRAC_1_SQRT_2, 1e-5);
    close(&solved, "rectified", 2.0 / PI, 1e-4);
}

#[test]
fn stairs_and_jumps_count_from_both_sides() {
    let solved = solve("measures_of_a_solution", "stairs");
    // n is 1 from 0 to 1 ms, 500 in the last millisecond, 501 at the end.
    close(&solved, "counted", 1e-3 * 500.0 * 501.0 / 2.0, 1e-9);
    close(&solved, "highest", 501.0, 0.0);
    close(&solved, "furthest", 0.25, 1e-9);
    close(&solved, "fastest", 3.0, 1e-9);
    close(&solved, "slowest", -3.0, 1e-9);
    close(&solved, "effective", 5.0_f64.sqrt(), 1e-9);
    close(&solved, "turned", 0.25, 1e-12);
    close(&solved, "there", 0.25, 1e-9);
}
