//! Calibrations of several records, experiments and models: values per label, weights, what is not determined, profiles.

use crate::command::{Folder, errors, hyde, status, text};
use serde_json::Value;
use std::fmt::Write as _;

const STROKES: &str = r#"
experiment strokes(record file = "empty-1.csv") of Slide
  stimulus F = file.force;
  measured file.pos = s ~ 0.2 [um];
  solve ida(rtol = 1e-6) stop file.end every 1 [ms];
end strokes;
"#;

/// A mass on a viscous guide; `{}` is what its record cannot show.
fn slide(name: &str, mass: &str, inertia: &str) -> String {
    format!(
        "
model {name}
  input Force F;
  parameter Real M = {mass};
  parameter Real b = 400 [N.s/m] ~ ±50%;
  parameter Real motor = 0 [kg] ~ ±2 [kg], spare = 3 [N] ~ ±10%;
  Length s(start = 0);
  Velocity v(start = 0);
equation
  v = der(s);
  ({inertia})*der(v) = F - b*v;
end {name};
"
    )
}

fn head() -> String {
    format!(
        "package loads;\nimport SI.*;\n{}{STROKES}",
        slide("Slide", "100 [kg] ~ ±50%", "M + motor")
    )
}

/// A record of a true mass and friction: the force that moved it, and a position with noise, by small steps of Runge and Kutta.
fn record(mass: f64, friction: f64, noise: f64, seed: u64) -> String {
    let force = |t: f64| {
        let jump = if (t * 3.0) as usize % 2 == 1 {
            150.0
        } else {
            -150.0
        };
        300.0 * (8.17 * t).sin() + 200.0 * (25.8 * t + 0.5).sin() + jump
    };
    let mut state = seed;
    let mut uniform = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut csv = "t [s],force [N],pos [m]\n".to_owned();
    let (mut s, mut v, step) = (0.0, 0.0, 1e-3);
    for row in 0..2000 {
        let (from, to) = (
            force(f64::from(row) * step),
            force(f64::from(row + 1) * step),
        );
        let random: f64 = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        let _ = writeln!(
            csv,
            "{:.3},{from:.9e},{:.9e}",
            f64::from(row) * step,
            s + noise * random
        );
        for part in 0..10 {
            let h = step / 10.0;
            let rate = |v: f64, along: f64| {
                (from + (to - from) * (f64::from(part) + along) / 10.0 - friction * v) / mass
            };
            let a1 = rate(v, 0.0);
            let a2 = rate(v + h / 2.0 * a1, 0.5);
            let a3 = rate(v + h / 2.0 * a2, 0.5);
            let a4 = rate(v + h * a3, 1.0);
            s += h * v + h * h / 6.0 * (a1 + a2 + a3);
            v += h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
        }
    }
    csv
}

/// Records of 80 kg and 140 kg on one friction of 500 N.s/m, two of each.
fn records(folder: &Folder) {
    for (name, mass, seed) in [
        ("empty-1.csv", 80.0, 1),
        ("empty-2.csv", 80.0, 2),
        ("full-1.csv", 140.0, 3),
        ("full-2.csv", 140.0, 4),
    ] {
        folder.file(name, &record(mass, 500.0, 2e-7, seed));
    }
}

fn json(line: &[&str]) -> Value {
    let output = hyde(line);
    assert_eq!(status(&output), 0, "{}{}", errors(&output), text(&output));
    serde_json::from_str(&text(&output)).unwrap()
}

/// The parameter of a name, and of a value of a label.
fn parameter<'v>(report: &'v Value, name: &str, at: Option<&str>) -> &'v Value {
    let mut all = report["parameters"].as_array().unwrap().iter();
    let has = |own: &&Value| {
        let label = own["at"].as_object().and_then(|at| at.values().next());
        own["name"] == name && label.and_then(Value::as_str) == at
    };
    all.find(has).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn holds(parameter: &Value, truth: f64) {
    let (low, high) = (
        number(&parameter["interval"][0]),
        number(&parameter["interval"][1]),
    );
    assert!(low < truth && truth < high, "{parameter}");
    assert!(high - low < 0.01 * truth, "{parameter}");
}

