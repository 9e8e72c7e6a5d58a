//! Derivatives against central differences, entry by entry; what is not in a pattern must be zero.

use crate::examples::{self, Case};
use crate::points::{Random, Values, parameters, plain};
use hyde_compiler::Backend;
use hyde_program::{Function, Point, Program, Workspace, Wrt};

/// The largest step of a difference against the size of what is varied.
const STEP: f64 = 1e-4;
/// The differences are extrapolated to no step from this and its halves: a force that repeats every 2.5 mm of a screw turns
/// by a quarter of a radian in the largest.
const STEPS: usize = 3;
/// The extrapolation leaves less than this, relative to the derivative.
const CURVATURE: f64 = 1e-6;
/// Values carry some roundings of their largest term.
const ROUNDING: f64 = 20.0 * f64::EPSILON;

#[test]
fn jacobian_and_other_derivatives_are_those_of_the_functions() {
    for case in examples::all() {
        let program = case.example.compile(Backend::Native).unwrap().program;
        let p = parameters(&program, &[]);
        let mut random = Random(3);
        for _ in 0..3 {
            let mut values = Values::of(&program, &mut random);
            for function in Function::ALL {
                let exact = exact(&program, function, values.point(&p));
                let size = size(&program, function, values.point(&p), &exact);
                for unknown in 0..program.n_unknowns {
                    for by_derivative in [false, true] {
                        let at = |values: &mut Values, step: f64| {
                            let vector = if by_derivative {
                                &mut values.yp
                            } else {
                                &mut values.y
                            };
                            let before = vector[unknown];
                            vector[unknown] = before + step;
                            let out = evaluated(&program, function, values.point(&p));
                            let vector = if by_derivative {
                                &mut values.yp
                            } else {
                                &mut values.y
                            };
                            vector[unknown] = before;
                            out
                        };
                        let (wrt, name) = if by_derivative {
                            (
                                Wrt::Derivative(unknown),
                                format!("der({})", program.unknown_name(unknown)),
                            )
                        } else {
                            (Wrt::Unknown(unknown), program.unknown_name(unknown))
                        };
                        let column = Column {
                            function,
                            wrt,
                            name,
                            step: STEP,
                        };
                        let changed = |step| at(&mut values, step);
                        column.check(&case, &program, &exact, &size, changed);
                    }
                }
            }
        }
    }
}

#[test]
fn derivatives_by_parameters_are_those_of_the_functions() {
    for case in examples::all() {
        let program = case.example.compile(Backend::Native).unwrap().program;
        // All at once: they are independent of each other. One by one: what is bound to it follows.
        let all = plain(&program);
        for function in Function::ALL {
            by_parameters(&case, &program, function, &all);
        }
        for &place in &all {
            by_parameters(&case, &program, Function::Residual, &[place]);
        }
    }
}

/// The derivatives by a chosen set of parameters, by their positions.
fn by_parameters(case: &Case, program: &Program, function: Function, chosen: &[usize]) {
    // Away from what is declared, each by its own part: round numbers may lie where a `min` changes its branch.
    let declared = parameters(program, &[]);
    let part = |k: usize| 1.0 + 0.1 * (0.618 * (k * k) as f64).fract();
    let moved: Vec<(usize, f64)> = chosen.iter().map(|&k| (k, part(k) * declared[k])).collect();
    let p = parameters(program, &moved);
    let values = Values::of(program, &mut Random(4));
    let at = values.point(&p);
    let mut work = Workspace::new(program.n_work);
    let kernels = &program.kernels;
    let exact: Vec<_> = kernels
        .parameter_partials(function, chosen, at, &mut work)
        .into_iter()
        .map(|(entry, value)| (entry.row, entry.wrt, value))
        .collect();
    let mut size = size(program, function, at, &self::exact(program, function, at));
    for &(row, wrt, value) in &exact {
        if let Wrt::Parameter(place) = wrt {
            size[row] += (value * p[place]).abs();
        }
    }
    for &place in chosen {
        let step = match p[place].abs() {
            0.0 => STEP,
            value => STEP * value,
        };
        let changed = |change: f64| {
            let value = |&k: &usize| (k, p[k] + if k == place { change } else { 0.0 });
            let set: Vec<(usize, f64)> = chosen.iter().map(value).collect();
            let p = parameters(program, &set);
            evaluated(program, function, values.point(&p))
        };
        let known = program.parameters.iter();
        let mut known =
            known.filter(|known| (known.place..known.place + known.len).contains(&place));
        let column = Column {
            function,
            wrt: Wrt::Parameter(place),
            name: known.next().unwrap().name.clone(),
            step,
        };
        column.check(case, program, &exact, &size, changed);
    }
}

