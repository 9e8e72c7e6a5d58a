//! FMUs in a real importer: FMPy validates them, simulates them by co-simulation and by model exchange, and agrees with
//! `hyde run`. Without FMPy in `target/fmpy` these tests say so and pass; `./dev test` installs it.
#![allow(
    clippy::disallowed_methods,
    clippy::print_stderr,
    clippy::unwrap_used,
    reason = "tests open files, tell what they skip, and unwrap what must be there"
)]

use hyde_tests::fmu::{Compared, FMI_RS_KINDS, KINDS, compare, fmi_rs, python, succeed};
use hyde_tests::random_fmus::RandomFmus;
use hyde_tests::root;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const MODELS: &str = "tests/models/fmu.hyde";

fn hyde() -> &'static Path {
    Path::new(env!("CARGO_BIN_EXE_hyde-tested"))
}

fn export(arguments: &[&str]) -> Output {
    let mut command = Command::new(hyde());
    command.current_dir(root()).args(["export", "fmu"]);
    command.args(arguments).output().unwrap()
}

/// Whether FMPy is there; says so if not.
fn importer() -> bool {
    python()
        .map_err(|reason| eprintln!("skipped: {reason}"))
        .is_ok()
}

#[test]
fn fmus_agree_with_the_run_of_their_experiment() {
    if !importer() {
        return;
    }
    for experiment in ["stepped", "bouncing", "moved"] {
        for fmi in ["3", "2"] {
            let compared = Compared {
                file: MODELS,
                experiment,
                fmi,
                run: &[],
                tolerance: "1e-10",
                kinds: &KINDS,
            };
            for own in compare(hyde(), &compared).unwrap() {
                let (samples, quantities, events) = own.compared;
                assert!(samples > 200 && quantities >= 3 && events >= 1, "{own:?}");
                // The library's own solver gives the digits of the run.
                let most = if own.kind == KINDS[2] { 1e-6 } else { 0.0 };
                assert!(own.deviation.0 <= most, "{experiment} {fmi}: {own:?}");
                assert!(
                    own.event_time_error_us <= 1.0,
                    "{experiment} {fmi}: {own:?}"
                );
            }
        }
    }
}

#[test]
fn an_axis_with_stick_and_a_field_agrees_as_well() {
    if !importer() {
        return;
    }
    // The second reports a derivative of a state itself, which is computed in two ways.
    for (file, experiment, quantities, most) in [
        ("examples/first/first.hyde", "push", 50, 0.0),
        ("tests/models/library/logic.hyde", "logic", 1, 1e-12),
    ] {
        let compared = Compared {
            file,
            experiment,
            fmi: "3",
            run: &[],
            tolerance: "1e-8",
            kinds: &KINDS[..2],
        };
        for own in compare(hyde(), &compared).unwrap() {
            let (samples, columns, _) = own.compared;
            assert!(samples > 200 && columns > quantities, "{own:?}");
            assert!(own.deviation.0 <= most, "{own:?}");
            assert!(own.event_time_error_us <= 1.0, "{own:?}");
        }
    }
}

#[test]
fn importers_set_read_fail_and_begin_again() {
    let Ok(python) = python() else {
        importer();
        return;
    };
    let folder = tempfile::tempdir().unwrap();
    for fmi in ["3", "2"] {
        for (name, file, model) in [
            ("lag", MODELS, ["--model", "Lag"].as_slice()),
            ("crushed", MODELS, &["crushed"]),
            ("ball", MODELS, &["bouncing"]),
            ("moved", MODELS, &["moved"]),
            ("bounded", "tests/models/exported.hyde", &["pushed"]),
        ] {
            let out = folder.path().join(format!("{name}{fmi}.fmu"));
            let out = out.to_string_lossy().into_owned();
            let mut arguments = vec![file];
            arguments.extend(model);
            arguments.extend(["--fmi", fmi, "--out", &out]);
            let output = export(&arguments);
            assert!(output.status.success(), "{output:?}");
        }
    }
    let mut command = Command::new(python);
    command.arg("tests/fmu/behaviour.py").arg(folder.path());
    let printed = succeed(&mut command).unwrap();
    assert!(printed.ends_with("done\n"), "{printed}");
}

