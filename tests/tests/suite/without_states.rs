//! Models in which nothing but the time moves: events are found, and values are exact at every row.

use crate::models::{close, solve};

#[test]
fn an_ideal_diode_rectifies_exactly() {
    let circuit = solve("without_states", "half_waves");
    let (i, v) = (circuit.column("load.i"), circuit.column("diode.v"));
    for (row, &t) in circuit.time().iter().enumerate() {
        let source = 10.0 * (std::f64::consts::TAU * t).sin();
        // Values between the solver's steps come from its polynomials: rtol 1e-6 of 10 V and 2 A.
        close(i[row], source.max(0.0) / 5.0, 4e-5);
        close(v[row], source.min(0.0), 2e-4);
    }
}

#[test]
fn a_hysteresis_without_unknowns_switches_at_its_levels() {
    let trigger = solve("without_states", "switching");
    let times: Vec<f64> = trigger.events().iter().map(|(t, _)| *t).collect();
    let expected = (0..3_u32).flat_map(|k| [f64::from(k) + 1.0 / 12.0, f64::from(k) + 7.0 / 12.0]);
    let expected: Vec<f64> = expected.collect();
    assert_eq!(times.len(), expected.len());
    for (found, expected) in times.iter().zip(expected) {
        // Rounding of the sine over its slope.
        close(*found, expected, 1e-13);
    }
}

#[test]
fn ticks_between_the_rows_are_rows() {
    let clock = solve("without_states", "steps");
    let u = clock.column("u");
    for k in 1..10_u32 {
        let (before, after) = clock.rows_at(0.1 * f64::from(k));
        close(u[before], f64::from(k), 0.0);
        close(u[after], f64::from(k) + 1.0, 0.0);
    }
}

#[test]
fn an_equation_of_the_time_alone_holds_at_every_row() {
    let bent = solve("without_states", "bent");
    for (q, u) in bent.column("q").iter().zip(bent.column("u").iter()) {
        // rtol 1e-6 of q, up to 2, times its slope 1 + 3 q^2, and some times that between two steps.
        close(q * q * q + q, *u, 1e-4);
    }
}
