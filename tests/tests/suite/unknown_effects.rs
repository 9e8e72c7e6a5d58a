//! Effects that no library has: planted on a small axis, found as laws of the model's own variables.

use crate::command::{hyde, read, report, write};
use crate::points::Random;
use hyde_tests::root;
use serde_json::Value;
use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;
use tempfile::TempDir;

/// What is tried before: nothing that was planted.
const DIAGNOSIS: &str = "
diagnose few of calibrate small
  candidates Effects.Pull, Effects.Viscous, Effects.Stribeck, Effects.Cogging, Effects.Signals.ScaleError,
    Effects.Signals.TachoGain, Effects.Signals.AmplifierGain, Effects.CouplingBacklash;
  max_effects 2;
end few;

diagnose forms of calibrate small
  candidates Effects.Stribeck, Effects.Tustin, Effects.DirectionalViscous, Effects.GroundSpring, Effects.Cogging;
  max_effects 3;
end forms;

diagnose drags of calibrate small
  candidates Effects.Stribeck, Effects.Tustin, Effects.SaturatingDrag, Effects.SqrtDrag, Effects.Viscous;
  max_effects 2;
end drags;

diagnose bodies of calibrate small
  candidates Effects.Rocking, Effects.Pull;
end bodies;
";

/// A record of 3 s with the effect on a site, diagnosed.
pub(crate) fn diagnosed(effect: &str, with: &str) -> Value {
    diagnosed_on(&[], effect, with, "few")
}

/// The same by a study, on another axis: its text with some parts replaced.
pub(crate) fn diagnosed_on(
    changes: &[(&str, &str)],
    effect: &str,
    with: &str,
    study: &str,
) -> Value {
    let folder = made(changes, effect, with);
    report(folder.path(), &["diagnose", "axis.hyde", study])
}

/// A folder with such an axis and its record.
fn made(changes: &[(&str, &str)], effect: &str, with: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    make(folder.path(), changes, effect, with);
    folder
}

/// Writes such an axis and its record into a folder; gives the text of the axis.
pub(crate) fn make(folder: &Path, changes: &[(&str, &str)], effect: &str, with: &str) -> String {
    let model = root().join("tests/models/small_axis.hyde");
    // The saddle is read by a scale, the motor's speed by a tacho.
    let mut plain = read(&model)
        .replace("  Guide guide(", "  PositionSensor scale;\n  Guide guide(")
        .replace("saddle.a, guide.a)", "saddle.a, guide.a, scale.a)")
        .replace("saddle.s ~", "scale.s ~")
        .replace(
            "import Translational.*;",
            "import Translational.*;\nimport Drives.Control.*;",
        )
        .replace(
            "  Mass saddle(",
            "  Tachogenerator tacho(K_ta = 0.05 [V.s/rad]);\n  Mass saddle(",
        )
        .replace("bearing.a, coupling.a)", "bearing.a, coupling.a, tacho.a)")
        .replace(
            "file.w = rotor.w ~ 0.08 [rad/s]",
            "file.V = tacho.V6 ~ 4 [mV]",
        );
    for (from, to) in changes {
        assert!(plain.contains(from), "{from}");
        plain = plain.replace(from, to);
    }
    let made = format!(
        "{plain}
{effect}
model Made = Loop(saddle.M = 262 [kg], guide.F = 145 [N], rotor.J = 3.9e-3 [kg.m2]){with};
experiment made of Made
  solve ida(rtol = 1e-8, atol = 1e-11) stop 3 [s] every 1 [ms];
end made;
"
    );
    write(&folder.join("made.hyde"), &made);
    write(&folder.join("axis.hyde"), &format!("{plain}{DIAGNOSIS}"));
    hyde(folder, &["run", "made.hyde", "made", "--out", "out"]);
    record(folder);
    plain
}

