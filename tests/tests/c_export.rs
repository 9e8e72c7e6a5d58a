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

/// What is set before a step: its number, the kind `p` or `in`, the name, the value.
type Change<'a> = (usize, &'a str, &'a str, f64);

/// A model as a program that steps it.
struct Built {
    folder: tempfile::TempDir,
    outputs: Vec<String>,
}

impl Built {
    fn new(file: &str, experiment: &str, step: &str, outputs: &str) -> Self {
        Self::with_inputs(file, experiment, step, outputs, &[])
    }

    /// With stimuli that the program sets.
    fn with_inputs(
        file: &str,
        experiment: &str,
        step: &str,
        outputs: &str,
        inputs: &[&str],
    ) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().to_string_lossy().into_owned();
        let model = ["export", "c", file, experiment, "--step", step];
        let others = ["--name", "model", "--output", outputs, "--out", &path];
        let released = inputs.iter().flat_map(|name| ["--input", name]);
        let released: Vec<&str> = released.collect();
        let output = hyde(&[&model[..], &others, &released].concat());
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
        self.run_changed(steps, inputs, &[])
    }

    fn run_changed(
        &self,
        steps: usize,
        inputs: &[Vec<f64>],
        changes: &[Change<'_>],
    ) -> Result<Vec<Vec<f64>>, String> {
        let mut command = Command::new(self.program());
        command.arg(steps.to_string());
        let path = self.folder.path().join("inputs");
        if inputs.is_empty() {
            command.arg("-");
        } else {
            std::fs::write(&path, lines(inputs)).unwrap();
            command.arg(path);
        }
        let path = self.folder.path().join("changes");
        let line = |(step, kind, name, value): &Change<'_>| {
            format!("{step} {kind} {} {value:?}\n", self.number(kind, name))
        };
        std::fs::write(&path, changes.iter().map(line).collect::<String>()).unwrap();
        command.arg(path);
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

    /// The number of a parameter or an input in its enumeration.
    fn number(&self, kind: &str, name: &str) -> usize {
        let header = std::fs::read_to_string(self.folder.path().join("model.h")).unwrap();
        let of_kind = |line: &&str| line.starts_with(&format!("    model_{kind}_"));
        let mut lines = header.lines().filter(of_kind);
        let named = |line: &str| line.contains(&format!("/* {name} "));
        lines.position(named).unwrap()
    }

    /// How many equations bend.
    fn curved(&self) -> usize {
        let source = std::fs::read_to_string(self.folder.path().join("model.c")).unwrap();
        let line = source
            .lines()
            .find_map(|line| line.strip_prefix("#define HY_CURVED "));
        line.unwrap().parse().unwrap()
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

/// Compares a model with the reference; gives back how many values were compared.
fn compare(file: &str, experiment: &str, step: &str, outputs: &str, steps: usize) -> usize {
    let built = Built::new(file, experiment, step, outputs);
    compare_built(&built, (file, experiment, step), steps, &[])
}

/// The same for a model that is built, with parameters and inputs that are set during the run. The reference sets the
/// parameters; its inputs are stimuli.
fn compare_built(
    built: &Built,
    (file, experiment, step): (&str, &str, &str),
    steps: usize,
    changes: &[Change<'_>],
) -> usize {
    let example = Example::load(file, Some(experiment)).unwrap();
    let tables = example.parse().unwrap().tables;
    let program = example.compile(Backend::Native).unwrap().program;
    let p = hyde_experiment::parameters(&program, &tables, &[]).unwrap();
    let ((start_s, _), _) = hyde_experiment::extent(&program, &tables, &p);
    let step_s: f64 = step.parse().unwrap();
    let times: Vec<f64> = (1..=steps).map(|k| start_s + k as f64 * step_s).collect();
    let inputs = inputs(&program, &tables, &times).unwrap();
    let found = built.run_changed(steps, &inputs, changes).unwrap();
    assert_eq!(found.len(), steps + 1);
    let start = hyde_sim::known_start(&program, &tables, &p, start_s, &[]).unwrap();
    let mut reference = FixedStep::new(&program, p, (start_s, step_s), start).unwrap();
    let numbers = built.numbers(&program);
    let mut expected = Vec::new();
    let mut set = Vec::new();
    for k in 0..=steps {
        if k > 0 {
            for (_, _, name, value) in changes.iter().filter(|own| own.0 == k - 1 && own.1 == "p") {
                let (parameter, element) = program.parameter(name).unwrap();
                set.push((parameter.place + element, *value));
                program.kernels.parameters(&set, &mut reference.p);
            }
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
fn a_screw_whose_waves_are_stiff_agrees_with_the_reference() {
    let outputs = "motor.w,pulley2.w,saddle.v";
    for experiment in ["waves", "modules"] {
        let compared = compare(
            "examples/screw_waves/axis.hyde",
            experiment,
            "1e-5",
            outputs,
            500,
        );
        assert_eq!(compared, 3 * 501);
    }
}

#[test]
fn a_double_pendulum_agrees_with_the_reference() {
    let compared = compare(
        "tests/models/msl/double_pendulum.hyde",
        "run",
        "1e-3",
        "revolute1.phi,revolute2.phi,revolute1.w",
        3000,
    );
    assert_eq!(compared, 3 * 3001);
}

const STEPPED: &str = "tests/models/fixed_step.hyde";

#[test]
fn masses_that_stick_and_slip_need_one_iteration_in_each_mode() {
    for (step, steps) in [("1e-3", 1000), ("0.25e-3", 4000)] {
        let outputs = "first.s,first.v,second.v,under.a.f,spring.F";
        let built = Built::new(STEPPED, "sliding", step, outputs);
        assert_eq!(built.curved(), 0);
        let compared = compare_built(&built, (STEPPED, "sliding", step), steps, &[]);
        assert_eq!(compared, 5 * (steps + 1));
    }
}

#[test]
fn equations_that_bend_are_iterated() {
    let built = Built::new(STEPPED, "swinging", "1e-3", "phi,w,torque,friction");
    assert_eq!(built.curved(), 2);
    let compared = compare_built(&built, (STEPPED, "swinging", "1e-3"), 1000, &[]);
    assert_eq!(compared, 4 * 1001);
}

#[test]
fn a_coefficient_of_a_clock_or_a_when_clause_is_followed() {
    let outputs = "x,v,gain,damping,control.reading";
    let built = Built::new(STEPPED, "scheduled", "1e-3", outputs);
    assert_eq!(built.curved(), 1);
    let compared = compare_built(&built, (STEPPED, "scheduled", "1e-3"), 2000, &[]);
    assert_eq!(compared, 5 * 2001);
}

#[test]
fn rows_are_exchanged_where_no_order_serves_all_modes() {
    let built = Built::new(STEPPED, "exchanging", "1e-3", "x,a,b,c");
    assert_eq!(built.curved(), 0);
    let compared = compare_built(&built, (STEPPED, "exchanging", "1e-3"), 500, &[]);
    assert_eq!(compared, 4 * 501);
}

#[test]
fn a_parameter_that_is_set_makes_the_factors_anew() {
    let outputs = "first.s,first.v,second.v,under.a.f,spring.F";
    let built = Built::new(STEPPED, "sliding", "1e-3", outputs);
    let changes = [
        (300, "p", "spring.c", 9000.0),
        (301, "p", "first.M", 0.5),
        (500, "p", "under.F", 2.0),
    ];
    let model = (STEPPED, "sliding", "1e-3");
    assert_eq!(compare_built(&built, model, 1000, &changes), 5 * 1001);
    // The changes matter: without them the model moves otherwise.
    let plain = built.run(1000, &[]).unwrap();
    let changed = built.run_changed(1000, &[], &changes).unwrap();
    assert!((plain[900][0] - changed[900][0]).abs() > 1e-3);
}

#[test]
fn an_input_that_is_a_coefficient_makes_the_factors_anew() {
    let built = Built::with_inputs(STEPPED, "loaded", "1e-3", "x,v", &["load"]);
    assert_eq!(built.curved(), 0);
    let changes = [(0, "in", "load", 0.0), (250, "in", "load", 5.0)];
    let model = (STEPPED, "loaded", "1e-3");
    assert_eq!(compare_built(&built, model, 1000, &changes), 2 * 1001);
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
fn what_an_initial_equation_finds_is_in_the_code() {
    let built = Built::new("tests/models/exported.hyde", "let_go", "1e-4", "s,v");
    let rows = built.run(10_000, &[]).unwrap();
    let (first, last) = (&rows[0], &rows[10_000]);
    // k = m*g/(s + 0.01 s*v) = 961.76 N/m; the end is that of `hyde run`.
    assert!((first[0] - 0.05).abs() < 1e-12 && (first[1] - 0.1).abs() < 1e-12);
    assert!((last[0] - 0.053_499).abs() < 1e-4, "{}", last[0]);
}

#[test]
fn values_outside_their_bounds_are_not_taken() {
    let built = Built::new("tests/models/exported.hyde", "pushed", "1e-3", "v");
    let refused = built.run_changed(20, &[], &[(10, "p", "Fc", -1.0)]);
    let reason = refused.unwrap_err();
    assert!(reason.contains("outside the bounds"), "{reason}");
    let refused = built.run_changed(20, &[], &[(10, "p", "Fc", f64::NAN)]);
    assert!(refused.is_err(), "{refused:?}");
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
