//! `compile_ms_y_axis`, `compile_growth_100k_over_100`, `compile_chain_growth_400_over_100`,
//! `compile_cars_10000_over_1000`: from source text to machine code that has run once.

use super::clock::now;
use super::promise::{Figure, Measured, Promise, Session};
use super::start::START;
use crate::Example;
use hyde_compiler::Backend;
use hyde_program::{Function, Point, Workspace};

pub(super) const Y_AXIS: Figure = Figure {
    name: "compile_ms_y_axis",
    unit: "ms",
    promise: Promise::Below(50.0),
    measure: |_: &Session| {
        Ok(Measured::Value(
            shortest(&Example::load(START.0, Some(START.1))?)? * 1e3,
        ))
    },
};

pub(super) const GROWTH: Figure = Figure {
    name: "compile_growth_100k_over_100",
    unit: "ratio",
    promise: Promise::Below(1.3),
    measure: |_: &Session| {
        let screw = |cells: f64| {
            let example = Example::load("tests/models/screw.hyde", None)?.set("n", cells);
            shortest(&example)
        };
        Ok(Measured::Value(screw(1e5)? / screw(100.0)?))
    },
};

/// The time a mass of a chain takes, of 400 over that of 100.
pub(super) const CHAIN: Figure = Figure {
    name: "compile_chain_growth_400_over_100",
    unit: "ratio",
    promise: Promise::Below(2.0),
    measure: |_: &Session| {
        let chain = |masses: usize| {
            let example = Example::load("tests/models/screw.hyde", None)?;
            let example = example.replaced(&chain_of(masses), "still");
            Ok::<f64, String>(shortest(&example)? / masses as f64)
        };
        Ok(Measured::Value(chain(400)? / chain(100)?))
    },
};

/// The time to compile a train of 10 000 cars with buffers and friction, over that of 1 000 cars.
pub(super) const CARS: Figure = Figure {
    name: "compile_cars_10000_over_1000",
    unit: "ratio",
    promise: Promise::AtMost(12.0),
    measure: |_: &Session| {
        let train = |cars: usize| {
            let example = Example::load("tests/models/screw.hyde", None)?;
            shortest_of(2, &example.replaced(&train_of(cars), "pull"))
        };
        Ok(Measured::Value(train(10_000)? / train(1_000)?))
    },
};

/// Cars on a rail with friction, buffers between them.
fn train_of(cars: usize) -> String {
    let part = |n: usize| {
        let mass = 80.0 + 0.01 * n as f64;
        format!("  Mass car{n}(M = {mass} [kg]); Guide guide{n}(F = 20 [N], b = 50 [N.s/m]);\n")
    };
    let buffer = |n: usize| format!("  SpringDamper buffer{n}(c = 1e6 [N/m], d = 1e3 [N.s/m]);\n");
    let coupled = |n: usize| {
        let next = n + 1;
        format!("  connect(car{n}.a, buffer{n}.a);\n  connect(buffer{n}.b, car{next}.a);\n")
    };
    let on_rail = |n: usize| format!("  connect(car{n}.a, guide{n}.a);\n");
    let parts: String = (1..=cars).map(part).collect();
    let buffers: String = (1..cars).map(buffer).collect();
    let rails: String = (1..=cars).map(on_rail).collect();
    let joints: String = (1..cars).map(coupled).collect();
    format!(
        "package train;\nimport SI.*;\nimport Translational.*;\nmodel Train\n{parts}{buffers}  Drive engine(F = 2 [kN]);\n\
         equation\n  connect(engine.a, car1.a);\n{rails}{joints}end Train;\n\
         experiment pull of Train\n  solve ida(rtol = 1e-6) stop 1 [s];\nend pull;\n"
    )
}

/// Masses with a spring between each two, by name.
fn chain_of(masses: usize) -> String {
    let part = |n: usize| format!("  Mass m{n}(M = 1 [kg]); SpringDamper k{n}(c = 1e4 [N/m]);\n");
    let joint = |n: usize| {
        format!(
            "  connect(m{n}.b, k{n}.a); connect(k{n}.b, m{}.a);\n",
            n + 1
        )
    };
    let parts: String = (0..masses).map(part).collect();
    let joints: String = (0..masses).map(joint).collect();
    format!(
        "package chain;\nimport SI.*;\nimport Translational.*;\nmodel Chain\n{parts}  Mass m{masses}(M = 1 [kg]);\n\
         equation\n{joints}end Chain;\nexperiment still of Chain\n  solve ida(rtol = 1e-6) stop 1 [s];\nend still;\n"
    )
}

/// Repeats; the shortest counts, for nothing but other work on the machine makes one longer.
const REPEATS: usize = 7;

/// The time to compile a model and to have machine code of its residual and its Jacobian, in s.
fn shortest(example: &Example) -> Result<f64, String> {
    shortest_of(REPEATS, example)
}

fn shortest_of(repeats: usize, example: &Example) -> Result<f64, String> {
    let mut least = f64::INFINITY;
    for _ in 0..repeats {
        let start = now();
        let compiled = example.compile(Backend::Native)?;
        let compile = start.elapsed().as_secs_f64();
        let program = &compiled.program;
        let (y, u) = (
            vec![0.0; program.n_unknowns],
            vec![0.0; 2 * program.columns.len() + program.delays.len()],
        );
        let (z, p) = (vec![0.0; program.n_memory], vec![1.0; program.n_parameters]);
        let at = Point {
            t: 0.0,
            y: &y,
            yp: &y,
            z: &z,
            u: &u,
            p: &p,
        };
        let mut work = Workspace::new(program.n_work);
        let mut residual = vec![0.0; program.rows(Function::Residual)];
        let mut partials = vec![0.0; program.partials(Function::Residual).len()];
        // The pages of memory are not made by the first call.
        residual.fill(1.0);
        partials.fill(1.0);
        // The first call makes the code, the second shows what of the first was running it.
        let mut once = || {
            let start = now();
            program
                .kernels
                .evaluate(Function::Residual, at, &mut work, &mut residual);
            program
                .kernels
                .partials(Function::Residual, at, &mut work, &mut partials);
            start.elapsed().as_secs_f64()
        };
        let (first, again) = (once(), once());
        least = least.min(compile + (first - again).max(0.0));
    }
    Ok(least)
}
