//! A model as flat Modelica: one class without components, whose identifiers are the full names in quotes.
//!
//! ```text
//! names         identifiers of everything that has a value                       names.rs
//! expression    expressions and truths                                           expression.rs
//! declarations  parameters, inputs, variables                                    declarations.rs
//! events        modes, `when` clauses, clocks, held values, asserts              events.rs
//! late          what a clock holds longer than its period                        late.rs
//! ```
//! What is written is the system after index reduction ([`hyde_ir::Dae`]): the flat model itself has modes that change the
//! index, which Modelica does not express; reduced, a mode only switches between equations. Arrays are written element by
//! element.

mod declarations;
mod events;
mod expression;
mod late;
mod names;
mod refusals;

use hyde_compiler::{Form, FreeInputs, Request};
use hyde_diag::{Diagnostic, Diagnostics};
use hyde_ir::Dae;
use hyde_ir::dae::{InitialCondition, ReactionKind};
use hyde_study::Project;
pub use late::ticks_before_change;
use names::Names;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// The longest text that is written, in bytes.
const LONGEST: usize = 50_000_000;

/// A model as text, with what a reader should know of it.
#[derive(Clone, Debug)]
pub struct Written {
    /// The class.
    pub text: String,
    /// Numbers of unknowns, of modes blocks and of clocks.
    pub counts: (usize, usize, usize),
}

/// What events at the start of a run change, by the places of the solver's vector and of the memory. A class starts behind
/// them: in Modelica a guard that is true at the start never becomes true, so its exit would never be taken.
#[derive(Clone, Debug, Default)]
pub struct Begun {
    /// States that jump.
    pub states: BTreeMap<usize, f64>,
    /// Modes, and what is remembered.
    pub memory: BTreeMap<usize, f64>,
    /// Of each clock, how many further ticks run before what it holds changes ([`ticks_before_change`]).
    pub earlier: Vec<usize>,
}

/// The model of a project as a class of that name. What is wrong is in the project's diagnostics.
pub fn written(project: &mut Project, name: &str, begun: &Begun) -> Option<Written> {
    let settings = project.set().into_iter().collect();
    let headers = hyde_study::headers(&project.records);
    let request = Request {
        free_inputs: FreeInputs::Undriven,
        ..project.request(&settings, &headers, Form::Run)
    };
    let mut diagnostics = Diagnostics::new();
    let dae = hyde_compiler::analyze(&request, &mut diagnostics);
    let Some(dae) = dae else {
        project.diagnostics = diagnostics;
        return None;
    };
    if let Some(diagnostic) = inexpressible(&dae) {
        project.diagnostics.push(diagnostic);
        return None;
    }
    let found = class(&dae, name, begun);
    if found.is_none() {
        project.diagnostics.push(refusals::too_long());
    }
    found
}

/// What Modelica does not express.
fn inexpressible(dae: &Dae) -> Option<Diagnostic> {
    if let Some(selection) = dae.selections.first() {
        let choice = dae.choice(selection);
        let constraint = choice.constraints.first().map(|origin| origin.span);
        return Some(refusals::chooses_states(&choice.candidates, constraint));
    }
    let edges = dae.reactions.iter();
    let edge = edges
        .into_iter()
        .find(|own| matches!(own.kind, ReactionKind::Edge(_)))?;
    Some(refusals::edge_in_condition(edge.origin.span))
}

fn class(dae: &Dae, name: &str, begun: &Begun) -> Option<Written> {
    let names = Names::of(dae);
    let mut text = format!(
        "model {name} \"{} after index reduction, written by Hyde {}; values in SI units\"\n",
        dae.name,
        env!("CARGO_PKG_VERSION")
    );
    declarations::write(&mut text, dae, &names, begun);
    initial(&mut text, dae, &names);
    text.push_str("equation\n");
    for definition in dae.definitions.iter().filter(|own| !own.slope) {
        for counter in definition.range.iter() {
            let target = names.variable(definition.var, definition.index.at(counter));
            if names.is_input(&target) {
                continue;
            }
            let value = names.number(definition.value, counter);
            let _ = writeln!(text, "  {target} = {value};");
        }
        if text.len() > LONGEST {
            return None;
        }
    }
    for residual in &dae.residuals {
        for counter in residual.range.iter() {
            let value = names.number(residual.value, counter);
            let _ = writeln!(text, "  0 = {value};");
        }
        if text.len() > LONGEST {
            return None;
        }
    }
    for delay in dae.delays.iter() {
        for (element, counter) in (0..).zip(delay.range.iter()) {
            let target = names.variable(delay.var, element);
            let value = names.number(delay.value, counter);
            let time = names.number(delay.time, counter);
            let _ = writeln!(text, "  {target} = delay({value}, {time});");
        }
    }
    declarations::reported(&mut text, dae, &names);
    events::write(&mut text, dae, &names, begun);
    let _ = writeln!(text, "end {name};");
    Some(Written {
        text,
        counts: (dae.n_unknowns, dae.automata.len(), dae.ticks.len()),
    })
}

/// Conditions at the start that are equations, and the parameters that follow from those which they determine.
fn initial(text: &mut String, dae: &Dae, names: &Names<'_>) {
    let mut lines = String::new();
    for condition in &dae.initial {
        let InitialCondition::Equation { range, value, .. } = condition else {
            continue;
        };
        for counter in range.iter() {
            let _ = writeln!(lines, "  0 = {};", names.number(*value, counter));
        }
    }
    for (name, value) in declarations::found_with_others(dae, names) {
        let _ = writeln!(lines, "  {name} = {value};");
    }
    if !lines.is_empty() {
        let _ = write!(text, "initial equation\n{lines}");
    }
}

/// The number of an automaton's mode, as the class has it.
pub(crate) fn mode_number(mode: usize) -> usize {
    mode + 1
}
