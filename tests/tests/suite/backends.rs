//! Machine code against the interpreter of the same IR: no bit apart, kernel by kernel and over a whole run.

use crate::examples::{self, Case};
use crate::points::{Random, Values, parameters, plain};
use hyde_compiler::{Backend, Stage};
use hyde_experiment::Options;
use hyde_program::{Constant, Function, Point, Program, Workspace};
use hyde_tests::Example;

#[test]
fn every_kernel_agrees_to_the_last_bit() {
    for case in examples::all() {
        agrees(&case);
    }
}

/// Four hundred rows that read one explicit variable: such a kernel becomes several functions, and those that come later
/// read what the first has made.
#[test]
fn a_kernel_of_several_functions_agrees_to_the_last_bit() {
    let mut text =
        "package rows;\nmodel Rows\n  Real shared = sin(x1*(1 [rad]))*exp(-x2^2);\n".to_owned();
    for row in 1..=400 {
        text += &format!("  Real x{row}(start = {row}/400, fixed = true);\n");
    }
    text += "equation\n";
    for row in 1..=400 {
        text += &format!("  der(x{row}) = (shared*x{row} - sin(x{row}*(1 [rad]))^3)/(1 [s]);\n");
    }
    text += "end Rows;\nexperiment run of Rows\n  stop 1 [s];\nend run;\n";
    let any = Example::load("tests/models/travelling_nut.hyde", Some("free")).unwrap();
    let case = Case {
        name: "rows".to_owned(),
        folder: String::new(),
        example: any.replaced(&text, "run"),
    };
    let clif = case.example.emit(Stage::Clif).unwrap();
    assert!(clif.contains("residual_partials_part_2"));
    agrees(&case);
}

/// One call computes both of an argument: of scalars, of the elements of a loop, and in a tick before and after an assignment.
#[test]
fn sines_with_cosines_agree_to_the_last_bit() {
    let text = "package turning;
import SI.*;
model Turning
  Angle x[12](start = 0.3, fixed = true);
  Angle y(start = 0.2, fixed = true);
  Real both = sin(y)*cos(y);
  Real held = hold(c.a);
  clocked c(10 [ms])
    Angle phi(start = 0) = pre(phi) + 0.1 [rad]*sin(sample(y));
    Real a(start = 0) = sin(phi)*sample(both) - cos(phi)*cos(sample(y));
  end c;
equation
  der(y) = (both - cos(y)^3)*1 [rad/s];
  for i in 1:12 loop
    der(x[i]) = (sin(x[i])^2 - cos(x[i])*both + held)*1 [rad/s];
  end for;
end Turning;
experiment run of Turning
  stop 1 [s];
end run;
";
    let any = Example::load("tests/models/travelling_nut.hyde", Some("free")).unwrap();
    let case = Case {
        name: "turning".to_owned(),
        folder: String::new(),
        example: any.replaced(text, "run"),
    };
    let clif = case.example.emit(Stage::Clif).unwrap();
    assert!(clif.contains("hyde_sine_and_cosine"));
    agrees(&case);
}

/// All kernels of a case at some points.
fn agrees(case: &Case) {
    let [native, oracle] = both(case);
    let p = parameters(&native, &[]);
    same(case, "parameters", &p, &parameters(&oracle, &[]));
    same(case, "start", &start(&native, &p), &start(&oracle, &p));
    let mut random = Random(1);
    for _ in 0..8 {
        let values = Values::of(&native, &mut random);
        let at = values.point(&p);
        let pairs = numbers(&native, at).into_iter().zip(numbers(&oracle, at));
        for ((kernel, a), (_, b)) in pairs {
            same(case, &kernel, &a, &b);
        }
    }
}

#[test]
fn some_rows_are_those_of_the_whole() {
    for case in examples::all() {
        for program in both(&case) {
            let p = parameters(&program, &[]);
            let values = Values::of(&program, &mut Random(3));
            let at = values.point(&p);
            let mut work = Workspace::new(program.n_work);
            for function in Function::ALL {
                let mut whole = vec![f64::NAN; program.rows(function)];
                program
                    .kernels
                    .evaluate(function, at, &mut work, &mut whole);
                // Every third from the end, and the last of these twice.
                let mut rows: Vec<usize> = (0..whole.len()).rev().step_by(3).collect();
                rows.extend(rows.last().copied());
                let some = program.kernels.some_rows(function, &rows);
                let mut own = vec![f64::NAN; rows.len()];
                some.evaluate(at, &mut Workspace::new(program.n_work), &mut own);
                let known: Vec<f64> = rows.iter().map(|&row| whole[row]).collect();
                same(&case, &format!("rows of {function:?}"), &own, &known);
            }
        }
    }
}

#[test]
fn some_derivatives_by_parameters_are_those_of_the_whole() {
    for case in examples::all() {
        for program in both(&case) {
            let p = parameters(&program, &[]);
            let values = Values::of(&program, &mut Random(5));
            let at = values.point(&p);
            let mut work = Workspace::new(program.n_work);
            for function in Function::ALL {
                let kernels = &program.kernels;
                let mut whole = vec![f64::NAN; kernels.still_entries(function).len()];
                kernels.still_partials(function, at, &mut work, &mut whole);
                let numbers: Vec<usize> = (0..whole.len()).rev().step_by(3).collect();
                let some = kernels.some_still_partials(function, &numbers);
                let mut own = vec![f64::NAN; numbers.len()];
                some.evaluate(at, &mut Workspace::new(program.n_work), &mut own);
                let known: Vec<f64> = numbers.iter().map(|&number| whole[number]).collect();
                same(&case, &format!("derivatives of {function:?}"), &own, &known);
            }
        }
    }
}

