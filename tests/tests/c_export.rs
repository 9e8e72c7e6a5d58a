//! Models as C: compiled by `cc` without warnings, run under the address and undefined-behaviour sanitizers, and compared
//! with the fixed-step reference on machine code ([`hyde_tests::fixed_step`]) and with closed forms.
#![allow(
    clippy::disallowed_methods,
    clippy::unwrap_used,
    reason = "tests open files, and unwrap what must be there"
)]

use hyde_compiler::Backend;
use hyde_program::Program;
use hyde_tests::fixed_step::{FixedStep, inputs, lines};
use hyde_tests::{Example, root};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const MODELS: &str = "tests/models/fmu.hyde";
/// Of a model, relative to the largest value of an output.
const AGREES: f64 = 1e-9;

fn hyde(arguments: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_hyde-tested"));
    command
        .current_dir(root())
        .args(arguments)
        .output()
        .unwrap()
}

/// A model as a program that steps it.
struct Built {
    folder: tempfile::TempDir,
    outputs: Vec<String>,
}

impl Built {
    fn new(file: &str, experiment: &str, step: &str, outputs: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_string_lossy().into_owned();
        let model = ["export", "c", file, experiment, "--step", step];
        let others = ["--name", "model", "--output", outputs, "--out", &path];
        let output = hyde(&[&model[..], &others].concat());
        assert!(output.status.success(), "{output:?}");
        let mut compiler = Command::new("cc");
        compiler.current_dir(folder.path()).args([
            "-std=c11",
            "-Wall",
            "-Wextra",
            "-Wpedantic",
            "-Werror",
            "-O1",
            "-g",
            "-fsanitize=address,undefined",
            "-fno-sanitize-recover=all",
            "-I.",
            "model.c",
        ]);
        compiler.arg(root().join("tests/exports/steps.c"));
        let output = compiler.args(["-o", "steps", "-lm"]).output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{said}");
        Self {
            folder,
            outputs: outputs.split(',').map(str::to_owned).collect(),
        }
    }

    /// The outputs in the program's order, after every step.
    fn run(&self, steps: usize, inputs: &[Vec<f64>]) -> Result<Vec<Vec<f64>>, String> {
        let mut command = Command::new(self.program());
        command.arg(steps.to_string());
        if !inputs.is_empty() {
            let path = self.folder.path().join("inputs");
            std::fs::write(&path, lines(inputs)).unwrap();
            command.arg(path);
        }
        let output = command.output().unwrap();
        if !output.status.success() {
            return Err(String::from_utf8_lossy(&output.stderr).into_owned());
        }
        let text = String::from_utf8(output.stdout).unwrap();
        let row = |line: &str| {
            line.split_whitespace()
                .map(|x| x.parse().unwrap())
                .collect()
        };
        Ok(text.lines().map(row).collect())
    }

    fn program(&self) -> PathBuf {
        self.folder.path().join("steps")
    }

    /// The numbers of the outputs in a program, in the order in which the C code has them.
    fn numbers(&self, program: &Program) -> Vec<usize> {
        let mut found: Vec<usize> = self
            .outputs
            .iter()
            .map(|name| program.output(name).unwrap())
            .collect();
        found.sort_unstable();
        found
    }
}

/// Compares a model with the reference; gives back how many values were compared and how often the outputs changed.
fn compare(file: &str, experiment: &str, step: &str, outputs: &str, steps: usize) -> usize {
    let built = Built::new(file, experiment, step, outputs);
    let example = Example::load(file, Some(experiment)).unwrap();
    let tables = example.parse().unwrap().tables;
    let program = example.compile(Backend::Native).unwrap().program;
    let p = hyde_experiment::parameters(&program, &tables, &[]).unwrap();
    let ((start_s, _), _) = hyde_experiment::extent(&program, &tables, &p);
    let step_s: f64 = step.parse().unwrap();
    let times: Vec<f64> = (1..=steps).map(|k| start_s + k as f64 * step_s).collect();
    let inputs = inputs(&program, &tables, &times).unwrap();
    let found = built.run(steps, &inputs).unwrap();
    assert_eq!(found.len(), steps + 1);
    let start = hyde_sim::known_start(&program, &tables, &p, start_s, &[]).unwrap();
    let mut reference = FixedStep::new(&program, p, (start_s, step_s), start).unwrap();
    let numbers = built.numbers(&program);
    let mut expected = Vec::new();
    for k in 0..=steps {
        if k > 0 {
            for (column, value) in inputs.get(k - 1).into_iter().flatten().enumerate() {
                reference.u[2 * column] = *value;
                reference.u[2 * column + 1] = *value;
            }
            reference.step().unwrap();
        }
        let all = reference.outputs();
        expected.push(numbers.iter().map(|&n| all[n]).collect::<Vec<f64>>());
    }
    let mut compared = 0;
    for (column, &number) in numbers.iter().enumerate() {
        let largest = expected
            .iter()
            .map(|row| row[column].abs())
            .fold(0.0, f64::max);
        assert!(
            largest > 0.0,
            "`{}` never moves",
            program.outputs[number].name
        );
        for (k, (own, other)) in found.iter().zip(&expected).enumerate() {
            let off = (own[column] - other[column]).abs() / largest;
            let name = &program.outputs[number].name;
            assert!(
                off <= AGREES,
                "{name} in step {k}: {} {}",
                own[column],
                other[column]
            );
            compared += 1;
        }
    }
    compared
}

