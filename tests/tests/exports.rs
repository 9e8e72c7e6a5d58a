//! What `hyde export` and `hyde run --format mat` write for other tools, read by those tools: SciPy, python-control, DyMat and rumoca; and
//! `hyde mcp` with the Python SDK of the protocol.
//! Without them in `target/fmpy` these tests say so and pass; `./dev test` installs them.
#![allow(
    clippy::disallowed_methods,
    clippy::print_stderr,
    clippy::unwrap_used,
    reason = "tests open files, tell what they skip, and unwrap what must be there"
)]

use hyde_tests::fmu::{python, succeed};
use hyde_tests::root;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const LINEAR: &str = "tests/models/state_space.hyde";
const FMU: &str = "tests/models/fmu.hyde";
const EXPORTED: &str = "tests/models/exported.hyde";

fn hyde(arguments: &[&str]) -> Output {
    let mut command = Command::new(Path::new(env!("CARGO_BIN_EXE_hyde-tested")));
    command
        .current_dir(root())
        .args(arguments)
        .output()
        .unwrap()
}

fn done(arguments: &[&str]) {
    let output = hyde(arguments);
    assert!(output.status.success(), "{arguments:?}: {output:?}");
}

#[test]
fn state_spaces_and_trajectories_are_read_by_other_tools() {
    let Ok(python) = python().map_err(|reason| eprintln!("skipped: {reason}")) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    for ending in ["mat", "json", "py", "m"] {
        let out = place(&format!("oscillator.{ending}"));
        let model = ["export", "statespace", LINEAR, "--model", "Oscillator"];
        let outputs = ["--output", "v,spring", "--quiet", "--out", &out];
        done(&[&model[..], &outputs].concat());
    }
    let loop_of_clocks = ["export", "statespace", LINEAR, "stepped", "--quiet"];
    done(&[&loop_of_clocks[..], &["--out", &place("servo.py")]].concat());
    let plant = ["--open", "--out", &place("plant.py")];
    done(&[&loop_of_clocks[..], &plant].concat());
    for (model, experiment, format, out) in [
        (LINEAR, "stepped", "json", "servo"),
        (FMU, "bouncing", "mat", "ball"),
        (FMU, "bouncing", "json", "ball-json"),
    ] {
        let run = ["run", model, experiment, "--quiet"];
        done(&[&run[..], &["--format", format, "--out", &place(out)]].concat());
    }
    let mut command = Command::new(python);
    command
        .arg("tests/exports/state_space.py")
        .arg(folder.path());
    let printed = succeed(&mut command).unwrap();
    assert!(printed.ends_with("done\n"), "{printed}");
}

#[test]
fn a_state_space_says_what_it_is_of() {
    let folder = tempfile::tempdir().unwrap();
    let out: PathBuf = folder.path().join("first.mat");
    let out = out.to_string_lossy().into_owned();
    let model = ["export", "statespace", "examples/first/first.hyde", "push"];
    let output = hyde(&[&model[..], &["--out", &out]].concat());
    let said = String::from_utf8(output.stdout).unwrap();
    assert!(
        output.status.success() && said.contains("continuous: "),
        "{said}"
    );
    // The mode that is taken, as `hyde modes` tells it.
    assert!(
        said.contains("guide                    slip, in the run stuck"),
        "{said}"
    );
    let output = hyde(&[&model[..], &["--out", "first.xls"]].concat());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        !output.status.success() && said.contains("write `.mat`, `.json`"),
        "{said}"
    );
    let wrong = hyde(&[&model[..], &["--input", "force", "--out", &out]].concat());
    let said = String::from_utf8(wrong.stderr).unwrap();
    assert!(said.contains("its inputs are `T`"), "{said}");
}

#[test]
fn an_assistant_uses_hyde_through_the_protocol() {
    let Ok(python) = python().map_err(|reason| eprintln!("skipped: {reason}")) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new(python);
    command.arg("tests/exports/mcp_client.py");
    command.arg(env!("CARGO_BIN_EXE_hyde-tested"));
    let printed = succeed(command.arg(folder.path())).unwrap();
    assert!(printed.ends_with("done\n"), "{printed}");
    let results = folder.path().join("results.csv");
    assert!(results.is_file(), "the samples are in the folder");
}

#[test]
fn classes_of_modelica_run_in_rumoca() {
    let Ok(python) = python().map_err(|reason| eprintln!("skipped: {reason}")) else {
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    let place = |name: &str| folder.path().join(name).to_string_lossy().into_owned();
    let mut asked = Vec::new();
    for (file, experiment, class, quantities) in [
        (FMU, "stepped", "Lag_stepped", "x,count:1e-4"),
        (FMU, "bouncing", "Ball_bouncing", "h:1e-3"),
        (FMU, "moved", "Sampled_moved", "mass.s,mass.v:1e-3"),
        // What an initial equation finds, a guide that slips at the start, a branch before another one, a common tick.
        (EXPORTED, "let_go", "Hung_let_go", "s,v:1e-3"),
        (EXPORTED, "coast", "Coasting_coast", "m.s,m.v:1e-3"),
        (EXPORTED, "branches", "Either_branches", "x,n:1e-3"),
        (EXPORTED, "ticks", "Common_ticks", "x,b.seen:1e-3"),
        (
            "examples/first/first.hyde",
            "push",
            "Axis_push",
            "table.a.s:1e-3",
        ),
    ] {
        let out = place(&format!("{class}.mo"));
        done(&[
            "export", "modelica", file, experiment, "--quiet", "--out", &out,
        ]);
        let run = ["run", file, experiment, "--quiet", "--format", "json"];
        done(&[&run[..], &["--out", &place(class)]].concat());
        asked.push(format!("{class}:{quantities}"));
    }
    let stiff = [
        "export",
        "modelica",
        "examples/y_axis/axis.hyde",
        "positioning",
    ];
    let out = place("Axis_positioning.mo");
    done(&[&stiff[..], &["--quiet", "--out", &out]].concat());
    asked.push("Axis_positioning::".to_owned());
    let mut command = Command::new(python);
    command.arg("tests/exports/modelica.py").arg(folder.path());
    let printed = succeed(command.args(asked)).unwrap();
    assert!(printed.ends_with("done\n"), "{printed}");
}

#[test]
fn what_modelica_does_not_express_is_refused_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder
        .path()
        .join("never.mo")
        .to_string_lossy()
        .into_owned();
    for (file, experiment, place) in [
        ("tests/models/chosen.hyde", "swing", "`x`, `y`"),
        ("tests/models/reactions.hyde", "edges", "this edge"),
    ] {
        let output = hyde(&["export", "modelica", file, experiment, "--out", &out]);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(!output.status.success(), "{said}");
        assert!(said.contains("E0815") && said.contains(place), "{said}");
    }
}