#[test]
fn an_fmu_has_the_source_only_if_it_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("x.fmu");
    let out_text = out.to_string_lossy().into_owned();
    let contains = |text: &str| {
        let bytes = std::fs::read(&out).unwrap();
        bytes
            .windows(text.len())
            .any(|part| part == text.as_bytes())
    };
    let plain = [MODELS, "stepped", "--quiet", "--out", &out_text];
    assert!(export(&plain).status.success());
    assert!(contains("resources/model.hydefmu") && !contains("resources/source/fmu.hyde"));
    let mut asked = plain.to_vec();
    asked.push("--with-source");
    assert!(export(&asked).status.success());
    assert!(contains("resources/source/fmu.hyde"));
}

#[test]
fn what_cannot_be_exported_is_refused_with_what_there_is() {
    let refused = |arguments: &[&str], said: &str| {
        let output = export(arguments);
        let text = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success() && text.contains(said), "{text}");
    };
    refused(
        &[MODELS, "stepped", "--output", "lag.x"],
        "no quantity `lag.x`; did you mean `x`?",
    );
    refused(
        &[MODELS, "stepped", "--input", "w"],
        "no stimulus drives an input `w`; those of the experiment drive `u`",
    );
    refused(&[MODELS, "stopped"], "no experiment `stopped`");
    refused(&["tests/models/delays.hyde", "--model", "Nobody"], "Nobody");
}

#[test]
fn without_its_library_the_command_says_where_it_looked() {
    let folder = tempfile::tempdir_in(hyde().parent().unwrap()).unwrap();
    let alone: PathBuf = folder.path().join("bin/hyde");
    std::fs::create_dir(folder.path().join("bin")).unwrap();
    std::fs::hard_link(hyde(), &alone).unwrap();
    let mut command = Command::new(alone);
    let command = command
        .current_dir(root())
        .args(["export", "fmu", MODELS, "stepped"]);
    let output = command.output().unwrap();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success(), "{text}");
    assert!(text.contains("lib/libhyde_fmu.so"), "{text}");
}

#[test]
fn a_model_with_a_delay_is_exported_for_co_simulation_alone() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("x.fmu").to_string_lossy().into_owned();
    let output = export(&["tests/models/delays.hyde", "closed", "--out", &out]);
    let text = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success(), "{output:?}");
    assert!(text.contains("no model exchange"), "{text}");
}

/// Exports an experiment, and what FMPy finds in its reference results.
fn reference(arguments: &[&str], experiment: &str) -> Option<Value> {
    let python = python()
        .map_err(|reason| eprintln!("skipped: {reason}"))
        .ok()?;
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("x.fmu").to_string_lossy().into_owned();
    let all: Vec<&str> = arguments.iter().copied().chain(["--out", &out]).collect();
    let output = export(&all);
    assert!(output.status.success(), "{output:?}");
    let mut command = Command::new(python);
    let command = command.arg("tests/fmu/reference.py").arg(out);
    let printed = succeed(command.arg(experiment)).unwrap();
    let found: Value = serde_json::from_str(&printed).unwrap();
    assert_eq!(found["findings"], Value::Array(Vec::new()), "{found}");
    Some(found)
}

#[test]
fn an_fmu_holds_the_results_of_its_experiment_which_an_importer_repeats() {
    for fmi in ["3", "2"] {
        let asked = [MODELS, "stepped", "--fmi", fmi];
        let Some(found) = reference(&asked, "stepped") else {
            return;
        };
        assert_eq!(found["related"]["result"], "stepped_out.csv");
        assert_eq!(found["inputs"], 0, "{found}");
        assert!(found["compared"].as_u64().unwrap() > 250, "{found}");
        assert!(found["deviation"].as_f64().unwrap() <= 1e-12, "{found}");
        // The importer sets the input: its stimulus is in the FMU as a table.
        let asked = [MODELS, "stepped", "--input", "u", "--fmi", fmi];
        let found = reference(&asked, "stepped").unwrap();
        assert_eq!(found["inputs"], 1, "{found}");
        assert!(found["deviation"].as_f64().unwrap() <= 1e-6, "{found}");
    }
}

