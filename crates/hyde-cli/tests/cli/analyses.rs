//! Figures, modes, responses, stages.

use crate::command::{BENCH, Folder, LAG, errors, hyde, read, status, text, top};
use serde_json::Value;
use std::path::Path;

#[test]
fn results_are_plotted_from_their_folder() {
    let folder = Folder::new();
    let model = folder.file("lag.hyde", LAG);
    let out = folder.path("out");
    assert_eq!(status(&hyde(&["run", &model, "--out", &out])), 0);
    let svg = folder.path("x.svg");
    let output = hyde(&["plot", &out, "x,u", "--out", &svg, "--title", "a step"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    assert!(read(&svg).contains("a step"));
    let png = folder.path("x.png");
    assert_eq!(status(&hyde(&["plot", &out, "x", "--out", &png])), 0);
    assert!(std::fs::read(&png).unwrap().starts_with(b"\x89PNG"));
    for (line, word) in [
        (["plot", &out, "speed", "--out", &svg], "speed"),
        (["plot", &out, "x", "--out", "x.pdf"], ".svg or a .png"),
    ] {
        let output = hyde(&line);
        assert_eq!(status(&output), 2);
        assert!(errors(&output).contains(word), "{}", errors(&output));
    }
    assert!(!Path::new("x.pdf").exists());
}

#[test]
fn modes_come_by_frequency() {
    let output = hyde(&["modes", BENCH, "--json", "--below", "2000"]);
    let value: Value = serde_json::from_str(&text(&output)).unwrap();
    let modes = value["modes"].as_array().unwrap();
    let frequencies: Vec<f64> = modes
        .iter()
        .map(|mode| mode["frequency_hz"].as_f64().unwrap())
        .collect();
    assert!(!frequencies.is_empty());
    assert!(frequencies.is_sorted() && frequencies.iter().all(|f| *f < 2000.0));
}

#[test]
fn files_are_left_beside_json_and_quiet_prints_nothing() {
    let folder = Folder::new();
    for (line, file) in [
        (["modes", BENCH, "--below", "2000"].as_slice(), "modes.html"),
        (
            &["bode", "examples/y_axis/axis.hyde", "swept", "--linear"],
            "bode.html",
        ),
    ] {
        for (how, out) in [("--json", "told"), ("--quiet", "quiet")] {
            let path = folder.path(out);
            let output = hyde(&[line, &[how, "--out", &path][..]].concat());
            assert_eq!(status(&output), 0, "{}", errors(&output));
            let names = folder.names(out);
            assert!(names.iter().any(|name| name == file), "{names:?}");
            let printed = text(&output);
            match how {
                "--json" => assert!(serde_json::from_str::<Value>(&printed).is_ok()),
                _ => assert_eq!(printed, ""),
            }
        }
    }
}

#[test]
fn a_linear_response_leaves_figure_and_numbers() {
    let folder = Folder::new();
    let out = folder.path("bode");
    let axis = "examples/y_axis/axis.hyde";
    let line = [
        "bode", axis, "swept", "--linear", "--points", "50", "--out", &out,
    ];
    let output = hyde(&line);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let names = folder.names("bode");
    for ending in [".csv", ".svg", ".png"] {
        assert!(names.iter().any(|name| name.ends_with(ending)), "{names:?}");
    }
    assert!(names.iter().all(|name| !name.starts_with('.')), "{names:?}");
}

#[test]
fn every_stage_is_printed() {
    for stage in ["ast", "flat", "structure", "dae", "clif", "asm"] {
        let output = hyde(&["emit", BENCH, "--stage", stage]);
        assert_eq!(status(&output), 0, "{stage}: {}", errors(&output));
        assert!(text(&output).lines().count() > 20, "{stage}");
    }
    // The tree is printed as source text, which says the same again.
    let folder = Folder::new();
    let once = text(&hyde(&["emit", BENCH, "--stage", "ast"]));
    let record = format!(
        "file={}",
        top().join("examples/bench_axis/strokes.csv").display()
    );
    let again = folder.file("again.hyde", &once);
    let again = hyde(&["emit", &again, "--stage", "ast", "--record", &record]);
    assert_eq!(text(&again), once);
}

/// A spring that a force stretches against friction: the way is (F - guide)/c where both act one way.
const PULLED: &str = r#"package pulled "a table on a spring, drawn against its guideway";
import SI.*;
import Translational.*;

model Pulled
  input Force F;
  Drive drive(F = F);
  Mass table(M = 1 [kg]);
  Guide guide(F = 20 [N], b = 400 [N.s/m]);
  SpringDamper spring(c = 1e4 [N/m]);
  Fixed wall;
equation
  connect(drive.a, table.a, guide.a, spring.a);
  connect(spring.b, wall.a);
end Pulled;

experiment pull of Pulled
  stimulus F = 100 [N/s]*time;
  measure Length way = last(table.s);
  budget rubbing(guide.F = 0) "no friction", spring(spring.c = 2e4 [N/m]) "twice as stiff";
  figure way = table.s, {drive.F, spring.F} in 0.2 [s] .. 0.8 [s] "the way";
  figure line = spring.F over table.s;
  figure contour = circle(table.s, 1 [mm], 5 [mm]);
  solve ida(rtol = 1e-8) stop 1 [s];
end pull;
"#;

#[test]
fn a_budget_has_the_shares_that_the_closed_form_has() {
    let folder = Folder::new();
    let model = folder.file("pulled.hyde", PULLED);
    let output = hyde(&["budget", &model, "--json", "--out", &folder.path("out")]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let value: Value = serde_json::from_str(&text(&output)).unwrap();
    let way = &value["measures"][0];
    let number = |value: &Value| value.as_f64().unwrap() * 1e3;
    // (100 N - 20 N - b*v)/c with v = (100 N/s)/c, in mm; after 1 s the transient, of 40 ms, has gone.
    let expected = |friction: f64, c: f64| (100.0 - friction - 400.0 * 100.0 / c) / c * 1e3;
    let real = expected(20.0, 1e4);
    let shares = [
        (
            "spring",
            real - expected(20.0, 2e4),
            expected(0.0, 1e4) - expected(0.0, 2e4),
        ),
        (
            "rubbing",
            real - expected(0.0, 1e4),
            expected(20.0, 2e4) - expected(0.0, 2e4),
        ),
    ];
    // Tolerance of the runs, and e^-25 of the transient.
    let near = |found: f64, expected: f64| (found - expected).abs() < 1e-5;
    assert!(near(number(&way["value"]), real), "{way}");
    for (place, (name, share, alone)) in shares.into_iter().enumerate() {
        let found = &way["shares"][place];
        assert_eq!(found["name"], name);
        assert!(near(number(&found["share"]), share), "{found} not {share}");
        assert!(near(number(&found["alone"]), alone), "{found} not {alone}");
    }
    assert!(near(number(&way["left"]), expected(0.0, 2e4)), "{way}");
    // How far a number may be off is more than it is off, and no more than the tolerance lets expect.
    for error in [&way["value_error"], &way["shares"][0]["share_error"]] {
        let error = number(error);
        assert!((1e-12..1e-5).contains(&error), "{error}");
    }
    let csv = read(&folder.path("out/budget.csv"));
    assert_eq!(csv.lines().count(), 5, "{csv}");
}

/// At a loose tolerance a budget has few digits. Those that it shows are those of the closed form.
#[test]
fn a_budget_shows_the_digits_that_are_right() {
    let folder = Folder::new();
    let exact = |friction: f64, c: f64| (100.0 - friction - 400.0 * 100.0 / c) / c;
    let (real, ideal) = (exact(20.0, 1.3e4), exact(0.0, 2.3e4));
    let expected = [
        ("way", vec![real]),
        (
            "spring",
            vec![real - exact(20.0, 2.3e4), exact(0.0, 1.3e4) - ideal],
        ),
        (
            "rubbing",
            vec![real - exact(0.0, 1.3e4), exact(20.0, 2.3e4) - ideal],
        ),
        ("left", vec![ideal]),
    ];
    let stiffer = PULLED
        .replace("= 1e4", "= 1.3e4")
        .replace("= 2e4", "= 2.3e4");
    let (mut fewest, mut most) = (usize::MAX, 0);
    for rtol in ["1e-2", "1e-3", "1e-4", "1e-6"] {
        let pulled = stiffer.replace("ida(rtol = 1e-8)", &format!("ida(rtol = {rtol})"));
        let model = folder.file("pulled.hyde", &pulled);
        let output = hyde(&["budget", &model]);
        assert_eq!(status(&output), 0, "{}", errors(&output));
        let printed = text(&output);
        for (name, values) in &expected {
            let line = printed.lines().find(|line| line.trim().starts_with(name));
            let found = lengths(line.unwrap());
            assert_eq!(found.len(), values.len(), "{printed}");
            for ((value, last_digit, digits), exact) in found.into_iter().zip(values) {
                (fewest, most) = (fewest.min(digits), most.max(digits));
                let off = (value - exact).abs();
                assert!(off <= last_digit, "{name}: {exact} at {rtol} in\n{printed}");
            }
        }
    }
    assert!(fewest < 3 && most == 4, "{fewest} to {most} digits");
}

/// The lengths of a line in m, each with the size of its last digit and the number of its digits.
fn lengths(line: &str) -> Vec<(f64, f64, usize)> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let units = [("m", 1.0), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9)];
    let length = |pair: &[&str]| {
        let (_, scale) = units.iter().find(|(unit, _)| *unit == pair[1])?;
        let value: f64 = pair[0].parse().ok()?;
        // Zeros at the end of a whole number stand for digits that are not known.
        let whole = pair[0].trim_end_matches('0').len();
        let places = match pair[0].split_once('.') {
            Some((_, behind)) => behind.len() as i32,
            None => whole as i32 - pair[0].len() as i32,
        };
        let digits = pair[0].trim_start_matches(['-', '0', '.']);
        let digits = digits.trim_end_matches('0').replace('.', "");
        let last = 10_f64.powi(-places);
        Some((value * scale, last * scale, digits.len()))
    };
    words.windows(2).filter_map(length).collect()
}

const WARM: &str = r#"package warm "a winding that gets warm";
import SI.*;

type Celsius = Real [degC];

model Winding
  parameter Power P = 60 [W], hum = 30 [W];
  parameter Celsius around = 20 [degC];
  Celsius T(start = 20 [degC]);
equation
  10 [s]*der(T) = around - T + 0.5 [K/W]*(P + hum);
end Winding;

experiment warm of Winding
  measure Celsius hot = last(T);
  budget current(P = 0), iron(hum = 0);
  solve auto(rtol = 1e-8) stop 300 [s];
end warm;
"#;

/// A share of a temperature is a difference, in K: 30 K, not -243 degC.
#[test]
fn shares_of_a_temperature_are_differences() {
    let folder = Folder::new();
    let output = hyde(&["budget", &folder.file("warm.hyde", WARM)]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let printed = text(&output);
    for (name, shown) in [
        ("hot", "hot = 65 degC"),
        ("current", " 30 K "),
        ("iron", " 15 K "),
        ("left", " 20 degC "),
    ] {
        let line = printed.lines().find(|line| line.trim().starts_with(name));
        assert!(line.unwrap().contains(shown), "{printed}");
    }
}

#[test]
fn what_a_budget_lacks_or_cannot_have_is_told() {
    let folder = Folder::new();
    let model = folder.file("pulled.hyde", PULLED);
    let output = hyde(&["budget", &model, "--set", "guide.F=30 [N]"]);
    assert_eq!(status(&output), 2);
    assert!(errors(&output).contains("`rubbing`"), "{}", errors(&output));
    let lag = folder.file("lag.hyde", LAG);
    let output = hyde(&["budget", &lag]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("has no `budget`"),
        "{}",
        errors(&output)
    );
    let without = PULLED.replace("  measure Length way = last(table.s);\n", "");
    let without = folder.file(
        "without.hyde",
        &without.replace("package pulled", "package without"),
    );
    let output = hyde(&["budget", &without]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("has no `measure`"),
        "{}",
        errors(&output)
    );
    // A mistake in the budget is one of the file: `check` finds it.
    let wrong = PULLED
        .replace("guide.F = 0", "guide.Fc = 0")
        .replace("package pulled", "package wrong");
    let wrong = folder.file("wrong.hyde", &wrong);
    let output = hyde(&["check", &wrong]);
    assert_eq!(status(&output), 1);
    assert!(errors(&output).contains("E0402"), "{}", errors(&output));
}

#[test]
fn a_run_leaves_the_figures_asked_for_and_tells_forces() {
    let folder = Folder::new();
    let model = folder.file("pulled.hyde", PULLED);
    let out = folder.path("out");
    let output = hyde(&["run", &model, "--forces", "--json", "--out", &out]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let names = folder.names("out");
    for name in ["way", "line", "contour"] {
        for ending in ["svg", "png"] {
            assert!(names.contains(&format!("{name}.{ending}")), "{names:?}");
        }
    }
    let figure = read(&folder.path("out/way.svg"));
    for word in ["the way", "table.s [mm]", "drive.F", "spring.F"] {
        assert!(figure.contains(word), "{word}");
    }
    assert!(read(&folder.path("out/contour.svg")).contains("magnified"));
    assert!(read(&folder.path("out/report.html")).contains("Forces between components"));
    let value: Value = serde_json::from_str(&text(&output)).unwrap();
    let forces = value["forces"].as_array().unwrap();
    let of = |name: &str| {
        forces
            .iter()
            .find(|line| line["connection"] == name)
            .unwrap()
    };
    // Into the drive goes what it gives, with the other sign: a ramp from 0 to 100 N, whose rms is 100/sqrt(3).
    let drive = of("into drive.a");
    let number = |line: &Value, key: &str| line[key].as_f64().unwrap();
    assert!((number(drive, "least") + 100.0).abs() < 1e-6);
    // The trapezoidal rule on a thousand rows.
    assert!((number(drive, "rms") - 100.0 / 3f64.sqrt()).abs() < 1e-3);
    // Of two that are joined one line: into the wall goes what is left of 100 N by 20 N and by 400 N.s/m at 10 mm/s.
    assert!((number(of("spring.b to wall.a"), "most") - 76.0).abs() < 1e-3); // tolerance of the run
}

#[test]
fn responses_of_several_experiments_are_drawn_together() {
    let folder = Folder::new();
    let out = folder.path("bode");
    let axis = "examples/screw_waves/axis.hyde";
    let output = hyde(&[
        "bode", axis, "waves", "--with", "rigid", "--linear", "--points", "60", "--out", &out,
    ]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    assert!(text(&output).contains("motor.w: rigid is more than 3 dB from waves over"));
    let figure = std::fs::read_to_string(folder.path("bode/bode-motor.w.svg")).unwrap();
    assert!(figure.contains("waves, linearised") && figure.contains("rigid, linearised"));
    assert!(figure.contains("Screw of 1 m as a field"));
}

#[test]
fn a_stepped_sine_tells_where_an_expectation_does_not_hold() {
    let folder = Folder::new();
    let out = folder.path("bode");
    let output = hyde(&["bode", "tests/models/stepped.hyde", "plain", "--out", &out]);
    assert_eq!(status(&output), 4, "{}", errors(&output));
    let said = text(&output);
    assert!(
        said.contains("expect a cube of less than 7: DOES NOT HOLD at 1 Hz"),
        "{said}"
    );
    assert!(said.contains("peak = 8 .. 8"), "{said}");
    let numbers = std::fs::read_to_string(folder.path("bode/bode-y.csv")).unwrap();
    let stepped = numbers
        .lines()
        .filter(|line| line.starts_with("plain,stepped,"));
    assert_eq!(stepped.count(), 4);
    // What does not move is said to, and 0.2 s to settle are enough to know it.
    let stuck = text(&hyde(&["bode", "tests/models/stepped.hyde", "stuck"]));
    assert_eq!(stuck.matches("does not move").count(), 3, "{stuck}");
}

#[test]
fn modes_are_told_over_a_parameter() {
    let folder = Folder::new();
    let out = folder.path("modes");
    let output = hyde(&[
        "modes",
        "examples/screw_waves/axis.hyde",
        "waves",
        "--with",
        "modules",
        "--set",
        "damped=0",
        "--below",
        "200",
        "--over",
        "xn=0.1 .. 0.5 [m]",
        "--points",
        "3",
        "--out",
        &out,
    ]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let numbers = std::fs::read_to_string(folder.path("modes/modes.csv")).unwrap();
    // Two experiments, three places, three modes; at a tenth the known 34.72, 90.22 and 181.26 Hz.
    assert_eq!(numbers.lines().count(), 1 + 2 * 3 * 3);
    assert!(
        text(&output).contains("34.721    90.217    181.26"),
        "{}",
        text(&output)
    );
    let wrong = hyde(&[
        "modes",
        "examples/screw_waves/axis.hyde",
        "waves",
        "--over",
        "xn=0.1",
    ]);
    assert_eq!(status(&wrong), 2);
    assert!(errors(&wrong).contains("write `path=from..to [unit]`"));
}
