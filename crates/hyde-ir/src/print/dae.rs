//! Prints a [`Dae`] in full: what interpreter and machine code are made from.

use super::{Names, comment, counted, subscript};
use crate::dae::{Dae, Function, ReactionKind, Target, Wrt};
use crate::expr::Index;
use crate::id::{AutomatonId, Id as _, RelationId};
use hyde_diag::Sources;
use std::fmt::Write as _;

/// The names of modes and relations, for expressions.
pub(super) struct Labels<'a> {
    dae: &'a Dae,
    mode: Box<dyn Fn(AutomatonId, u32) -> String + 'a>,
    relation: Box<dyn Fn(RelationId) -> String + 'a>,
}

impl<'a> Labels<'a> {
    pub(super) fn new(dae: &'a Dae) -> Self {
        let mode = move |automaton: AutomatonId, mode: u32| {
            let automaton = &dae.automata[automaton];
            let name = automaton
                .modes
                .get(mode as usize)
                .map_or("?", String::as_str);
            format!("{}.{name}", automaton.name)
        };
        Self {
            dae,
            mode: Box::new(mode),
            relation: Box::new(move |relation| dae.relations[relation].text.clone()),
        }
    }

    pub(super) fn names(&self) -> Names<'_> {
        Names {
            exprs: &self.dae.exprs,
            variables: &self.dae.variables,
            parameters: &self.dae.parameters,
            mode: &*self.mode,
            relation: &*self.relation,
        }
    }
}

/// The whole system as text: derived parameters, definitions, residuals, derivatives, events, clocks, starts, outputs.
#[must_use]
pub fn print_dae(dae: &Dae, sources: &Sources) -> String {
    let labels = Labels::new(dae);
    let names = labels.names();
    let mut out = format!("dae {}\n", dae.name);
    let line = |out: &mut String, text: String| {
        let _ = writeln!(out, "  {text}");
    };
    let _ = writeln!(out, "derived parameters");
    for parameter in dae.parameters.iter().filter(|parameter| parameter.derived) {
        let values: Vec<String> = parameter
            .value
            .iter()
            .map(|&value| names.expr(value))
            .collect();
        line(
            &mut out,
            format!("{} = {}", parameter.name, values.join(", ")),
        );
    }
    let _ = writeln!(out, "explicit");
    for d in &dae.definitions {
        let target = names.element(d.var, d.index);
        let text = format!(
            "{}{target} = {}{}",
            counted(d.range),
            names.expr(d.value),
            comment(&d.origin, sources)
        );
        line(&mut out, text);
    }
    let _ = writeln!(out, "residuals");
    for residual in &dae.residuals {
        let origins: Vec<String> = residual
            .origins
            .iter()
            .map(|origin| comment(origin, sources))
            .collect();
        let row = subscript(residual.row, 0);
        line(
            &mut out,
            format!(
                "{}{row}: 0 = {}{}",
                counted(residual.range),
                names.expr(residual.value),
                origins.join(",")
            ),
        );
    }
    for function in Function::ALL {
        let partials = dae.partials(function);
        if !partials.is_empty() {
            let _ = writeln!(out, "derivatives of {}", function_name(function));
        }
        for partial in partials {
            let wrt = match partial.wrt {
                Wrt::Unknown(index) => by_unknown(dae, index, ""),
                Wrt::Derivative(index) => by_unknown(dae, index, "der "),
                Wrt::Parameter(index) => format!("p {}", subscript(index, 0)),
                Wrt::Memory(index) => format!("z {}", subscript(index, 0)),
                Wrt::Delayed(index) => format!("delayed {}", subscript(index, 0)),
                Wrt::Time => "time".to_owned(),
            };
            let row = match partial.range.len() {
                1 => partial.row.at(partial.range.first).to_string(),
                _ => subscript(partial.row, 0),
            };
            line(
                &mut out,
                format!(
                    "{}{row} by {wrt}: {}",
                    counted(partial.range),
                    names.expr(partial.value)
                ),
            );
        }
    }
    events(&mut out, dae, &names, sources);
    for part in &dae.foreign {
        let _ = writeln!(
            out,
            "fmu {} from {}, stepped by {}",
            part.name, part.file, dae.ticks[part.clock].name
        );
    }
    for &clock in &dae.tick_order {
        let tick = &dae.ticks[clock];
        let times = format!(
            "every {} delay {} phase {}",
            names.expr(tick.period),
            names.expr(tick.delay),
            names.expr(tick.phase)
        );
        let _ = writeln!(out, "tick {} {times}", tick.name);
        for assignment in &tick.assignments {
            let target = names.element(assignment.var, assignment.index);
            let value = names.expr(assignment.value);
            line(
                &mut out,
                format!(
                    "{}{target} := {value}{}",
                    counted(assignment.range),
                    comment(&assignment.origin, sources)
                ),
            );
        }
    }
    if !dae.turning.is_empty() || dae.exponential {
        let _ = writeln!(out, "turning");
    }
    for &rate in &dae.turning {
        line(&mut out, names.expr(rate));
    }
    if dae.exponential {
        line(&mut out, "an exponential grows".to_owned());
    }
    if !dae.angles.is_empty() {
        let _ = writeln!(out, "angles of root functions");
    }
    for &angle in &dae.angles {
        line(&mut out, names.expr(angle));
    }
    let _ = writeln!(out, "starts");
    for start in &dae.starts {
        let space = match start.place.space {
            crate::dae::Space::Unknown => "y",
            crate::dae::Space::Memory => "z",
            crate::dae::Space::Input => "u",
            crate::dae::Space::Work => "w",
            crate::dae::Space::Parameter => "p",
        };
        let index = Index {
            offset: start.index.offset + i32::try_from(start.place.base).unwrap_or(0),
            ..start.index
        };
        line(
            &mut out,
            format!(
                "{}{space}[{}] = {}",
                counted(start.range),
                subscript(index, 0),
                names.expr(start.value)
            ),
        );
    }
    let _ = writeln!(out, "outputs");
    for output in &dae.outputs {
        let name = match output.names.as_slice() {
            [name] => name.clone(),
            [first, .., last] => format!("{first} .. {last}"),
            [] => String::new(),
        };
        line(
            &mut out,
            format!(
                "{}{name} = {}",
                counted(output.range),
                names.expr(output.value)
            ),
        );
    }
    out
}