/// The results as a record with the noise that the experiment declares.
fn record(folder: &Path) {
    let results = read(&folder.join("out/results.csv"));
    let mut lines = results.lines().filter(|line| !line.starts_with('#'));
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let noise = [
        ("t", 0.0),
        ("T", 0.0),
        ("rotor.phi", 1e-4),
        ("tacho.V6", 4e-3),
        ("scale.s", 3e-7),
    ];
    let places = noise.map(|(name, sd)| {
        let named = |text: &&str| text.split(' ').next() == Some(name);
        (head.iter().position(named).unwrap(), sd)
    });
    let mut random = Random(7);
    let mut text = "t [s],T [N.m],phi [rad],V [V],s [m]\n".to_owned();
    let mut rows = 0;
    for line in lines {
        let values: Vec<f64> = line.split(',').map(|v| v.parse().unwrap_or(0.0)).collect();
        // Events have rows of their own.
        if (values[places[0].0] - f64::from(rows) * 1e-3).abs() > 1e-9 {
            continue;
        }
        rows += 1;
        let noisy = places.map(|(at, sd)| (values[at] + sd * random.normal()).to_string());
        let _ = writeln!(text, "{}", noisy.join(","));
    }
    assert_eq!(rows, 3001);
    write(&folder.join("fit-1.csv"), &text);
}

#[test]
fn a_drag_that_waves_along_the_way_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Translational.Rail
           add a.f = 30 [N]*sin(2*pi*a.s/(23 [mm]))*v/(100 [mm/s]);
           Velocity v = der(a.s);
         end Odd;",
        " with Odd on saddle.a",
    );
    assert_eq!(found["verdict"], "unknown");
    let [effect] = found["effects"].as_array().unwrap().as_slice() else {
        panic!("{}", found["sentence"]);
    };
    assert_eq!(effect["effect"], "Found");
    assert_eq!(effect["site"], "saddle.a");
    let law = &found["unknown"]["law"];
    let text = law["text"].as_str().unwrap();
    assert!(
        text.contains("add a.f = -(Fs*v/v1*sin(2*pi*a.s/period) + Fc*v/v1*cos(2*pi*a.s/period));"),
        "{text}"
    );
    // The text has the values found: put on a model without any more words it is the effect.
    assert!(!text.contains("Fs = 0 [N]"), "{text}");
    // 30 N at 100 mm/s are 60 N at the 200 mm/s that sizes are given at; its interval is 1 % of it.
    let size = effect["size"].as_f64().unwrap();
    assert!((size / 60.0 - 1.0).abs() < 0.03, "{size}");
    // A thirtieth of a wave over the way.
    let period = effect["shape"]["period"]["value"].as_f64().unwrap();
    assert!((period / 0.023 - 1.0).abs() < 0.01, "{period}");
    assert!(law["share_of_map"].as_f64().unwrap() > 0.8);
    assert_eq!(found["unexplained"], false);
    // The map says of which variable it is a function, well above what chance makes of it.
    let panel = &found["unknown"]["map"]["panels"][0];
    assert_eq!(panel["variable"], "speed times place");
    assert!(panel["gain"].as_f64().unwrap() > 2.0 * panel["band"].as_f64().unwrap());
}

/// Drags that bend otherwise are no parts of it: without the shape two of them stand for it.
#[test]
fn a_drag_with_a_power_of_the_speed_is_found_and_written() {
    let with = " with Effects.PowerDrag(k = 600 [N], p = 0.7) on guide";
    let found = diagnosed_on(&[], "", with, "drags");
    let law = law_alone(&found);
    let text = "wrap grip by grip + F*noEvent(abs(v))/v1*(noEvent(abs(v))/v1 + 1e-6)^(p - 1);";
    assert!(law.contains(text), "{law}");
    let effect = &found["effects"][0];
    let p = effect["shape"]["p"]["value"].as_f64().unwrap();
    assert!((p / 0.7 - 1.0).abs() < 0.05, "{p}");
    // 600 N at 100 mm/s are 975 N at the 200 mm/s that sizes are given at.
    let size = effect["size"].as_f64().unwrap();
    assert!((size / 975.0 - 1.0).abs() < 0.05, "{size}");
}

