//! Modes, `when` clauses, clocks, held values and asserts.
//!
//! What an automaton, a clause or a tick sets stands in an algorithm of its own, in which several branches may set one variable;
//! jumps of states are `reinit`s in equations with the same conditions. A guard acts when it is true in its mode: its condition is `pre(mode) = k
//! and guard`, which becomes true when the mode is entered too. Guards that are true at the start are taken before
//! ([`crate::Begun`]).

use crate::names::{Names, mode_name};
use crate::{Begun, late, mode_number};
use hyde_ir::dae::{Dae, Reaction, ReactionKind, Target};
use hyde_ir::{AutomatonId, ClockId, Id as _};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Writes all events, behind the equations.
pub(crate) fn write(text: &mut String, dae: &Dae, names: &Names<'_>, begun: &Begun) {
    let chains = chains(dae);
    jumps(text, dae, names, &chains);
    for reaction in &dae.reactions {
        if let ReactionKind::Assert(message) = &reaction.kind {
            let message = message.replace('\\', "/").replace('"', "'");
            let condition = names.condition(reaction.condition);
            let _ = writeln!(text, "  assert(not {condition}, \"{message}\");");
        }
    }
    late::asserts(text, dae, names, begun);
    for reactions in chains.values() {
        chain(text, dae, names, reactions);
    }
    ticks(text, dae, names, begun);
}

/// The reactions of each automaton, and those of each `when` clause, in their order.
fn chains(dae: &Dae) -> BTreeMap<(usize, usize), Vec<&Reaction>> {
    let mut found: BTreeMap<(usize, usize), Vec<&Reaction>> = BTreeMap::new();
    for reaction in &dae.reactions {
        let key = match &reaction.kind {
            ReactionKind::Transition { automaton, .. } => (0, *automaton),
            ReactionKind::When { clause } => (1, *clause),
            ReactionKind::Edge(_) | ReactionKind::Assert(_) => continue,
        };
        found.entry(key).or_default().push(reaction);
    }
    found
}

/// When a reaction acts.
fn condition(dae: &Dae, names: &Names<'_>, reaction: &Reaction) -> String {
    let condition = names.condition(reaction.condition);
    match &reaction.kind {
        ReactionKind::Transition {
            automaton, from, ..
        } => {
            let mode = mode_name(&dae.automata[AutomatonId::from_index(*automaton)].name);
            format!("pre({mode}) == {} and {condition}", mode_number(*from))
        }
        ReactionKind::When { .. } | ReactionKind::Edge(_) | ReactionKind::Assert(_) => condition,
    }
}

/// The jumps of states: those that reactions make, and those into a mode that fixes a state. A state is set by one clause.
fn jumps(
    text: &mut String,
    dae: &Dae,
    names: &Names<'_>,
    chains: &BTreeMap<(usize, usize), Vec<&Reaction>>,
) {
    let mut found: BTreeMap<usize, Vec<(String, String)>> = BTreeMap::new();
    for reactions in chains.values() {
        for (number, reaction) in reactions.iter().enumerate() {
            for assignment in &dae.assignments[reaction.assignments.clone()] {
                let Target::State(position) = assignment.target else {
                    continue;
                };
                let branches = found.entry(position).or_default();
                // One that acts instead leaves the state as it is. A branch without a statement would be valid; rumoca drops
                // it.
                let name = names.unknown(position);
                let before = reactions[..number].iter();
                for other in before.filter(|own| precedes(own, reaction)) {
                    let condition = condition(dae, names, other);
                    if branches.iter().all(|own| own.0 != condition) {
                        branches.push((condition, format!("pre({name})")));
                    }
                }
                let condition = condition(dae, names, reaction);
                branches.push((condition, names.set(assignment.value, 0)));
            }
        }
    }
    for pin in &dae.pins {
        let mode = mode_name(&dae.automata[pin.automaton].name);
        let condition = format!("{mode} == {}", mode_number(pin.mode));
        let value = names.number(pin.value, 0);
        found.entry(pin.state).or_default().push((condition, value));
    }
    for (state, branches) in found {
        let name = names.unknown(state);
        let mut word = "when";
        for (condition, value) in branches {
            let _ = writeln!(
                text,
                "  {word} {condition} then\n    reinit({name}, {value});"
            );
            word = "elsewhen";
        }
        text.push_str("  end when;\n");
    }
}

