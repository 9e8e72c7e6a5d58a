//! Switches that both sides lead back to: the run slides, leaves again, or ends and says why.

use super::solved::{Solved, close, failure, same, solve, tells, time_told};
use hyde_experiment::Options;
use hyde_sim::EventKind;

/// A relay holds its state at exactly zero, with the mean of both sides.
pub(super) fn relay() -> Result<(), String> {
    let run = solve("events/sliding", "relay")?;
    // A straight line: nothing but rounding.
    turned(&run, &[(1.0, "x > 0", SLIDES)], 1e-12)?;
    from(&run, "x", 1.0, |_| 0.0, 0.0)?;
    from(&run, "u", 1.0, |_| 0.0, 0.0)?;
    // The same with two modes, whose guards lead to each other.
    let modes = solve("events/relay", "bare")?;
    turned(&modes, &[(1.0, "x < -width", SLIDES)], 1e-12)?;
    from(&modes, "x", 1.0, |_| 0.0, 0.0)?;
    // Two thirds of the time down at 1/s, one third up at 2/s, hold it; it came down for 1 s, and stays for 2 s.
    let times = &modes.run.results.mode_times[0];
    close("time in `high`", times[0], 1.0 + 2.0 * 2.0 / 3.0, 1e-9)?;
    close("time in `low`", times[1], 2.0 / 3.0, 1e-9)
}

/// Sliding on v + c*x = 0 the place decays with exp(-c*t).
pub(super) fn surface() -> Result<(), String> {
    let run = solve("events/sliding", "surface")?;
    // With v = -5t and x = 1 - 2.5t2 until 5t + 5t2 = 2; rtol 1e-9.
    let start = (-5.0 + 65.0_f64.sqrt()) / 10.0;
    turned(&run, &[(start, "v + c*x > 0", SLIDES)], 1e-8)?;
    let x = |t: f64| (1.0 - 2.5 * start * start) * (-2.0 * (t - start)).exp();
    from(&run, "x", start, x, 1e-8)?;
    from(&run, "v", start, |t| -2.0 * x(t), 1e-8)?;
    // What the relay does in the mean, by the solution's second derivative.
    from(&run, "u", start, |t| 4.0 * x(t), 1e-7)
}

/// Friction as a relay sticks while the force is below it, and lets go at the instant at which it is not.
pub(super) fn friction() -> Result<(), String> {
    let run = solve("events/sliding", "ramp")?;
    // 2v' = 1.5t - 3 from 1 m/s comes to rest at the first zero of a parabola; 1.5t = 3 at 2 s.
    let stop = (1.5 - 0.75_f64.sqrt()) / 0.75;
    turned(
        &run,
        &[(stop, "v > 0", SLIDES), (2.0, "v > 0", "true")],
        1e-8,
    )?;
    // The leaving is no matter of the solution: a force that is given.
    close("leaves", run.events()[1].t, 2.0, 1e-11)?;
    let stuck = |t: f64| (stop..2.0).contains(&t).then_some(());
    for (&t, &v) in run.run.results.time.iter().zip(run.column("v")?.iter()) {
        if stuck(t - 1e-9).is_some() && stuck(t + 1e-9).is_some() {
            same("speed while it sticks", &v, &0.0)?;
        }
    }
    // From rest under 1.5(t - 2).
    close("speed", run.last("v")?, 0.375, 1e-8)?;
    // 5 sin(2t) exceeds 3 from asin(0.6)/2 on; it comes to rest where the areas are equal, and so on.
    let swing = solve("events/sliding", "swing")?;
    let first = 0.6_f64.asin() / 2.0;
    let half = std::f64::consts::FRAC_PI_2;
    let stop = swing_stops(first);
    let cause = "v > 0";
    turned(
        &swing,
        &[
            (0.0, cause, SLIDES),
            (first, cause, "true"),
            (stop, cause, SLIDES),
            (first + half, cause, "false"),
            (stop + half, cause, SLIDES),
            (first + 2.0 * half, cause, "true"),
        ],
        1e-7,
    )
}