/// A friction that remembers: its filter is found with the time constant, though parameters took half of it before.
#[test]
fn a_friction_that_grows_as_it_is_worked_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Translational.Guide
           Real w(start = 0, fixed = true);
           wrap grip by grip + 25 [N]*w;
           wrap hold by hold + 25 [N]*w;
         equation
           der(w) = (noEvent(abs(v))/(100 [mm/s]) - w)/(0.15 [s]);
         end Odd;",
        " with Odd on guide",
    );
    let law = law_alone(&found);
    assert!(
        law.contains("wrap grip by grip + F*worked_tau/v1;"),
        "{law}"
    );
    let filter = "tau*der(worked_tau) = noEvent(abs(v)) - worked_tau;";
    assert!(law.contains(filter), "{law}");
    let effect = &found["effects"][0];
    let tau = effect["shape"]["tau"]["value"].as_f64().unwrap();
    assert!((tau / 0.15 - 1.0).abs() < 0.1, "{tau}");
    // 25 N at 100 mm/s are 50 N at the 200 mm/s that sizes are given at.
    let size = effect["size"].as_f64().unwrap();
    assert!((size / 50.0 - 1.0).abs() < 0.1, "{size}");
}

#[test]
fn a_drag_in_one_direction_beyond_a_place_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Translational.Rail
           add a.f = 40 [N]*(1 + tanh((a.s - 20 [mm])/(2 [mm])))/2*(1 + tanh(v/(2 [mm/s])))/2;
           Velocity v = der(a.s);
         end Odd;",
        " with Odd on saddle.a",
    );
    let law = law_alone(&found);
    let forwards = "(1 + v/(noEvent(abs(v)) + vs))/2*(1 + tanh((a.s - x0)/width))/2";
    assert!(
        law.contains(&format!("add a.f = -(F*{forwards});")),
        "{law}"
    );
    let effect = &found["effects"][0];
    let place = effect["shape"]["x0"]["value"].as_f64().unwrap();
    assert!((place - 0.02).abs() < 0.5e-3, "{place}");
    let size = effect["size"].as_f64().unwrap();
    assert!((size / -40.0 - 1.0).abs() < 0.1, "{size}");
}

/// The text of the law that is the whole answer.
pub(crate) fn law_alone(found: &Value) -> &str {
    assert_eq!(found["verdict"], "unknown", "{}", found["sentence"]);
    let effects = found["effects"].as_array().unwrap();
    assert_eq!(effects.len(), 1, "{}", found["sentence"]);
    assert_eq!(effects[0]["effect"], "Found");
    found["unknown"]["law"]["text"].as_str().unwrap()
}

#[test]
fn an_error_of_the_scale_at_one_place_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Translational.PositionSensor
           wrap s by s + 6 [um]*exp(-((a.s - 30 [mm])/(9 [mm]))^2);
         end Odd;",
        " with Odd on scale",
    );
    assert_eq!(found["verdict"], "unknown");
    let [effect] = found["effects"].as_array().unwrap().as_slice() else {
        panic!("{}", found["sentence"]);
    };
    assert_eq!(effect["site"], "scale", "{}", found["sentence"]);
    let text = found["unknown"]["law"]["text"].as_str().unwrap();
    assert!(text.contains("wrap s by s + e*exp("), "{text}");
    let size = effect["size"].as_f64().unwrap();
    assert!((size / 6e-6 - 1.0).abs() < 0.05, "{size}");
    assert_eq!(found["unexplained"], false);
}

/// Waves of 7 mm over a way of more than 100 mm show in no function of 16 pieces: every site's map is empty but for its waves.
#[test]
fn a_drag_that_waves_shortly_is_found_where_it_is() {
    let found = diagnosed(
        "effect Odd on Translational.Rail
           add a.f = 40 [N]*sin(2*pi*a.s/(7.3 [mm]))*v/(100 [mm/s]);
           Velocity v = der(a.s);
         end Odd;",
        " with Odd on saddle.a",
    );
    let law = law_alone(&found);
    assert_eq!(found["effects"][0]["site"], "saddle.a");
    assert!(law.contains("Fs*v/v1*sin(2*pi*a.s/period)"), "{law}");
    let period = &found["effects"][0]["shape"]["period"]["value"];
    let period = period.as_f64().unwrap();
    assert!((period / 7.3e-3 - 1.0).abs() < 0.005, "{period}");
    let map = &found["unknown"]["map"];
    let panel = map["panels"][0]["gain"].as_f64().unwrap();
    assert!(map["waves"].as_f64().unwrap() > 3.0 * panel, "{panel}");
}