/// Whether a reaction acts instead of one behind it in its chain: both can become true at once.
fn precedes(first: &Reaction, second: &Reaction) -> bool {
    match (&first.kind, &second.kind) {
        (ReactionKind::Transition { from: a, .. }, ReactionKind::Transition { from: b, .. }) => {
            a == b
        }
        (
            ReactionKind::Transition { .. }
            | ReactionKind::When { .. }
            | ReactionKind::Edge(_)
            | ReactionKind::Assert(_),
            _,
        ) => true,
    }
}

/// The branches of one automaton or clause.
fn chain(text: &mut String, dae: &Dae, names: &Names<'_>, reactions: &[&Reaction]) {
    let mut word = "when";
    let mut open = false;
    for reaction in reactions {
        let mut lines = String::new();
        for assignment in &dae.assignments[reaction.assignments.clone()] {
            if let Target::Memory(position) = assignment.target
                && let Some(name) = names.memory(position)
            {
                let value = names.set(assignment.value, 0);
                let _ = writeln!(lines, "    {name} := {value};");
            }
        }
        if let ReactionKind::Transition { automaton, to, .. } = &reaction.kind {
            let mode = mode_name(&dae.automata[AutomatonId::from_index(*automaton)].name);
            let _ = writeln!(lines, "    {mode} := {};", mode_number(*to));
        }
        if lines.is_empty() {
            continue;
        }
        let condition = condition(dae, names, reaction);
        if !open {
            text.push_str("algorithm\n");
        }
        let _ = write!(text, "  {word} {condition} then\n{lines}");
        word = "elsewhen";
        open = true;
    }
    if open {
        text.push_str("  end when;\n");
    }
}

/// The ticks of clocks in their order, and what they hold. What changes later changes first at an instant: a tick then writes
/// the next value.
fn ticks(text: &mut String, dae: &Dae, names: &Names<'_>, begun: &Begun) {
    for hold in dae.holds.iter() {
        let tick = &dae.ticks[ClockId::from_index(hold.clock)];
        if dae.exprs.is_constant(tick.delay, 0.0) {
            continue;
        }
        let (phase, delay) = (names.number(tick.phase, 0), names.number(tick.delay, 0));
        let period = names.number(tick.period, 0);
        let _ = writeln!(
            text,
            "algorithm\n  when sample({phase} + {delay}, {period}) then"
        );
        for element in 0..hold.len {
            let source = late::source(dae, names, begun, hold.source + element);
            if let (Some(source), Some(target)) = (source, names.memory(hold.target + element)) {
                let _ = writeln!(text, "    {target} := pre({source});");
            }
        }
        text.push_str("  end when;\n");
    }
    for &clock in &dae.tick_order {
        let tick = &dae.ticks[clock];
        let (phase, period) = (names.number(tick.phase, 0), names.number(tick.period, 0));
        let _ = writeln!(text, "algorithm\n  when sample({phase}, {period}) then");
        late::moved(text, dae, names, begun, clock);
        for assignment in &tick.assignments {
            for counter in assignment.range.iter() {
                let target = names.variable(assignment.var, assignment.index.at(counter));
                let value = names.ticked(assignment.value, counter);
                let _ = writeln!(text, "    {target} := {value};");
            }
        }
        let prompt = dae.exprs.is_constant(tick.delay, 0.0);
        for hold in dae
            .holds
            .iter()
            .filter(|hold| prompt && hold.clock == clock.index())
        {
            for element in 0..hold.len {
                if let (Some(source), Some(target)) = (
                    names.memory(hold.source + element),
                    names.memory(hold.target + element),
                ) {
                    let _ = writeln!(text, "    {target} := {source};");
                }
            }
        }
        text.push_str("  end when;\n");
    }
}
