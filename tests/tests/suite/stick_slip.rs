//! Stick–slip of a mass pulled through a spring at constant speed, breakaway above sliding friction.
//!
//! With w = sqrt(k/m) and D = Fs - F a slide from rest takes 2/w*(pi - atan(w*D/(k*v0))) and the rest after it
//! 2*D/(k*v0), for ever (Leine, van Campen, de Kraker, van den Steen: Stick-slip vibrations induced by alternate friction
//! models, Nonlinear Dynamics 16 (1998) 41).

use crate::command::write;
use crate::models::{close, model, solve, solve_with};
use hyde_experiment::Options;
use std::fmt::Write;

const M: f64 = 1.0;
const K: f64 = 100.0;
const V0: f64 = 0.1;
const SLIDING: f64 = 1.0;
const BREAKAWAY: f64 = 2.0;

#[test]
fn slides_and_rests_last_as_long_as_published() {
    let pulled = solve("stick_slip", "creep");
    let events = pulled.events();
    let w = (K / M).sqrt();
    let drop = BREAKAWAY - SLIDING;
    let slide = 2.0 / w * (std::f64::consts::PI - (w * drop / (K * V0)).atan());
    let rest = 2.0 * drop / (K * V0);
    assert!(events.len() >= 15, "{events:?}");
    let mut expected = BREAKAWAY / (K * V0);
    for (number, &(t, mode)) in events.iter().enumerate() {
        assert_eq!(mode, if number % 2 == 0 { "slip" } else { "stuck" });
        // rtol 1e-9; the motion repeats, so that errors do not grow but add up.
        close(t, expected, 1e-6);
        expected += if number % 2 == 0 { slide } else { rest };
    }
}

#[test]
fn at_rest_the_velocity_is_exactly_zero() {
    let pulled = solve("stick_slip", "creep");
    let events = pulled.events();
    let (v, s) = (pulled.column("body.v"), pulled.column("body.s"));
    let force = pulled.column("floor.a.f");
    let mut rows = 0;
    let mut place = None;
    for (row, &t) in pulled.time().iter().enumerate() {
        let before = events.iter().rev().find(|(event, _)| *event <= t);
        let stuck = before.is_none_or(|&(event, mode)| mode == "stuck" && event < t);
        let ends = events
            .iter()
            .any(|&(event, _)| event.to_bits() == t.to_bits());
        if !stuck || ends {
            place = None;
            continue;
        }
        rows += 1;
        assert_eq!(v[row].to_bits(), 0.0_f64.to_bits(), "at {t} s");
        // It stays where it is to the last bit, and the floor takes what the spring gives.
        assert_eq!(
            s[row].to_bits(),
            place.get_or_insert(s[row]).to_bits(),
            "at {t} s"
        );
        close(force[row], K * (V0 * t - s[row]), 1e-12);
        assert!(force[row].abs() <= BREAKAWAY);
    }
    assert!(rows > 1000, "only {rows} rows at rest");
}

#[test]
fn below_breakaway_a_whole_drive_stands_still() {
    let axis = solve("stick", "off");
    for name in ["saddle.v", "motor.w", "pulley.w"] {
        let column = axis.column(name);
        let moved = column.iter().filter(|v| v.to_bits() != 0);
        assert_eq!(moved.count(), 0, "{name}");
    }
    assert!(axis.events().is_empty());
}

/// Rounding of large angles is a torque in a stiff bar, and for a while more than the drive's torque grows: nothing says so
/// but the torque a moment later. By the sign of a derivative alone it broke away without end.
#[test]
fn a_stiff_bar_breaks_away_once_however_far_it_has_turned() {
    for (turned, ramp) in [(20.0, 1.0), (100.0, 1.0), (200.0, 1.0), (150.0, 7.0)] {
        let options = Options {
            set: vec![("turned".to_owned(), turned), ("ramp".to_owned(), ramp)],
            ..Options::default()
        };
        let bar = solve_with("stiff_bar", "breakaway", &options);
        let events = bar.events();
        let [(t, "slip")] = events[..] else {
            panic!("{turned} rad, {ramp} N.m/s: {events:?}")
        };
        // Beside the ramp the bar swings with some 500 Hz, by a slope of at most that of the ramp: 0.3 ms.
        close(t, 0.3 / ramp, 1e-3);
    }
}

/// A record is linear between its rows, so a step that goes over one has a kink in it, and the interpolant of a force that holds
/// a body bends to crossings that there are not, or elsewhere. Breakaways are 10 ms to 1 ns before a row or behind it.
#[test]
fn what_a_record_pulls_loose_breaks_away_once_and_when_the_record_says() {
    let (mut text, mut expected) = ("t [s],F [N]\n".to_owned(), Vec::new());
    for pull in 0..200 {
        let part = (0.381_966 * f64::from(pull)).fract();
        let short = 10_f64.powf(-2.0 - 7.0 * part) * if pull % 2 == 0 { -1.0 } else { 1.0 };
        let rows = [0.9, 0.9, 0.9, 0.9, 1.0 - short, 1.5, 0.5, 0.9, 0.9, 0.9];
        let start = 0.2 * f64::from(pull);
        for (row, force) in (0..).zip(rows) {
            let _ = writeln!(text, "{:.2},{force:.12}", start + 0.02 * f64::from(row));
        }
        expected.push(match short < 0.0 {
            true => start + 0.06 + 0.02 * 0.1 / (0.1 - short),
            false => start + 0.08 + 0.02 * short / (0.5 + short),
        });
    }
    let folder = tempfile::tempdir().unwrap();
    let record = folder.path().join("kinks.csv");
    write(&record, &text);
    for experiment in ["kinks", "kinks_by_one_step"] {
        let pushed = model("pushed", Some(experiment)).record("file", &record);
        let (_, run) = pushed.run().unwrap();
        let times: Vec<f64> = run.results.events.iter().map(|event| event.t).collect();
        assert_eq!(times.len(), 2 * expected.len(), "{experiment}");
        for (pair, &t) in times.chunks(2).zip(&expected) {
            close(pair[0], t, 1e-6);
        }
    }
}

/// No state moves, so no error of a state shortens a step: rows within one are no mere interpolation of the forces.
#[test]
fn what_holds_a_body_is_the_drive_between_steps_too() {
    let run = solve_with("held_body", "pulled", &Options::default());
    for (t, holds) in run.time().iter().zip(run.column("guide.a.f").iter()) {
        let pulls = 3.0 * (2.0 * std::f64::consts::PI * 8.0 * t).sin();
        assert!(
            (holds - pulls).abs() < 1e-9,
            "{holds} N at {t} s, {pulls} N"
        );
    }
}
