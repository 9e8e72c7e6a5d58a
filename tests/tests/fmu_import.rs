//! FMUs as components: those of Hyde itself, and those of pythonfmu, pythonfmu3 and FMPy against closed forms. Without these
//! packages in `target/fmpy` the tests that need them say so and pass; `./dev test` installs them.
#![allow(
    clippy::disallowed_methods,
    clippy::print_stderr,
    clippy::unwrap_used,
    reason = "tests open files, tell what they skip, and unwrap what must be there"
)]

use hyde_tests::fmu::{python, succeed};
use hyde_tests::imported::{self, LOOP, column, largest_difference, of_hyde, thrown, write};
use hyde_tests::root;
use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

const HYDE: &str = env!("CARGO_BIN_EXE_hyde-tested");

fn hyde(folder: &Path, arguments: &[&str]) -> Output {
    imported::hyde(HYDE, folder, arguments)
}

fn columns(folder: &Path, arguments: &[&str]) -> Value {
    imported::columns(HYDE, folder, arguments)
}

/// A folder with the FMUs of other tools, if those are there; says so if not.
fn of_others() -> Option<tempfile::TempDir> {
    let folder = of_hyde(HYDE);
    std::fs::rename(
        folder.path().join("lag3.fmu"),
        folder.path().join("lag.fmu"),
    )
    .unwrap();
    let python = python()
        .map_err(|reason| eprintln!("skipped: {reason}"))
        .ok()?;
    let mut probe = Command::new(&python);
    if succeed(probe.args(["-c", "import pythonfmu, pythonfmu3"])).is_err() {
        eprintln!("skipped: pythonfmu is not installed in target/fmpy: `./dev test` does it");
        return None;
    }
    let mut command = Command::new(python);
    succeed(command.arg("tests/fmu/foreign.py").arg(folder.path())).unwrap();
    Some(folder)
}

#[test]
fn an_fmu_of_hyde_gives_the_run_of_its_equations() {
    let folder = of_hyde(HYDE);
    let folder = folder.path();
    write(folder, "three.hyde", LOOP);
    write(folder, "two.hyde", &LOOP.replace("lag3", "lag2"));
    let native = column(&columns(folder, &["run", "three.hyde", "native"]), "v");
    let here = column(&columns(folder, &["run", "three.hyde", "imported"]), "v");
    let apart = column(
        &columns(folder, &["run", "three.hyde", "imported", "--sandbox"]),
        "v",
    );
    let two = column(&columns(folder, &["run", "two.hyde", "imported"]), "v");
    assert!(native.len() > 50);
    // The FMU integrates at the tolerance of its export.
    let difference = largest_difference(&native, &here);
    assert!(difference < 1e-7, "{difference}");
    assert_eq!(here, apart, "another process computes the same");
    assert_eq!(here, two, "both versions compute the same");
}

