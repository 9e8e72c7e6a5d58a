//! Prints the structure of a [`Dae`]: what became of every variable, and in which order the rest is solved.

use super::{comment, dae};
use crate::dae::{Alias, Dae, Firmness, InitialCondition};
use hyde_diag::Sources;
use std::fmt::Write as _;

/// The structure as text: eliminated variables, states, implicit algebraic variables with the equation each is
/// matched to, explicit variables in order, pins, initial conditions, and notes.
#[must_use]
pub fn print_structure(dae: &Dae, sources: &Sources) -> String {
    let labels = dae::Labels::new(dae);
    let names = labels.names();
    let definitions = || dae.definitions.iter().filter(|own| !own.slope);
    let mut out = format!(
        "structure {}\n  {} unknowns, {} explicit, {} eliminated, {} in memory\n",
        dae.name,
        dae.n_unknowns,
        definitions().map(|d| d.range.len()).sum::<usize>(),
        dae.aliases.len(),
        dae.n_memory
    );
    for (title, differential) in [("states", true), ("algebraic variables", false)] {
        let blocks: Vec<_> = (dae.unknowns.iter().zip(&dae.residuals))
            .filter(|(block, _)| block.differential == differential)
            .collect();
        if !blocks.is_empty() {
            let _ = writeln!(out, "{title}");
        }
        for (block, residual) in blocks {
            let variable = &dae.variables[block.var];
            let mut name = variable.element_name(block.first);
            if block.len > 1 {
                let _ = write!(
                    name,
                    " .. {}",
                    variable.element_name(block.first + block.len - 1)
                );
            }
            let origins = residual.origins.iter();
            let origins: Vec<String> = origins.map(|origin| comment(origin, sources)).collect();
            let _ = writeln!(out, "  {:>4} {name}{}", block.offset, origins.join(","));
        }
    }
    if !dae.selections.is_empty() {
        let _ = writeln!(out, "states chosen while running");
    }
    for selection in &dae.selections {
        let choice = dae.choice(selection);
        let origins: Vec<String> = choice
            .constraints
            .iter()
            .map(|origin| comment(origin, sources))
            .collect();
        let names = choice.candidates.join(", ");
        let _ = writeln!(out, "  {} of {names}{}", choice.states, origins.join(","));
    }
    if !dae.dependent.is_empty() {
        let _ = writeln!(out, "no states, for an equation gives them by others");
    }
    for dependent in &dae.dependent {
        let name = dae.dependent_name(dependent);
        let _ = writeln!(out, "  {name}{}", comment(&dependent.origin, sources));
    }
    if definitions().next().is_some() {
        let _ = writeln!(out, "explicit variables");
    }
    for definition in definitions() {
        let lead = super::counted(definition.range);
        let target = names.element(definition.var, definition.index);
        let _ = writeln!(
            out,
            "  {lead}{target}{}",
            comment(&definition.origin, sources)
        );
    }
    if !dae.aliases.is_empty() {
        let _ = writeln!(out, "eliminated variables");
    }
    for (var, alias) in &dae.aliases {
        let name = &dae.variables[*var].name;
        let target = match alias {
            Alias::Of {
                var,
                element,
                negated,
            } => {
                let sign = if *negated { "-" } else { "" };
                format!("{sign}{}", dae.variables[*var].element_name(*element))
            }
            Alias::Value(value) => names.expr(*value),
        };
        let _ = writeln!(out, "  {name} = {target}");
    }
    if !dae.pins.is_empty() {
        let _ = writeln!(out, "pins");
    }
    for pin in &dae.pins {
        let automaton = &dae.automata[pin.automaton];
        let state = dae.unknown_name(pin.state);
        let value = names.expr(pin.value);
        let mode = &automaton.modes[pin.mode];
        let _ = writeln!(out, "  {}.{mode}: {state} = {value}", automaton.name);
    }
    let _ = writeln!(out, "initial conditions");
    for condition in &dae.initial {
        let text = match condition {
            InitialCondition::Fixed {
                state,
                len,
                firmness,
                yields,
                ..
            } => {
                let mut name = dae.unknown_name(*state);
                if *len > 1 {
                    let _ = write!(name, " .. {}", dae.unknown_name(state + len - 1));
                }
                match (yields, *firmness < Firmness::Default) {
                    (true, _) => format!("{name} by an equation"),
                    (false, true) => format!("{name} = start (not declared fixed)"),
                    (false, false) => format!("{name} = start"),
                }
            }
            InitialCondition::Equation {
                range,
                value,
                origin,
            } => {
                format!(
                    "{}0 = {}{}",
                    super::counted(*range),
                    names.expr(*value),
                    comment(origin, sources)
                )
            }
            InitialCondition::Check { var, start, .. } => format!(
                "{} is to be {}, by the others",
                dae.variables[*var].name,
                names.expr(*start)
            ),
        };
        let _ = writeln!(out, "  {text}");
    }
    for note in &dae.notes {
        let _ = writeln!(out, "note: {note}");
    }
    out
}
