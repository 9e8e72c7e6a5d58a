//! A body that a recorded force drives, and effects that its model lacks: the smallest model that can be diagnosed.

use crate::command::{report, write};
use crate::points::Random;
use serde_json::Value;
use std::fmt::Write as _;

const MODEL: &str = "model Body
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
  candidates effects.*;
  max_effects 3;
end all;
";

const ON_GUIDE: &str = "model Body
  input Force u;
  Mass load(M = 1.02 [kg] ~ ±5%);
  Guide guide(F = 0.2 [N]);
  Drive push(F = u);
equation
  connect(push.a, load.a, guide.a);
end Body;
";

/// A force that neither the model nor any other effect of these tests explains.
pub(crate) const SLOW: &str = "effect Slow on Rail
  size Force F = 0 in -50 .. 50 [N];
  add a.f = -F*sin(7 [rad/s]*time);
end Slow;
";

/// The report of a diagnosis with some effects, of 4 s of the force in N and of the velocity in m/s at times in s; the velocity
/// is measured with noise of 1 mm/s.
pub(crate) fn diagnosed(effects: &[&str], force_and_velocity: impl Fn(f64) -> (f64, f64)) -> Value {
    diagnosed_of(MODEL, effects, force_and_velocity)
}

/// The same of a body on a guide with a friction of 0.2 N.
pub(crate) fn diagnosed_on_guide(
    effects: &[&str],
    force_and_velocity: impl Fn(f64) -> (f64, f64),
) -> Value {
    let (_, experiment) = MODEL.split_once("end Body;\n").unwrap();
    let on_guide = [ON_GUIDE, &experiment.replace("= v ~", "= load.v ~")].concat();
    diagnosed_of(&on_guide, effects, force_and_velocity)
}

fn diagnosed_of(
    model: &str,
    effects: &[&str],
    force_and_velocity: impl Fn(f64) -> (f64, f64),
) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let begin = "package effects;\nimport SI.*;\nimport Translational.*;\n";
    let file = [&[begin, model], effects].concat().join("\n");
    write(&folder.path().join("effects.hyde"), &file);
    let mut random = Random(5);
    let mut text = "t [s],u [N],v [m/s]\n".to_owned();
    for row in 0..4000 {
        let t = 1e-3 * f64::from(row);
        let (u, v) = force_and_velocity(t);
        let _ = writeln!(text, "{t:.3},{u:.9},{:.9}", v + 1e-3 * random.normal());
    }
    write(&folder.path().join("record.csv"), &text);
    report(folder.path(), &["diagnose", "effects.hyde", "all"])
}
