//! The limit test of effects from the command line, and what an effect changes line by line.

use crate::command::{Folder, errors, hyde, status, text};
use serde_json::Value;

const SLED: &str = r#"package sled;
import SI.*;
import Translational.*;

effect Drag on Rail "vanishes"
  size Damping b = 0 in 0 .. 500 [N.s/m];
  add a.f = b*der(a.s);
end Drag;

effect Step on Rail "is there as soon as its size is not 0"
  size Force F = 0 in 0 .. 100 [N];
  add a.f = if F > 0 then -20 [N] else 0;
end Step;

effect Idle on Rail "no model has it"
  size Force F = 0 in 0 .. 100 [N];
  add a.f = -F;
end Idle;

model Sled
  Mass body(M = 80 [kg]);
  Drive push(F = 400 [N]*sin(2*pi*1 [Hz]*time));
equation
  connect(body.a, push.a);
end Sled;

model Worn = Sled with EFFECT on body.a;

experiment shove of Worn
  measure Energy E = max(body.M*body.v^2/2);
  measure Velocity v = max(body.v);
  expect E < 81 [kg]*v^2/2 and v > 0;
  solve ida(rtol = 1e-6) stop 1 [s];
end shove;
"#;

#[test]
fn an_effect_that_vanishes_with_its_size_passes_and_another_does_not() {
    let folder = Folder::new();
    let drag = folder.file("drag.hyde", &SLED.replace("EFFECT", "Drag"));
    let output = hyde(&["effects", &drag, "--check"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let printed = text(&output);
    assert!(
        printed.contains("passed  shove: body.a.Drag.b"),
        "{printed}"
    );
    assert!(
        printed.contains("in no experiment: Step, Idle"),
        "{printed}"
    );
    // Others may be in another experiment.
    let printed = text(&hyde(&["effects", &drag, "shove", "--check"]));
    assert!(printed.contains("\nnot in shove: Step, Idle"), "{printed}");
    let step = folder.file("step.hyde", &SLED.replace("EFFECT", "Step"));
    let output = hyde(&["effects", &step, "--check"]);
    assert_eq!(status(&output), 1);
    let printed = text(&output);
    // All of the step is there at a thousandth of its size.
    let line = "FAILED  shove: body.a.Step.F  at 0.1 % of its size, 100 % of its effect remains";
    assert!(printed.contains(line), "{printed}");
    let output = hyde(&["effects", &step, "--check", "--json"]);
    let value: Value = serde_json::from_str(&text(&output)).unwrap();
    assert_eq!(value["ok"], false);
    assert_eq!(value["tests"][0]["verdict"], "failed");
}

#[test]
fn what_an_effect_changes_is_shown_line_by_line() {
    let folder = Folder::new();
    let drag = folder.file("drag.hyde", &SLED.replace("EFFECT", "Drag(b = 5 [N.s/m])"));
    let flat = ["emit", &drag, "--stage", "flat"];
    let against = ["--model", "Worn", "--against", "Sled"];
    let output = text(&hyde(&[&flat[..], &against[..]].concat()));
    let changed = |mark: char| output.lines().filter(|line| line.starts_with(mark)).count();
    // Its name, and the sum of forces at its site: the rest of the model is as it was.
    assert_eq!(changed('-'), 2, "{output}");
    assert!(
        output.contains("+  body.a.Drag.a.f = body.a.Drag.b*der(body.a.Drag.a.s)"),
        "{output}"
    );
    assert!(
        output.lines().all(|line| line.starts_with(['+', '-'])),
        "{output}"
    );
    let itself = ["--model", "Worn", "--against", "Worn"];
    assert_eq!(text(&hyde(&[&flat[..], &itself[..]].concat())).trim(), "");
}

#[test]
fn expectations_use_measures_by_name_and_energies_are_in_joules() {
    let folder = Folder::new();
    let drag = folder.file("drag.hyde", &SLED.replace("EFFECT", "Drag"));
    let output = hyde(&["run", &drag]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    // v = F/(M*w)*(1 - cos(w*t)) is 1.592 m/s at most: 101.3 J.
    let printed = text(&output);
    assert!(printed.contains("E = 101.3 J"), "{printed}");
    assert!(printed.contains("v > 0: holds"), "{printed}");
}
