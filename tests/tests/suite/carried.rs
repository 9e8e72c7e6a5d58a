//! An effect of size 0 does not act, but the axis drives what it brings: a body on a spring, a bristle. Where its equations are
//! linear, or each state flows on its own, they are solved along the run of the model without it; what follows is what a run of
//! the whole model tells.

use crate::driven_body::{SLOW, diagnosed, diagnosed_on_guide};
use serde_json::Value;

/// A body on a spring, of a name, its equation with another term.
fn swing(name: &str, bend: &str) -> String {
    format!(
        "effect {name} on Rail
  size Mass m = 0 in 0 .. 1 [kg];
  shape Frequency f = 12 [Hz] in 3 .. 100 [Hz];
  Length z(start = 0, fixed = true);
  Velocity vz(start = 0, fixed = true) = der(z);
  add der(vz) + 0.1*(2*pi*f)*(vz - der(a.s)) + (2*pi*f)^2*(z - a.s){bend} = 0;
  a.f = m*der(vz);
end {name};
"
    )
}

/// Two bristles side by side that bend over with a power of their bending, of a name; the rate of one with another term.
fn bristles(name: &str, power: u32, bend: &str) -> String {
    format!(
        "effect {name} on Rail
  size Force F = 0 in -10 .. 10 [N];
  shape Length z0 = 10 [mm] in 0.1 .. 100 [mm];
  Real z(start = 0, fixed = true), y(start = 0, fixed = true);
  Velocity v = der(a.s);
  add a.f = F*(z + y)/2;
equation
  der(z) = (v - noEvent(abs(v))*z^{power})/z0{bend};
  der(y) = (v - noEvent(abs(v))*y^{power})/(2*z0);
end {name};
"
    )
}

/// A force that increases with the square of the time, of a name, with something beside it that does not act.
fn push(name: &str, beside: &str) -> String {
    format!(
        "effect {name} on Rail
  size Force F = 0 in -10 .. 10 [N];
  add a.f = F*(0.25 [1/s]*time)^2;
{beside}end {name};
"
    )
}

const COUPLED: &str = "  Real z(start = 0, fixed = true), y(start = 0, fixed = true);
equation
  der(z) = 1 [1/s]*(1 - z^3 + 1e-3*y);
  der(y) = 1 [1/s]*(1 - y^3 + 1e-3*z);
";

/// Cosines of 3 and 31 rad/s as a force, and the velocity of 1 kg under it and under the force that only `Slow` explains.
fn force_and_velocity(t: f64) -> (f64, f64) {
    let u = (3.0 * t).cos() + 0.5 * (31.0 * t).cos();
    let v =
        (3.0 * t).sin() / 3.0 + 0.5 * (31.0 * t).sin() / 31.0 + 0.4 * (1.0 - (7.0 * t).cos()) / 7.0;
    (u, v)
}

/// Compares what two effects promise that were tried.
fn promise_alike(found: &Value, carried: &str, run: &str, close: f64) {
    let rejected = found["rejected"].as_array().unwrap();
    let of = |name: &str| -> &Value {
        let own = rejected.iter().find(|one| one["effect"] == name);
        own.unwrap_or_else(|| panic!("{name}: {}", found["sentence"]))
    };
    let (carried, run) = (of(carried), of(run));
    let same = |a: &Value, b: &Value| {
        let (a, b) = (a.as_f64().unwrap(), b.as_f64().unwrap());
        assert!(b > 0.0 && (a / b - 1.0).abs() < close, "{a} {b}");
    };
    same(&carried["score"], &run["score"]);
    same(
        &carried["smallest_seen"]["value"],
        &run["smallest_seen"]["value"],
    );
}

#[test]
fn what_an_effect_brings_is_carried_along_as_in_a_run_of_its_own() {
    // Beside each effect the same with a term that does nothing but bend or couple its equations: that one needs runs of its own.
    let effects = [
        swing("Swing", ""),
        swing("BentSwing", " + 1e-9 [1/(m2.s2)]*z^3"),
        bristles("Bristles", 1, ""),
        bristles("CoupledBristles", 1, " + 1e-9 [1/s]*y"),
        bristles("Springs", 3, ""),
        bristles("CoupledSprings", 3, " + 1e-9 [1/s]*y"),
        SLOW.to_owned(),
    ];
    let effects = effects.each_ref().map(String::as_str);
    let found = diagnosed(&effects, force_and_velocity);
    // A constant flow is exact but for what drives it within a row; a bristle is taken as it is in the middle of a row, and a
    // spring a few times a row.
    for (carried, run, close) in [
        ("Swing", "BentSwing", 1e-6),
        ("Bristles", "CoupledBristles", 1e-3),
        ("Springs", "CoupledSprings", 1e-3),
    ] {
        promise_alike(&found, carried, run, close);
    }
}

#[test]
fn an_effect_that_changes_which_of_two_equal_forces_is_unknown_promises_what_a_run_tells() {
    // Without an effect the force on the body is that of the guide; beside one, either may be the unknown. States that are not
    // linear and act on each other need a run of their own.
    let effects = [
        push("Push", ""),
        push("CoupledPush", COUPLED),
        SLOW.to_owned(),
    ];
    let effects = effects.each_ref().map(String::as_str);
    let found = diagnosed_on_guide(&effects, force_and_velocity);
    promise_alike(&found, "Push", "CoupledPush", 1e-6);
}
