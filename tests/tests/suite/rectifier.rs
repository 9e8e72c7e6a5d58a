//! A rectifier of ideal diodes: current and voltage of a diode pass its knee together, so that rounding decides which of
//! its two guards is true there. Modes and a relation along its line must tell the same.

use crate::models::{Solved, close, solve};

#[test]
fn a_diode_of_modes_and_one_of_relations_rectify_alike() {
    let modes = solve("rectifier", "by_modes");
    let relations = solve("rectifier", "by_relations");
    // 6 diodes, on and off once in each of 5 periods, and the two that conduct at first.
    assert_eq!(modes.run.results.statistics.events, 62);
    assert_eq!(instants(&relations), 62);
    let last = |column: &[f64]| column[column.len() - 1];
    for name in ["uDC", "L1.i", "L2.i"] {
        let (a, b) = (last(&modes.column(name)), last(&relations.column(name)));
        // rtol 1e-7 of 600 V and 1000 A over 60 switchings.
        close(a, b, 5e-3);
    }
}

/// The instants with events. A relation may change to and fro within the last bit of the time where its two branches differ
/// there by what the step errs.
fn instants(solved: &Solved) -> usize {
    let times: Vec<f64> = solved.run.results.events.iter().map(|e| e.t).collect();
    1 + times
        .windows(2)
        .filter(|two| two[1] - two[0] > 1e-15)
        .count()
}
