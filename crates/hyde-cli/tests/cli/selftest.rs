//! Effects planted in simulated records of a small axis, and what its diagnosis makes of them: a sample of what
//! `./dev long` does in full.

use crate::command::{Folder, errors, hyde, read, status, text};
use serde_json::Value;

const AXIS: &str = "tests/models/small_axis/axis.hyde";
const RACK: &str = "tests/models/rack_axis/axis.hyde";

fn tested(arguments: &[&str]) -> String {
    tested_by("quick", arguments)
}

fn tested_by(diagnosis: &str, arguments: &[&str]) -> String {
    let output = hyde(&[&["selftest", AXIS, diagnosis], arguments].concat());
    assert_eq!(status(&output), 0, "{}", errors(&output));
    text(&output)
}

/// Innovations of a play are rough where an observer does not hold the axis within it: a fit ended at 5 mrad of 6.
#[test]
fn a_play_is_found_as_large_as_it_is() {
    let output = hyde(&[
        "selftest",
        RACK,
        "quick",
        "--only",
        "planted",
        "--sizes",
        "0.5",
        "--effects",
        "CouplingBacklash",
        "--seed",
        "1",
        "--json",
    ]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let report = json(&text(&output));
    let case = &report["cases"][0];
    assert_eq!(case["right"], true, "{report:#}");
    let number = |value: &Value| value.as_f64().unwrap();
    let [low, high] = [0, 1].map(|end| number(&case["effects"][0]["interval"][end]));
    let size = number(&case["size"]);
    assert!((low..=high).contains(&size), "{case:#}");
    assert!(high - low < 0.05 * size, "{case:#}");
}

fn json(printed: &str) -> Value {
    serde_json::from_str(printed).unwrap()
}

/// An effect, a twentieth of its range large, is named first where all are searched for.
fn assert_found(effect: &str) {
    let wanted = ["--only", "planted", "--seed", "1", "--sizes", "0.05"];
    let report = [&wanted[..], &["--json", "--effects", effect]].concat();
    let report = json(&tested_by("moves", &report));
    assert_eq!(report["planted"][0]["right"], 1, "{report:#}");
}

#[test]
fn planted_effects_are_found_and_nothing_where_nothing_is() {
    // Friction and a force; at a twentieth of their ranges they show clearly.
    let wanted = "Stribeck,Pull";
    let only = [
        "--only",
        "planted,empty",
        "--sizes",
        "0.05",
        "--empties",
        "1",
        "--effects",
        wanted,
    ];
    let folder = Folder::new();
    let out = folder.path("kept");
    let report = json(&tested(&[&only[..], &["--out", &out, "--json"]].concat()));
    assert_eq!(
        report["controls"]["empty"],
        serde_json::json!({ "cases": 1, "right": 1 })
    );
    let rows = report["planted"].as_array().unwrap();
    assert_eq!(rows.len(), 2);
    for row in rows {
        let effect = row["planted"]["effect"].as_str().unwrap();
        assert_eq!(
            (&row["visible"], &row["right"]),
            (&1.into(), &1.into()),
            "{row:#}"
        );
        // The sizes are those planted: 15 % is what a diagnosis promises.
        let ratio = row["size_found_over_planted"][0].as_f64().unwrap();
        assert!((ratio - 1.0).abs() < 0.15, "{effect}: {ratio}");
    }
    // Nothing is done again, and what is kept says the same.
    let again = tested(&[&only[..], &["--out", &out, "--json"]].concat());
    assert_eq!(json(&again), report);
    let printed = tested(&[&only[..], &["--out", &out]].concat());
    assert!(printed.contains("ranked first: 2 of 2"), "{printed}");
    assert!(
        printed.lines().all(|line| line.chars().count() <= 80),
        "{printed}"
    );
}

#[test]
fn an_effect_among_many_that_are_alike_is_fitted_as_well() {
    // Most of what pushes the saddle or turns the screw gains nearly all of what the planted one does, and more of them
    // than a round fits at first.
    assert_found("Counterbalance");
}

/// Beside a drag so steep at rest slopes along a run grow out of all numbers: runs are compared there.
#[test]
fn a_steep_power_of_the_speed_is_found() {
    assert_found("PowerDrag");
}

#[test]
fn a_report_is_the_same_from_any_number_of_threads_and_however_often_it_began_anew() {
    let kinds = ["--only", "empty", "--seed", "7", "--json", "--empties"];
    let folder = Folder::new();
    let out = folder.path("kept");
    // One case first, then the other: as if the first run had been interrupted.
    let first = json(&tested(&[&kinds[..], &["1", "--out", &out]].concat()));
    assert_eq!(first["cases"].as_array().unwrap().len(), 1);
    let resumed = tested(&[&kinds[..], &["2", "--jobs", "1", "--out", &out]].concat());
    let direct = tested(&[&kinds[..], &["2", "--jobs", "3"]].concat());
    assert_eq!(resumed, direct);
}

#[test]
fn the_records_of_a_case_are_what_its_diagnosis_reads() {
    let folder = Folder::new();
    let out = folder.path("records");
    let case = "planted Pull@saddle.a 0.05 1";
    tested(&[
        "--only", "planted", "--sizes", "0.05", "--case", case, "--out", &out,
    ]);
    let output = hyde(&["diagnose", AXIS, "quick", "--data", &out, "--json"]);
    let found = json(&text(&output));
    assert_eq!(found["verdict"], "effect", "{found:#}");
    assert_eq!(found["effects"][0]["effect"], "Pull");
    // A twentieth of 1 kN, either way.
    let size = found["effects"][0]["size"].as_f64().unwrap();
    assert!((size.abs() - 50.0).abs() < 5.0, "{size}");
}

/// A folder with the small axis and a diagnosis of a few effects.
fn with_candidates(axis: &str, candidates: &str) -> Folder {
    let folder = Folder::new();
    let model = read(axis);
    let (above, _) = model.split_once("diagnose quick").unwrap();
    let few = format!(
        "diagnose few of calibrate moves\n  candidates {candidates};\n  max_effects 2;\n  seed 1;\nend few;\n"
    );
    folder.file("axis.hyde", &format!("{above}{few}"));
    folder
}

/// The self-test of these effects, a twentieth of their ranges large, on the records of an axis.
fn with_records(axis: &str, folder: &Folder, more: &[&str]) -> Value {
    let file = folder.path("axis.hyde");
    let data = ["--data", axis.trim_end_matches("/axis.hyde")];
    let arguments = ["selftest", &file, "few", "--sizes", "0.05", "--json"];
    let output = hyde(&[&arguments[..], &data, more].concat());
    assert_eq!(status(&output), 0, "{}", errors(&output));
    json(&text(&output))
}

/// With an exponent of 0.5 a drag with a power of the speed is the square root: it is named where the other one is not known,
/// and is no alternative where it is.
#[test]
fn an_effect_that_repeats_a_simpler_one_is_no_alternative() {
    let folder = with_candidates(AXIS, "Effects.SqrtDrag, Effects.PowerDrag");
    let report = with_records(
        AXIS,
        &folder,
        &["--only", "planted,unknown", "--effects", "SqrtDrag"],
    );
    let [withheld, planted] = [0, 1].map(|number| &report["cases"][number]);
    let named = |effect: &str, relation: Option<&str>| {
        let mut named = serde_json::json!({ "effect": effect, "site": "guide" });
        if let Some(relation) = relation {
            named["relation"] = relation.into();
        }
        named
    };
    assert_eq!(planted["verdict"], "effect", "{report:#}");
    let [found] = planted["effects"].as_array().unwrap().as_slice() else {
        panic!("{report:#}");
    };
    assert_eq!(found["claimed"], named("SqrtDrag", None));
    assert_eq!(found["one_of"], serde_json::json!([]));
    let repeats = named("PowerDrag", Some("repeats"));
    assert_eq!(found["equivalents"], serde_json::json!([repeats]));
    assert_eq!(withheld["effects"][0]["claimed"], named("PowerDrag", None));
    assert_eq!(withheld["equivalent"], true, "{report:#}");
    let right = serde_json::json!({ "cases": 1, "right": 1 });
    assert_eq!(report["controls"]["unknown"], right);
    assert_eq!(report["controls"]["unknown_equivalents"], 1);
}

/// A stiff screw moves both its ends alike, a belt does not.
#[test]
fn an_effect_at_places_that_move_together_is_one() {
    let folder = with_candidates(AXIS, "Effects.ShaftFadingViscous");
    let report = with_records(AXIS, &folder, &["--only", "planted"]);
    let cases = report["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 3, "{report:#}");
    for case in cases {
        assert_eq!(case["verdict"], "effect", "{case:#}");
        let found = &case["effects"][0];
        assert_eq!(found["claimed"], case["planted"], "{case:#}");
        let place = |site: &str| serde_json::json!({ "effect": "ShaftFadingViscous", "site": site, "relation": "joined" });
        match case["planted"]["site"].as_str().unwrap() {
            "motor.shaft" => assert_eq!(found["equivalents"], serde_json::json!([])),
            "screw.b" => assert_eq!(found["equivalents"], serde_json::json!([place("pulley.a")])),
            _ => {}
        }
    }
}

/// A folder with the small axis, a record of it at one speed, and a diagnosis of effects that such a record cannot distinguish.
fn at_one_speed() -> Folder {
    let folder = with_candidates(
        AXIS,
        "Effects.Stribeck, Effects.SaturatingDrag, Effects.Tustin",
    );
    let mut record =
        "r [um],i_inj [mA],i_ref [mA],i [mA],phi_m [rev],v_tacho [mV],x [um]\n".to_owned();
    let (mut place, mut speed) = (0.0, 0.0_f64);
    for (wanted, rows) in [
        (0.0, 100),
        (100.0, 500),
        (0.0, 100),
        (-100.0, 500),
        (0.0, 100),
    ] {
        for _ in 0..rows {
            // In um and ms: 2 m/s2 on the way to 100 mm/s.
            speed += (wanted - speed).clamp(-2.0, 2.0);
            place += speed;
            record += &format!("{place:.0},0,0,0,0,0,0\n");
        }
    }
    folder.file("fit-strokes.csv", &record);
    folder.file("validate-strokes.csv", &record);
    folder
}

#[test]
fn a_designed_record_distinguishes_what_the_records_cannot() {
    let folder = at_one_speed();
    let (file, out) = (folder.path("axis.hyde"), folder.path("kept"));
    let arguments = [
        "selftest",
        &file,
        "few",
        "--only",
        "planted",
        "--sizes",
        "0.02",
        "--designed",
        "--travel",
        "100 [mm]",
        "--speed",
        "200 [mm/s]",
        "--acceleration",
        "4 [m/s2]",
        "--jerk",
        "1000 [m/s3]",
        "--duration",
        "5 [s]",
        "--out",
        &out,
    ];
    let run = |more: &[&str]| {
        let output = hyde(&[&arguments[..], more].concat());
        assert_eq!(status(&output), 0, "{}", errors(&output));
        text(&output)
    };
    let report = json(&run(&["--json"]));
    let cases = report["cases"].as_array().unwrap();
    let designed: Vec<&Value> = cases
        .iter()
        .filter(|case| case["verdict"] == "one_of")
        .collect();
    assert!(!designed.is_empty(), "{report:#}");
    for case in &designed {
        let own = &case["designed"];
        // The strokes at several speeds, on which the two are far apart.
        assert_eq!(
            (&own["signal"], &own["resolved"]),
            (&"jogs of `r`".into(), &true.into()),
            "{case:#}"
        );
        assert_eq!(own["effects"][0]["claimed"], case["planted"], "{case:#}");
        assert!(own["apart"].as_f64().unwrap() > 1.0, "{case:#}");
    }
    let others = cases.iter().filter(|case| case["verdict"] != "one_of");
    assert!(
        others.into_iter().all(|case| case["designed"].is_null()),
        "{report:#}"
    );
    assert_eq!(report["designed"]["one_of"], designed.len());
    assert_eq!(report["designed"]["resolved"], designed.len());
    // What is kept says the same, and the table tells it.
    let printed = run(&[]);
    let line = printed
        .lines()
        .find(|line| line.contains("one designed record"));
    let counts = format!("{} of {}", designed.len(), designed.len());
    assert!(line.unwrap().ends_with(&counts), "{printed}");
    assert!(printed.contains("--band '1 .. 100 [Hz]'"), "{printed}");
    assert!(
        printed.lines().all(|line| line.chars().count() <= 80),
        "{printed}"
    );
}

#[test]
fn limits_are_those_of_a_designed_record() {
    let output = hyde(&["selftest", AXIS, "quick", "--travel", "100 [mm]"]);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("add `--designed`"),
        "{}",
        errors(&output)
    );
    // A motion does not fit the column of a current.
    let output = hyde(&["selftest", AXIS, "quick", "--designed", "--column", "i_inj"]);
    assert_eq!(status(&output), 1, "{}", errors(&output));
}

#[test]
fn what_is_asked_wrongly_is_said() {
    for (arguments, told) in [
        (["--sizes", "3"], "`3` is not a size"),
        (["--effects", "Strybeck"], "has no effect `Strybeck`"),
    ] {
        let output = hyde(&[&["selftest", AXIS, "quick"], &arguments[..]].concat());
        assert_eq!(status(&output), 2);
        assert!(errors(&output).contains(told), "{}", errors(&output));
    }
}

/// A pinion turns with its rack: a drag of the table is one of the shaft.
#[test]
fn effects_on_both_sides_of_an_ideal_gear_are_one() {
    let folder = with_candidates(
        RACK,
        "Effects.DirectionalViscous, Effects.ShaftDirectionalViscous",
    );
    let report = with_records(RACK, &folder, &["--only", "planted"]);
    let places = |values: &Value| -> Vec<String> {
        let site = |own: &Value| own["site"].as_str().unwrap().to_owned();
        values.as_array().unwrap().iter().map(site).collect()
    };
    let cases = report["cases"].as_array().unwrap();
    let shown: Vec<&Value> = cases.iter().filter(|case| case["shows"] == true).collect();
    assert!(shown.len() > 2, "{report:#}");
    for case in shown {
        assert_eq!(case["verdict"], "effect", "{case:#}");
        let found = &case["effects"][0];
        let mut all = places(&found["equivalents"]);
        all.push(found["claimed"]["site"].as_str().unwrap().to_owned());
        all.sort();
        match case["planted"]["site"].as_str().unwrap() {
            // A coupling lies between.
            "motor.shaft" => assert_eq!(all, ["motor.shaft"], "{case:#}"),
            _ => assert_eq!(all, ["coupling.b", "table.a"], "{case:#}"),
        }
    }
}

/// A drag with the cube root of the speed is as steep as a wall where the axis rests: tangents grew there by orders of
/// magnitude, and an interval of 0.08 % did not hold its size.
#[test]
fn a_drag_that_is_steepest_at_rest_is_found_as_large_as_it_is() {
    let folder = with_candidates(RACK, "Effects.PowerDrag");
    let report = with_records(RACK, &folder, &["--only", "planted"]);
    let case = &report["cases"][0];
    let number = |value: &Value| value.as_f64().unwrap();
    let [low, high] = [0, 1].map(|end| number(&case["effects"][0]["interval"][end]));
    assert!((low..=high).contains(&number(&case["size"])), "{case:#}");
    assert!(high - low > 0.01 * low, "{case:#}");
}

/// A friction that was taken in beside a body and dropped at the end took the gain of the body's states with it: the interval
/// was a fifth as wide, beside the size.
#[test]
fn a_body_is_as_large_as_it_is_where_an_effect_beside_it_is_dropped() {
    let folder = with_candidates(RACK, "Effects.ShaftBody, Effects.Tustin");
    let planted = ["--only", "planted", "--effects", "ShaftBody"];
    let report = with_records(RACK, &folder, &planted);
    let cases = report["cases"].as_array().unwrap();
    let shown: Vec<&Value> = cases.iter().filter(|case| case["shows"] == true).collect();
    assert!(shown.len() > 1, "{report:#}");
    for case in shown {
        let number = |value: &Value| value.as_f64().unwrap();
        let interval = &case["effects"][0]["interval"];
        let (low, high) = (number(&interval[0]), number(&interval[1]));
        assert!((low..=high).contains(&number(&case["size"])), "{case:#}");
    }
}
