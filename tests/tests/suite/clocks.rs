//! Several clocks, tick by tick, as a person tells them with a pencil.
#![allow(clippy::float_cmp, reason = "what clocks write is exact")]

use crate::models::{Solved, close, solve};

/// The values of some columns just after an instant given in ms.
fn after<const N: usize>(run: &Solved, names: [&str; N], ms: f64) -> [f64; N] {
    let (_, row) = run.rows_at(ms * 1e-3);
    names.map(|name| run.column(name)[row])
}

/// The value of a column just before an instant given in ms.
fn before(run: &Solved, name: &str, ms: f64) -> f64 {
    run.column(name)[run.rows_at(ms * 1e-3).0]
}

#[test]
fn two_clocks_pass_values_in_data_flow_order() {
    let run = solve("clocks", "cascade");
    // fast every 4 ms, held 1 ms later; slow every 6 ms, held 6 ms later: both tick at 0, 12 and 24 ms, the slow one first.
    for (ms, expected) in [
        // seen, demand, old, out
        (0.0, [0.0, 1.0, -2.0, 101.0]),
        (4.0, [4.0, 1.0, -2.0, 102.0]),
        (8.0, [8.0, 2.0, 1.0, 203.0]),
        // What the slow one holds changes at 12 ms too, after the ticks.
        (12.0, [12.0, 3.0, 1.0, 304.0]),
        (16.0, [16.0, 3.0, 2.0, 305.0]),
        (20.0, [20.0, 4.0, 3.0, 406.0]),
        (24.0, [24.0, 5.0, 3.0, 507.0]),
    ] {
        let names = ["fast.seen", "fast.demand", "fast.old", "fast.out"];
        let [seen, rest @ ..] = after(&run, names, ms);
        // The time in ms.
        close(seen, expected[0], 1e-12);
        assert_eq!(rest, expected[1..], "at {ms} ms");
    }
    for (ms, expected) in [
        // of_fast, out
        (0.0, [-1.0, 1.0]),
        (6.0, [102.0, 2.0]),
        (12.0, [203.0, 3.0]),
        (18.0, [305.0, 4.0]),
        (24.0, [406.0, 5.0]),
    ] {
        assert_eq!(
            after(&run, ["slow.of_fast", "slow.out"], ms),
            expected,
            "at {ms} ms"
        );
    }
    // What is held changes after its delay, and no sooner.
    for (ms, old, new) in [
        (1.0, -1.0, 101.0),
        (5.0, 101.0, 102.0),
        (13.0, 203.0, 304.0),
    ] {
        assert_eq!(
            (before(&run, "u", ms), after(&run, ["u"], ms)),
            (old, [new]),
            "u at {ms} ms"
        );
    }
    for (ms, old, new) in [(6.0, -2.0, 1.0), (12.0, 1.0, 2.0), (24.0, 3.0, 4.0)] {
        assert_eq!(
            (before(&run, "w", ms), after(&run, ["w"], ms)),
            (old, [new]),
            "w at {ms} ms"
        );
    }
    assert_eq!(run.run.results.statistics.ticks, 7 + 5);
}

#[test]
fn the_order_of_ticks_is_that_of_the_data() {
    let run = solve("clocks", "chain");
    for (ms, turn) in [(0.0, 1.0), (10.0, 2.0), (20.0, 3.0), (30.0, 4.0)] {
        let found = after(&run, ["first.out", "second.out", "third.out", "y"], ms);
        assert_eq!(
            found,
            [turn, 10.0 * turn, 10.0 * turn + 1.0, 10.0 * turn + 1.0]
        );
    }
    // Alone at 5 ms the second one reads what there is.
    assert_eq!(after(&run, ["second.out"], 5.0), [10.0]);
}

#[test]
fn a_delay_may_be_longer_than_a_period() {
    let run = solve("clocks", "late");
    // Ticks at 3, 13, 23, …; what they hold comes at 28, 38, 48, ….
    for (ms, old, new) in [
        (28.0, 0.0, 1.0),
        (38.0, 1.0, 2.0),
        (48.0, 2.0, 3.0),
        (58.0, 3.0, 4.0),
    ] {
        assert_eq!(
            (before(&run, "y", ms), after(&run, ["y"], ms)),
            (old, [new]),
            "at {ms} ms"
        );
    }
    // 10 ms of 1, 2 and 3, then 2 ms of 4; steps of constant slope.
    close(*run.column("integral").last().unwrap(), 0.068, 1e-12);
    assert_eq!(run.run.results.statistics.ticks, 6);
    assert_eq!(before(&run, "c.n", 3.0), 0.0);
}

#[test]
fn clocks_tick_at_the_start_and_at_the_stop_and_their_events_follow() {
    let run = solve("clocks", "ends");
    assert_eq!(
        (before(&run, "y", 0.0), after(&run, ["y", "c.n"], 0.0)),
        (0.0, [1.0, 1.0])
    );
    assert_eq!(
        (before(&run, "y", 30.0), after(&run, ["y", "c.n"], 30.0)),
        (3.0, [4.0, 4.0])
    );
    assert_eq!(run.run.results.statistics.ticks, 4);
    // The third tick makes `y > 2.5` true; x passes 10 where the second tick is.
    assert_eq!(
        (before(&run, "seen", 20.0), after(&run, ["seen"], 20.0)),
        (0.0, [1.0])
    );
    assert_eq!(
        (before(&run, "again", 10.0), after(&run, ["again"], 10.0)),
        (0.0, [1.0])
    );
    // One edge of a clocked condition.
    assert_eq!(after(&run, ["c.ups"], 20.0), [1.0]);
    assert_eq!(after(&run, ["c.ups"], 30.0), [1.0]);
}
