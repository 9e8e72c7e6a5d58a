//! Models of whole arrays, and the same models with every element written out as a variable of its own.

use super::model::Model;
use crate::numbers::Numbers;
use std::fmt::Write as _;

/// The force that is implicit.
const IMPLICIT: u64 = 2;

/// The model of a seed: a row of masses with springs that stiffen, and something about them that arrays have.
pub(super) fn random(seed: u64) -> Model {
    let mut numbers = Numbers::of(seed);
    let n = 3 + numbers.one_of(6) as i32;
    let mut rows = Rows::default();
    let (k, k3, d) = (
        numbers.between(200.0, 4000.0),
        numbers.between(0.0, 5e3),
        numbers.between(0.1, 4.0),
    );
    rows.constant("Stiffness k", k, "N/m");
    rows.constant("Damping d", d, "N.s/m");
    rows.list("Mass m", n, "kg", &mut numbers, (0.3, 3.0));
    let with_levers = numbers.one_of(3) == 0;
    let force = numbers.one_of(7);
    let (x0, v0): (Vec<f64>, Vec<f64>) = (0..n)
        .map(|_| (numbers.between(-0.02, 0.02), numbers.between(-0.3, 0.3)))
        .unzip();
    rows.states(&x0, &v0);
    rows.array("Force g", (1, n));
    rows.array("Length e", (1, n - 1));
    rows.each((1, n - 1), "e[i] = x[i] - x[i + 1]");
    if with_levers {
        levers(&mut rows, &mut numbers, n, k3);
    } else if force == IMPLICIT {
        joined_ends(&mut rows, n, k3);
        rows.each((1, n), "m[i]*der(v[i]) = f[i] - f[i + 1] + g[i]");
    } else {
        rows.array("Force f", (1, n - 1));
        rows.each((1, n - 1), &format!("f[i] = {}", spring(k3, "e[i]")));
        rows.each((1, 1), "m[i]*der(v[i]) = g[i] - f[i] - k*x[i]");
        rows.each((2, n - 1), "m[i]*der(v[i]) = f[i - 1] - f[i] + g[i]");
        rows.each((n, n), "m[i]*der(v[i]) = f[i - 1] + g[i]");
    }
    external(&mut rows, &mut numbers, n, force);
    let parameters = match rows.arrays.equations.contains("delay(") {
        true => Vec::new(),
        false => vec!["k".to_owned(), "d".to_owned(), "m[1]".to_owned()],
    };
    Model {
        text: rows.text(&rows.arrays),
        unrolled: Some(rows.text(&rows.scalars)),
        point: None,
        parameters,
        measures_work: false,
    }
}

/// The force of a spring that stiffens, with a damper.
fn spring(k3: f64, e: &str) -> String {
    format!("k*{e}*(1 + {k3}*({e}/(1 [m]))^2) + d*der({e})")
}

/// The forces on both sides of every mass, so that all have one equation.
fn joined_ends(rows: &mut Rows, n: i32, k3: f64) {
    rows.array("Force f", (1, n + 1));
    rows.each((1, 1), "f[i] = -k*x[i]");
    rows.each((2, n), &format!("f[i] = {}", spring(k3, "e[i - 1]")));
    rows.each((n + 1, n + 1), "f[i] = 0");
}

/// Masses that follow the others by levers: a constraint between whole arrays, which asks for one equation of all.
fn levers(rows: &mut Rows, numbers: &mut Numbers, n: i32, k3: f64) {
    rows.list("Real r", n, "", numbers, (0.4, 2.0));
    joined_ends(rows, n, k3);
    rows.array("Length y", (1, n));
    rows.array("Velocity u", (1, n));
    rows.array("Force h", (1, n));
    rows.each((1, n), "y[i] = r[i]*x[i] + 0.01 [m]");
    rows.each((1, n), "u[i] = der(y[i])");
    rows.each((1, n), "0.4 [kg]*der(u[i]) = h[i] - d*u[i]");
    rows.each(
        (1, n),
        "m[i]*der(v[i]) = f[i] - f[i + 1] + g[i] - r[i]*h[i]",
    );
}

/// What acts on every mass from outside.
fn external(rows: &mut Rows, numbers: &mut Numbers, n: i32, force: u64) {
    let size = numbers.between(0.5, 10.0);
    let rate = numbers.between(10.0, 80.0);
    match force {
        0 => rows.each(
            (1, n),
            &format!("g[i] = {size} [N]*sin({rate} [rad/s]*time + 0.3*i)"),
        ),
        1 => rows.each(
            (1, n),
            &format!(
                "g[i] = noEvent(if x[i] > 2 [mm] then -{} [N/m]*(x[i] - 2 [mm]) else 0)",
                100.0 * size
            ),
        ),
        // Implicit in g: such a force asks for one equation of all masses.
        IMPLICIT => rows.each(
            (1, n),
            &format!(
                "g[i] + {size} [N]*tanh(g[i]/(1 [N])) = -{} [N.s/m]*v[i]",
                2.0 * size
            ),
        ),
        3 => {
            let late = numbers.between(2.0, 20.0);
            rows.each(
                (1, n),
                &format!("g[i] = -{size} [N.s/m]*delay(v[i], {late} [ms])"),
            );
        }
        // One force of all, which every mass shares.
        4 => {
            rows.all("Force whole", "d*v[i]", n);
            rows.each((1, n), "g[i] = -whole/i");
        }
        5 => {
            rows.clocked(numbers.between(1.5, 6.0), size, n);
        }
        _ => rows.each(
            (1, n),
            &format!("g[i] = -{size} [N]*min(max(v[i]/(0.1 [m/s]), -1), 1) - {size} [N]*abs(x[i]/(0.1 [m]))"),
        ),
    }
}