fn events(out: &mut String, dae: &Dae, names: &Names<'_>, sources: &Sources) {
    if !dae.relations.is_empty() {
        let _ = writeln!(out, "relations");
    }
    for relation in dae.relations.iter() {
        let sign = if relation.inclusive { ">=" } else { ">" };
        let scheduled = relation
            .time_event
            .map_or_else(String::new, |at| format!(" at time {}", names.expr(at)));
        let place = comment(&relation.origin, sources);
        let _ = writeln!(
            out,
            "  «{}»: {} {sign} 0{scheduled}{place}",
            relation.text,
            names.expr(relation.root)
        );
    }
    if !dae.reactions.is_empty() {
        let _ = writeln!(out, "reactions");
    }
    for reaction in &dae.reactions {
        let what = match &reaction.kind {
            ReactionKind::Transition {
                automaton,
                from,
                to,
                impact,
            } => {
                let automaton = &dae.automata[AutomatonId::from_index(*automaton)];
                let impact = if *impact { " impact" } else { "" };
                format!(
                    "{}: {} -> {}{impact}",
                    automaton.name, automaton.modes[*from], automaton.modes[*to]
                )
            }
            ReactionKind::When { clause } => format!("when {clause}"),
            ReactionKind::Edge(place) => format!("edge in z[{place}]"),
            ReactionKind::Assert(message) => format!("assert {message:?}"),
        };
        let mut text = format!("  {what} on {}", names.expr(reaction.condition));
        for assignment in &dae.assignments[reaction.assignments.clone()] {
            let target = match assignment.target {
                Target::State(position) => dae.unknown_name(position),
                Target::Memory(position) => format!("z[{position}]"),
            };
            let _ = write!(text, " {target} := {}", names.expr(assignment.value));
        }
        let _ = writeln!(out, "{text}{}", comment(&reaction.origin, sources));
    }
}

fn by_unknown(dae: &Dae, index: Index, lead: &str) -> String {
    if index.stride == 0 {
        let position = usize::try_from(index.offset).unwrap_or(usize::MAX);
        return format!("{lead}{}", dae.unknown_name(position));
    }
    format!("{lead}y[{}]", subscript(index, 0))
}

fn function_name(function: Function) -> &'static str {
    match function {
        Function::Residual => "residuals",
        Function::Roots => "root functions",
        Function::Assignments => "assignments",
        Function::Outputs => "outputs",
        Function::Initial => "initial equations",
        Function::Delayed => "delayed values",
        Function::Angles => "angles",
    }
}
