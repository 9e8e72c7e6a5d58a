//! What a clock holds longer than its period: the values of its earlier ticks, in a line of variables.
//!
//! A held value changes after the delay of its clock with the value of the tick. If further ticks run until then, the variable
//! of the tick has a later value. Each tick therefore moves its last values one place on, and the held value takes the last
//! place.

use crate::Begun;
use crate::names::Names;
use hyde_ir::dae::{Dae, Hold};
use hyde_ir::{ClockId, Expr, ExprId, Id as _};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Parts of a period that are rounding in the ratio of a delay to it.
const ROUNDING: f64 = 1e-9;

/// How many ticks of a clock run between one and the change of what it holds; one at the instant of the change does not count.
#[must_use]
pub fn ticks_before_change(delay_s: f64, period_s: f64) -> usize {
    let periods = delay_s / period_s;
    let whole = periods.round();
    let up = match (periods - whole).abs() <= ROUNDING * whole.max(1.0) {
        true => whole,
        false => periods.ceil(),
    };
    // A cast of a float saturates: a ratio without a value is 0.
    (up as usize).saturating_sub(1)
}

/// The places of the line of a source at a position of the memory, the latest value first.
fn line(dae: &Dae, names: &Names<'_>, begun: &Begun) -> BTreeMap<usize, Vec<String>> {
    let mut found = BTreeMap::new();
    for hold in &dae.holds {
        let earlier = earlier(begun, hold);
        for position in hold.source..hold.source + hold.len {
            if let Some(name) = names.memory(position).filter(|_| earlier > 0) {
                let bare = name.trim_matches('\'');
                let places = (1..=earlier).map(|ticks| format!("'{bare}.{ticks} ticks ago'"));
                found.insert(position, places.collect());
            }
        }
    }
    found
}

fn earlier(begun: &Begun, hold: &Hold) -> usize {
    begun.earlier.get(hold.clock).copied().unwrap_or(0)
}

/// Declares the lines. What they are at the start is never held.
pub(crate) fn declare(text: &mut String, dae: &Dae, names: &Names<'_>, begun: &Begun) {
    for place in line(dae, names, begun).into_values().flatten() {
        let _ = writeln!(text, "  discrete Real {place}(start = 0.0, fixed = true);");
    }
}

/// What a tick of a clock does before all else: its last values move on.
pub(crate) fn moved(
    text: &mut String,
    dae: &Dae,
    names: &Names<'_>,
    begun: &Begun,
    clock: ClockId,
) {
    let own = dae.holds.iter().filter(|own| own.clock == clock.index());
    let positions: Vec<_> = own.map(|own| own.source..own.source + own.len).collect();
    for (position, places) in line(dae, names, begun) {
        if !positions.iter().any(|own| own.contains(&position)) {
            continue;
        }
        let source = names.memory(position).unwrap_or_default();
        let before = std::iter::once(source).chain(places.iter().map(String::as_str));
        let moves: Vec<_> = places.iter().zip(before).collect();
        for (place, before) in moves.into_iter().rev() {
            let _ = writeln!(text, "    {place} := pre({before});");
        }
    }
}

/// Where the value for a held one is at the end of the delay.
pub(crate) fn source(
    dae: &Dae,
    names: &Names<'_>,
    begun: &Begun,
    position: usize,
) -> Option<String> {
    let last = line(dae, names, begun).remove(&position);
    let last = last.and_then(|mut places| places.pop());
    last.or_else(|| names.memory(position).map(str::to_owned))
}

/// Asserts of clocks whose delay or period is made of parameters: the length of a line is that of the exported values.
pub(crate) fn asserts(text: &mut String, dae: &Dae, names: &Names<'_>, begun: &Begun) {
    for (clock, tick) in dae.ticks.enumerate() {
        let is_held = dae.holds.iter().any(|own| own.clock == clock.index());
        let parts = [tick.delay, tick.period];
        if !is_held || dae.exprs.is_constant(tick.delay, 0.0) || !changes(dae, &parts) {
            continue;
        }
        let earlier = begun.earlier.get(clock.index()).copied().unwrap_or(0);
        let (delay, period) = (names.number(tick.delay, 0), names.number(tick.period, 0));
        let periods = format!("{delay}/{period}");
        let (least, most) = (earlier as f64, (earlier + 1) as f64);
        let above = match earlier {
            0 => String::new(),
            _ => format!("{periods} > {:?} and ", least * (1.0 + ROUNDING)),
        };
        let most = most * (1.0 + ROUNDING);
        let _ = writeln!(
            text,
            "  assert({above}{periods} <= {most:?}, \"the delay of {} is a different number of its periods: export again\");",
            tick.name
        );
    }
}

/// Whether one of some expressions contains a parameter.
fn changes(dae: &Dae, parts: &[ExprId]) -> bool {
    let mut below = dae.exprs.below(parts).into_iter();
    below.any(|id| matches!(dae.exprs[id], Expr::Param(_, _)))
}

#[cfg(test)]
mod tests {
    use super::ticks_before_change;

    #[test]
    fn only_ticks_before_the_change_count() {
        let ticks = |delay: f64| ticks_before_change(delay, 0.01);
        assert_eq!(
            [0.0, 0.004, 0.01, 0.015, 0.02, 0.025, 0.03, 0.07].map(ticks),
            [0, 0, 0, 1, 1, 2, 2, 6]
        );
    }
}