/// The derivatives of a function by one thing.
struct Column {
    function: Function,
    wrt: Wrt,
    name: String,
    step: f64,
}

impl Column {
    /// Against the differences of two evaluations each, row by row.
    fn check(
        &self,
        case: &Case,
        program: &Program,
        exact: &[(usize, Wrt, f64)],
        size: &[f64],
        mut changed: impl FnMut(f64) -> Vec<f64>,
    ) {
        let steps: Vec<f64> = (0..STEPS)
            .map(|k| self.step / f64::powi(2.0, k as i32))
            .collect();
        let pairs: Vec<_> = steps
            .iter()
            .map(|step| (changed(*step), changed(-step)))
            .collect();
        for row in 0..pairs[0].0.len() {
            // Quantisers stand in measured channels and are differentiated as the identity (S3).
            if self.function == Function::Outputs && program.outputs[row].auxiliary {
                continue;
            }
            let entries = exact.iter();
            let entries = entries.filter(|(r, wrt, _)| *r == row && *wrt == self.wrt);
            let derivative: f64 = entries.map(|(_, _, value)| value).sum();
            let differences = pairs.iter().zip(&steps);
            let differences =
                differences.map(|((high, low), step)| (high[row] - low[row]) / (2.0 * step));
            let difference = extrapolated(differences.collect());
            let tolerance = CURVATURE * derivative.abs() + ROUNDING * size[row] / steps[STEPS - 1];
            assert!(
                (difference - derivative).abs() <= tolerance,
                "{}: {:?} {row} by {}: {derivative:e}, but differences say {difference:e} (± {tolerance:e})",
                case.name,
                self.function,
                self.name
            );
        }
    }
}

/// Central differences at a step and its halves, extrapolated to no step: their errors are of even powers of it (Richardson).
fn extrapolated(mut differences: Vec<f64>) -> f64 {
    let mut weight = 1.0;
    while differences.len() > 1 {
        weight *= 4.0;
        let pairs = differences.windows(2);
        differences = pairs
            .map(|pair| pair[1] + (pair[1] - pair[0]) / (weight - 1.0))
            .collect();
    }
    differences[0]
}

fn evaluated(program: &Program, function: Function, at: Point<'_>) -> Vec<f64> {
    let mut work = Workspace::new(program.n_work);
    let mut out = vec![0.0; program.rows(function)];
    program.kernels.evaluate(function, at, &mut work, &mut out);
    out
}

/// The derivatives by unknowns and their derivatives.
fn exact(program: &Program, function: Function, at: Point<'_>) -> Vec<(usize, Wrt, f64)> {
    let entries = program.partials(function);
    let mut work = Workspace::new(program.n_work);
    let mut out = vec![0.0; entries.len()];
    program.kernels.partials(function, at, &mut work, &mut out);
    entries
        .iter()
        .zip(out)
        .map(|(entry, value)| (entry.row, entry.wrt, value))
        .collect()
}

/// How large the terms of each row are together.
fn size(
    program: &Program,
    function: Function,
    at: Point<'_>,
    exact: &[(usize, Wrt, f64)],
) -> Vec<f64> {
    let mut size: Vec<f64> = evaluated(program, function, at)
        .iter()
        .map(|value| value.abs())
        .collect();
    for &(row, wrt, value) in exact {
        size[row] += match wrt {
            Wrt::Unknown(k) => (value * at.y[k]).abs(),
            Wrt::Derivative(k) => (value * at.yp[k]).abs(),
            Wrt::Delayed(k) => (value * at.u[at.u.len() - program.delays.len() + k]).abs(),
            Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Time => 0.0,
        };
    }
    size
}
