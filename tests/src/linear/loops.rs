//! Random sampled loops: what their poles say against the tick-by-tick values of their own runs.
//!
//! Values at whole periods of a linear loop are sums of powers of its poles, so the polynomial that has them as its roots
//! makes nothing of any sequence of them.

use crate::Example;
use crate::numbers::Numbers;
use hyde_compiler::Backend;
use hyde_experiment::{linearize, parameters, poles};
use hyde_program::Method;
use hyde_sim::{Setup, simulate};
use nalgebra::Complex;
use std::collections::BTreeMap;

/// What a sequence may leave of the polynomial, as a part of its largest term.
const OFF: f64 = 1e-4;

/// The loop of a seed.
fn random(seed: u64) -> String {
    let mut numbers = Numbers::of(seed ^ 0x5EED);
    let period = numbers.between(0.5, 4.0);
    let (mass, other) = (numbers.between(0.5, 3.0), numbers.between(0.5, 3.0));
    let (k, d) = (numbers.between(1e3, 4e4), numbers.between(1.0, 20.0));
    // Up to about twice what a loop around a bare mass would bear.
    let most = 4.0 * mass / (1e-3 * period);
    let kd = most * numbers.between(0.02, 0.4);
    let kp = kd / (1e-3 * period) * numbers.between(0.002, 0.1);
    let ki = kp / (1e-3 * period) * numbers.between(0.0, 0.02);
    let delay = match numbers.one_of(3) {
        0 => format!(", delay = {} [ms]", (0.4 * period * 1e3).round() / 1e3),
        _ => String::new(),
    };
    let phase = match numbers.one_of(3) {
        0 => format!(", phase = {} [ms]", (0.3 * period * 1e3).round() / 1e3),
        _ => String::new(),
    };
    let speed = match numbers.one_of(2) {
        0 => "sample(v)".to_owned(),
        _ => "(xs - pre(xs))/interval()".to_owned(),
    };
    let (second, extra) = match numbers.one_of(3) {
        0 => (
            format!(
                "  Force g = hold(slow.u);\n  clocked slow({} [ms])\n    Force u = -{} [N/m]*sample(y);\n  end slow;\n",
                2.0 * period,
                0.1 * k
            ),
            " + g",
        ),
        _ => (String::new(), ""),
    };
    format!(
        "package sampled \"a sampled loop around two masses\";\nimport SI.*;\n\nmodel M\n  \
         Length x(start = 1 [mm], fixed = true), y(start = -2 [mm], fixed = true);\n  \
         Velocity v(start = 0, fixed = true) = der(x), w(start = 0.1 [m/s], fixed = true) = der(y);\n  \
         Force s = {k} [N/m]*(x - y) + {d} [N.s/m]*(v - w);\n  Force f = hold(c.u);\n  \
         clocked c({period} [ms]{phase}{delay})\n    Length xs(start = 1 [mm]) = sample(x);\n    Velocity vs = {speed};\n    \
         Force sum(start = 0) = pre(sum) - {ki} [N/(m.s)]*xs*interval();\n    \
         Force u = sum - {kp} [N/m]*xs - {kd} [N.s/m]*vs;\n  end c;\n{second}equation\n  \
         {mass} [kg]*der(v) = f - s{extra};\n  {other} [kg]*der(w) = s;\nend M;\n\n\
         experiment run of M\n  stop 1 [s];\nend run;\n"
    )
}

/// What is wrong with the poles of a random loop; none if nothing is.
///
/// # Errors
/// The loop does not compile, or does not run.
pub fn wrong_poles(seed: u64) -> Result<Option<String>, String> {
    let text = random(seed);
    let found = compared(&text);
    found.map_err(|reason| format!("{reason}\n{text}"))
}

fn compared(text: &str) -> Result<Option<String>, String> {
    let example = Example::load("tests/models/ledger.hyde", None)?.replaced(text, "run");
    let program = example.free_inputs().compile(Backend::Native)?.program;
    let records = BTreeMap::new();
    let p = parameters(&program, &records, &[]).map_err(|error| format!("{error:?}"))?;
    let linear = linearize(&program, &records, &p, &[], &[]);
    let poles = poles(&linear.map_err(|error| format!("{error:?}"))?);
    let period = poles.period_s.ok_or("no clock closes the loop")?;
    // The polynomial with the poles as its roots, and 1 for what is at rest; lowest power first.
    let mut polynomial = vec![Complex::new(-1.0, 0.0), Complex::new(1.0, 0.0)];
    for pole in &poles.all {
        let z = (pole.s * period).exp();
        polynomial = times(&polynomial, z);
        if pole.s.im > 0.0 && z.im.abs() > 1e-12 * z.norm() {
            polynomial = times(&polynomial, z.conj());
        }
    }
    let growth = poles
        .all
        .iter()
        .map(|pole| pole.s.re)
        .fold(f64::NEG_INFINITY, f64::max);
    let count = 3 * polynomial.len() + 8;
    let stop = count as f64 * period;
    let mut setup = Setup::new(p, &records, stop);
    setup.method = Method::Esdirk;
    (setup.rtol, setup.atol) = (1e-11, 1e-13);
    setup.rows_s = Setup::rows_every(0.0, stop, period);
    let results = simulate(&program, &setup).map_err(|failure| format!("{:?}", failure.kind))?;
    for name in ["x", "y"] {
        let column = program
            .output(name)
            .and_then(|output| results.column(output));
        let column = column.ok_or("no column")?;
        let value = |k: usize| {
            results
                .rows_at(k as f64 * period)
                .map(|rows| column[rows.1])
        };
        // What is over within a period is so after the first few.
        for first in polynomial.len()..count - polynomial.len() {
            let terms = polynomial.iter().enumerate().map(|(power, factor)| {
                let value = value(first + power).unwrap_or(f64::NAN);
                *factor * value
            });
            let terms: Vec<Complex<f64>> = terms.collect();
            let sum: Complex<f64> = terms.iter().sum();
            let largest = terms.iter().map(|term| term.norm()).fold(1e-9, f64::max);
            if sum.norm().is_nan() || sum.norm() > OFF * largest {
                return Ok(Some(format!(
                    "the poles {:?} leave {} of `{name}`\n{text}",
                    poles.all,
                    sum.norm() / largest
                )));
            }
        }
        let size = |from: usize, to: usize| {
            let values = (from..to).filter_map(value);
            values.map(f64::abs).fold(0.0, f64::max)
        };
        let grew = size(2 * count / 3, count) > size(0, count / 3);
        let clear = growth.abs() * stop > 3.0;
        let stable = poles.unstable().is_empty();
        if stable == (growth > 0.0) || clear && grew == stable && size(0, count) > 1e-9 {
            return Ok(Some(format!(
                "stable {stable}, growth {growth}, grew {grew}\n{text}"
            )));
        }
    }
    Ok(None)
}

/// A polynomial times (z - root).
fn times(polynomial: &[Complex<f64>], root: Complex<f64>) -> Vec<Complex<f64>> {
    let mut product = vec![Complex::new(0.0, 0.0); polynomial.len() + 1];
    for (power, factor) in polynomial.iter().enumerate() {
        product[power + 1] += factor;
        product[power] -= factor * root;
    }
    product
}
