//! Algebraic loops: with switches in them, and torn.

use crate::models::{close, solve};
use std::f64::consts::TAU;

#[test]
fn springs_that_a_plate_reaches_one_after_the_other() {
    let press = solve("loops", "press");
    let k = 1e5;
    for (&t, &x) in press.time().iter().zip(press.column("x").iter()) {
        let force = 500.0 * t;
        // One spring up to 1 mm, two up to 2 mm, then three.
        let expected = if force <= 100.0 {
            force / k
        } else if force <= 300.0 {
            (force + 100.0) / (2.0 * k)
        } else {
            (force + 300.0) / (3.0 * k)
        };
        // Rounding: nothing is integrated.
        close(x, expected, 1e-15);
    }
    let at: Vec<f64> = press.events().iter().map(|(t, _)| *t).collect();
    assert_eq!(at.len(), 2);
    // Crossings are located to the last digits of the time.
    close(at[0], 0.2, 1e-12);
    close(at[1], 0.6, 1e-12);
}

#[test]
fn a_bridge_of_four_switching_resistances() {
    let rectify = solve("loops", "rectify");
    let columns = ["source", "a", "b", "p"].map(|name| rectify.column(name));
    let (on, off, rs, r) = (0.1, 1e5, 1.0, 10.0);
    for row in 0..rectify.time().len() {
        let [u, a, b, p] = columns.each_ref().map(|column| column[row]);
        // With u > 0 the current enters at a: from p through the load to n, and back to b. The circuit by the potentials
        // of nodes: a, p, b against n = 0.
        let (first, second) = if u >= 0.0 { (a, b) } else { (b, a) };
        let size = u.abs();
        // Kirchhoff's law at the three nodes, in A: the tolerance of the potentials over the least resistance.
        let source = (size - (first - second)) / rs;
        close(source, (first - p) / on + first / off, 1e-6);
        close((first - p) / on + (second - p) / off, p / r, 1e-6);
        close(source, (p - second) / off - second / on, 1e-6);
        // The tolerance of a step, 1e-8 of 10 V.
        assert!(p >= -1e-7, "the load's voltage is rectified: {p}");
    }
}

#[test]
fn a_torn_loop_is_solved_at_every_row() {
    let follow = solve("loops", "follow");
    assert_eq!(follow.compiled.program.n_unknowns, 1);
    for (&t, &y) in follow.time().iter().zip(follow.column("y").iter()) {
        // Between two steps the interpolant errs by ten times the tolerance of a step.
        close(y * y * y + y, 2.0 * (TAU * t).sin(), 1e-7);
    }
}

#[test]
fn a_force_that_no_equation_gives_explicitly_satisfies_its_own_in_every_row() {
    let run = solve("loops", "damped");
    for body in 1..=4 {
        let (v, g) = (
            run.column(&format!("v[{body}]")),
            run.column(&format!("g[{body}]")),
        );
        for (v, g) in v.iter().zip(g.iter()) {
            // Rows every 0.1 ms of steps of a millisecond at rtol 1e-8; an interpolated force was off by 7e-4 of 5 N.
            close(g + 9.0 * g.tanh(), -18.0 * v, 1e-6);
        }
    }
}