#[test]
fn a_scale_that_lags_by_direction_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Translational.PositionSensor
           wrap s by s - 4 [um]*tanh(der(a.s)/(3 [mm/s]));
         end Odd;",
        " with Odd on scale",
    );
    let law = law_alone(&found);
    assert_eq!(found["effects"][0]["site"], "scale");
    assert!(law.contains("wrap s by s + e*tanh(v/vs);"), "{law}");
    let size = found["effects"][0]["size"].as_f64().unwrap();
    assert!((size / -4e-6 - 1.0).abs() < 0.05, "{size}");
}

/// Alone both forms of friction bend towards the drag that is missing beside them.
#[test]
fn a_drag_beside_a_known_friction_is_found_and_both_are_told() {
    let found = diagnosed_on(
        &[],
        "effect Odd on Translational.Rail
           add a.f = 30 [N]*(v/(100 [mm/s]))*a.s/(50 [mm]);
           Velocity v = der(a.s);
         end Odd;",
        " with Effects.Stribeck(dF = 40 [N], vs = 9 [mm/s]) on guide, Odd on saddle.a",
        "forms",
    );
    assert_eq!(found["verdict"], "unknown", "{}", found["sentence"]);
    let [known, law] = found["effects"].as_array().unwrap().as_slice() else {
        panic!("{}", found["sentence"]);
    };
    assert_eq!(
        (&known["effect"], &known["site"]),
        (&"Stribeck".into(), &"guide".into())
    );
    let size = known["size"].as_f64().unwrap();
    assert!((size / 40.0 - 1.0).abs() < 0.05, "{size}");
    assert_eq!(
        (&law["effect"], &law["site"]),
        (&"Found".into(), &"saddle.a".into())
    );
    let text = found["unknown"]["law"]["text"].as_str().unwrap();
    assert!(text.contains("add a.f = -(F*v/v1*a.s/x1);"), "{text}");
}

/// In the linear answer a square with its sign gains more than the cube; fitted, the cube does.
#[test]
fn a_coupling_that_becomes_stiffer_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Rotational.SpringDamper
           wrap T by T + 2 [N.m]*(twist/(2 [mrad]))^3;
         end Odd;",
        " with Odd on coupling",
    );
    let law = law_alone(&found);
    assert_eq!(found["effects"][0]["site"], "coupling");
    assert!(law.contains("wrap T by T + M*(twist/x1)^3;"), "{law}");
    assert!(law.contains("x1 = 2 [mrad]"), "{law}");
    // The stiffness beside it answers most of a cube, and what drives the axis is known to its digits alone: the record does
    // not tell the size further.
    let interval = &found["effects"][0]["interval"];
    let (low, high) = (interval[0].as_f64().unwrap(), interval[1].as_f64().unwrap());
    assert!((1.0..2.0).contains(&low), "{interval}");
    assert!((2.0..4.5).contains(&high), "{interval}");
}

#[test]
fn a_voltage_of_the_tacho_that_bends_with_speed_is_found_and_written() {
    let found = diagnosed(
        "effect Odd on Tachogenerator
           wrap V6 by V6 + 0.03 [V]*(w/(100 [rad/s]))*noEvent(abs(w))/(100 [rad/s]);
         end Odd;",
        " with Odd on tacho",
    );
    let law = law_alone(&found);
    assert_eq!(found["effects"][0]["site"], "tacho");
    assert!(law.contains("on Drives.Control.Tachogenerator"), "{law}");
    assert!(
        law.contains("wrap V6 by V6 + U*w*noEvent(abs(w))/w1^2;"),
        "{law}"
    );
    // 0.03 V at 100 rad/s are 0.12 V at the 200 rad/s that sizes are given at.
    let size = found["effects"][0]["size"].as_f64().unwrap();
    assert!((size / 0.12 - 1.0).abs() < 0.03, "{size}");
}

/// The drive has a winding and an amplifier.
pub(crate) const AMPLIFIER: [(&str, &str); 3] = [
    (
        "  Rotational.Drive motor(T = T);",
        "  Rotational.Drive motor(T = 0.5 [N.m/A]*i);
  Current i(start = 0, fixed = true);
  Electrical.CurrentAmplifier amplifier(i_ref = T/(0.5 [N.m/A]), i = i, Kc = 20 [V/A]);",
    ),
    (
        "  connect(motor.a, rotor.a);",
        "  connect(motor.a, rotor.a);\n  2 [mH]*der(i) = amplifier.u - 0.5 [ohm]*i;",
    ),
    (
        "import Translational.*;",
        "import Translational.*;\nimport Electrical;",
    ),
];

