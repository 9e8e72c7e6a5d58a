//! Components of a user's own packages get laws as those of the library do: their sites say of what a law is a function.

use crate::command::{hyde, report, write};
use crate::unknown_effects::{law_alone, make};
use serde_json::Value;
use std::path::Path;

/// A package with a friction law of its own.
const PADS: &str = r#"package pads "what brakes our slides";
import SI.*;
import Translational.Rail;

model Pad "a pad on a way: more than F at creep speed, an oil film beside it"
  Rail a;
  parameter Force F(min = 0) "at speed";
  parameter Damping b(min = 0) = 0;
  parameter Velocity creep = 4 [mm/s];
  Velocity v = der(a.s);
  site Force rub = F*(1 + 0.2*creep/(noEvent(abs(v)) + creep)) over (place = a.s, slip = v, hold = breakaway);
  site Force breakaway = 1.2*F;
  site Force oil = b*v;
  modes initial stuck {
    mode stuck {
      v = 0;
      exit a.f - oil > breakaway -> slip(+1);
      exit a.f - oil < -breakaway -> slip(-1);
    }
    mode slip(Real s) {
      a.f = s*rub + oil;
      exit s*v < 0 -> stuck;
    }
  }
end Pad;
"#;

/// A package with a new kind of sensor.
const WIRES: &str = r#"package wires "sensors with a wire";
import SI.*;
import Translational.Rail;

model WireSensor "a wire is pulled off a drum, whose turns are counted; one of them is a known way"
  Rail a;
  parameter Length turn = 50 [mm] "way of a turn";
  Angle drum = a.s*(1 [rev])/turn;
  output Length s = drum*turn/(1 [rev]) over (place = drum, speed = der(drum));
equation
  a.f = 0;
end WireSensor;
"#;

/// A package with a shape of its own: a peak that falls slowly to both sides.
const PEAKS: &str = r#"package peaks "what our scales show";
import SI.*;

function resonant "a resonance at {x0} ± {width}"
  input Length x, x_min, x_max;
  input Length x0(step = 0.5*width) = {x_min + (x_max - x_min)*k/20 for k in 0:20} in x_min .. x_max;
  input Length width = 0.05*(x_max - x_min) in 0 .. 0.5*(x_max - x_min);
  Real away = ((x - x0)/width)^2;
  output Real f(cost = 1) = 1/(1 + away) over (place, stretch);
  signature position(x0);
end resonant;
"#;

/// An axis with a component of a package and an effect on it, diagnosed; its law, checked as a part of a file of its own.
fn diagnosed(
    (name, package): (&str, &str),
    changes: &[(&str, &str)],
    (effect, site): (&str, &str),
) -> Value {
    let folder = tempfile::tempdir().unwrap();
    let folder: &Path = folder.path();
    write(&folder.join(format!("{name}.hyde")), package);
    let import = format!("import Translational.*;\nimport {name}.*;");
    let changes = [&[("import Translational.*;", import.as_str())], changes].concat();
    let plain = make(folder, &changes, effect, &format!(" with Odd on {site}"));
    let found = report(folder, &["diagnose", "axis.hyde", "few"]);
    let law = law_alone(&found);
    let with_law = format!("{plain}\n{law}\nmodel Complete = Axis with Found on {site};\n");
    write(&folder.join("complete.hyde"), &with_law);
    let printed = hyde(folder, &["check", "complete.hyde", "--model", "Complete"]);
    assert!(printed.contains("model Complete"), "{printed}");
    found
}

fn close_to(found: &Value, expected: f64, part: f64) {
    let value = found.as_f64().unwrap();
    assert!((value / expected - 1.0).abs() < part, "{value}");
}

#[test]
fn a_friction_of_ones_own_gets_a_law_at_rest_and_in_motion() {
    let found = diagnosed(
        ("pads", PADS),
        &[("  Guide guide(F", "  Pad guide(F")],
        (
            "effect Odd on pads.Pad
               wrap rub by rub + 24 [N]*exp(-((a.s - 30 [mm])/(9 [mm]))^2);
               wrap breakaway by breakaway + 24 [N]*exp(-((a.s - 30 [mm])/(9 [mm]))^2);
             end Odd;",
            "guide",
        ),
    );
    let effect = &found["effects"][0];
    assert_eq!(effect["site"], "guide", "{}", found["sentence"]);
    let law = law_alone(&found);
    assert!(law.starts_with("effect Found on pads.Pad \""), "{law}");
    for value in ["rub", "breakaway"] {
        let clause = format!("wrap {value} by {value} + F*exp(-((a.s - x0)/width)^2);");
        assert!(law.contains(&clause), "{law}");
    }
    close_to(&effect["size"], 24.0, 0.05);
    close_to(&effect["shape"]["x0"]["value"], 0.03, 0.02);
    close_to(&effect["shape"]["width"]["value"], 0.009, 0.1);
}

/// The drum runs out of true: a law of an angle that no other component knows.
#[test]
fn a_new_kind_of_sensor_gets_a_law_over_its_own_angle() {
    let found = diagnosed(
        ("wires", WIRES),
        &[("  PositionSensor scale;", "  WireSensor scale;")],
        (
            "effect Odd on wires.WireSensor
               wrap s by s + 4 [um]*sin(drum) - 3 [um]*cos(drum);
             end Odd;",
            "scale",
        ),
    );
    let effect = &found["effects"][0];
    assert_eq!(effect["site"], "scale", "{}", found["sentence"]);
    let law = law_alone(&found);
    assert!(
        law.starts_with("effect Found on wires.WireSensor \""),
        "{law}"
    );
    let clause = "wrap s by s + es*sin(N*drum) + ec*cos(N*drum);";
    assert!(law.contains(clause), "{law}");
    close_to(&effect["sizes"]["es"]["value"], 4e-6, 0.05);
    close_to(&effect["sizes"]["ec"]["value"], -3e-6, 0.05);
    close_to(&effect["shape"]["N"]["value"], 1.0, 0.01);
}

/// A shape of a package that the model imports is tried beside those of the library.
#[test]
fn a_law_is_made_of_a_shape_of_ones_own() {
    let found = diagnosed(
        ("peaks", PEAKS),
        &[],
        (
            "effect Odd on Translational.PositionSensor
               wrap s by s + 60 [um]/(1 + ((a.s - 30 [mm])/(6 [mm]))^2);
             end Odd;",
            "scale",
        ),
    );
    let law = law_alone(&found);
    let clause = "wrap s by s + e*1/(1 + ((a.s - x0)/width)^2);";
    assert!(law.contains(clause), "{law}");
    let effect = &found["effects"][0];
    close_to(&effect["size"], 60e-6, 0.05);
    close_to(&effect["shape"]["x0"]["value"], 0.03, 0.02);
    close_to(&effect["shape"]["width"]["value"], 0.006, 0.05);
}
