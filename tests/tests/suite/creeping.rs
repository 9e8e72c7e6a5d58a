//! A slow force on a light, damped mass: `ida` creeps, `esdirk` takes over, and the answer is that of the closed form.

use crate::command::{report, write};

/// Stiffness, damping, mass, the force 150 N sin(wt) - 200 N.
const C: f64 = 1e6;
const D: f64 = 2750.0;
const M: f64 = 0.01;
const SINE: f64 = 150.0;
const CONSTANT: f64 = -200.0;

fn model(rtol: f64) -> String {
    format!(
        "package slow;
import SI.*;
model Light
  Length s(start = 0, fixed = true);
  Velocity v(start = 0, fixed = true) = der(s);
equation
  0.01 [kg]*der(v) = 150 [N]*sin(2*pi*0.01 [Hz]*time) - 200 [N] - 1e6 [N/m]*s - 2750 [N.s/m]*v;
end Light;
experiment run of Light
  measure Length reached = last(s);
  solve ida(rtol = {rtol:e}) stop 90 [s];
end run;
"
    )
}

/// s after 90 s, when what the start left is gone: the real and imaginary parts of 1/(C - M w^2 + jwD) times the force.
fn closed_form() -> f64 {
    let w = std::f64::consts::TAU * 0.01;
    let (re, im) = (C - M * w * w, D * w);
    let (sin, cos) = (w * 90.0).sin_cos();
    CONSTANT / C + SINE * (re * sin - im * cos) / (re * re + im * im)
}

#[test]
fn a_light_damped_mass_under_a_slow_force_takes_hundreds_of_steps_at_every_tolerance() {
    let folder = tempfile::tempdir().unwrap();
    let mut left = 0;
    // A method of order 5 takes 542 steps at 1e-8 and 1342 at 1e-9 from the start.
    for (rtol, most) in [
        (1e-4, 400),
        (1e-5, 400),
        (3e-6, 400),
        (1e-6, 400),
        (3e-7, 600),
        (1e-7, 600),
        (1e-8, 1200),
        (1e-9, 2500),
    ] {
        write(&folder.path().join("slow.hyde"), &model(rtol));
        let run = report(folder.path(), &["run", "slow.hyde", "--out", "out"]);
        let steps = run["statistics"]["steps"].as_u64().unwrap();
        assert!(steps < most, "{steps} steps at {rtol:e}");
        let end = run["measures"][0]["value"].as_f64().unwrap();
        let error = (end - closed_form()).abs() / 3.5e-4;
        assert!(error < 3.0 * rtol, "{error:e} at {rtol:e}");
        left += usize::from(run["statistics"]["esdirk_from_s"].is_f64());
    }
    assert!(left > 0, "no run crept: the test tests nothing");
}
