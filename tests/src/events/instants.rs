//! Events at the start, at the stop time and exactly at a tick.

use super::solved::{close, same, solve};

/// What is true at 0 holds from the first row on, without having become true; a ball that leaves the floor at 0 does not
/// meet it there.
pub(super) fn start() -> Result<(), String> {
    let run = solve("events/instants", "start")?;
    // Thrown at 1 m/s against 10 m/s2. The ball is at the floor for as long as rounding and rtol 1e-9 tell it.
    run.happened(&[(0.0, "x > 0.5"), (0.2, "h < 0")], 1e-9)?;
    same("start", &run.events()[0].t, &0.0)?;
    same("rate at 0", &run.column("rate")?[0], &2.0)?;
    same("step at 0", &run.column("step")?[0], &2.0)?;
    same("`when` that is true at 0", &run.last("fired")?, &0.0)?;
    // 1 + 2/s over 0.3 s.
    close("x", run.last("x")?, 1.6, 1e-12)
}

/// A ball thrown down where it lies bounces at 0, and again 0.2 s later.
pub(super) fn struck() -> Result<(), String> {
    let run = solve("events/instants", "struck")?;
    // 1 m/s against 10 m/s2 at rtol 1e-9.
    run.happened(&[(0.0, "h < 0"), (0.2, "h < 0")], 1e-9)?;
    same("speed from 0 on", &run.column("v")?[0], &1.0)?;
    close("speed at 0.3 s", run.last("v")?, 0.0, 1e-8)
}

/// An event at the stop time takes place: the last two rows are its left and its right limit.
pub(super) fn stop() -> Result<(), String> {
    let run = solve("events/instants", "stop")?;
    // The state passes its mark 1 ns before the end.
    run.happened(
        &[(1.0 - 1e-9, "y > 0.999999999"), (1.0, "time >= 1")],
        1e-12,
    )?;
    same("end", &run.run.results.time.last(), &Some(&1.0))?;
    same("passed", &run.last("passed")?, &1.0)?;
    same("fired", &run.around("fired", 1.0)?, &(0.0, 1.0))?;
    let (before, after) = run.around("x", 1.0)?;
    close("x before", before, 1.0, 1e-12)?;
    same("x after", &after, &7.0)
}

/// At a tick `sample` reads what was before the events of that instant, and the next tick what came of them (C1).
pub(super) fn tick() -> Result<(), String> {
    let run = solve("events/instants", "tick")?;
    // One by the time, one found on the solution: a straight line.
    run.happened(&[(0.1, "time >= 0.1"), (0.1, "y >= 0.1")], 1e-12)?;
    same("instants", &run.run.results.statistics.events, &1)?;
    same("x", &run.around("x", 0.1)?, &(1.0, 2.0))?;
    same("ticks", &run.around("control.ticks", 0.1)?, &(10.0, 11.0))?;
    same("sample of x", &run.around("control.of_x", 0.1)?.1, &1.0)?;
    close(
        "sample of y",
        run.around("control.of_y", 0.1)?.1,
        0.1,
        1e-12,
    )?;
    same(
        "next sample of x",
        &run.around("control.of_x", 0.11)?.1,
        &2.0,
    )?;
    close(
        "next sample of y",
        run.around("control.of_y", 0.11)?.1,
        -0.99,
        1e-12,
    )
}
