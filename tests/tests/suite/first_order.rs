//! A capacitor charged through a resistor: one exponential.

use crate::models::{close, solve};

#[test]
fn a_capacitor_charges_with_its_time_constant() {
    let circuit = solve("first_order", "charge");
    let tau = 2e3 * 5e-6;
    let (u, i) = (circuit.column("u"), circuit.column("i"));
    for (row, &t) in circuit.time().iter().enumerate() {
        let expected = 10.0 * (1.0 - (-t / tau).exp());
        // rtol 1e-9 over five time constants, some errors in one direction.
        close(u[row], expected, 2e-7);
        // The algebraic variable obeys its own equation to rounding.
        close(i[row], (10.0 - u[row]) / 2e3, 1e-17);
    }
    assert_eq!(circuit.time().len(), 51);
}
