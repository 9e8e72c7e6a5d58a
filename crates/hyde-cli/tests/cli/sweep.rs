//! Sweeps: what varies, and what is left of a case.

use crate::command::{Folder, errors, hyde, read, status, text};
use hyde_signal::parquet::{Frame, read_frame};
use serde_json::Value;
use std::process::Command;

const MODEL: &str = r#"package swing;
import SI.*;

model Spring
  input Length e;
  output Force F;
  parameter Stiffness k = 1000 [N/m];
equation
  F = k*e;
end Spring;

model Hard
  input Length e;
  output Force F;
  parameter Stiffness k = 1000 [N/m], k3 = 1;
equation
  F = k*e*(1 + (e/1 [mm])^2);
end Hard;

model Swing
  input Force u;
  parameter Mass m = 1 [kg] ~ ±10%;
  parameter Damping d = 2 [N.s/m];
  parameter Integer n = 1;
  parameter Real w[n] = {1/i for i in 1:n};
  Length x(start = 0, fixed = true);
  Velocity v(start = 0, fixed = true) = der(x);
  replaceable Spring spring(e = x);
equation
  m*der(v) = u*sum(w) - d*v - spring.F;
  assert(x < 5 [mm], "the end stop is hit");
end Swing;

model Heavy = Swing(m = 3 [kg]);

experiment step of Swing
  stimulus u = 1 [N];
  measure Length peak = max(x);
  measure Length last = last(x);
  expect peak < 3 [mm] "no overshoot";
  stop 0.2 [s] every 5 [ms];
end step;
"#;

/// The model with a sweep.
pub(crate) fn with(body: &str) -> String {
    let model = MODEL.replace(", k3 = 1", "");
    format!("{model}\nsweep s of step\n{body}\nend s;\n")
}

fn frame(path: &str) -> Frame {
    read_frame(&std::fs::read(path).unwrap()).unwrap()
}

