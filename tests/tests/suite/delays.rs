//! `delay(u, T)` against closed forms: in time, in events, in the linearised model.
#![allow(clippy::float_cmp, reason = "jumps and what stands still are exact")]

use crate::models::{Solved, close, model, solve};
use hyde_compiler::Backend;
use hyde_experiment::{Options, frequency_response, linearize, modes};
use hyde_signal::Series;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Every row of a column against a function of the time; rows within a nanosecond of an event are left out.
fn follows(solved: &Solved, name: &str, tolerance: f64, f: impl Fn(f64) -> f64) {
    let mut compared = 0;
    for (&t, &value) in solved.time().iter().zip(solved.column(name).iter()) {
        let (early, late) = (f(t - 1e-9), f(t + 1e-9));
        if (early - late).abs() < 1e-6 {
            close(value, f(t), tolerance);
            compared += 1;
        }
    }
    assert!(compared > 15, "{name}: {compared} rows were compared");
}

/// The values of a column on both sides of an instant.
fn around(solved: &Solved, name: &str, t: f64) -> (f64, f64) {
    let (before, after) = solved.rows_at(t);
    (solved.column(name)[before], solved.column(name)[after])
}

#[test]
fn a_line_and_a_sine_come_later_as_they_are() {
    let run = solve("delays", "signals");
    // A polynomial of degree 6 is exact for a line.
    follows(&run, "line", 1e-14, |t| (t - 0.13).max(0.0));
    // The polynomials meet the sine to a hundredth of rtol 1e-8.
    follows(&run, "sine", 1e-9, |t| {
        (TAU * 3.0 * (t - 0.13).max(0.0)).sin()
    });
}

#[test]
fn a_jump_arrives_as_a_jump_through_any_number_of_delays() {
    let run = solve("delays", "signals");
    let step = |t: f64, at: f64| f64::from(u8::from(t >= at));
    follows(&run, "late", 0.0, |t| step(t, 0.5));
    follows(&run, "later", 0.0, |t| step(t, 0.6));
    follows(&run, "half", 0.0, |t| 0.5 * step(t, 0.55) + step(t, 0.85));
    assert_eq!(around(&run, "late", 0.5), (0.0, 1.0));
    assert_eq!(around(&run, "later", 0.6), (0.0, 1.0));
    assert_eq!(around(&run, "half", 0.55), (0.0, 0.5));
    assert_eq!(around(&run, "half", 0.85), (0.5, 1.5));
    // It is the one event of the log: what arrives is no event of its own.
    assert_eq!(run.events(), [(0.3, "if")]);
}

/// The solution of x' = -x(t - 1) from 1 by the method of steps: a polynomial of one degree more in every interval.
fn by_steps(t: f64) -> f64 {
    let (mut sum, mut factorial) = (1.0, 1.0);
    for k in 1..=20 {
        let since = t - f64::from(k - 1);
        if since <= 0.0 {
            break;
        }
        factorial *= -f64::from(k);
        sum += since.powi(k) / factorial;
    }
    sum
}

#[test]
fn a_delay_equation_has_the_solution_of_the_method_of_steps() {
    let run = solve("delays", "scalar");
    // rtol 1e-8 over eight intervals.
    follows(&run, "x", 1e-7, by_steps);
    assert_eq!(run.run.results.statistics.restarts, 1);
}

#[test]
fn the_one_step_method_meets_it_as_well() {
    // Its steps are long, and their histories are kept in parts.
    let run = solve("delays", "one_step");
    follows(&run, "x", 1e-7, by_steps);
}

#[test]
fn without_a_delay_the_value_is_the_one_of_now() {
    let example = model("delays", Some("scalar")).set("T", 0.0);
    let (compiled, run) = example.run_with(&Options::default()).unwrap();
    assert!(compiled.program.delays.is_empty());
    let solved = Solved { compiled, run };
    // rtol 1e-8 of a value that falls to 3e-4.
    follows(&solved, "x", 1e-7, |t| (-t).exp());
}

#[test]
fn a_saw_arrives_with_its_teeth() {
    let run = solve("delays", "saw");
    let saw = |t: f64| if t < 0.0 { 0.25 } else { (t + 0.25).fract() };
    // A state of constant slope.
    follows(&run, "back", 1e-9, |t| saw(t - 0.4));
    for tooth in 0..3 {
        let (before, after) = around(&run, "back", 1.15 + f64::from(tooth));
        close(before, 1.0, 1e-9);
        close(after, 0.0, 1e-9);
    }
    // Each tooth has the area 1/2; the first 0.4 s stand at 0.25, the first tooth begins there.
    let whole = |t: f64| 0.5 * t.floor() + 0.5 * t.fract() * t.fract();
    let area = |t: f64| 0.25 * t.min(0.4) + whole((t - 0.4).max(0.0) + 0.25) - 0.5 * 0.0625;
    // rtol 1e-8 at every step of eight starts.
    follows(&run, "integral", 1e-6, area);
}

