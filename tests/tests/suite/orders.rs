//! Orders of an angle: whole where they may be, and as they are where not.

use crate::command::{report, write};
use crate::points::Random;
use std::fmt::Write as _;

const MODEL: &str = "package orders;
import SI.*;
import Rotational.*;

effect Ripple on Flange
  size Torque As = 0 in -1 .. 1 [N.m], Ac = 0 in -1 .. 1 [N.m];
  shape Real order = 1 in 0.5 .. 6;
  add a.tau = -(As*sin(order*a.phi) + Ac*cos(order*a.phi));
  signature angle(order);
end Ripple;

model Rotor
  input Torque u;
  parameter MomentOfInertia J = 0.0102 [kg.m2] ~ ±5%;
  Flange a;
  Angle phi(start = 0, fixed = true);
  AngularVelocity w(start = 0, fixed = true) = der(phi);
equation
  a.phi = phi;
  J*der(w) = a.tau + u;
end Rotor;

experiment turns(record file every 1 [ms] = \"record.csv\") of Rotor
  stimulus u = file.u;
  measured file.w = w ~ 0.02 [rad/s];
  solve ida(rtol = 1e-8) stop file.end every 1 [ms];
end turns;

calibrate rotor of Rotor
  fit turns(\"record.csv\");
  vary uncertain;
end rotor;

diagnose ripple of calibrate rotor
  candidates orders.*;
  max_effects 1;
end ripple;
";

/// The order that a diagnosis tells of a rotor of 0.01 kg m2 with 0.02 N m of some order, and its interval.
fn told(order: f64) -> (f64, (f64, f64)) {
    const STEPS: u32 = 50;
    let folder = tempfile::tempdir().unwrap();
    write(&folder.path().join("orders.hyde"), MODEL);
    let mut random = Random(5);
    let mut text = "t [s],u [N.m],w [rad/s]\n".to_owned();
    let (mut phi, mut w) = (0.0_f64, 0.0_f64);
    for row in 0..4000 {
        let t = 1e-3 * f64::from(row);
        let u = 0.1 * (3.0 * t).cos();
        let read = w + 0.02 * random.normal();
        let _ = writeln!(text, "{t:.3},{u:.9},{read:.9}");
        for step in 0..STEPS {
            // Half a step of the way, one of the speed, half a step of the way; u in between as the record has it.
            let part = (f64::from(step) + 0.5) / f64::from(STEPS);
            let next = 0.1 * (3.0 * (t + 1e-3)).cos();
            let dt = 1e-3 / f64::from(STEPS);
            phi += 0.5 * dt * w;
            w += dt * (u + part * (next - u) + 0.02 * (order * phi + 0.4).sin()) / 0.01;
            phi += 0.5 * dt * w;
        }
    }
    write(&folder.path().join("record.csv"), &text);
    let found = report(folder.path(), &["diagnose", "orders.hyde", "ripple"]);
    let shape = &found["effects"][0]["shape"]["order"];
    let number = |value: &serde_json::Value| value.as_f64().unwrap_or_else(|| panic!("{found}"));
    let interval = (number(&shape["interval"][0]), number(&shape["interval"][1]));
    (number(&shape["value"]), interval)
}

#[test]
fn an_order_is_whole_where_it_may_be() {
    let (order, (low, high)) = told(3.0);
    assert_eq!(order.to_string(), "3");
    assert!(low < 3.0 && 3.0 < high && high - low < 0.05, "{low} {high}");
}

#[test]
fn an_order_that_is_not_whole_stays() {
    let (order, (low, high)) = told(2.94);
    assert!((order - 2.94).abs() < 0.02, "{order}");
    assert!(low < 2.94 && 2.94 < high && high < 3.0, "{low} {high}");
}
