//! Signals to record: files that Hyde reads back, limits that bind, assumptions.

use crate::command::{Folder, errors, hyde, read, status, text};
use serde_json::Value;

fn json(line: &[&str]) -> Value {
    let output = hyde(line);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    serde_json::from_str(&text(&output)).unwrap()
}

#[test]
fn what_is_written_is_a_record_that_hyde_look_reads_back() {
    let folder = Folder::new();
    let line = ["excite", "--signal", "jogs", "--travel", "300mm", "--out"];
    let csv = folder.path("next.csv");
    assert_eq!(status(&hyde(&[&line[..], &[&csv]].concat())), 0);
    assert!(read(&csv).starts_with("t [s],r [mm]\n0,0\n0.001,"));
    let looked = &json(&["look", &csv, "--json"])["files"][0];
    assert_eq!(looked["clocks"][0]["samples"], 20_001);
    let step_s = looked["clocks"][0]["step_s"].as_f64().unwrap();
    assert!((step_s - 0.001).abs() < 1e-9, "{step_s}");
    let channel = &looked["channels"][0];
    assert_eq!(
        (&channel["name"], &channel["unit"]),
        (&"r".into(), &"mm".into())
    );
    let most = channel["max"].as_f64().unwrap();
    assert!((80.0..=150.0).contains(&most), "{most}");
    // The same as set points, with the speed beside it: by differences it is the slope.
    let points = folder.path("points.csv");
    let line = [&line[..], &[&points, "--format", "twincat"]].concat();
    assert_eq!(status(&hyde(&line)), 0);
    let looked = &json(&["look", &points, "--json"])["files"][0];
    let speed = &looked["channels"][1];
    assert_eq!(
        (&speed["name"], &speed["unit"]),
        (&"Velocity".into(), &"mm/s".into())
    );
    let most = speed["max"].as_f64().unwrap();
    assert!((99.0..=100.0).contains(&most), "{most}");
}

#[test]
fn g_code_has_the_moves_and_says_what_the_controller_changes() {
    let folder = Folder::new();
    let path = folder.path("next.nc");
    let line = [
        "excite", "--signal", "jogs", "--travel", "300 [mm]", "--start", "200 [mm]", "--axis", "y",
        "--out", &path,
    ];
    assert_eq!(status(&hyde(&line)), 0);
    let code = read(&path);
    assert!(
        code.contains("Acceleration and jerk\n; are those of the controller"),
        "{code}"
    );
    let moves: Vec<(f64, f64)> = code
        .lines()
        .filter_map(|line| {
            let (place, feed) = line.strip_prefix("G1 Y")?.split_once(" F")?;
            Some((place.parse().unwrap(), feed.parse().unwrap()))
        })
        .collect();
    assert_eq!(moves.len(), 15);
    for (place, feed) in &moves {
        assert!((50.0..=350.0).contains(place) && *feed <= 6000.0, "{code}");
    }
    assert_eq!(moves[14].0, 200.0);
    // A multisine is points at inverse time: no block is faster than the limit.
    let line = [
        "excite",
        "--signal",
        "multisine",
        "--band",
        "1..20Hz",
        "--out",
        &path,
    ];
    assert_eq!(status(&hyde(&line)), 0);
    let code = read(&path);
    assert!(
        code.contains("G93") && code.contains("One block every 10 ms"),
        "{code}"
    );
    let (mut last, mut fastest) = (0.0, 0.0_f64);
    for line in code.lines().filter_map(|line| line.strip_prefix("G1 X")) {
        let (place, rate) = line.split_once(" F").unwrap();
        let (place, rate): (f64, f64) = (place.parse().unwrap(), rate.parse().unwrap());
        fastest = fastest.max((place - last).abs() * rate);
        last = place;
    }
    assert!(fastest > 500.0 && fastest <= 6000.0, "{fastest} mm/min");
    assert_eq!(last, 0.0);
    // A current is nothing that a controller moves to.
    let line = [
        "excite",
        "--signal",
        "chirp",
        "--current",
        "5 [A]",
        "--out",
        &path,
    ];
    let output = hyde(&line);
    assert_eq!(status(&output), 2);
    assert!(
        errors(&output).contains("--format csv"),
        "{}",
        errors(&output)
    );
}

#[test]
fn each_limit_that_is_assumed_is_reported() {
    let line = [
        "excite",
        "--signal",
        "reversals",
        "--travel",
        "90deg",
        "--speed",
        "2 [rad/s]",
        "--json",
    ];
    let found = json(&line);
    let assumed: Vec<&str> = found["assumed"]
        .as_array()
        .unwrap()
        .iter()
        .map(|own| own.as_str().unwrap())
        .collect();
    assert_eq!(
        assumed,
        [
            "--acceleration '900 [deg/s2]'",
            "--jerk '45000 [deg/s3]'",
            "--duration '20 [s]'",
            "--every '1 [ms]'",
            "--reversal '0.09 [deg]'",
            "--start '0 [deg]'"
        ]
    );
    for limit in found["limits"].as_array().unwrap() {
        let part = limit["reached"].as_f64().unwrap() / limit["limit"].as_f64().unwrap();
        assert!(part <= 1.0, "{limit}");
    }
    let output = hyde(&line[..7]);
    let told = text(&output);
    assert!(told.contains("--jerk '45000 [deg/s3]'"), "{told}");
    assert!(
        told.lines().all(|line| line.chars().count() <= 80),
        "{told}"
    );
}

#[test]
fn an_impossible_limit_is_named_with_the_option_to_change() {
    let refused = |options: &[&str]| {
        let output = hyde(&[&["excite", "--signal"], options].concat());
        assert_eq!(status(&output), 2);
        errors(&output)
    };
    let short = refused(&["jogs", "--duration", "3 [s]"]);
    assert!(short.contains("help: write `--duration '"), "{short}");
    // The advice is true.
    let duration = short.split("--duration '").nth(1).unwrap();
    let duration = duration.split('\'').next().unwrap();
    let line = ["excite", "--signal", "jogs", "--duration", duration];
    assert_eq!(status(&hyde(&line)), 0);
    let high = refused(&["chirp", "--band", "1 .. 300 [Hz]"]);
    assert!(
        high.contains("up to 200 Hz") && high.contains("--every '0.66 [ms]'"),
        "{high}"
    );
    let mixed = refused(&["jogs", "--travel", "300 [mm]", "--speed", "3 [rad/s]"]);
    assert!(
        mixed.contains("`--travel` is of an axis that slides"),
        "{mixed}"
    );
    let unit = refused(&["jogs", "--travel", "300 [kg]"]);
    assert!(unit.contains("'10 [mm]' or '10 [deg]'"), "{unit}");
    let both = refused(&["jogs", "--travel", "300 [mm]", "--current", "3 [A]"]);
    assert!(both.contains("cannot be used with"), "{both}");
}