/// A model that is written both ways.
#[derive(Default)]
struct Rows {
    arrays: Both,
    scalars: Both,
}

#[derive(Default)]
struct Both {
    declared: String,
    equations: String,
}

impl Rows {
    fn constant(&mut self, name: &str, value: f64, unit: &str) {
        let line = format!("  parameter {name} = {value} [{unit}];\n");
        self.arrays.declared.push_str(&line);
        self.scalars.declared.push_str(&line);
    }

    fn list(&mut self, name: &str, n: i32, unit: &str, numbers: &mut Numbers, between: (f64, f64)) {
        let values: Vec<f64> = (0..n)
            .map(|_| numbers.between(between.0, between.1))
            .collect();
        let unit = if unit.is_empty() {
            String::new()
        } else {
            format!(" [{unit}]")
        };
        let all = joined(&values);
        let _ = writeln!(
            self.arrays.declared,
            "  parameter {name}[{n}] = {{{all}}}{unit};"
        );
        for (value, i) in values.iter().zip(1..) {
            let _ = writeln!(
                self.scalars.declared,
                "  parameter {name}_{i} = {value}{unit};"
            );
        }
    }

    fn states(&mut self, x0: &[f64], v0: &[f64]) {
        let n = x0.len();
        let _ = writeln!(
            self.arrays.declared,
            "  Length x[{n}](start = {{{}}} [m], fixed = true);\n  \
             Velocity v[{n}](start = {{{}}} [m/s], fixed = true) = der(x);",
            joined(x0),
            joined(v0)
        );
        for ((x, v), i) in x0.iter().zip(v0).zip(1..) {
            let _ = writeln!(
                self.scalars.declared,
                "  Length x_{i}(start = {x} [m], fixed = true);\n  \
                 Velocity v_{i}(start = {v} [m/s], fixed = true) = der(x_{i});"
            );
        }
    }

    fn array(&mut self, name: &str, (first, last): (i32, i32)) {
        let _ = writeln!(
            self.arrays.declared,
            "  {name}[{}](each start = 0, each fixed = false);",
            last - first + 1
        );
        for i in first..=last {
            let _ = writeln!(
                self.scalars.declared,
                "  {name}_{i}(start = 0, fixed = false);"
            );
        }
    }

    fn each(&mut self, (first, last): (i32, i32), equation: &str) {
        if first == last {
            let one = equation
                .replace("[i - 1]", &format!("[{}]", first - 1))
                .replace("[i]", &format!("[{first}]"));
            let _ = writeln!(self.arrays.equations, "  {one};");
        } else {
            let _ = writeln!(
                self.arrays.equations,
                "  for i in {first}:{last} loop\n    {equation};\n  end for;"
            );
        }
        for i in first..=last {
            let _ = writeln!(self.scalars.equations, "  {};", written_out(equation, i));
        }
    }

    /// A variable that is the sum of a term over all.
    fn all(&mut self, name: &str, term: &str, n: i32) {
        let _ = writeln!(
            self.arrays.declared,
            "  {name} = sum({});",
            term.replace("[i]", "")
        );
        let terms: Vec<String> = (1..=n).map(|i| written_out(term, i)).collect();
        let _ = writeln!(self.scalars.declared, "  {name} = {};", terms.join(" + "));
    }

    /// A controller on every mass, which hears of its neighbour a tick late.
    fn clocked(&mut self, period: f64, size: f64, n: i32) {
        let first = format!("u[1] = -{size} [N.s/m]*q[1]");
        let other = format!("u[i] = -{size} [N.s/m]*(q[i] + 0.3*pre(q[i - 1]))");
        let _ = writeln!(
            self.arrays.declared,
            "  clocked c({period} [ms])\n    Velocity q[{n}](each start = 0);\n    Force u[{n}];\n  equation\n    \
             for i in 1:{n} loop\n      q[i] = sample(v[i]);\n    end for;\n    {first};\n    \
             for i in 2:{n} loop\n      {other};\n    end for;\n  end c;"
        );
        let mut inside = String::new();
        for i in 1..=n {
            let _ = write!(inside, "    Velocity q_{i}(start = 0);\n    Force u_{i};\n");
        }
        inside.push_str("  equation\n");
        for i in 1..=n {
            let _ = writeln!(inside, "    q_{i} = sample(v_{i});");
        }
        let _ = writeln!(inside, "    {};", written_out(&first, 1));
        for i in 2..=n {
            let _ = writeln!(inside, "    {};", written_out(&other, i));
        }
        let _ = writeln!(
            self.scalars.declared,
            "  clocked c({period} [ms])\n{inside}  end c;"
        );
        self.each((1, n), "g[i] = hold(c.u[i])");
    }

    fn text(&self, which: &Both) -> String {
        format!(
            "package random \"rows of masses\";\nimport SI.*;\n\nmodel M\n{}equation\n{}end M;\n\n\
             experiment run of M\n  solve ida(rtol = 1e-9, atol = 1e-12) stop 0.3 [s] every 10 [ms];\nend run;\n",
            which.declared, which.equations
        )
    }
}

fn joined(values: &[f64]) -> String {
    let all: Vec<String> = values.iter().map(f64::to_string).collect();
    all.join(", ")
}

/// An equation of one element: the counter is its number, `x[3]` is `x_3`.
fn written_out(equation: &str, i: i32) -> String {
    let own = equation
        .replace("[i - 1]", &format!("_{}", i - 1))
        .replace("[i + 1]", &format!("_{}", i + 1))
        .replace("[1]", "_1")
        .replace("[i]", &format!("_{i}"));
    // The counter as a number.
    own.replace("0.3*i)", &format!("0.3*{i})"))
        .replace("whole/i", &format!("whole/{i}"))
}
