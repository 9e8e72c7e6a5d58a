//! FMUs that tests make as components: for model exchange alone, and with arrays. Without FMPy in `target/fmpy` these tests say
//! so and pass; `./dev test` installs it.
#![allow(
    clippy::print_stderr,
    clippy::unwrap_used,
    reason = "tests tell what they skip, and unwrap what must be there"
)]

use hyde_tests::fmu::{python, succeed};
use hyde_tests::imported::{self, LOOP, column, largest_difference, of_hyde, thrown, write};
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

/// Runs `made.py`; none without the Python of the tests.
fn made(arguments: &[&Path], what: &str) -> Option<()> {
    let python = python()
        .map_err(|reason| eprintln!("skipped: {reason}"))
        .ok()?;
    let mut command = Command::new(python);
    succeed(command.args(["tests/fmu/made.py", what]).args(arguments)).unwrap();
    Some(())
}

#[test]
fn an_fmu_for_model_exchange_is_integrated_within_each_step() {
    let folder = of_hyde(HYDE);
    let folder = folder.path();
    let place = |name: &str| folder.join(name);
    for fmi in ["3", "2"] {
        let (both, alone) = (format!("lag{fmi}.fmu"), format!("alone{fmi}.fmu"));
        if made(&[&place(&both), &place(&alone)], "exchange").is_none() {
            return;
        }
    }
    write(folder, "three.hyde", &LOOP.replace("lag3", "alone3"));
    write(folder, "two.hyde", &LOOP.replace("lag3", "alone2"));
    let native = column(&columns(folder, &["run", "three.hyde", "native"]), "v");
    let three = column(&columns(folder, &["run", "three.hyde", "imported"]), "v");
    let two = column(&columns(folder, &["run", "two.hyde", "imported"]), "v");
    let apart = column(
        &columns(folder, &["run", "two.hyde", "imported", "--sandbox"]),
        "v",
    );
    let largest = native.iter().fold(0.0_f64, |most, v| most.max(v.abs()));
    // Its tolerance is 1e-6 at most.
    let difference = largest_difference(&native, &three);
    assert!(difference < 1e-6 * largest, "{difference}");
    assert_eq!(three, two, "both versions compute the same");
    assert_eq!(two, apart, "another process computes the same");
}

#[test]
fn events_of_an_fmu_for_model_exchange_are_located() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let place = |name: &str| folder.join(name);
    for fmi in ["3", "2"] {
        let mut command = Command::new(HYDE);
        command.args(["export", "fmu", "--quiet", "--fmi", fmi]);
        command.args(["tests/models/fmu.hyde", "bouncing", "--out"]);
        succeed(command.arg(place("both.fmu"))).unwrap();
        if made(&[&place("both.fmu"), &place("ball.fmu")], "exchange").is_none() {
            return;
        }
        write(
            folder,
            "ball.hyde",
            "import SI.*;\nmodel Ball = fmu(\"ball.fmu\", step = 10 [ms]);\nmodel Thrown\n  Ball ball;\nend Thrown;\n\
             experiment thrown of Thrown\n  solve auto stop 2.4 [s] every 10 [ms];\nend thrown;\n",
        );
        let results = columns(folder, &["run", "ball.hyde"]);
        let (t, h) = (column(&results, "t"), column(&results, "ball.h"));
        let bounces = column(&results, "ball.bounces");
        let mut looked_at = 0;
        for row in 0..t.len() {
            if t.get(row + 1).is_some_and(|next| *next <= t[row]) {
                continue;
            }
            let (height, count) = thrown(t[row], 1.0, 0.8);
            assert!((h[row] - height).abs() < 1e-7, "{} s: {}", t[row], h[row]);
            assert!((bounces[row] - count).abs() < 1e-12, "{} s", t[row]);
            looked_at += 1;
        }
        assert!(looked_at > 200, "{looked_at}");
    }
}

/// A block that stops at 0.586 s, sticks while the force grows, and starts anew at 2 s.
const BLOCK: &str = "import SI.*;
model Block
  Velocity v(start = 1 [m/s], fixed = true);
  Force f = 1.5 [N/s]*time;
  Force friction = 3 [N]*sign(v);
equation
  2 [kg]*der(v) = f - friction;
end Block;
experiment e of Block
  solve auto(rtol = 1e-8) stop 3 [s];
end e;
";

#[test]
fn a_switch_that_slides_ends_at_a_step_of_an_importer_that_integrates() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let place = |name: &str| folder.join(name);
    write(folder, "block.hyde", BLOCK);
    for fmi in ["3", "2"] {
        let mut command = Command::new(HYDE);
        command.args(["export", "fmu", "--quiet", "--fmi", fmi]);
        command.arg(place("block.hyde")).arg("--out");
        succeed(command.arg(place("both.fmu"))).unwrap();
        if made(&[&place("both.fmu"), &place("block.fmu")], "exchange").is_none() {
            return;
        }
        write(
            folder,
            "imported.hyde",
            "import SI.*;\nmodel Block = fmu(\"block.fmu\", step = 10 [ms]);\nmodel Pushed\n  Block block;\nend Pushed;\n\
             experiment pushed of Pushed\n  solve auto stop 3 [s] every 10 [ms];\nend pushed;\n",
        );
        let results = columns(folder, &["run", "imported.hyde"]);
        let v = column(&results, "block.v");
        let t = column(&results, "t");
        let at = |wanted: f64| {
            let row = t.iter().position(|t| (t - wanted).abs() < 1e-9).unwrap();
            v[row]
        };
        assert!(at(1.5).abs() < 1e-9, "it sticks: {}", at(1.5));
        // 2 kg dv/dt = 1.5 N/s (t - 2 s).
        let end = v.last().unwrap();
        assert!((end - 0.375).abs() < 1e-3, "it starts anew: {end}");
    }
}

#[test]
fn arrays_have_the_size_of_their_structural_parameter_and_prints_stay_apart() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    if made(&[&folder.join("arrays.fmu")], "arrays").is_none() {
        return;
    }
    write(
        folder,
        "arrays.hyde",
        r#"
import SI.*;

model Arrays = fmu("arrays.fmu", A = {2, 3, 4});

model Uses
  Arrays arrays;
  Real sum = arrays.y[1] + arrays.y[2] + arrays.y[3];
equation
  arrays.u = 0.5;
end Uses;

experiment used of Uses
  measure Real reached = last(sum);
  solve auto stop 0.1 [s] every 10 [ms];
end used;
"#,
    );
    let results = columns(folder, &["run", "arrays.hyde"]);
    let sum = column(&results, "sum");
    assert!((sum.last().unwrap() - 9.0).abs() < 1e-12, "{sum:?}");
    // The library prints at every step: never into the answer.
    for more in [&[][..], &["--sandbox"]] {
        let all: Vec<&str> = ["run", "arrays.hyde", "--json"]
            .iter()
            .chain(more)
            .copied()
            .collect();
        let output = hyde(folder, &all);
        let told: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(told["measures"][0]["value"], 9.0);
        let said = String::from_utf8_lossy(&output.stderr);
        assert!(said.contains("a library may print"), "{said}");
    }
}
