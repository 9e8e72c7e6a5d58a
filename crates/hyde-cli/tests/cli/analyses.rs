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
