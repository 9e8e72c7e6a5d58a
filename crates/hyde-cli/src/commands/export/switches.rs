//! Conditions of equations on which a run may slide: they switch by states alone, and the equations jump there. A fixed step
//! does not hold a state at such a surface.

use hyde_c::Start;
use hyde_program::{Function, Point, Program, RelationUse, Workspace, Wrt};
use std::collections::BTreeSet;

/// A residual that changes by less, over its size, does not jump: it is bent, as that of `max` and `abs`.
const JUMP: f64 = 1e-6;
/// The same as a number: what is smaller is rounding.
const ROUNDING: f64 = 1e-12;

/// The texts of these conditions. Whether the equations jump is looked at where the start is nearest to the surface.
pub(super) fn that_may_slide(
    program: &Program,
    p: &[f64],
    (t, start): (f64, &Start),
) -> BTreeSet<String> {
    let differential = program.differential(&start.z);
    let u = vec![0.0; 2 * program.columns.len() + program.delays.len()];
    let mut work = Workspace::new(program.n_work);
    let entries = program.partials(Function::Roots);
    let at = Point {
        t,
        y: &start.y,
        yp: &start.yp,
        z: &start.z,
        u: &u,
        p,
    };
    let mut roots = vec![0.0; program.relations.len()];
    let mut partials = vec![0.0; entries.len()];
    program
        .kernels
        .evaluate(Function::Roots, at, &mut work, &mut roots);
    program
        .kernels
        .partials(Function::Roots, at, &mut work, &mut partials);
    let mut found = BTreeSet::new();
    for (number, relation) in program.relations.iter().enumerate() {
        if relation.used != RelationUse::Equation || relation.scheduled {
            continue;
        }
        let own = entries.iter().zip(&partials);
        let own = own.filter(|(entry, _)| entry.row == number);
        let mut gradient = Vec::new();
        let mut of_states = true;
        for (entry, &partial) in own {
            match entry.wrt {
                Wrt::Unknown(column) => {
                    of_states &= differential[column];
                    gradient.push((column, partial));
                }
                Wrt::Derivative(_) => of_states = false,
                Wrt::Delayed(_) | Wrt::Parameter(_) | Wrt::Memory(_) | Wrt::Time => {}
            }
        }
        let square: f64 = gradient.iter().map(|(_, own)| own * own).sum();
        if !of_states || square.is_nan() || square <= 0.0 {
            continue;
        }
        let mut y = start.y.clone();
        for (column, partial) in gradient {
            y[column] -= roots[number] / square * partial;
        }
        let mut residual = |truth: f64| {
            let mut z = start.z.clone();
            z[number] = truth;
            let mut residual = vec![0.0; program.n_unknowns];
            let at = Point { y: &y, z: &z, ..at };
            program
                .kernels
                .evaluate(Function::Residual, at, &mut work, &mut residual);
            residual
        };
        let (no, yes) = (residual(0.0), residual(1.0));
        let jumps = no.iter().zip(&yes).any(|(a, b)| {
            let jump = (a - b).abs();
            jump > ROUNDING && jump > JUMP * (a.abs() + b.abs())
        });
        if jumps {
            found.insert(relation.text.clone());
        }
    }
    found
}