#[test]
fn two_loads_have_a_mass_each_and_one_friction() {
    let folder = Folder::new();
    records(&folder);
    let block = r#"
calibrate trial of Slide
  fit strokes("empty-1.csv") at load = 0 [kg];
  fit strokes("full-1.csv") at load = 60 [kg];
  holdout strokes("empty-2.csv") at load = 0 [kg];
  holdout strokes("full-2.csv") at load = 60000 [g];
  vary b, M per load;
end trial;
"#;
    let file = folder.file("loads.hyde", &format!("{}{block}", head()));
    let out = folder.path("found");
    let report = json(&["fit", &file, "--json", "--out", &out]);
    holds(parameter(&report, "M", Some("0 kg")), 80.0);
    holds(parameter(&report, "M", Some("60 kg")), 140.0);
    holds(parameter(&report, "b", None), 500.0);
    let records = report["records"].as_array().unwrap();
    assert_eq!(records.len(), 4);
    for own in records {
        let chi = number(&own["chi"]["after"]);
        assert!((0.7..1.3).contains(&chi), "{own}");
        assert_eq!(
            own["holdout"],
            own["record"].as_str().unwrap().ends_with("2.csv")
        );
    }
    // What it leaves compiles: shared values below, one model for each load on top.
    let left = std::fs::read_to_string(folder.path("found/Slide_fitted.hyde")).unwrap();
    let run = r#"
experiment still of Slide_fitted_load_60_kg
  stimulus F = 500 [N];
  measure Velocity v_end = last(v);
  expect abs(last(v) - 1 [m/s]) < 2 [mm/s];
  expect abs(last(s) - (3 - 0.28)*1 [m]) < 5 [mm];
  stop 3 [s] every 10 [ms];
end still;
"#;
    let left = folder.file("left.hyde", &format!("{left}{run}"));
    let ran = hyde(&["run", &left, "still"]);
    assert_eq!(status(&ran), 0, "{}{}", errors(&ran), text(&ran));
    crate::readable_pages::is_readable(&folder.path("found/fit.html"));
    let page = std::fs::read_to_string(folder.path("found/fit.html")).unwrap();
    assert!(page.contains("M at load = 60 kg") && page.contains("<svg"));
    assert!(
        folder
            .names("found")
            .contains(&"correlation.svg".to_owned())
    );
    let printed = text(&hyde(&["fit", &file, "--correlation"]));
    for line in ["  M per load", "    60 kg  ", "  3 M at load = 60 kg"] {
        assert!(printed.contains(line), "{line}: {printed}");
    }
    assert!(
        printed.lines().all(|line| line.chars().count() <= 80),
        "{printed}"
    );
}