#[test]
fn a_relay_behind_a_delay_swings() {
    let run = solve("delays", "relay");
    let expected = ["up", "down", "up", "down", "up"];
    let events = run.events();
    assert_eq!(events.len(), expected.len());
    for (k, ((t, mode), known)) in (0_u32..).zip(events.iter().zip(expected)) {
        // Piecewise straight lines.
        close(*t, 1.5 + f64::from(k), 1e-9);
        assert_eq!(*mode, known);
    }
    let triangle = |t: f64| {
        if t < 1.5 {
            1.0 - t
        } else {
            0.5 - ((t - 1.5).rem_euclid(2.0) - 1.0).abs()
        }
    };
    follows(&run, "x", 1e-8, triangle);
}

#[test]
fn an_algebraic_loop_closes_through_the_past() {
    let run = solve("delays", "echo");
    let echo = |t: f64| {
        let heard = ((t - 0.05) / 0.1 + 1e-12).floor();
        if heard < 0.0 {
            0.0
        } else {
            2.0 - 0.5_f64.powf(heard)
        }
    };
    // Sums of powers of two.
    follows(&run, "y", 0.0, echo);
    // What was at rest before the start stays so: y = 1 + y/2.
    follows(&run, "rest", 1e-12, |_| 2.0);
}

#[test]
fn the_past_of_a_steady_start_is_the_start() {
    let run = solve("delays", "steady");
    follows(&run, "x", 1e-9, |_| 2.0);
}

#[test]
fn a_tick_reads_what_was_before_a_jump_arrives() {
    let run = solve("delays", "sampled");
    assert_eq!(around(&run, "late", 0.3), (0.0, 1.0));
    assert_eq!(around(&run, "counter.seen", 0.3).1, 0.0);
    assert_eq!(around(&run, "counter.seen", 0.31).1, 1.0);
}

#[test]
fn a_staircase_comes_later_as_a_staircase() {
    let run = solve("delays", "sampled");
    let stairs = |t: f64| {
        let steps = (t - 0.025) / 0.01;
        if steps < -1e-9 {
            0.0
        } else {
            (steps + 1e-9).floor() + 1.0
        }
    };
    follows(&run, "heldlate", 0.0, stairs);
    // The integral of a staircase, of steps k = 1.. that begin at 25 ms: rtol 1e-8.
    let integral = |t: f64| {
        let steps = ((t - 0.025) / 0.01).max(0.0);
        let whole = steps.floor();
        0.01 * (0.5 * whole * (whole + 1.0) + (steps - whole) * (whole + 1.0))
    };
    follows(&run, "integral", 1e-7, integral);
}

#[test]
fn what_is_held_bounds_no_step() {
    let run = solve("delays", "brief");
    // Steps no longer than the delay would be a quarter of a million.
    let steps = run.run.results.statistics.steps;
    assert!(steps < 2_000, "{steps} steps");
    // Steps k = 1.. begin 2 us behind the ticks, the first of which is at 0.
    let integral = |t: f64| {
        let steps = ((t - 2e-6) / 0.01).max(0.0);
        let whole = steps.floor();
        0.01 * (0.5 * whole * (whole + 1.0) + (steps - whole) * (whole + 1.0))
    };
    follows(&run, "integral", 1e-7, integral);
}

#[test]
fn arrays_are_delayed_element_by_element() {
    let run = solve("delays", "arrays");
    for (name, factor, by) in [
        ("b[1]", 1.0, 0.1),
        ("b[3]", 3.0, 0.1),
        ("c[2]", 1.0, 0.2),
        ("c[3]", 2.0, 0.2),
        ("second", 2.0, 0.3),
    ] {
        // Lines, and rounding of the polynomials.
        follows(&run, name, 1e-14, |t| factor * (t - by).max(0.0));
    }
    let delays = &run.compiled.program.delays;
    assert_eq!(delays.len(), 3 + 3 + 1);
}

#[test]
fn a_condition_is_delayed_like_a_number() {
    let run = solve("delays", "truth");
    let on = |t: f64| f64::from(u8::from(t > 0.45 && t < 0.65));
    follows(&run, "late", 0.0, on);
    follows(&run, "y", 0.0, |t| 1.0 + on(t));
    assert_eq!(around(&run, "n", 0.45), (0.0, 1.0));
    assert_eq!(run.column("n").last(), Some(&1.0));
}

#[test]
fn delays_run_the_same_on_both_backends() {
    for experiment in ["signals", "scalar", "saw", "relay", "sampled", "arrays"] {
        let example = model("delays", Some(experiment));
        let runs = [Backend::Native, Backend::Interpreter].map(|backend| {
            let program = example.compile(backend).unwrap().program;
            hyde_experiment::run(&program, &BTreeMap::new(), &Options::default()).unwrap()
        });
        let bits = |number: usize| {
            let columns = runs[number].results.columns.iter().flat_map(Series::iter);
            columns.map(|value| value.to_bits()).collect::<Vec<_>>()
        };
        assert_eq!(bits(0), bits(1), "{experiment}");
    }
}