/// The cases of a sweep.
fn cases(body: &str) -> Frame {
    let folder = Folder::new();
    let model = folder.file("swing.hyde", &with(body));
    let out = folder.path("out");
    let output = hyde(&["sweep", &model, "s", "--out", &out, "--quiet"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    frame(&format!("{out}/cases.parquet"))
}

#[test]
fn lists_and_grids_multiply_and_the_last_is_the_fastest() {
    let frame = cases("vary m = {1, 2} [kg], d in 1 .. 3 [N.s/m]; grid 3;");
    assert_eq!(frame.integers("case").unwrap(), [1, 2, 3, 4, 5, 6]);
    assert_eq!(frame.numbers("m").unwrap(), [1.0, 1.0, 1.0, 2.0, 2.0, 2.0]);
    assert_eq!(frame.numbers("d").unwrap(), [1.0, 2.0, 3.0, 1.0, 2.0, 3.0]);
    assert_eq!(
        frame.column("m").unwrap().0.unit.as_ref().unwrap().text(),
        "kg"
    );
    assert_eq!(
        (frame.note("role:m"), frame.note("role:peak")),
        (Some("input"), Some("measure"))
    );
    assert!(
        frame
            .texts("status")
            .unwrap()
            .iter()
            .all(|status| status == "done")
    );
    // The step response of m x'' + d x' + k x = F, its first peak: F/k (1 + exp(-pi zeta/sqrt(1 - zeta^2))).
    let (m, d) = (frame.numbers("m").unwrap(), frame.numbers("d").unwrap());
    for (at, peak) in frame.numbers("peak").unwrap().iter().enumerate() {
        let zeta = d[at] / (2.0 * (m[at] * 1000.0).sqrt());
        let exact =
            1e-3 * (1.0 + (-std::f64::consts::PI * zeta / (1.0 - zeta * zeta).sqrt()).exp());
        // Rows 5 ms apart miss the peak by at most (w*2.5 ms)^2/2 of the swing: 0.3 %.
        assert!((peak / exact - 1.0).abs() < 4e-3, "{peak} {exact}");
    }
}

#[test]
fn uncertain_parameters_and_starts_are_sampled_within_their_spread() {
    for how in ["random", "latin", "sobol"] {
        let frame = cases(&format!(
            "vary uncertain, x.start in -1 .. 1 [mm]; {how} 64; seed 5;"
        ));
        assert_eq!(frame.rows(), 64);
        let within = |name: &str, low: f64, high: f64| {
            let values = frame.numbers(name).unwrap();
            assert!(
                values.iter().all(|v| (low..=high).contains(v)),
                "{how} {name}: {values:?}"
            );
            let spread = values.iter().copied().fold(f64::MIN, f64::max)
                - values.iter().copied().fold(f64::MAX, f64::min);
            assert!(spread > 0.8 * (high - low), "{how} {name}");
        };
        within("m", 0.9, 1.1);
        within("x.start", -1e-3, 1e-3);
        // The start is the run's: without damping the peak is 1 mm + |x0 - 1 mm|, with it a little less.
        let (start, peak) = (
            frame.numbers("x.start").unwrap(),
            frame.numbers("peak").unwrap(),
        );
        for (start, peak) in start.iter().zip(peak) {
            let free = 1e-3 + (start - 1e-3).abs();
            assert!(
                *peak < free * 1.001 && *peak > 0.9 * free,
                "{how}: {start} {peak}"
            );
        }
    }
}

#[test]
fn models_components_stimuli_and_structural_parameters_compile_once_each() {
    let frame = cases(
        "vary model = {Swing, Heavy}, spring = {Spring, Hard(k = 500 [N/m])}, stimulus u = {1 [N], 2 [N]*sin(time/10 [ms])}, n = {1, 2};",
    );
    assert_eq!(frame.rows(), 16);
    assert_eq!(frame.texts("model").unwrap()[7..9], ["Swing", "Heavy"]);
    assert_eq!(
        frame.texts("spring").unwrap()[3..5],
        ["Spring", "Hard(k = 500 [N/m])"]
    );
    let peak = frame.numbers("peak").unwrap();
    for (at, peak) in peak.iter().enumerate() {
        assert!(peak.is_finite(), "{:?}", frame.texts("reason").unwrap()[at]);
    }
    // Two weights 1 and 1/2: linear in the force for the linear spring.
    assert!((peak[1] / peak[0] - 1.5).abs() < 1e-4); // rtol 1e-6 on both.
    assert!((peak[4] / peak[0] - 1.0).abs() > 0.1);
}

#[test]
fn a_sweep_is_given_in_arguments_as_it_would_be_written() {
    let folder = Folder::new();
    folder.file("cases.csv", "m [kg]\n1\n2\n");
    let written = with("vary d in 1 .. 3 [N.s/m]; cases \"cases.csv\"; grid 4;");
    let model = folder.file("swing.hyde", &written);
    let bare = folder.file("bare.hyde", &written[..written.find("sweep s").unwrap()]);
    let (one, other) = (folder.path("one"), folder.path("other"));
    let made = |line: &[&str], out: &str| {
        let output = hyde(&[line, &["--out", out, "--quiet", "--format", "csv"]].concat());
        assert_eq!(status(&output), 0, "{}", errors(&output));
        read(&format!("{out}/cases.csv"))
    };
    let line = [
        &["sweep", &bare, "--of", "step", "--vary"][..],
        &["d in 1 .. 3 [N.s/m]", "--cases", "cases.csv"][..],
        &["--points", "grid 4"][..],
    ]
    .concat();
    assert_eq!(made(&["sweep", &model], &one), made(&line, &other));
    // The folder knows it: it needs neither the arguments nor the file.
    std::fs::remove_file(&bare).unwrap();
    assert_eq!(status(&hyde(&["sweep", &other, "--quiet"])), 0);
    // Without a folder the command that reruns a case has the arguments.
    folder.file("bare.hyde", &written[..written.find("sweep s").unwrap()]);
    let told = text(&hyde(&line));
    let rerun = told.lines().find_map(|line| line.split_once(": hyde "));
    let rerun = format!("{} {}", env!("CARGO_BIN_EXE_hyde"), rerun.unwrap().1);
    let output = Command::new("sh").args(["-c", &rerun]).output().unwrap();
    assert_eq!(status(&output), 0, "{rerun}: {}", errors(&output));
    // What is wrong is told as of a file.
    let wrong = hyde(&[
        "sweep",
        &bare,
        "--of",
        "step",
        "--vary",
        "q in 1 .. 2",
        "--points",
        "grid 3",
    ]);
    assert_eq!(status(&wrong), 1);
    assert!(
        errors(&wrong).contains("no parameter `q`"),
        "{}",
        errors(&wrong)
    );
}

#[test]
fn effects_are_put_on_and_left_off() {
    let folder = Folder::new();
    let effect =
        "effect Sticky on Spring\n  size Force F0 = 0.5 [N];\n  wrap F by F + F0;\nend Sticky;\n";
    let text = with("vary effect Sticky(F0 = 0.5 [N]) on spring, d = {2, 4} [N.s/m];").replace(
        "vary effect Sticky(F0 = 0.5 [N]) on spring, d",
        "vary effect Sticky(F0 = 0.5 [N]) on spring;\n  vary d",
    );
    let model = folder.file(
        "swing.hyde",
        &text.replace("model Hard", &format!("{effect}\nmodel Hard")),
    );
    let out = folder.path("out");
    let output = hyde(&["sweep", &model, "--out", &out, "--quiet"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let frame = frame(&format!("{out}/cases.parquet"));
    assert_eq!(
        frame.texts("effect Sticky on spring").unwrap(),
        ["without", "without", "with", "with"]
    );
    // Half of the force is taken away: half of the motion.
    let peak = frame.numbers("peak").unwrap();
    assert!((peak[2] / peak[0] - 0.5).abs() < 1e-4, "{peak:?}"); // rtol 1e-6 on both.
}

#[test]
fn cases_and_records_come_from_files() {
    let folder = Folder::new();
    folder.file("cases.csv", "m [g],d [N.s/m]\n1000,2\n2000,3\n");
    folder.file("one.csv", "t [s],u [N]\n0,1\n1,1\n");
    folder.file("two.csv", "t [s],u [N]\n0,2\n1,2\n");
    let text = with("cases \"cases.csv\"; vary record file = {\"one.csv\", \"two.csv\"};")
        .replace("step of Swing", "step(record file = \"one.csv\") of Swing")
        .replace("stimulus u = 1 [N]", "stimulus u = file.u");
    let model = folder.file("swing.hyde", &text);
    let out = folder.path("out");
    let output = hyde(&["sweep", &model, "s", "--out", &out, "--quiet"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    let found = frame(&format!("{out}/cases.parquet"));
    assert_eq!(found.numbers("m").unwrap(), [1.0, 1.0, 2.0, 2.0]);
    let peak = found.numbers("peak").unwrap();
    assert!((peak[1] / peak[0] - 2.0).abs() < 1e-4, "{peak:?}"); // rtol 1e-6 on both.
    // The folder holds all that the batch reads: the files may go.
    let whole = std::fs::read(format!("{out}/cases.parquet")).unwrap();
    for name in ["swing.hyde", "cases.csv", "one.csv", "two.csv"] {
        std::fs::remove_file(folder.path(name)).unwrap();
    }
    std::fs::remove_dir_all(format!("{out}/journal")).unwrap();
    let output = hyde(&["sweep", &out, "--quiet"]);
    assert_eq!(status(&output), 0, "{}", errors(&output));
    assert_eq!(
        std::fs::read(format!("{out}/cases.parquet")).unwrap(),
        whole
    );
}

#[test]
fn a_case_that_fails_is_a_row_that_says_why() {
    let frame = cases("vary stimulus u = {1 [N], 4 [N], 2 [N]}; keep x, spring.*;");
    assert_eq!(frame.texts("status").unwrap(), ["done", "failed", "done"]);
    assert_eq!(frame.texts("code").unwrap()[1], "E0704");
    assert!(frame.texts("reason").unwrap()[1].contains("the end stop is hit"));
    assert!(frame.texts("equation").unwrap()[1].contains("x < 5 [mm]"));
    assert!(frame.texts("source").unwrap()[1].contains("swing.hyde:"));
    // x = 4 mm (1 - cos(31.6 t)) without damping is 5 mm at 57.7 ms; damping of 3 % makes it a little later.
    let time = frame.numbers("failed_at").unwrap();
    assert!(
        time[0].is_nan() && (0.0577..0.062).contains(&time[1]),
        "{time:?}"
    );
    assert!(frame.numbers("peak").unwrap()[1].is_nan());
}

#[test]
fn a_case_is_run_again_exactly() {
    let folder = Folder::new();
    let model = folder.file(
        "swing.hyde",
        &with("vary uncertain, d in 1 .. 3 [N.s/m], x.start in 0 .. 1 [mm]; latin 9; keep x;"),
    );
    let out = folder.path("out");
    assert_eq!(
        status(&hyde(&["sweep", &model, "s", "--out", &out, "--quiet"])),
        0
    );
    let summary: Value = serde_json::from_str(&read(&format!("{out}/summary.json"))).unwrap();
    let worst = &summary["worst"][0];
    let line = worst["command"].as_str().unwrap();
    assert_eq!(line, format!("hyde sweep {out} --case {}", worst["case"]));
    let one = folder.path("one");
    let words: Vec<&str> = line
        .split(' ')
        .skip(1)
        .chain(["--out", &one, "--quiet"])
        .collect();
    assert_eq!(status(&hyde(&words)), 0);
    let again = read(&format!("{one}/summary.json"));
    let case = worst["case"].as_u64().unwrap() as usize;
    let found = frame(&format!("{out}/cases.parquet"));
    // As text: serde_json may miss the last bit.
    let (_, behind) = again.split_once("\"value\": ").unwrap();
    let value: f64 = behind.split([',', '\n']).next().unwrap().parse().unwrap();
    assert_eq!(
        value.to_bits(),
        found.numbers("peak").unwrap()[case - 1].to_bits()
    );
    // What was kept over time is what the run gives.
    let kept = frame(&format!("{out}/trajectories.parquet"));
    let rows = kept
        .integers("case")
        .unwrap()
        .iter()
        .filter(|&&number| number == case as i64)
        .count();
    let run = hyde_signal::csv::read(
        read(&format!("{one}/results.csv")).as_bytes(),
        &hyde_signal::Layout::default(),
    )
    .unwrap();
    assert_eq!(rows, run.rows());
}

#[test]
fn a_csv_has_the_same_rows() {
    let folder = Folder::new();
    let model = folder.file(
        "swing.hyde",
        &with("vary d = {1, 2} [N.s/m], stimulus u = {1 [N], 6 [N]};"),
    );
    let out = folder.path("out");
    assert_eq!(
        status(&hyde(&[
            "sweep", &model, "--out", &out, "--quiet", "--format", "csv"
        ])),
        0
    );
    let lines = read(&format!("{out}/cases.csv"));
    let lines: Vec<&str> = lines.lines().collect();
    assert_eq!(lines.len(), 5);
    assert!(
        lines[0]
            .starts_with("case,d [N.s/m],stimulus u,peak [m],last [m],no overshoot [1],status,"),
        "{}",
        lines[0]
    );
    assert!(lines[1].starts_with("1,1,1 [N],0.00"), "{}", lines[1]);
    assert!(
        lines[2].starts_with("2,1,6 [N],,,,failed,E0704,"),
        "{}",
        lines[2]
    );
}
