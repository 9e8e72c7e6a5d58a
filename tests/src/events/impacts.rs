//! Impacts: a bouncing ball, two balls before a wall, and several at one instant.

use super::solved::{Solved, close, failure, same, solve, tells, time_told};
use hyde_experiment::Options;
use std::f64::consts::PI;

const G: f64 = 9.81;
const E: f64 = 0.8;
/// The time of the first fall in s, and the speed at its end in m/s.
const FALL: f64 = 0.451_523_640_985_730_8;
const IMPACT: f64 = 4.429_446_918_070_019;

/// Impacts follow as a geometric series; the first one slower than 1 cm/s is the last.
pub(super) fn ball_comes_to_rest() -> Result<(), String> {
    let ball = solve("bouncing_ball", "settle")?;
    let last = (0..).find(|&k| IMPACT * E.powi(k) < 0.01).unwrap_or(0);
    let bounce = |k| FALL * (1.0 + 2.0 * E * (1.0 - E.powi(k)) / (1.0 - E));
    let mut expected: Vec<(f64, &str)> = (0..last)
        .map(|k| (bounce(k), "h < 0 and abs(v) >= v_rest"))
        .collect();
    expected.push((bounce(last), "h < 0 and abs(v) < v_rest"));
    // rtol 1e-9 over 28 flights.
    ball.happened(&expected, 1e-6)?;
    // At rest to the last bit, and the floor carries the weight.
    same("speed at rest", &ball.last("v")?, &0.0)?;
    same("push at rest", &ball.last("push")?, &G)?;
    // Where it lay down: the instant is located to rounding.
    close("height at rest", ball.last("h")?, 0.0, 1e-12)
}

/// Without a mode of rest the bounces add up to nine falls, and the run ends there with what happens.
pub(super) fn ball_without_rest() -> Result<(), String> {
    let options = Options {
        stop_s: Some(6.0),
        ..Options::default()
    };
    let told = failure("bouncing_ball", "drop", &options)?;
    tells(&told, &["Zeno", "bouncing_ball.hyde:11"])?;
    // It is told when those that are to come add up to 1e-6 of the first one; rtol 1e-9 in each of 60 bounces.
    close("end", time_told(&told)?, 9.0 * FALL, 1e-4)
}

/// A heavy ball pushes a light one against a wall: with masses as 1 to 100 there are 31 impacts.
///
/// With lengths scaled by the roots of the masses the two move on a straight line that is reflected at the two sides of a
/// wedge. Unfolded it crosses rays at multiples of the wedge's angle (Galperin: Playing pool with pi, Regular and
/// Chaotic Dynamics 8 (2003) 375).
pub(super) fn two_balls_and_a_wall() -> Result<(), String> {
    let balls = solve("events/two_balls", "roll")?;
    // Scaled: the light one at 1, the heavy one from 20 with -10/s.
    let wedge = (1.0_f64 / 10.0).atan();
    let impacts = (1..)
        .map(|k| f64::from(k) * wedge)
        .take_while(|angle| *angle < PI);
    let expected: Vec<(f64, &str)> = impacts
        .zip(["X < x", "x < 0"].into_iter().cycle())
        .map(|(angle, pair)| ((20.0 - 1.0 / angle.tan()) / 10.0, pair))
        .collect();
    same("number of impacts", &expected.len(), &31)?;
    // Times are of the order of seconds, rounding is carried through 31 impacts.
    balls.happened(&expected, 1e-9)?;
    // After the last, of odd number, the flight is the mirrored straight line.
    let direction = 32.0 * wedge - PI;
    close("light ball", balls.last("v")?, 10.0 * direction.sin(), 1e-9)?;
    close("heavy ball", balls.last("V")?, direction.cos(), 1e-9)
}

/// Two automata make their impacts at one instant; each keeps its momentum.
pub(super) fn two_pairs() -> Result<(), String> {
    let pairs = solve("events/simultaneous", "pairs")?;
    // Speeds before are 2 and 0, 3 and -1 m/s; times and speeds are those of straight lines.
    pairs.happened(
        &[(0.5, "slow.x2 < slow.x1"), (0.5, "fast.x2 < fast.x1")],
        1e-12,
    )?;
    at_one_instant(&pairs)?;
    for (name, speed) in [
        ("slow.v1", -2.0 / 3.0),
        ("slow.v2", 4.0 / 3.0),
        ("fast.v1", 1.0),
        ("fast.v2", 5.0),
    ] {
        close(name, pairs.last(name)?, speed, 1e-12)?;
    }
    let momentum = |pair: &str, m1: f64, m2: f64| -> Result<f64, String> {
        let (v1, v2) = (format!("{pair}.v1"), format!("{pair}.v2"));
        Ok(m1 * pairs.last(&v1)? + m2 * pairs.last(&v2)?)
    };
    close("momentum", momentum("slow", 1.0, 2.0)?, 2.0, 1e-12)?;
    close("momentum", momentum("fast", 3.0, 1.0)?, 8.0, 1e-12)
}

/// A ball struck from both sides at once: three impacts follow each other at one instant, and the outer two fly back.
pub(super) fn three_balls() -> Result<(), String> {
    let balls = solve("events/simultaneous", "three")?;
    let (left, right) = ("b <= a and va > vb", "c <= b and vb > vc");
    balls.happened(&[(1.0, left), (1.0, right), (1.0, left)], 1e-12)?;
    at_one_instant(&balls)?;
    for (name, speed) in [("va", -1.0), ("vb", 0.0), ("vc", 1.0)] {
        // Speeds are exchanged, not computed.
        same(name, &balls.last(name)?, &speed)?;
    }
    Ok(())
}

fn at_one_instant(solved: &Solved) -> Result<(), String> {
    same("instants", &solved.run.results.statistics.events, &1)
}
