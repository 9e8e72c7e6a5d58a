//! Circuits whose equations hide something: a loop of capacitors, and a small current behind a steep diode.

use crate::command::{report, write};
use crate::models::{close, solve};
use std::fmt::Write as _;

/// Voltages of the capacitors a and b of the loop by Kirchhoff's laws and the classical Runge-Kutta method, `t` s behind the
/// step of the source.
fn charged(t: f64) -> (f64, f64) {
    let (line, load2, load3) = (5.0, 400.0, 300.0);
    let (a, b, c) = (280e-6, 240e-6, 450e-6);
    let rates = |(va, vb): (f64, f64)| {
        let top =
            (24.0 / line + va / load2 + vb / load3) / (1.0 / line + 1.0 / load2 + 1.0 / load3);
        let (i2, i3) = ((top - va) / load2, (top - vb) / load3);
        // c carries what its rate asks for: vc = vb - va.
        let ic = (i3 / b - i2 / a) / (1.0 / a + 1.0 / b + 1.0 / c);
        ((i2 + ic) / a, (i3 - ic) / b)
    };
    let steps = 2000;
    let h = t / f64::from(steps);
    let along = |v: (f64, f64), k: (f64, f64), part: f64| (v.0 + part * k.0, v.1 + part * k.1);
    let mut v = (0.0, 0.0);
    for _ in 0..steps {
        let k1 = rates(v);
        let k2 = rates(along(v, k1, 0.5 * h));
        let k3 = rates(along(v, k2, 0.5 * h));
        let k4 = rates(along(v, k3, h));
        v.0 += h / 6.0 * (k1.0 + 2.0 * k2.0 + 2.0 * k3.0 + k4.0);
        v.1 += h / 6.0 * (k1.1 + 2.0 * k2.1 + 2.0 * k3.1 + k4.1);
    }
    v
}

#[test]
fn a_loop_of_capacitors_has_two_states() {
    let run = solve("circuits", "charge");
    let [a, b, c] = ["a.v", "b.v", "c.v"].map(|name| run.column(name));
    for (row, &t) in run.time().iter().enumerate() {
        let (va, vb) = charged((t - 1e-3).max(0.0));
        // rtol 1e-8 of up to 10 V.
        close(a[row], va, 1e-6);
        close(b[row], vb, 1e-6);
        close(c[row], vb - va, 1e-6);
    }
}

#[test]
fn a_small_current_beside_a_large_one_is_as_exact_as_the_voltages() {
    for experiment in ["ida", "one_step"] {
        let run = solve("circuits", experiment);
        let (i, v) = (run.column("node2.i"), run.column("node2.p.v"));
        for (i, v) in i.iter().zip(v.iter()) {
            // 44 mA as the difference of amperes, through a diode of 80 A/V: it was off by 2 mA with rtol 1e-6.
            close(*i, v / 490.0, 1e-5);
        }
    }
}

#[test]
fn a_sum_of_shared_sums_is_looked_at_once() {
    // 2^40 ways lead to x.
    let mut model = "package shared;\nimport SI.*;\n".to_owned();
    for k in 0..40 {
        let inner = match k {
            0 => "x".to_owned(),
            _ => format!("f{}(x)", k - 1),
        };
        let body = format!("  input Real x;\n  output Real y = {inner} + {inner};");
        writeln!(model, "function f{k}\n{body}\nend f{k};").unwrap();
    }
    model.push_str(
        "model M\n  Real x(start = 1, fixed = true), w;\nequation\n  der(x) = -w/1 [s];\n  w + f39(x) = 2*x;\nend M;\n\
         experiment run of M\n  solve esdirk stop 1e-13 [s];\nend run;\n",
    );
    let folder = tempfile::tempdir().unwrap();
    write(&folder.path().join("shared.hyde"), &model);
    report(folder.path(), &["run", "shared.hyde"]);
}