#[test]
fn small_models_agree_with_the_reference() {
    assert!(compare(MODELS, "stepped", "1e-4", "x,y,high,count", 3000) == 4 * 3001);
    assert!(compare(MODELS, "bouncing", "1e-4", "h,v,bounces", 20_000) == 3 * 20_001);
    let moved = "mass.s,mass.v,guide.a.f,control.F,limited";
    assert!(compare(MODELS, "moved", "1e-4", moved, 6000) == 5 * 6001);
}

#[test]
fn the_y_axis_agrees_with_the_reference() {
    let outputs = "saddle.s,saddle.v,motor.w,armature.i,screw.contact.F";
    let compared = compare(
        "examples/y_axis/axis.hyde",
        "positioning",
        "1e-4",
        outputs,
        2500,
    );
    assert!(compared == 5 * 2501);
}

#[test]
fn the_bench_axis_agrees_with_the_reference() {
    let outputs = "saddle.s,saddle.v,motor.i,motor.w,guide.a.f";
    let compared = compare(
        "examples/bench_axis/axis.hyde",
        "bench",
        "1e-4",
        outputs,
        6000,
    );
    assert!(compared == 5 * 6001);
}

#[test]
fn a_lag_and_a_ball_follow_their_closed_forms() {
    let lag = Built::new(MODELS, "stepped", "1e-4", "x,count")
        .run(3000, &[])
        .unwrap();
    for (k, row) in lag.iter().enumerate() {
        // Implicit Euler has its own closed form.
        let exact = 1.0 - (1.0_f64 + 1e-4 / 0.05).powi(-i32::try_from(k).unwrap());
        assert!((row[0] - exact).abs() < 1e-11, "{k}: {} {exact}", row[0]);
        let counted = if row[0] > 0.5 { 4.0 } else { 0.0 };
        assert!((row[1] - counted).abs() < 1e-12, "{k}");
    }
    let ball = Built::new(MODELS, "bouncing", "1e-5", "h,bounces")
        .run(50_000, &[])
        .unwrap();
    let first = ball.iter().position(|row| row[1] > 0.5).unwrap();
    let falls = (2.0_f64 / 9.81).sqrt();
    assert!(
        (first as f64 * 1e-5 - falls).abs() < 3e-5,
        "{first} {falls}"
    );
}

#[test]
fn a_failed_assert_leaves_the_model_as_it_was() {
    let built = Built::new(MODELS, "crushed", "1e-2", "x");
    let said = built.run(60, &[]).unwrap_err();
    assert!(said.contains("at 0.49 s: the spring is crushed"), "{said}");
}

#[test]
fn what_cannot_be_expressed_is_refused() {
    let refused = |model: &[&str], step: &str| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_string_lossy().into_owned();
        let others = ["--step", step, "--out", &path];
        let output = hyde(&[&["export", "c"], model, &others].concat());
        assert!(!output.status.success());
        assert!(!Path::new(&path).join("model.c").exists());
        String::from_utf8(output.stderr).unwrap()
    };
    let said = refused(&[MODELS, "moved"], "0.3e-3");
    assert!(
        said.contains("E0815") && said.contains("not a whole number of steps"),
        "{said}"
    );
    let said = refused(
        &["tests/fixtures/errors/E0815_delay_in_a_state_space.hyde"],
        "1e-3",
    );
    assert!(
        said.contains("E0815") && said.contains("no `delay`"),
        "{said}"
    );
    let said = refused(&[MODELS, "moved"], "0");
    assert!(said.contains("`--step`"), "{said}");
}
