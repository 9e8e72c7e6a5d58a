//! Stiff shafts: consistent values where their rows leave more by rounding than others have left to correct (at tight
//! tolerances two drives once ended in E0603 at an event), and accelerations at their ends, where the last cell is a millionth
//! of the body it is fixed to.

use crate::command::{report, write};
use crate::models::{close, solve};

const BRAKE: &str = "package brake;
import SI.*;
import Rotational.*;
model Drive
  Inertia motor(J = 1.721414 [kg.m2]);
  Inertia middle(J = 1.137587 [kg.m2]);
  Inertia load(J = 0.452652 [kg.m2]);
  Rotational.Brake brake(f_normalized = if time < 0.16398 [s] then 0 else 1, fn_max = 2.015722 [N]);
  Friction drag(T = 2.819857 [N.m], b = 0.892187 [N.m.s/rad]);
  IdealGear gear(ratio = 0.627803);
  ElastoBacklash2 play(c = 17308.419501 [N.m/rad], d = 9.923244 [N.m.s/rad], b0 = 0.001577 [rad]);
  Rotational.Shaft shaft(len = 0.848346 [m], d = 9.307029 [mm], tv = 0.05 [ms], n = 7);
  Rotational.SpringDamper brace(c = 625.026384 [N.m/rad], d = 13.697275 [N.m.s/rad]);
  Rotational.Drive push(T = 3.035909 [N.m]*sin(87.029775 [rad/s]*time));
  Rotational.Drive extra(T = -0.938204 [N.m]*atan(load.w/(0.3 [rad/s]))*exp(-load.phi/(1 [rad])));
  Power power = push.T*motor.w + extra.T*load.w;
equation
  connect(brake.a, middle.a);
  connect(drag.a, load.a);
  connect(motor.b, gear.a);
  connect(gear.b, play.a);
  connect(play.b, middle.a);
  connect(middle.b, shaft.a);
  connect(shaft.b, load.a);
  connect(middle.b, brace.a);
  connect(brace.b, motor.a);
  connect(push.a, motor.a);
  connect(extra.a, load.b);
end Drive;
experiment run of Drive
  measure Energy work = integral(power);
  solve METHOD stop 0.3 [s] every 10 [ms];
end run;
";

#[test]
fn a_shaft_behind_a_play_runs_on_at_the_tightest_tolerance() {
    let folder = tempfile::tempdir().unwrap();
    let work = |method: &str| {
        let model = BRAKE.replace("METHOD", method);
        write(&folder.path().join("brake.hyde"), &model);
        let run = report(folder.path(), &["run", "brake.hyde", "--out", "out"]);
        run["measures"][0]["value"].as_f64().unwrap()
    };
    let tight = work("esdirk(rtol = 1e-10, atol = 1e-13)");
    for method in [
        "esdirk(rtol = 1e-8, atol = 1e-10)",
        "ida(rtol = 1e-8, atol = 1e-10)",
    ] {
        let loose = work(method);
        let error = (loose / tight - 1.0).abs();
        assert!(error < 1e-4, "{loose} J by {method}, {tight} J");
    }
}

#[test]
fn a_body_at_the_end_of_a_shaft_accelerates_by_its_own_mass() {
    let (run, exact) = (solve("shaft_end", "ida"), solve("shaft_end", "exact"));
    let exact_times = exact.time();
    let (found, expected) = (run.column("bearing.acc"), exact.column("bearing.acc"));
    let mut compared = 0;
    for (t, found) in run.time().iter().zip(found.iter()) {
        // On the grid, away from the events.
        if let Some(row) = exact_times
            .iter()
            .position(|known| known.to_bits() == t.to_bits())
        {
            // rtol 1e-6 of 14 rad/s2; torn from the torque between the body and the cell they were off by more than that.
            close(*found, expected[row], 1e-3);
            compared += 1;
        }
    }
    assert!(compared > 550, "{compared}");
}