#[test]
fn expectations_and_measures_are_in_the_fmu() {
    let asked = ["examples/first/first.hyde", "push", "--reference", "whole"];
    let Some(found) = reference(&asked, "push") else {
        return;
    };
    assert_eq!(found["related"]["testcase"], "push_expect.json");
    let expected = &found["expected"]["expectations"][0];
    assert_eq!(expected["holds"], true, "{found}");
    assert!(found["deviation"].as_f64().unwrap() <= 1e-9, "{found}");
}

#[test]
fn reference_results_end_with_the_run_and_after_1000_rows() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("x.fmu").to_string_lossy().into_owned();
    let said = |arguments: &[&str]| {
        let all: Vec<&str> = arguments.iter().copied().chain(["--out", &out]).collect();
        let output = export(&all);
        assert!(output.status.success(), "{output:?}");
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let crushed = said(&[MODELS, "crushed"]);
    assert!(crushed.contains("no reference results: E0704"), "{crushed}");
    let long = said(&["examples/y_axis/axis.hyde", "positioning"]);
    assert!(
        long.contains("reference results: the run to 1 s;"),
        "{long}"
    );
    for without in [
        said(&[MODELS, "stepped", "--reference", "none"]),
        said(&[MODELS, "--model", "Lag"]),
    ] {
        assert!(!without.contains("reference results"), "{without}");
    }
}

#[test]
fn random_models_run_in_an_importer() {
    if !importer() {
        return;
    }
    let fmus = RandomFmus::export(hyde(), 0..10).unwrap();
    assert!(fmus.len() >= 9, "refused: {:?}", fmus.refused);
    let failures = fmus.failures().unwrap();
    assert!(failures.is_empty(), "{failures:#?}");
}

#[test]
fn a_second_importer_agrees_with_the_runs_of_the_examples() {
    if !importer() {
        return;
    }
    if let Err(reason) = fmi_rs() {
        eprintln!("skipped: {reason}");
        return;
    }
    // Event mode is one of FMI 3.0.
    for (file, experiment, fmi, kinds) in [
        (MODELS, "stepped", "3", &FMI_RS_KINDS[..]),
        (MODELS, "bouncing", "3", &FMI_RS_KINDS),
        (MODELS, "moved", "3", &FMI_RS_KINDS),
        (MODELS, "bouncing", "2", &FMI_RS_KINDS[..1]),
        ("examples/first/first.hyde", "push", "3", &FMI_RS_KINDS),
        ("examples/first/first.hyde", "push", "2", &FMI_RS_KINDS[..1]),
        ("examples/shaft/shaft.hyde", "step", "3", &FMI_RS_KINDS),
    ] {
        let compared = Compared {
            file,
            experiment,
            fmi,
            run: &[],
            tolerance: "1e-8",
            kinds,
        };
        for own in compare(hyde(), &compared).unwrap() {
            let (samples, _, _) = own.compared;
            assert!(samples > 100, "{experiment}: {own:?}");
            assert!(own.deviation.0 <= 1e-6, "{experiment}: {own:?}");
            assert!(own.event_time_error_us <= 1.0, "{experiment}: {own:?}");
        }
    }
}

#[test]
fn an_instance_leaves_no_memory_behind() {
    if !importer() {
        return;
    }
    if Command::new("valgrind").arg("--version").output().is_err() {
        eprintln!("skipped: there is no valgrind: `./dev setup` installs it");
        return;
    }
    // One of FMI 3.0, one of FMI 2.0.
    let fmus = RandomFmus::export(hyde(), 0..2).unwrap();
    let (lost, errors, told) = fmus.memory().unwrap();
    assert_eq!((fmus.len(), lost, errors), (2, 0, 0), "{told}");
}