/// The amplifier gives less than it is asked for the more that is.
#[test]
fn an_amplifier_that_gives_less_and_less_is_found_and_written() {
    let found = diagnosed_on(
        &AMPLIFIER,
        "effect Odd on Electrical.CurrentAmplifier
           wrap demand by demand*(1 - 0.05*noEvent(abs(demand))/(10 [A]));
         end Odd;",
        " with Odd on amplifier",
        "few",
    );
    let law = law_alone(&found);
    assert_eq!(found["effects"][0]["site"], "amplifier");
    assert!(
        law.contains("wrap demand by demand + I*i_ref*noEvent(abs(i_ref))/x1^2;"),
        "{law}"
    );
    // 5 % less at 10 A are 12.5 A less at the 50 A that sizes are given at.
    let size = found["effects"][0]["size"].as_f64().unwrap();
    assert!((size / -12.5 - 1.0).abs() < 0.01, "{size}");
}

/// A body on a spring has states that the declared observer has no gain for: the model is calibrated with one of its own.
#[test]
fn parameters_beside_a_body_on_a_spring_are_those_of_the_axis() {
    let body = " with Effects.Rocking(m = 60 [kg], f = 30 [Hz], zeta = 0.02) on saddle.a";
    let found = diagnosed_on(&[], "", body, "bodies");
    assert_eq!(found["verdict"], "effect");
    let interval = &found["effects"][0]["interval"];
    let ends = [&interval[0], &interval[1]].map(|end| end.as_f64().unwrap());
    assert!(ends[0] < 60.0 && 60.0 < ends[1], "{ends:?}");
    // As well as the saddle's mass: all masses weigh up to a common factor, which only the springs' stiffness tells.
    assert!(ends[1] - ends[0] < 4.0, "{ends:?}");
    let parameters = found["parameters"].as_array().unwrap();
    for (name, value) in [("saddle.M", 262.0), ("guide.F", 145.0), ("rotor.J", 3.9e-3)] {
        let own = parameters.iter().find(|one| one["name"] == name).unwrap();
        let after = own["after"]["value"].as_f64().unwrap();
        assert!((after / value - 1.0).abs() < 0.02, "{name} {after}");
    }
}

#[test]
fn a_record_without_an_effect_has_no_unknown_one() {
    let found = diagnosed("", "");
    assert_eq!(found["verdict"], "none");
    assert!(found["unknown"].is_null());
}

/// Holds a column of the record through some rows.
fn hold(folder: &Path, column: usize, rows: Range<usize>) {
    let path = folder.join("fit-1.csv");
    let text = read(&path);
    let mut held = String::new();
    let mut lines: Vec<String> = Vec::new();
    for (line, text) in text.lines().enumerate() {
        let mut values: Vec<&str> = text.split(',').collect();
        // The head is the line before the first row.
        if line == rows.start + 1 {
            held = values[column].to_owned();
        } else if line > rows.start + 1 && line <= rows.end {
            values[column] = &held;
        }
        lines.push(values.join(","));
    }
    write(&path, &(lines.join("\n") + "\n"));
}

/// Two spells ask for a law that passes every gate, and is of no drive.
#[test]
fn of_a_reading_that_was_held_no_law_is_made() {
    let folder = made(&[], "", "");
    for rows in [1000..1100, 2000..2100] {
        hold(folder.path(), 2, rows);
    }
    let found = report(folder.path(), &["diagnose", "axis.hyde", "few"]);
    assert_eq!(found["verdict"], "unknown");
    assert_eq!(found["unknown"]["law"], Value::Null);
    let held = found["frozen"].as_array().unwrap().iter();
    let held: Vec<String> = held.map(ToString::to_string).collect();
    assert_eq!(
        held,
        [
            r#"{"channel":"phi","from_s":1.0,"record":"fit-1.csv","to_s":1.099}"#,
            r#"{"channel":"phi","from_s":2.0,"record":"fit-1.csv","to_s":2.099}"#,
        ]
    );
    let told = "phi of fit-1.csv is constant from 1 to 1.099 s";
    assert!(found["doubts"][0].as_str().unwrap().starts_with(told));
}
