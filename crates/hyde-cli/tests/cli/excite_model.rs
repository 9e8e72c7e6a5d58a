//! Signals chosen by a model: what they promise is what a calibration finds, and what cannot be is refused.

use crate::command::{Folder, errors, hyde, read, rows, status, text};
use serde_json::Value;
use std::fmt::Write as _;

const MODEL: &str = "tests/models/excited.hyde";

fn json(line: &[&str]) -> Value {
    let output = hyde(line);
    assert_eq!(status(&output), 0, "{}{}", errors(&output), text(&output));
    serde_json::from_str(&text(&output)).unwrap()
}

fn deviations(report: &Value) -> Vec<(String, f64)> {
    let parameters = report["parameters"].as_array().unwrap().iter();
    let each = parameters.map(|own| {
        let name = own["name"].as_str().unwrap().to_owned();
        (name, own["deviation"].as_f64().unwrap())
    });
    each.collect()
}

/// Standard normal numbers, the same every time: sums of twelve uniform ones.
fn noise() -> impl FnMut() -> f64 {
    let mut state = 36_u64;
    let mut uniform = move || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    move || (0..12).map(|_| uniform()).sum::<f64>() - 6.0
}

#[test]
fn a_calibration_on_the_designed_record_finds_the_deviations_that_were_promised() {
    let folder = Folder::new();
    let next = folder.path("next.csv");
    let limits = [
        "--travel",
        "200 [mm]",
        "--speed",
        "200 [mm/s]",
        "--acceleration",
        "2 [m/s2]",
    ];
    let line = [
        "excite",
        MODEL,
        "slide",
        "--duration",
        "10 [s]",
        "--band",
        "1 .. 50 [Hz]",
    ];
    let line = [&line[..], &limits, &["--out", &next, "--json"]].concat();
    let promised = json(&line);
    assert_eq!(promised["column"], "r");
    assert!(
        promised["signals"].as_array().unwrap().len() >= 6,
        "{promised:#}"
    );
    // The record is played to the axis, and its sensor adds noise.
    let out = folder.path("played");
    let record = format!("file={next}");
    let line = ["run", MODEL, "played", "--record", &record, "--out", &out];
    let output = hyde(&line);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let results = read(&format!("{out}/results.csv"));
    let header: Vec<&str> = results.lines().next().unwrap().split(',').collect();
    let at = |name: &str| header.iter().position(|own| *own == name).unwrap();
    let (place, force, reference) = (at("saddle.s [m]"), at("force [N]"), at("r [m]"));
    let mut noise = noise();
    let mut log = "t [s],r [m],F [N],x [m]\n".to_owned();
    let all = rows(&results);
    for (number, row) in all.iter().enumerate() {
        // Of two rows at a tick the one behind it; the record has one every millisecond.
        let next = all.get(number + 1);
        let is_last = next.is_none_or(|next| next[0] > row[0]);
        let tick = (row[0] * 1e3).round();
        if is_last && (row[0] * 1e3 - tick).abs() < 1e-6 {
            let x = row[place] + 1e-6 * noise();
            let _ = writeln!(
                log,
                "{},{:?},{:?},{:?}",
                tick / 1e3,
                row[reference],
                row[force],
                x
            );
        }
    }
    folder.file("fit-1.csv", &log);
    let fitted = json(&["fit", MODEL, "slide", "--data", &folder.path(""), "--json"]);
    let (promised, found) = (deviations(&promised), deviations(&fitted));
    assert_eq!(promised.len(), 3);
    for ((name, promised), (_, found)) in promised.iter().zip(&found) {
        let ratio = found / promised;
        assert!(
            (1.0 / 1.5..1.5).contains(&ratio),
            "{name}: {found} for {promised}"
        );
    }
    for own in fitted["parameters"].as_array().unwrap() {
        let error = own["value"].as_f64().unwrap() - own["declared"].as_f64().unwrap();
        assert!(
            error.abs() < 5.0 * own["deviation"].as_f64().unwrap(),
            "{own:#}"
        );
    }
}

#[test]
fn a_force_is_made_so_small_that_the_model_keeps_the_travel() {
    let line = [
        "excite",
        MODEL,
        "pushed",
        "--force",
        "2 [kN]",
        "--travel",
        "20 [mm]",
        "--duration",
        "4 [s]",
        "--json",
    ];
    let found = json(&line);
    assert_eq!(found["column"], "u");
    assert!(found["part"].as_f64().unwrap() < 1.0, "{found:#}");
    let told = text(&hyde(&line[..line.len() - 1]));
    assert!(
        told.contains("the travel or the speed of the model limits the signal"),
        "{told}"
    );
    assert!(
        told.lines().all(|line| line.chars().count() <= 80),
        "{told}"
    );
}

#[test]
fn effects_to_distinguish_choose_the_signal() {
    let line = [
        "excite",
        MODEL,
        "slide",
        "--travel",
        "200 [mm]",
        "--duration",
        "6 [s]",
        "--between",
    ];
    let found = json(&[&line[..], &["Stribeck,SaturatingDrag", "--json"]].concat());
    let signals = found["signals"].as_array().unwrap();
    let least = |own: &Value| own["apart"]["least"].as_f64().unwrap();
    let best = signals
        .iter()
        .find(|own| own["signal"] == found["chosen"])
        .unwrap();
    assert!(
        signals.iter().all(|own| least(own) <= least(best)),
        "{found:#}"
    );
    // What an effect gains over another one is at most what it gains alone.
    for own in signals {
        for (alone, over) in own["apart"]["alone"]
            .as_array()
            .unwrap()
            .iter()
            .zip(own["apart"]["over"].as_array().unwrap())
        {
            for gain in over.as_array().unwrap() {
                assert!(
                    gain.as_f64().unwrap() <= alone.as_f64().unwrap() * (1.0 + 1e-9),
                    "{own:#}"
                );
            }
        }
    }
    let refused = |effects: &str| {
        let output = hyde(&[&line[..], &[effects]].concat());
        assert_eq!(status(&output), 2);
        errors(&output)
    };
    assert!(refused("Stribeck,Blah").contains("`hyde effects FILE`"));
    assert!(refused("Stribeck").contains("two or more"));
}

#[test]
fn a_column_that_no_stimulus_reads_is_refused() {
    let refused = |options: &[&str]| {
        let output = hyde(&[&["excite", MODEL, "slide"], options].concat());
        assert_ne!(status(&output), 0);
        errors(&output)
    };
    let column = refused(&["--column", "x"]);
    assert!(
        column.contains("the columns that drive the model are `r`"),
        "{column}"
    );
    // A current for a length.
    let unit = refused(&["--current", "3 [A]"]);
    assert!(unit.contains("E0301"), "{unit}");
    let study = refused(&["other"]);
    assert!(!study.is_empty());
}