#[test]
fn a_frequency_response_has_the_delay_exactly() {
    use nalgebra::Complex;
    let example = model("delays", Some("closed")).free_inputs();
    let program = example.compile(Backend::Native).unwrap().program;
    let p = hyde_experiment::parameters(&program, &BTreeMap::new(), &[]).unwrap();
    let linear = linearize(&program, &BTreeMap::new(), &p, &["r".to_owned()], &[]).unwrap();
    let outputs: Vec<usize> = ["x", "e"]
        .iter()
        .map(|name| program.output(name).unwrap())
        .collect();
    let frequencies = [0.5, 3.0, 17.0, 120.0, 900.0];
    let found = frequency_response(&linear, 0, &outputs, &frequencies).unwrap();
    for (k, f) in frequencies.into_iter().enumerate() {
        let s = Complex::new(0.0, TAU * f);
        let (back, echo) = ((-s * 0.02).exp(), (-s * 0.005).exp());
        let forward = Complex::new(2.0, 0.0) / (s * 0.05 + 1.0) / (-echo * 0.3 + 1.0);
        let x = forward / (forward * back + 1.0);
        // Rounding of a few complex operations.
        assert!(
            (found[0][k] - x).norm() < 1e-13 * (1.0 + x.norm()),
            "{f} Hz"
        );
        let e = -x * back + 1.0;
        assert!(
            (found[1][k] - e).norm() < 1e-13 * (1.0 + e.norm()),
            "{f} Hz"
        );
    }
}

#[test]
fn modes_of_a_delay_equation_are_roots_of_its_characteristic_equation() {
    let example = model("delays", Some("scalar"));
    let program = example.compile(Backend::Native).unwrap().program;
    let p = hyde_experiment::parameters(&program, &BTreeMap::new(), &[]).unwrap();
    let linear = linearize(&program, &BTreeMap::new(), &p, &[], &[]).unwrap();
    let found = modes(&linear);
    // s exp(s) = -1: the branches of Lambert's W at -1 (Corless et al., Adv. Comput. Math. 5 (1996) 329).
    let known = [
        (-0.318_131_505_204_764_1, 1.337_235_701_430_689_4),
        (-2.062_277_729_598_284, 7.588_631_178_472_513),
    ];
    // One in every strip of height 2 pi, without a gap: the collocation leads to six.
    assert!(found.len() >= 6, "{} roots", found.len());
    for (k, mode) in (0_u32..).zip(&found) {
        let im = mode.frequency_hz * TAU * (1.0 - mode.damping * mode.damping).sqrt();
        let strip = TAU * f64::from(k);
        assert!(
            im > strip - 1.0 && im < strip + TAU - 1.0,
            "{im} is root {k}"
        );
    }
    for (mode, (re, im)) in found.iter().zip(known) {
        let size = f64::hypot(re, im);
        // Newton's method ends at 1e-12.
        close(mode.frequency_hz, size / TAU, 1e-11);
        close(mode.damping, -re / size, 1e-11);
    }
    // The others fulfil it too: |s| exp(Re s) = 1.
    for mode in &found {
        let size = mode.frequency_hz * TAU;
        close(size * (-mode.damping * size).exp(), 1.0, 1e-9);
    }
}

#[test]
fn no_mode_is_missing_between_the_others() {
    use nalgebra::Complex;
    let example = model("delays", Some("closed")).free_inputs();
    let program = example.compile(Backend::Native).unwrap().program;
    let p = hyde_experiment::parameters(&program, &BTreeMap::new(), &[]).unwrap();
    let linear = linearize(&program, &BTreeMap::new(), &p, &[], &[]).unwrap();
    let equation = |s: Complex<f64>| {
        let (back, echo) = ((-s * 0.02).exp(), (-s * 0.005).exp());
        (s * 0.05 + 1.0) * (-echo * 0.3 + 1.0) + back * 2.0
    };
    let (left, right, top) = (-1500.0, 100.0, TAU * 900.0);
    let inside = |s: &Complex<f64>| s.re > left && s.re < right && s.im < top;
    let found: Vec<Complex<f64>> = modes(&linear)
        .iter()
        .map(|mode| mode.eigenvalue)
        .filter(inside)
        .collect();
    for s in &found {
        // A root to 1e-12 of |s| = 6e3, times the slope of the equation.
        assert!(equation(*s).norm() < 1e-7, "{s}");
    }
    // As many as the equation turns round zero on the way round (the argument principle).
    let corners = [
        (left, 1.0),
        (right, 1.0),
        (right, top),
        (left, top),
        (left, 1.0),
    ];
    let corners = corners.map(|(re, im)| Complex::new(re, im));
    let mut turns = 0.0;
    for side in corners.windows(2) {
        let at = |k: u32| equation(side[0] + (side[1] - side[0]) * (f64::from(k) / 1e5));
        turns += (0..100_000).map(|k| (at(k + 1) / at(k)).arg()).sum::<f64>();
    }
    close(turns / TAU, found.len() as f64, 1e-6);
    assert_eq!(found.len(), 18);
}
