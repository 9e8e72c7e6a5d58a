//! Two effects that hide each other: neither gains enough alone, both together do.

use crate::command::{report, write};
use crate::points::Random;
use std::fmt::Write as _;

/// How much later the second force is, in rad: nearly the first one's opposite, so that alone either gains next to nothing.
const LATER: f64 = 0.14;
/// Both forces in N, and how fast they swing in rad/s.
const FORCE: f64 = 1.0;
const SWING: f64 = 40.0;

const MODEL: &str = "package pairs;
import SI.*;
import Translational.*;

effect Early on Rail
  size Force F = 0 in -50 .. 50 [N];
  add a.f = -F*sin(40 [rad/s]*time);
end Early;

effect Late on Rail
  size Force F = 0 in -50 .. 50 [N];
  add a.f = -F*sin(40 [rad/s]*time + 0.14);
end Late;

effect Slow on Rail
  size Force F = 0 in -50 .. 50 [N];
  add a.f = -F*sin(7 [rad/s]*time);
end Slow;

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

diagnose both of calibrate body
  candidates pairs.*;
  max_effects 3;
end both;
";

#[test]
fn two_effects_that_hide_each_other_are_found_together() {
    let folder = tempfile::tempdir().unwrap();
    write(&folder.path().join("pairs.hyde"), MODEL);
    let mut random = Random(5);
    let mut text = "t [s],u [N],v [m/s]\n".to_owned();
    for row in 0..4000 {
        let t = 1e-3 * f64::from(row);
        // The integral of cos(3 t) + sin(40 t) - sin(40 t + 0.14) with a mass of 1 kg.
        let early = (1.0 - (SWING * t).cos()) / SWING;
        let late = (LATER.cos() - (SWING * t + LATER).cos()) / SWING;
        let v = (3.0 * t).sin() / 3.0 + FORCE * (early - late) + 1e-3 * random.normal();
        let _ = writeln!(text, "{t:.3},{:.9},{v:.9}", (3.0 * t).cos());
    }
    write(&folder.path().join("record.csv"), &text);
    let found = report(folder.path(), &["diagnose", "pairs.hyde", "both"]);
    assert_eq!(found["verdict"], "effect");
    assert_eq!(found["unexplained"], false);
    let effects = found["effects"].as_array().unwrap();
    let of = |name: &str| -> f64 {
        let own = effects.iter().find(|effect| effect["effect"] == name);
        own.unwrap_or_else(|| panic!("{}", found["sentence"]))["size"]
            .as_f64()
            .unwrap()
    };
    assert_eq!(effects.len(), 2);
    assert!((of("Early") - FORCE).abs() < 0.03, "{}", found["sentence"]);
    assert!((of("Late") + FORCE).abs() < 0.03, "{}", found["sentence"]);
}