/// What the fixed steps of a calibration stand on: they evaluate what bends and no more.
#[test]
fn rows_that_do_not_bend_have_the_same_derivatives_everywhere() {
    let (mut straight, mut bent) = (0, 0);
    for case in examples::all() {
        let [program, _] = both(&case);
        let bending = program.kernels.bending_rows();
        assert!(bending.is_sorted());
        let p = parameters(&program, &[]);
        let mut random = Random(4);
        let start = Values::of(&program, &mut random);
        let derivatives = |at: Point<'_>| {
            let mut values = vec![f64::NAN; program.partials(Function::Residual).len()];
            let mut work = Workspace::new(program.n_work);
            let kernels = &program.kernels;
            kernels.partials(Function::Residual, at, &mut work, &mut values);
            values
        };
        let here = derivatives(start.point(&p));
        for _ in 0..4 {
            let other = Values::of(&program, &mut random);
            // Modes and relations stay.
            let at = Point {
                z: start.point(&p).z,
                ..other.point(&p)
            };
            let there = derivatives(at);
            let entries = program.partials(Function::Residual);
            for ((entry, a), b) in entries.iter().zip(&here).zip(&there) {
                let bends = bending.binary_search(&entry.row).is_ok();
                let same = a.to_bits() == b.to_bits();
                assert!(bends || same, "{}: row {}", case.name, entry.row);
                straight += usize::from(!bends);
                bent += usize::from(!same);
            }
        }
    }
    assert!(straight > 1000 && bent > 0, "{straight} {bent}");
}

#[test]
fn derivatives_by_parameters_agree_to_the_last_bit() {
    for case in examples::all() {
        let [native, oracle] = both(&case);
        let p = parameters(&native, &[]);
        let values = Values::of(&native, &mut Random(2));
        let at = values.point(&p);
        let all = plain(&native);
        for function in Function::ALL {
            let of = |program: &Program| {
                let mut work = Workspace::new(program.n_work);
                let kernels = &program.kernels;
                kernels.parameter_partials(function, &all, at, &mut work)
            };
            let (a, b) = (of(&native), of(&oracle));
            let places = |list: &[(hyde_program::PartialEntry, f64)]| {
                list.iter().map(|(entry, _)| *entry).collect::<Vec<_>>()
            };
            assert_eq!(places(&a), places(&b), "{}: {function:?}", case.name);
            let numbers =
                |list: &[(_, f64)]| list.iter().map(|(_, value)| *value).collect::<Vec<_>>();
            same(&case, &format!("{function:?}"), &numbers(&a), &numbers(&b));
        }
    }
}

#[test]
fn a_run_is_the_same_on_both() {
    for case in examples::all() {
        let loaded = case.example.parse().unwrap();
        let [a, b] = both(&case).map(|program| {
            // Rows before those that are skipped are not compared, and some must be.
            let skip = program
                .kernels
                .constant(Constant::Skip, &parameters(&program, &[]));
            let options = Options {
                stop_s: Some(skip.unwrap_or(0.0).max(0.09) + 0.01),
                ..Options::default()
            };
            hyde_experiment::run(&program, &loaded.tables, &options).unwrap()
        });
        same(&case, "time", &a.results.time, &b.results.time);
        assert_eq!(a.results.outputs, b.results.outputs);
        for ((number, a), (_, b)) in a.results.kept().zip(b.results.kept()) {
            same(&case, &format!("output {number}"), &a.values(), &b.values());
        }
        assert_eq!(a.results.events, b.results.events, "{}", case.name);
        assert_eq!(a.results.statistics, b.results.statistics, "{}", case.name);
    }
}

fn both(case: &Case) -> [Program; 2] {
    [Backend::Native, Backend::Interpreter].map(|backend| {
        let compiled = case.example.compile(backend);
        compiled
            .unwrap_or_else(|error| panic!("{}: {error}", case.name))
            .program
    })
}

fn start(program: &Program, p: &[f64]) -> Vec<f64> {
    let (mut y, mut z) = (vec![0.0; program.n_unknowns], vec![0.0; program.n_memory]);
    program.kernels.start(p, &mut y, &mut z);
    y.extend(z);
    y
}

/// What every kernel gives at a point, with its name.
fn numbers(program: &Program, at: Point<'_>) -> Vec<(String, Vec<f64>)> {
    let kernels = &program.kernels;
    let mut work = Workspace::new(program.n_work);
    let mut found = Vec::new();
    for function in Function::ALL {
        let mut out = vec![f64::NAN; program.rows(function)];
        kernels.evaluate(function, at, &mut work, &mut out);
        found.push((format!("{function:?}"), out));
        let mut out = vec![f64::NAN; program.partials(function).len()];
        kernels.partials(function, at, &mut work, &mut out);
        found.push((format!("partials of {function:?}"), out));
    }
    let mut out = vec![f64::NAN; program.reactions.len()];
    kernels.conditions(at, &mut work, &mut out);
    found.push(("conditions".to_owned(), out));
    for clock in 0..program.clocks.len() {
        let mut after = at.z.to_vec();
        kernels.tick(clock, at, &mut work, &mut after);
        found.push((format!("tick of clock {clock}"), after));
    }
    found
}

/// Bit by bit; two values that are no number are alike.
fn same(case: &Case, what: &str, a: &[f64], b: &[f64]) {
    assert_eq!(a.len(), b.len(), "{}: {what}", case.name);
    for (number, (a, b)) in a.iter().zip(b).enumerate() {
        assert!(
            a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan()),
            "{}: {what}, value {number}: {a:e} by machine code, {b:e} by the interpreter",
            case.name
        );
    }
}
