//! Edges, branches of one `when`, and what modes set on entering and leaving, against what a person finds by hand.
#![allow(clippy::float_cmp, reason = "what events set is exact")]

use crate::models::{Solved, close, solve};

fn last(run: &Solved, name: &str) -> f64 {
    *run.column(name).last().unwrap()
}

#[test]
fn an_edge_is_true_in_the_moment_of_becoming_true_and_no_longer() {
    let run = solve("reactions", "edges");
    // `high` becomes true at 0.5: then `time > 0.3` holds and `time > 0.7` does not, nor does it later.
    assert_eq!(last(&run, "inside"), 1.0);
    assert_eq!(last(&run, "outside"), 0.0);
    // Without the edge the condition becomes true at 0.7.
    assert_eq!(last(&run, "level"), 1.0);
    // Two edges joined by `or` are two events, 1 at the first and 10 at the second.
    assert_eq!(last(&run, "either"), 11.0);
    // What is true from the start has no edge.
    assert_eq!(last(&run, "from_start"), 0.0);
    let times: Vec<f64> = run.events().iter().map(|(t, _)| *t).collect();
    for (found, known) in times.iter().zip([0.5, 0.5, 0.5, 0.7, 0.8]) {
        // A straight line, located to rounding.
        close(*found, known, 1e-12);
    }
    assert_eq!(times.len(), 5);
}

#[test]
fn of_branches_that_become_true_together_the_first_fires() {
    let run = solve("reactions", "branches");
    assert_eq!(last(&run, "first"), 1.0);
    // True at the same instant, in the same round: never.
    assert_eq!(last(&run, "second"), 0.0);
    // Made true by the first branch: in the next round of that instant.
    assert_eq!(last(&run, "third"), 1.0);
    // Later, though the first condition is still true: it does not become so.
    assert_eq!(last(&run, "fourth"), 1.0);
    let times: Vec<f64> = run.events().iter().map(|(t, _)| *t).collect();
    for (found, known) in times.iter().zip([0.5, 0.5, 0.6]) {
        close(*found, known, 1e-12);
    }
    assert_eq!(times.len(), 3);
}

#[test]
fn modes_act_on_leaving_and_on_entering_in_this_order() {
    let run = solve("reactions", "tank");
    // 1 s up at 1/s, 0.8 down at 2/s, up at 2/s for 0.5 s, 0.4 s down, then up at 3/s.
    let tank: Vec<_> = run
        .run
        .results
        .events
        .iter()
        .filter(|event| event.cause.starts_with('x'))
        .map(|event| event.t)
        .collect();
    for (found, known) in tank.iter().zip([1.0, 1.4, 1.9, 2.3]) {
        // Straight lines at rtol 1e-9.
        close(*found, known, 1e-9);
    }
    assert_eq!(tank.len(), 4);
    let after = |name: &str, t: f64| run.column(name)[run.rows_at(t).1];
    // Leaving writes 1, the exit adds 2, entering adds 3; the value entered with is 0.8.
    assert_eq!(after("order", tank[0]), 123.0);
    assert_eq!(after("x", tank[0]), 0.8);
    assert_eq!(after("left", tank[0]), 1.0);
    // The first mode was not entered.
    assert_eq!(after("turns", tank[0]), 0.0);
    assert_eq!(after("turns", tank[1]), 1.0);
    close(after("entered", tank[1]), 1.4, 1e-9);
    // The parameter that the exit gives is there on entering: 2, then 3.
    assert_eq!(last(&run, "sum"), 5.0);
    assert_eq!(last(&run, "left"), 2.0);
    close(last(&run, "x"), 0.6, 1e-8);
}

#[test]
fn parallel_modes_go_their_own_ways() {
    let run = solve("reactions", "tank");
    let triangle = |t: f64| 0.3 - ((t % 0.6) - 0.3).abs();
    for (t, y) in run.time().iter().zip(run.column("y").iter()) {
        // Straight lines at rtol 1e-9, through eight corners.
        close(*y, triangle(*t), 1e-8);
    }
    // Both blocks have a mode `up` with a parameter `r`.
    assert_eq!(last(&run, "pendulum.up.r"), 1.0);
    assert_eq!(last(&run, "tank.up.r"), 3.0);
}

#[test]
fn pre_is_the_value_before_what_switches_at_the_same_instant() {
    let climb = solve("before", "climb");
    assert_eq!(last(&climb, "n"), 0.0);
    assert_eq!(last(&climb, "m"), 1.0);
}

#[test]
fn what_turns_without_effect_is_no_event_and_restarts_nothing() {
    let run = solve("reactions", "idle");
    // Since 3.5 s x = cos(w t) rises through 0 after 3.75 and 4.75 periods, turns at 1 after 4 and falls through 0 after 4.25.
    let period = 2.0 * std::f64::consts::PI / 40.0_f64.sqrt();
    let expected = [3.75, 4.0, 4.25, 4.75].map(|periods| periods * period);
    let times: Vec<f64> = run.events().iter().map(|(t, _)| *t).collect();
    assert_eq!(times.len(), expected.len(), "{times:?}");
    for (found, known) in times.iter().zip(expected) {
        // An oscillation of five periods at rtol 1e-9.
        close(*found, known, 1e-6);
    }
    assert_eq!((last(&run, "late"), last(&run, "turns")), (2.0, 1.0));
    // At the start and at the four events; none at all the crossings before 3.5 s.
    assert_eq!(run.run.results.statistics.restarts, 5);
}