#[test]
fn experiments_of_two_models_share_a_friction_and_weigh_by_their_noise() {
    let folder = Folder::new();
    folder.file("fine.csv", &record(80.0, 500.0, 2e-6, 5));
    folder.file("coarse.csv", &record(140.0, 500.0, 4e-5, 6));
    let experiment = |name: &str, model: &str, noise: &str| {
        format!(
            "
experiment {name}(record file = \"{name}.csv\") of {model}
  stimulus F = file.force;
  measured file.pos = s ~ {noise};
  solve ida(rtol = 1e-6) stop file.end every 1 [ms];
end {name};
"
        )
    };
    let text_of = [
        "package both;\nimport SI.*;\n".to_owned(),
        slide("Slide", "80 [kg]", "M"),
        slide("Bench", "70 [kg]", "2*M"),
        experiment("fine", "Slide", "2 [um]"),
        experiment("coarse", "Bench", "40 [um]"),
        "calibrate one of Slide\n  fit fine;\n  vary b in 1 .. 5000 [N.s/m];\nend one;\n".to_owned(),
        "calibrate other of Bench\n  fit coarse;\n  vary b in 1 .. 5000 [N.s/m];\nend other;\n".to_owned(),
        "calibrate both of Slide, Bench\n  fit fine, coarse;\n  vary b in 1 .. 5000 [N.s/m];\nend both;\n".to_owned(),
        "calibrate apart of Slide, Bench\n  fit fine, coarse;\n  vary b in 1 .. 5000 [N.s/m] per experiment;\nend apart;\n".to_owned(),
    ];
    let file = folder.file("both.hyde", &text_of.concat());
    let found = |name: &str, at| {
        let report = json(&["fit", &file, name, "--json"]);
        let own = parameter(&report, "b", at);
        (number(&own["value"]), number(&own["deviation"]))
    };
    let (one, other) = (found("one", None), found("other", None));
    let both = found("both", None);
    // The prior of a spread is in all three; it is far wider than what the records tell.
    let weights = (one.1.powi(-2), other.1.powi(-2));
    let mean = (one.0 * weights.0 + other.0 * weights.1) / (weights.0 + weights.1);
    let deviation = (weights.0 + weights.1).powf(-0.5);
    assert!(
        (both.0 - mean).abs() < 0.3 * deviation,
        "{both:?} {mean} {deviation}"
    );
    assert!(
        (both.1 / deviation - 1.0).abs() < 0.3,
        "{both:?} {deviation}"
    );
    assert!(other.1 > 1.5 * one.1, "{one:?} {other:?}");
    // With a value each, nothing is shared.
    let own = found("apart", Some("coarse"));
    assert!((own.0 - other.0).abs() < 0.1 * other.1, "{own:?} {other:?}");
    let report = json(&["fit", &file, "both", "--json"]);
    assert_eq!(report["experiments"][1]["model"], "Bench");
    assert_eq!(report["experiments"][1]["noise"][0]["noise"], 4e-5);
    let printed = text(&hyde(&["fit", &file, "both"]));
    assert!(printed.contains("experiment coarse of Bench"), "{printed}");
    assert!(
        printed.contains("2 um") && printed.contains("40 um"),
        "{printed}"
    );
}

#[test]
fn what_no_record_moves_and_what_moves_only_together_is_told_before_the_fit() {
    let folder = Folder::new();
    records(&folder);
    let block = "
calibrate alone of Slide
  fit strokes;
  vary uncertain;
end alone;
";
    let file = folder.file("loads.hyde", &format!("{}{block}", head()));
    let report = json(&["fit", &file, "--json"]);
    let told = &report["identifiability"];
    assert_eq!(told["no_effect"], serde_json::json!(["spare"]));
    assert_eq!(
        told["together"],
        serde_json::json!([{ "parameters": ["M", "motor"], "combinations": 1 }])
    );
    // The sum is found; what is known beforehand divides it.
    let sum = number(&parameter(&report, "M", None)["value"])
        + number(&parameter(&report, "motor", None)["value"]);
    assert!((sum - 80.0).abs() < 0.1, "{sum}");
    let printed = text(&hyde(&["fit", &file]));
    let (before, after) = printed.split_once("alone of Slide").unwrap();
    assert!(before.starts_with("before the fit, alone:"), "{printed}");
    assert!(
        before.contains("no record depends on `spare`") && after.contains("NO EFFECT"),
        "{printed}"
    );
    // Records that determine all say nothing.
    let clear = folder.file(
        "clear.hyde",
        &format!("{}{}", head(), block.replace("uncertain", "M, b")),
    );
    let clear_text = text(&hyde(&["fit", &clear]));
    assert!(!clear_text.contains("before the fit") && !clear_text.contains("to its end"));
    // A stop before the end of the record is none for the observer.
    let short = std::fs::read_to_string(&clear).unwrap();
    let short = folder.file(
        "short.hyde",
        &short.replace("stop file.end", "stop 0.5 [s]"),
    );
    let told = text(&hyde(&["fit", &short]));
    let note = "counts to its end at 1.999 s: the stop of `strokes` at 0.5 s bounds its runs alone";
    let words: Vec<&str> = told.split_whitespace().collect();
    assert!(words.join(" ").contains(note), "{told}");
}

#[test]
fn a_profile_is_a_parabola_where_the_model_is_linear_and_follows_a_change_of_variable_where_it_is_not()
 {
    let folder = Folder::new();
    records(&folder);
    let block = "
calibrate alone of Slide
  fit strokes;
  vary M in 1 .. 1000 [kg], b in 1 .. 5000 [N.s/m];
end alone;
";
    let file = folder.file("loads.hyde", &format!("{}{block}", head()));
    let report = json(&["fit", &file, "--json", "--profile", "M"]);
    let own = parameter(&report, "M", None);
    let profile = &report["profiles"][0];
    let (low, high) = (
        number(&profile["interval"][0]),
        number(&profile["interval"][1]),
    );
    let half = 1.96 * number(&own["deviation"]);
    for (end, at) in [(low, -half), (high, half)] {
        let away = end - number(&own["value"]);
        // The interval of the curvature is also as wide as gradients scatter from second to second.
        assert!((away / at - 1.0).abs() < 0.3, "{away} {at}");
    }
    // So much noise that 1/M is anything but normal: the interval of M is that of c = 1/M all the same.
    folder.file("noisy.csv", &record(80.0, 500.0, 6e-2, 9));
    let noisy = |mass: &str, name: &str, bounds: &str| {
        let text = format!(
            "package noisy;\nimport SI.*;\nmodel Slide
  input Force F;
  parameter Real {name} = {mass};
  parameter Real b = 500 [N.s/m];
  Length s(start = 0);
  Velocity v(start = 0);
equation
  v = der(s);
  {} = F - b*v;
end Slide;
{}
calibrate noisy of Slide
  fit strokes;
  vary {name} in {bounds};
end noisy;
",
            if name == "c" { "der(v)/c" } else { "M*der(v)" },
            STROKES
                .replace("empty-1", "noisy")
                .replace("0.2 [um]", "60 [mm]"),
        );
        let file = folder.file(&format!("{name}.hyde"), &text);
        let out = folder.path(&format!("out-{name}"));
        let report = json(&["fit", &file, "--json", "--profile", name, "--out", &out]);
        let value = number(&report["parameters"][0]["value"]);
        let profile = report["profiles"][0]["interval"].clone();
        assert!(
            folder
                .names(&format!("out-{name}"))
                .contains(&format!("profile-{name}.svg"))
        );
        (number(&profile[0]), value, number(&profile[1]))
    };
    let mass = noisy("80 [kg]", "M", "1 .. 1000 [kg]");
    let compliance = noisy("0.0125 [1/kg]", "c", "0.001 .. 1 [1/kg]");
    let skew = (compliance.2 - compliance.1) / (compliance.1 - compliance.0);
    assert!(skew > 1.1, "{compliance:?}");
    for (own, other) in [(mass.0, compliance.2), (mass.2, compliance.0)] {
        assert!((own * other - 1.0).abs() < 0.03, "{mass:?} {compliance:?}");
    }
    let refused = hyde(&["fit", &file, "--profile", "mass"]);
    assert_eq!(status(&refused), 2);
    assert!(
        errors(&refused).contains("it varies `M`, `b`"),
        "{}",
        errors(&refused)
    );
}

#[test]
fn what_cannot_be_is_refused_with_what_to_write() {
    let folder = Folder::new();
    records(&folder);
    let two = "fit strokes(\"empty-1.csv\") at load = 0 [kg];\n  fit strokes(\"full-1.csv\") at load = 60 [kg];";
    let other = STROKES
        .replace("strokes", "bench")
        .replace("Slide", "Bench");
    let other = format!("{}{other}", slide("Bench", "70 [kg]", "M"));
    for (of, items, message, help) in [
        (
            "Slide",
            "fit strokes(\"empty-1.csv\") at load = 0 [kg];\n  fit strokes(\"full-1.csv\");\n  vary b, M per load;".to_owned(),
            "`full-1.csv` has no `load`",
            "at load = 200 [kg]",
        ),
        (
            "Slide",
            format!("{two}\n  vary b, M per laod;"),
            "no records have a label `laod`",
            "this calibration has `per load`, `per record`",
        ),
        (
            "Slide",
            "fit strokes(\"*-1.csv\") at load = 0 [kg];\n  vary b, M per load;".to_owned(),
            "all records have the same, `0 kg`",
            "leave `per load` out",
        ),
        (
            "Slide",
            format!("{two}\n  holdout strokes(\"full-2.csv\") at load = 61 [kg];\n  vary b, M per load;"),
            "no fitted record has `61 kg`",
            "that is fitted",
        ),
        (
            "Slide",
            "fit strokes(\"*-1.csv\");\n  holdout strokes(\"*-2.csv\");\n  vary b, M per record;".to_owned(),
            "`empty-2.csv` is held out",
            "per load",
        ),
        (
            "Slide",
            "fit strokes(\"*-1.csv\"), strokes(\"empty-1.csv\");\n  vary b, M;".to_owned(),
            "`empty-1.csv` of `strokes` is named twice",
            "in one `fit` only",
        ),
        (
            "Slide",
            format!("{}\n  vary b, M per load;", two.replace("60 [kg]", "\"full\"")),
            "`full` here and `0 kg` elsewhere",
            "units of one kind",
        ),
        (
            "Slide",
            format!("{two}\n  vary uncertain per load;"),
            "`uncertain` stands for many parameters",
            "vary uncertain; vary saddle.M per load;",
        ),
        (
            "Slide",
            "fit strokes(\"*-1.csv\") at record = 1;\n  vary M;".to_owned(),
            "every record has its own value of `record`",
            "per record",
        ),
        (
            "Slide",
            "fit strokes, bench(\"full-1.csv\");\n  vary b, M;".to_owned(),
            "`bench` is an experiment of `Bench`, the calibration is of `Slide`",
            "calibrate trial of Slide, Bench",
        ),
        (
            "Slide, Bench",
            "fit strokes;\n  vary b, M;".to_owned(),
            "no record of the calibration is of the model `Bench`",
            "records of an experiment of each",
        ),
        (
            "Slide, Bench",
            "fit strokes, bench(\"full-1.csv\");\n  vary b, mass;".to_owned(),
            "`mass` cannot be varied",
            "hyde params",
        ),
    ] {
        let block = format!("calibrate trial of {of}\n  {items}\nend trial;\n");
        let file = folder.file("loads.hyde", &format!("{}{other}{block}", head()));
        let output = hyde(&["fit", &file]);
        let said = errors(&output);
        assert_eq!(status(&output), 1, "{items}: {said}");
        assert_eq!(said.matches("error[").count(), 1, "{said}");
        for part in [message, help] {
            assert!(said.contains(part), "{part}: {said}");
        }
    }
}

#[test]
fn a_diagnosis_takes_a_calibration_of_one_experiment() {
    let folder = Folder::new();
    records(&folder);
    let block = "
calibrate trial of Slide
  fit strokes(\"*-1.csv\");
  vary b, M per record;
end trial;

diagnose trial of calibrate trial
  candidates Effects.*;
end trial;
";
    let file = folder.file("loads.hyde", &format!("{}{block}", head()));
    let output = hyde(&["diagnose", &file]);
    assert_eq!(status(&output), 1, "{}", errors(&output));
    assert!(
        errors(&output).contains("without `per`"),
        "{}",
        errors(&output)
    );
}
