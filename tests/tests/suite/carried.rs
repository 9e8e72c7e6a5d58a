//! An effect of size 0 does not act, but the axis drives what it brings: a body on a spring, a bristle. Where its equations are
//! linear they are solved along the run of the model without it; what follows is what a run of the whole model tells.

use crate::command::{report, write};
use crate::points::Random;
use serde_json::Value;
use std::fmt::Write as _;

/// Beside each effect the same with a term that does nothing but bend its equations: that one needs runs of its own.
const MODEL: &str = "package carried;
import SI.*;
import Translational.*;

effect Slow on Rail
  size Force F = 0 in -50 .. 50 [N];
  add a.f = -F*sin(7 [rad/s]*time);
end Slow;

effect Swing on Rail
  size Mass m = 0 in 0 .. 1 [kg];
  shape Frequency f = 12 [Hz] in 3 .. 100 [Hz];
  Length z(start = 0, fixed = true);
  Velocity vz(start = 0, fixed = true) = der(z);
  add der(vz) + 0.1*(2*pi*f)*(vz - der(a.s)) + (2*pi*f)^2*(z - a.s) = 0;
  a.f = m*der(vz);
end Swing;

effect BentSwing on Rail
  size Mass m = 0 in 0 .. 1 [kg];
  shape Frequency f = 12 [Hz] in 3 .. 100 [Hz];
  Length z(start = 0, fixed = true);
  Velocity vz(start = 0, fixed = true) = der(z);
  add der(vz) + 0.1*(2*pi*f)*(vz - der(a.s)) + (2*pi*f)^2*(z - a.s) + 1e-9 [1/(m2.s2)]*z^3 = 0;
  a.f = m*der(vz);
end BentSwing;

effect Bristle on Rail
  size Force F = 0 in -10 .. 10 [N];
  shape Length z0 = 10 [mm] in 0.1 .. 100 [mm];
  Real z(start = 0, fixed = true);
  Velocity v = der(a.s);
  add a.f = F*z;
equation
  der(z) = (v - noEvent(abs(v))*z)/z0;
end Bristle;

effect BentBristle on Rail
  size Force F = 0 in -10 .. 10 [N];
  shape Length z0 = 10 [mm] in 0.1 .. 100 [mm];
  Real z(start = 0, fixed = true);
  Velocity v = der(a.s);
  add a.f = F*z;
equation
  der(z) = (v - noEvent(abs(v))*z)/z0 + 1e-9 [1/s]*z^3;
end BentBristle;

model Body
  input Force u;
  parameter Mass M = 1.02 [kg] ~ ±5%;
  Rail a;
  Length s(start = 0, fixed = true);
  Velocity v(start = 0, fixed = true) = der(s);
equation
  a.s = s;
  M*der(v) = a.f + u;
end Body;

experiment moves(record file every 1 [ms] = \"record.csv\") of Body
  stimulus u = file.u;
  measured file.v = v ~ 1 [mm/s];
  solve ida(rtol = 1e-8) stop file.end every 1 [ms];
end moves;

calibrate body of Body
  fit moves(\"record.csv\");
  vary uncertain;
end body;

diagnose all of calibrate body
  candidates carried.*;
  max_effects 3;
end all;
";

#[test]
fn what_an_effect_brings_is_carried_along_as_in_a_run_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    write(&folder.path().join("carried.hyde"), MODEL);
    let mut random = Random(5);
    let mut text = "t [s],u [N],v [m/s]\n".to_owned();
    for row in 0..4000 {
        let t = 1e-3 * f64::from(row);
        let u = (3.0 * t).cos() + 0.5 * (31.0 * t).cos();
        // Its integral with a mass of 1 kg, and that of a force that only Slow explains.
        let v = (3.0 * t).sin() / 3.0
            + 0.5 * (31.0 * t).sin() / 31.0
            + 0.4 * (1.0 - (7.0 * t).cos()) / 7.0
            + 1e-3 * random.normal();
        let _ = writeln!(text, "{t:.3},{u:.9},{v:.9}");
    }
    write(&folder.path().join("record.csv"), &text);
    let found = report(folder.path(), &["diagnose", "carried.hyde", "all"]);
    let rejected = found["rejected"].as_array().unwrap();
    let of = |name: &str| -> &Value {
        let own = rejected.iter().find(|one| one["effect"] == name);
        own.unwrap_or_else(|| panic!("{name}: {}", found["sentence"]))
    };
    // A constant flow is exact but for what drives it within a row; a bristle is taken as it is in the middle of a row.
    for (carried, run, close) in [
        ("Swing", "BentSwing", 1e-6),
        ("Bristle", "BentBristle", 1e-3),
    ] {
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
}
