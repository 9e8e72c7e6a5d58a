//! The bouncing ball: times and heights are geometric series.

use crate::models::{close, model, solve};
use hyde_experiment::Options;

const G: f64 = 9.81;
const E: f64 = 0.8;
const H0: f64 = 1.0;

/// Time of the bounce k = 0, 1, … in s.
fn bounce_s(k: i32) -> f64 {
    let fall = (2.0 * H0 / G).sqrt();
    // One fall, then flights of 2*fall*(e + e^2 + … + e^k).
    fall * (1.0 + 2.0 * E * (1.0 - E.powi(k)) / (1.0 - E))
}

#[test]
fn bounces_come_when_the_series_says() {
    let ball = solve("bouncing_ball", "drop");
    let events = ball.events();
    assert_eq!(events.len(), 4, "{events:?}");
    let (height, speed) = (ball.column("h"), ball.column("v"));
    for (k, &(t, kind)) in (0..).zip(&events) {
        assert_eq!(kind, "when");
        // rtol 1e-9 over some hundred steps.
        close(t, bounce_s(k), 1e-7);
        let (before, after) = ball.rows_at(t);
        // Both rows stand at one instant; only the speed jumps, and by exactly e.
        assert_eq!(height[before].to_bits(), height[after].to_bits());
        close(height[after], 0.0, 1e-12);
        close(speed[after], -E * speed[before], 1e-15);
        // The height that follows is that of the series.
        let top = speed[after].powi(2) / (2.0 * G);
        close(top, H0 * E.powi(2 * (k + 1)), 1e-7);
    }
}

#[test]
fn between_bounces_it_flies_a_parabola() {
    let ball = solve("bouncing_ball", "drop");
    let events = ball.events();
    for (row, &t) in ball.time().iter().enumerate() {
        let flight = events.iter().filter(|(event, _)| *event < t).count();
        let expected = match i32::try_from(flight).unwrap() {
            0 => H0 - 0.5 * G * t * t,
            k => {
                let since = t - bounce_s(k - 1);
                let up = (2.0 * G * H0).sqrt() * E.powi(k);
                up * since - 0.5 * G * since * since
            }
        };
        // rtol 1e-9; the error of a bounce's time is carried along.
        close(ball.column("h")[row], expected, 1e-6);
    }
}

#[test]
fn a_ball_without_rest_ends_with_a_message() {
    // The bounces add up to 9 falls, 4.064 s.
    let options = Options {
        stop_s: Some(6.0),
        ..Options::default()
    };
    let outcome = model("bouncing_ball", Some("drop")).run_with(&options);
    let told = outcome.err().unwrap();
    assert!(told.contains("Zeno"), "{told}");
    assert!(told.contains("bouncing_ball.hyde:11"), "{told}");
    assert!(told.contains("at 4.06"), "{told}");
}

#[test]
fn a_ball_with_a_mode_of_rest_comes_to_lie() {
    let ball = solve("bouncing_ball", "settle");
    let events = ball.events();
    let (last, kind) = *events.last().unwrap();
    assert_eq!(kind, "lying");
    // The last impact is the first one slower than 1 cm/s: v0*e^k < 0.01. It rises from the one before, for at h = 0 the
    // sign of the speed decides (M2).
    let impact = (2.0 * G * H0).sqrt();
    let k = (0..).find(|&k| impact * E.powi(k) < 0.01).unwrap();
    assert_eq!(i32::try_from(events.len()).unwrap(), k + 1);
    close(last, bounce_s(k), 1e-6);
    for (row, &t) in ball.time().iter().enumerate() {
        if t > last {
            assert_eq!(ball.column("v")[row].to_bits(), 0.0_f64.to_bits());
            // Exactly what carries the weight.
            assert_eq!(ball.column("push")[row].to_bits(), G.to_bits());
        }
    }
}
