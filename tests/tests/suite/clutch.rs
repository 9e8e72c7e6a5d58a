//! A clutch sticks exactly: a mode may fix the difference of two states.

use crate::models::{close, solve};

#[test]
fn inertias_slip_until_they_turn_alike_and_then_do_so_to_the_last_bit() {
    let pair = solve("clutch", "close");
    // 10 rad/s fall by (1/J1 + 1/J2)*10 N.m = 15 rad/s2.
    let lock = 10.0 / 15.0;
    let events = pair.events();
    assert_eq!(events.len(), 2, "{events:?}");
    assert_eq!(events[0], (0.0, "backward"));
    let (t, mode) = events[1];
    assert_eq!(mode, "stuck");
    // Integrated from start to here at rtol 1e-9.
    close(t, lock, 1e-8);
    let (before, after) = pair.rows_at(t);
    let slip = pair.column("clutch.w_rel");
    // The start values that both inertias fix.
    close(slip[0], -10.0, 1e-12);
    assert!(slip[..before].iter().all(|&slip| slip < 0.0));
    assert!(slip[after..].iter().all(|&slip| slip == 0.0));
    // Momentum is kept: 10 rad/s * J1 / (J1 + J2).
    close(*pair.column("driven.w").last().unwrap(), 10.0 / 3.0, 1e-8);
    close(*pair.column("driving.w").last().unwrap(), 10.0 / 3.0, 1e-8);
    // 5 rad/s2 over the slipping, then 10/3 rad/s.
    let turned = 0.5 * 5.0 * lock * lock + 10.0 / 3.0 * (1.0 - lock);
    close(*pair.column("driven.phi").last().unwrap(), turned, 1e-7);
}