/// Where the speed under 5 sin(2t) - 3, from rest at `first`, is zero again: by bisection.
fn swing_stops(first: f64) -> f64 {
    let speed = |t: f64| 2.5 * ((2.0 * first).cos() - (2.0 * t).cos()) - 3.0 * (t - first);
    let (mut low, mut high) = (1.0, 2.5);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if speed(middle) > 0.0 {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Two relays on two bodies, one between them: they come to move as one, then both rest.
pub(super) fn two_relays() -> Result<(), String> {
    let run = solve("events/sliding", "stack")?;
    // 2 - 2t meets t/3; then 4 kg against 1 N.
    let meet = 6.0 / 7.0;
    let events = [(meet, "v1 - v2 > 0", SLIDES), (2.0, "v2 > 0", SLIDES)];
    turned(&run, &events, 1e-9)?;
    from(&run, "v1", meet, |t| (0.25 * (2.0 - t)).max(0.0), 1e-9)?;
    from(&run, "v1", 2.0, |_| 0.0, 0.0)?;
    from(&run, "v2", 2.0, |_| 0.0, 0.0)?;
    same("surfaces", &run.run.results.sliding.len(), &2)
}

/// A surface that is no plane, and one that moves.
pub(super) fn bent() -> Result<(), String> {
    let run = solve("events/sliding", "circle")?;
    // The radius falls as 2exp(-t), the angle grows as 2t; rtol 1e-9.
    let start = 2.0_f64.ln();
    turned(&run, &[(start, "x*x + y*y > 1", SLIDES)], 1e-8)?;
    from(&run, "x", start, |t| (2.0 * t).cos(), 1e-7)?;
    let radius = |run: &Solved| -> Result<Vec<f64>, String> {
        let (x, y) = (run.column("x")?, run.column("y")?);
        let pairs = x.iter().zip(y.iter());
        Ok(pairs.map(|(x, y)| x.hypot(*y)).collect())
    };
    for (t, radius) in run.run.results.time.iter().zip(radius(&run)?) {
        if *t > start {
            close("radius", radius, 1.0, 1e-14)?;
        }
    }
    // 0.5 - 0.5t meets the sine, 0.5t from there on falls behind it and catches up; at 120 degrees the sine falls faster.
    let follows = solve("events/sliding", "follows")?;
    let leave = 2.0 * std::f64::consts::FRAC_PI_3;
    let last = follows.events().last().ok_or("no event")?;
    same("kind", &turn(&last.kind), &"true")?;
    close("leaves", last.t, leave, 1e-10)?;
    let meets = follows.events()[1].t;
    let (x, goal) = (follows.column("x")?, follows.column("goal")?);
    for (t, (x, goal)) in follows
        .run
        .results
        .time
        .iter()
        .zip(x.iter().zip(goal.iter()))
    {
        if *t > meets && *t < leave {
            close("x", *x, *goal, 1e-15)?;
        }
    }
    Ok(())
}

/// An event takes the state away from the surface, or the surface from the state.
pub(super) fn kicked() -> Result<(), String> {
    let run = solve("events/sliding", "kicked")?;
    let cause = "x > goal";
    let slides: Vec<(f64, &str)> = run
        .events()
        .iter()
        .filter(|event| event.cause == cause)
        .map(|event| (event.t, turn(&event.kind)))
        .collect();
    let expected = [
        (1.0, SLIDES),
        (2.0, "true"),
        (2.5, SLIDES),
        (3.0, "true"),
        (3.25, SLIDES),
    ];
    same("number of events", &slides.len(), &expected.len())?;
    for ((t, turn), (at, into)) in slides.iter().zip(expected) {
        same("turn", turn, &into)?;
        // Straight lines.
        close(cause, *t, at, 1e-12)?;
    }
    same("x in the end", &run.last("x")?, &-0.25)?;
    // An exit of one of two modes that slide.
    let pair = solve("events/sliding", "pair")?;
    let names: Vec<&str> = pair
        .events()
        .iter()
        .map(|event| event.cause.as_str())
        .collect();
    same("events", &names, &vec!["v < 0", "time > 0.5"])?;
    // 0.5 s at 100 N.
    close("speed", pair.last("v")?, 0.5 * 100.0 / 310.0, 1e-9)
}

/// A row of masses on relays moves as one on guides that stick exactly.
pub(super) fn row() -> Result<(), String> {
    let (relays, guides) = (
        solve("events/sliding", "relays")?,
        solve("events/sliding", "guides")?,
    );
    let leaves = |run: &Solved| -> Vec<f64> {
        let events = run.events().iter().filter(|event| event.t > 0.0);
        events.map(|event| event.t).collect()
    };
    let (a, b) = (leaves(&relays), leaves(&guides));
    same("events", &a.len(), &b.len())?;
    same("all moved", &(a.len() >= 10), &true)?;
    for (a, b) in a.iter().zip(&b) {
        // rtol 1e-8 in each.
        close("break away", *a, *b, 1e-6)?;
    }
    for k in 1..=10 {
        let name = format!("body[{k}].s");
        close(&name, relays.last(&name)?, guides.last(&name)?, 1e-6)?;
    }
    Ok(())
}

/// What cannot slide ends the run, with its guards and why.
pub(super) fn refused() -> Result<(), String> {
    let options = Options::default();
    let told = failure("events/sliding", "cubed", &options)?;
    tells(&told, &["CannotSlide", "x > 0", "do not act linearly"])?;
    close("end", time_told(&told)?, 1.0, 1e-8)?;
    let told = failure("events/sliding", "through", &options)?;
    tells(&told, &["CannotSlide", "y > 0", "the guard itself jumps"])?;
    // y = x + 0.1u comes down from 0.9 at 1/s.
    close("end", time_told(&told)?, 0.9, 1e-9)?;
    // x changes sign at 1/3 s, then y, and so on; a round lasts a ninth of the one before. All rounds end at 0.65 s: the
    // times between are 1/3, 19/90, 19/270, …
    let told = failure("events/sliding", "spiral", &options)?;
    tells(&told, &["Zeno", "sum_s: 0.6500"])
}

const SLIDES: &str = "sliding";

/// What an event of a relation or a pair of modes turns to.
fn turn(kind: &EventKind) -> &'static str {
    match kind {
        EventKind::Slide { after: None, .. } => SLIDES,
        EventKind::Slide { after: Some(0), .. } | EventKind::Relation(false) => "false",
        EventKind::Slide { after: Some(_), .. } | EventKind::Relation(true) => "true",
        EventKind::Transition { .. } | EventKind::When => "",
    }
}

/// Whether the log holds these events and no others: time in s, condition, and what it turns to.
fn turned(run: &Solved, expected: &[(f64, &str, &str)], tolerance: f64) -> Result<(), String> {
    let pairs: Vec<(f64, &str)> = expected.iter().map(|(t, cause, _)| (*t, *cause)).collect();
    run.happened(&pairs, tolerance)?;
    for (event, (.., into)) in run.events().iter().zip(expected) {
        same("turn", &turn(&event.kind), into)?;
    }
    Ok(())
}

/// Whether a column is a function of the time behind an instant.
fn from(
    run: &Solved,
    name: &str,
    start: f64,
    expected: impl Fn(f64) -> f64,
    tolerance: f64,
) -> Result<(), String> {
    let column = run.column(name)?;
    let rows = run.run.results.time.iter().zip(column.iter());
    let mut behind = rows.filter(|(t, _)| **t > start + 1e-9);
    behind.try_for_each(|(&t, &value)| {
        close(&format!("{name} at {t} s"), value, expected(t), tolerance)
    })
}
