//! A rectifier of ideal diodes: current and voltage of a diode pass its knee together, so that rounding decides which of
//! its two guards is true there. Modes and a relation along its line must tell the same.

use crate::models::{close, solve};

#[test]
fn a_diode_of_modes_and_one_of_relations_rectify_alike() {
    let modes = solve("rectifier", "by_modes");
    let relations = solve("rectifier", "by_relations");
    // 6 diodes, on and off once in each of 5 periods, and the two that conduct at first.
    assert_eq!(modes.run.results.statistics.events, 62);
    assert_eq!(relations.run.results.statistics.events, 62);
    let last = |column: &[f64]| column[column.len() - 1];
    for name in ["uDC", "L1.i", "L2.i"] {
        let (a, b) = (last(modes.column(name)), last(relations.column(name)));
        // rtol 1e-7 of 600 V and 1000 A over 60 switchings.
        close(a, b, 5e-3);
    }
}
