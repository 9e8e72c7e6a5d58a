//! What is wrong where equations and unknowns do not match, in the words of the model.

mod massless;

use super::node::{Node, origin, sides};
use crate::graph::{Bipartite, Matching};
use crate::refusals::words::short;
use crate::refusals::{place_of, unmatched as refused};
use crate::segments::Segment;
use crate::system::System;
use hyde_diag::{Code, Diagnostic, Diagnostics, Origin};
use hyde_ir::{Expr, Range, VarId};

pub(super) fn report(
    system: &System,
    nodes: &[Node],
    unknowns: &[Segment],
    graph: &Bipartite,
    matching: &Matching,
    diagnostics: &mut Diagnostics,
) {
    let unmatched: Vec<usize> = (0..unknowns.len())
        .filter(|&right| matching.of_right[right].is_none())
        .collect();
    let surplus: Vec<usize> = (0..nodes.len())
        .filter(|&left| matching.of_left[left].is_none())
        .collect();
    let mut constraints = false;
    for &left in &surplus {
        let (lefts, rights) = graph.over_determined(matching, left);
        let massless = massless::between(system, nodes, &lefts);
        constraints |= massless.is_some();
        let diagnostic = if rights.is_empty() {
            constrained(system, nodes[left])
        } else {
            massless.unwrap_or_else(|| too_many(system, nodes, unknowns, &lefts, &rights))
        };
        constraints |= diagnostic.code == Code::Constrained;
        diagnostics.push(diagnostic);
    }
    // Parts that are fixed to each other leave the force between them open: that is no second mistake.
    let open = |right: usize| {
        let flow = system.flat.variables[unknowns[right].var].flow;
        surplus.len() >= unmatched.len() && (flow || constraints)
    };
    // A missing boundary condition often shows at a neighbour: look for the flux in the whole part.
    for &right in unmatched.iter().filter(|&&right| !open(right)) {
        let (_, part) = graph.under_determined(matching, right);
        let trace = part
            .iter()
            .find(|&&right| system.flat.variables[unknowns[right].var].trace.is_some());
        let input = part
            .iter()
            .find(|&&right| system.flat.variables[unknowns[right].var].input);
        let diagnostic = match (trace, input) {
            (Some(&trace), _) => missing_boundary(system, unknowns[trace].var),
            (None, Some(&input)) => unbound_input(system, unknowns[input].var),
            (None, None) => too_few(system, nodes, unknowns, graph, matching, right),
        };
        diagnostics.push(diagnostic);
    }
}

pub(crate) fn missing_boundary(system: &System, trace: VarId) -> Diagnostic {
    let variable = &system.flat.variables[trace];
    let end = variable.trace.clone().unwrap_or_default();
    let flux = short(&variable.name);
    let flux = flux
        .strip_suffix(".left")
        .or_else(|| flux.strip_suffix(".right"))
        .unwrap_or(flux);
    let instance = variable.origin.instance.as_str();
    let place = place_of(system, &variable.origin);
    refused::missing_boundary(&end, flux, place, instance)
}

pub(crate) fn unbound_input(system: &System, input: VarId) -> Diagnostic {
    let variable = &system.flat.variables[input];
    refused::unbound_input(&variable.name, place_of(system, &variable.origin))
}

/// An array of which some element has no equation at all.
pub(super) fn undetermined(system: &System, array: VarId) -> Diagnostic {
    let variable = &system.flat.variables[array];
    let place = place_of(system, &variable.origin);
    refused::undetermined_elements(&variable.name, variable.size(), place)
}

fn too_few(
    system: &System,
    nodes: &[Node],
    unknowns: &[Segment],
    graph: &Bipartite,
    matching: &Matching,
    right: usize,
) -> Diagnostic {
    let unknown = unknowns[right];
    let variable = &system.flat.variables[unknown.var];
    let what = name(system, unknown);
    let (lefts, rights) = graph.under_determined(matching, right);
    let equations = lefts.iter().map(|&left| origin(system, nodes[left]));
    let equations: Vec<Origin> = equations.collect();
    let names = rights.iter().map(|&right| name(system, unknowns[right]));
    let names: Vec<String> = names.collect();
    let help = match variable.flow {
        true => "connect its connector, or give the force a law".to_owned(),
        false => equation_for(&variable.name),
    };
    let place = place_of(system, &variable.origin);
    refused::undetermined(&what, place, &equations, &names, &help)
}

/// The equation to add for a variable: in the class of its component, or in the model.
pub(crate) fn equation_for(name: &str) -> String {
    let short = short(name);
    match short == name {
        true => format!("add an equation for it: `{short} = …;`"),
        false => format!(
            "add an equation for it: `{short} = …;` in the class of its component, or `{name} = …;` in the model"
        ),
    }
}

/// An equation between states alone: they cannot all be states.
fn constrained(system: &System, node: Node) -> Diagnostic {
    let mut names: Vec<String> = Vec::new();
    for (_, lhs, rhs) in sides(system, node) {
        for id in system.flat.exprs.below(&[lhs, rhs]) {
            if let Expr::Var(var, index) | Expr::Der(var, index) = system.flat.exprs[id] {
                let text = match System::cell(var, index) {
                    Some(cell) => system.cell_name(cell),
                    None => system.flat.variables[var].name.clone(),
                };
                if !names.contains(&text) && system.is_continuous(var) {
                    names.push(text);
                }
            }
        }
    }
    let origin = origin(system, node);
    if names.is_empty() {
        return refused::redundant_equation(place_of(system, &origin));
    }
    let sides = sides(system, node);
    match sides.iter().all(|(range, ..)| *range == Range::SCALAR) {
        true => refused::constrained(&names, origin.span),
        false => refused::constrained_arrays(&names, origin.span),
    }
}

fn too_many(
    system: &System,
    nodes: &[Node],
    unknowns: &[Segment],
    lefts: &[usize],
    rights: &[usize],
) -> Diagnostic {
    let equations = lefts.iter().map(|&left| origin(system, nodes[left]));
    let equations: Vec<Origin> = equations.collect();
    let names = rights.iter().map(|&right| name(system, unknowns[right]));
    let names: Vec<String> = names.collect();
    refused::too_many_equations(&equations, &names)
}

/// The name of an unknown: of a whole array with its bounds.
pub(crate) fn name(system: &System, unknown: Segment) -> String {
    let variable = &system.flat.variables[unknown.var];
    let text = if unknown.len() == 1 {
        variable.element_name(unknown.first)
    } else {
        format!(
            "{}..{}",
            variable.element_name(unknown.first).trim_end_matches(']'),
            unknown.last + usize::try_from(variable.first).unwrap_or(0)
        ) + "]"
    };
    if unknown.state {
        format!("der({text})")
    } else {
        text
    }
}
