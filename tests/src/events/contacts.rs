//! Contacts that close together, at no gap, at no speed, or exactly at the limit.

use super::solved::{Solved, close, same, solve};
use std::f64::consts::PI;

/// The last of five balls that touch flies on, all impacts at one instant.
pub(super) fn cradle() -> Result<(), String> {
    let balls = solve("events/contacts", "cradle")?;
    let pairs = [
        "x[2] <= x[1] and v[1] > v[2]",
        "x[3] <= x[2] and v[2] > v[3]",
        "x[4] <= x[3] and v[3] > v[4]",
        "x[5] <= x[4] and v[4] > v[5]",
    ];
    balls.happened(&pairs.map(|pair| (1.0, pair)), 1e-12)?;
    same("instants", &balls.run.results.statistics.events, &1)?;
    for k in 1..=5 {
        // Speeds are exchanged, not computed.
        let speed = f64::from(u8::from(k == 5));
        same("speed", &balls.last(&format!("v[{k}]"))?, &speed)?;
    }
    close("place", balls.last("x[5]")?, 2.0, 1e-12)
}

/// Two springs, one by a mode and one by a relation, close and open at the same instants.
pub(super) fn springs() -> Result<(), String> {
    let run = solve("events/contacts", "springs")?;
    let (g, stiffness) = (9.81, 4000.0_f64);
    let fall = (0.4_f64 / g).sqrt();
    // h = -g/k + A*cos(w*t + phi) from h = 0 to h = 0, with tan(phi) = v*w/g.
    let w = stiffness.sqrt();
    let contact = 2.0 * (PI - (g * fall * w / g).atan()) / w;
    let mut t = fall;
    let mut expected = Vec::new();
    while t < 2.0 {
        expected.extend([t, t]);
        if t + contact < 2.0 {
            expected.extend([t + contact, t + contact]);
        }
        t += contact + 2.0 * fall;
    }
    let events = run.events();
    same("number of events", &events.len(), &expected.len())?;
    for (event, t) in events.iter().zip(expected) {
        // rtol 1e-9 over nine flights.
        close(&event.cause, event.t, t, 1e-7)?;
    }
    let instants = u64::try_from(events.len() / 2).map_err(|error| error.to_string())?;
    same("instants", &run.run.results.statistics.events, &instants)
}

/// Backlash of no width is the spring alone, at 10 rad/s.
pub(super) fn no_gap() -> Result<(), String> {
    let run = solve("events/contacts", "gap")?;
    for (t, x) in run.run.results.time.iter().zip(run.column("x")?.iter()) {
        // rtol 1e-9 over three periods, the amplitude is 1 cm.
        close("x", *x, 0.01 * (10.0 * t).cos(), 1e-9)?;
    }
    // Both relations turn at each passage: odd quarters of the period.
    same("events", &run.events().len(), &12)?;
    for (k, pair) in (0..).zip(run.events().chunks(2)) {
        let passage = (f64::from(k) + 0.5) * PI / 10.0;
        for event in pair {
            close(&event.cause, event.t, passage, 1e-8)?;
        }
    }
    Ok(())
}

/// A ball on a shaken table: it leaves where the table falls faster than it does, period after period.
pub(super) fn table() -> Result<(), String> {
    let run = solve("events/contacts", "table")?;
    // 20 sin(20t) = 10; the flight ends where the path has come back, found by bisection.
    let leave = PI / 6.0 / 20.0;
    let phase = PI / 6.0;
    let height = |t: f64| {
        let (s, w) = (t - leave, 20.0);
        -5.0 * s * s + 20.0 / (w * w) * (phase.sin() - (w * t).sin()) + 20.0 / w * phase.cos() * s
    };
    let (mut low, mut high) = (0.15, 0.33);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if height(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let period = 2.0 * PI / 20.0;
    let rounds = (0..96).map(f64::from);
    let expected: Vec<(f64, &str)> = rounds
        .flat_map(|k| {
            [
                (leave + k * period, "push < 0"),
                (low + k * period, "h < 0"),
            ]
        })
        .filter(|(t, _)| *t < 29.85)
        .collect();
    // Each flight begins anew from rest, so that errors of rtol 1e-6 do not add up.
    run.happened(&expected, 1e-5)?;
    // It lands where it was located: rounding of 95 instants at 2 m/s.
    close("height", run.last("h")?, 0.0, 1e-12)
}

/// A guide holds what is exactly its limit, and lets go of more.
pub(super) fn limit() -> Result<(), String> {
    let run = solve("events/contacts", "limit")?;
    run.happened(
        &[
            (1.0, "time < 1"),
            (1.0, "guide.a.f - guide.drag > guide.Fs"),
        ],
        0.0,
    )?;
    let (before, _) = run.around("saddle.s", 1.0)?;
    same("place until then", &before, &0.0)?;
    // 0.26 N on 310 kg for 2 s.
    close("speed", run.last("saddle.v")?, 0.52 / 310.0, 1e-12)
}

/// A clutch that closes at no relative speed does not slip, and carries on what is driven.
pub(super) fn at_speed() -> Result<(), String> {
    let run = solve("events/contacts", "at_speed")?;
    run.happened(
        &[(1.0, "time < 1"), (1.0, "clutch.fn > 0"), (2.0, "time < 2")],
        0.0,
    )?;
    same("slip", &slips(&run)?, &0)?;
    // 20 N.m on 4 kg.m2 for 1 s.
    close("one", run.last("one.w")?, 15.0, 1e-8)?;
    close("two", run.last("two.w")?, 15.0, 1e-8)?;
    // What the clutch carries.
    close("torque", run.last("clutch.tau")?.abs(), 15.0, 1e-8)
}

/// Rows in which the clutch slips after it has closed.
fn slips(run: &Solved) -> Result<usize, String> {
    let slip = run.column("clutch.w_rel")?;
    let rows = run.run.results.time.iter().zip(slip.iter());
    Ok(rows.filter(|(t, slip)| **t > 1.0 && **slip != 0.0).count())
}