#[test]
fn cases_of_a_sweep_have_instances_of_their_own() {
    let folder = of_hyde(HYDE);
    let folder = folder.path();
    let text = LOOP.replace("  grid 4;\n  expect last(v) > 0 [m/s];\n", "  grid 4;\n");
    let text = text.replace("  solve auto(rtol = 1e-9) stop 0.3 [s] every 5 [ms];\nend imported;",
        "  measure Velocity reached = at(v, 0.1 [s]);\n  solve auto(rtol = 1e-9) stop 0.1 [s] every 5 [ms];\nend imported;");
    let text = text.replace("at(v, 0.1 [s])", "max(v)");
    write(folder, "loop.hyde", &text);
    let of = |arguments: &[&str]| {
        let output = hyde(folder, arguments);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    of(&[
        "sweep",
        "loop.hyde",
        "gains",
        "--jobs",
        "2",
        "--format",
        "csv",
        "--out",
        "two",
    ]);
    of(&[
        "sweep",
        "loop.hyde",
        "gains",
        "--jobs",
        "1",
        "--format",
        "csv",
        "--sandbox",
        "--out",
        "one",
    ]);
    let table = |name: &str| {
        let files = std::fs::read_dir(folder.join(name)).unwrap();
        let mut files: Vec<_> = files.map(|entry| entry.unwrap().path()).collect();
        files.retain(|path| path.extension().is_some_and(|end| end == "csv"));
        assert_eq!(files.len(), 1, "{files:?}");
        std::fs::read_to_string(&files[0]).unwrap()
    };
    assert_eq!(table("two"), table("one"));
    assert_eq!(table("one").lines().count(), 5, "{}", table("one"));
}

#[test]
fn what_cannot_be_had_of_an_fmu_is_refused_with_the_line_to_write() {
    let folder = of_hyde(HYDE);
    let folder = folder.path();
    let said = |change: (&str, &str), arguments: &[&str]| {
        write(folder, "t.hyde", &LOOP.replace(change.0, change.1));
        let output = hyde(folder, arguments);
        assert!(!output.status.success(), "{change:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    let check = ["check", "t.hyde"];
    let none = said(("k = 3, step = 1 [ms]", "k = 3"), &check);
    assert!(
        none.contains("write `fmu(\"lag3.fmu\", step = 1 [ms])`"),
        "{none}"
    );
    let near = said(("k = 3,", "K = 3,"), &check);
    assert!(near.contains("did you mean `k`?"), "{near}");
    let unit = said(("k = 3,", "T = 3 [m],"), &check);
    assert!(unit.contains("E0301"), "{unit}");
    for command in [
        ["modes", "t.hyde", "imported"].as_slice(),
        &["export", "fmu", "t.hyde", "imported", "--out", "again.fmu"],
        &["export", "modelica", "t.hyde", "imported"],
        &["run", "t.hyde", "imported", "--gradient", "c.k"],
    ] {
        let refused = said(("", ""), command);
        let code = if command[0] == "run" {
            "E0707"
        } else {
            "E0817"
        };
        assert!(refused.contains(code), "{command:?}: {refused}");
    }
}

#[test]
fn the_run_tells_whose_machine_code_it_runs_and_leaves_no_files() {
    let (folder, temporary) = (of_hyde(HYDE), tempfile::tempdir().unwrap());
    write(folder.path(), "loop.hyde", LOOP);
    for (more, told) in [
        (&[][..], "in this process"),
        (&["--sandbox"], "in a process of its own"),
    ] {
        let mut command = Command::new(HYDE);
        command
            .current_dir(folder.path())
            .env("TMPDIR", temporary.path());
        let output = command
            .args(["run", "loop.hyde", "imported"])
            .args(more)
            .output()
            .unwrap();
        let said = String::from_utf8_lossy(&output.stdout);
        let said = said.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            said.contains(&format!("`c` runs machine code of `lag3.fmu` {told}")),
            "{said}"
        );
        assert_eq!(std::fs::read_dir(temporary.path()).unwrap().count(), 0);
    }
}

#[test]
fn fmus_of_other_tools_follow_their_closed_forms() {
    let Some(folder) = of_others() else { return };
    let folder = folder.path();
    write(
        folder,
        "others.hyde",
        r#"
import SI.*;

model Ball = fmu("Ball.fmu");
model Stair = fmu("Stair.fmu", height = 0.25, step = 10 [ms]);
model Lag = fmu("Lag.fmu", T = 0.05, step = 1 [ms]);
model Container = fmu("Container.fmu");

model All
  Ball ball(start_height = 0.5 [m]);
  Stair stair;
  Lag lag;
  Container container;
  Real turned = if stair.odd then 1 else -1;
equation
  stair.u = 0;
  lag.u = 1;
  container.u = 1;
end All;

experiment run of All
  solve auto(rtol = 1e-8) stop 1 [s] every 50 [ms];
end run;
"#,
    );
    for more in [&[][..], &["--sandbox"]] {
        let all: Vec<&str> = ["run", "others.hyde"].iter().chain(more).copied().collect();
        let results = columns(folder, &all);
        let t = column(&results, "t");
        let (ball, stair) = (column(&results, "ball.h"), column(&results, "stair.y"));
        let (lag, turned) = (column(&results, "lag.y"), column(&results, "turned"));
        let (container, bounces) = (
            column(&results, "container.F"),
            column(&results, "ball.bounces"),
        );
        let mut looked_at = 0;
        for (row, &t) in t.iter().enumerate() {
            // Every row has a tick: the value there is the one after it, of which the row is the last of its instant.
            if row + 1 < ball.len() && column(&results, "t")[row + 1] <= t {
                continue;
            }
            looked_at += 1;
            let steps = (t / 0.01).round();
            assert!(
                (stair[row] - 0.25 * steps).abs() < 1e-12,
                "{t}: {}",
                stair[row]
            );
            let side = if steps % 2.0 == 0.0 { -1.0 } else { 1.0 };
            assert!((turned[row] - side).abs() < 1e-12, "{t}");
            assert!(
                (lag[row] + (-t / 0.05_f64).exp_m1()).abs() < 1e-9,
                "{t}: {}",
                lag[row]
            );
            let contained = -200.0 * (-t / 0.02_f64).exp_m1();
            assert!(
                (container[row] - contained).abs() < 1e-3,
                "{t}: {}",
                container[row]
            );
            let (height, count) = thrown(t, 0.5, 0.5);
            assert!((ball[row] - height).abs() < 1e-9, "{t}: {}", ball[row]);
            assert!((bounces[row] - count).abs() < 1e-12, "{t}");
        }
        assert!(looked_at >= 21, "{looked_at}");
    }
}

#[test]
fn an_fmu_that_stops_or_crashes_ends_in_a_diagnostic() {
    let Some(folder) = of_others() else { return };
    let folder = folder.path();
    let text = |limit: &str| {
        format!(
            "import SI.*;\nmodel Stair = fmu(\"Stair.fmu\", step = 10 [ms]);\nmodel Walk\n  Stair stair;\nequation\n  \
             stair.u = if time < 95 [ms] then 0 else {limit};\nend Walk;\nexperiment up of Walk\n  solve auto stop 1 [s];\nend up;\n"
        )
    };
    write(folder, "stops.hyde", &text("4"));
    write(folder, "crashes.hyde", &text("6"));
    let said = |arguments: &[&str]| {
        let output = hyde(folder, arguments);
        assert_eq!(output.status.code(), Some(3), "{arguments:?}");
        String::from_utf8_lossy(&output.stderr).into_owned()
    };
    // The input of 4 is there from the tick at 0.1 s on; the step from there fails and is noticed at its end.
    for arguments in [
        &["run", "stops.hyde"][..],
        &["run", "stops.hyde", "--sandbox"],
    ] {
        let stopped = said(arguments);
        assert!(
            stopped.contains("E0818") && stopped.contains("`fmi2DoStep` returned Discard"),
            "{stopped}"
        );
        assert!(stopped.contains("of `stair` failed at 0.11 s"), "{stopped}");
    }
    let crashed = said(&["run", "crashes.hyde", "--sandbox"]);
    assert!(
        crashed.contains("E0818") && crashed.contains("its process ended: signal: 11"),
        "{crashed}"
    );
}

#[test]
fn a_controller_of_another_tool_closes_the_position_loop_of_the_y_axis() {
    let Some(folder) = of_others() else { return };
    let folder = folder.path();
    let axis = std::fs::read_to_string(root().join("examples/y_axis/axis.hyde")).unwrap();
    let axis = axis.replacen("package y_axis", "package loops", 1);
    let (before, rest) = axis.split_once("  NumericalController cnc(").unwrap();
    let (_, after) = rest.split_once(";\n").unwrap();
    let gain = "K_v*tacho.K_ta*belt.zb/belt.za/screw.lead*(1 [mm/V])";
    let with = |cnc: &str, model: &str| {
        let text = format!("{before}{cnc}{after}");
        text.replacen("model Axis ", &format!("{model}\nmodel Axis "), 1)
    };
    // The step of the FMU is the delay of a clock: both give at a tick what they took at the one before.
    let imported = with(
        &format!("  Position cnc(A = {gain});\n"),
        "model Position = fmu(\"Position.fmu\", step = 10 [ms]);\n",
    );
    let imported = imported.replacen(
        "  connect(armature.shaft",
        "  cnc.r = r/(1 [m]);\n  cnc.s = saddle.s/(1 [m]);\n  connect(armature.shaft",
        1,
    );
    let imported = imported.replacen("E2 = cnc.V1 + inject", "E2 = cnc.V1*(1 [V]) + inject", 1);
    let native = with(
        &format!("  Position cnc(r = r, s = saddle.s, A = {gain});\n"),
        "model Position\n  input Length r, s;\n  output Voltage V1 = hold(t.V1);\n  parameter Real A;\n  \
         clocked t(10 [ms], delay = 10 [ms])\n    Voltage V1 = A*clamp((1 [V/mm])*(sample(r) - sample(s)), -10 [V], 10 [V]);\n  \
         end t;\nend Position;\n",
    );
    write(folder, "imported.hyde", &imported);
    write(folder, "native.hyde", &native);
    let run = |file: &str| {
        let arguments = [
            "run",
            file,
            "positioning",
            "--stop",
            "0.6",
            "--rtol",
            "1e-8",
        ];
        let results = columns(folder, &arguments);
        let (t, s) = (column(&results, "t"), column(&results, "saddle.s"));
        // Rows at events come in addition, and there may be others.
        let grid = (0..600_u32).map(|k| f64::from(k) * 1e-3);
        let at = |time: f64| t.iter().position(|own| (own - time).abs() < 1e-9).unwrap();
        grid.map(|time| s[at(time)]).collect::<Vec<f64>>()
    };
    let (imported, native) = (run("imported.hyde"), run("native.hyde"));
    let moved = native.iter().copied().fold(0.0, f64::max);
    assert!(moved > 0.015, "the axis moves: {moved}");
    let difference = largest_difference(&imported, &native);
    assert!(difference < 1e-5 * moved, "{difference} of {moved}");
}

#[test]
fn an_error_budget_splits_what_an_fmu_contributes() {
    let folder = of_hyde(HYDE);
    let folder = folder.path();
    let asked = "  measure Velocity reached = last(v);\n  budget weak(c.k = 4), slow(c.T = 1 [ms]);\n  solve auto(rtol = 1e-9) stop 0.3 [s] every 5 [ms];\nend imported;";
    let plain = "  solve auto(rtol = 1e-9) stop 0.3 [s] every 5 [ms];\nend imported;";
    let text = LOOP.replacen(plain, asked, 1);
    write(folder, "loop.hyde", &text);
    // What the measure is with a gain, run for itself.
    let with = |k: &str| {
        let output = hyde(
            folder,
            &["run", "loop.hyde", "imported", "--set", k, "--json"],
        );
        let told: Value = serde_json::from_slice(&output.stdout).unwrap();
        told["measures"][0]["value"].as_f64().unwrap()
    };
    let (real, without) = (with("c.k=3"), with("c.k=4"));
    let split = |more: &[&str]| {
        let all: Vec<&str> = ["budget", "loop.hyde", "imported", "--json"]
            .iter()
            .chain(more)
            .copied()
            .collect();
        let output = hyde(folder, &all);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{said}");
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    let told = split(&[]);
    let budget = &told["measures"][0];
    assert_eq!(budget["value"].as_f64(), Some(real));
    let mut shares = budget["shares"].as_array().unwrap().iter();
    let weak = shares.find(|own| own["name"] == "weak").unwrap();
    let share = weak["share"].as_f64().unwrap();
    assert!((share - (real - without)).abs() < 1e-12, "{budget}");
    assert_eq!(told, split(&["--sandbox"]));
}
