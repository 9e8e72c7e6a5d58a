//! What is wrong where equations and unknowns do not match, in the words of the model.

mod massless;

use super::{Node, origin, sides};
use crate::graph::{Bipartite, Matching};
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
    let place = variable.trace.clone().unwrap_or_default();
    let flux = short(&variable.name);
    let flux = flux
        .strip_suffix(".left")
        .or_else(|| flux.strip_suffix(".right"))
        .unwrap_or(flux);
    Diagnostic::error(
        Code::MissingBoundary,
        format!("no boundary condition at `{place}`"),
    )
    .label(
        variable.origin.span,
        format!("its flux at `{place}` is not determined"),
    )
    .in_component(system, &variable.origin)
    .note("each end needs one condition, and one more for each connector variable set there")
    .help(format!(
        "write `{flux} = 0 indomain {place};` for a free end, or give the value of the field there"
    ))
}

pub(crate) fn unbound_input(system: &System, input: VarId) -> Diagnostic {
    let variable = &system.flat.variables[input];
    let name = &variable.name;
    Diagnostic::error(
        Code::UnboundInput,
        format!("the input `{name}` has no source"),
    )
    .placed(
        system,
        &variable.origin,
        &format!("gives no `{}`", short(name)),
        "declared here",
    )
    .help(format!(
        "bind it where its component is declared: `({} = …)`, or write an equation: `{name} = …;`",
        short(name)
    ))
}

/// An array of which some element has no equation at all.
pub(super) fn undetermined(system: &System, array: VarId) -> Diagnostic {
    let variable = &system.flat.variables[array];
    Diagnostic::error(
        Code::TooFewEquations,
        format!(
            "the equations do not determine all elements of `{}`",
            variable.name
        ),
    )
    .placed(
        system,
        &variable.origin,
        "in this component",
        &format!("an array of {} elements", variable.size()),
    )
    .help(format!(
        "write an equation for each: `for i in 1:{} loop {}[i] = …; end for;`",
        variable.size(),
        short(&variable.name)
    ))
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
    let mut diagnostic = Diagnostic::error(
        Code::TooFewEquations,
        format!("no equation determines `{what}`"),
    )
    .placed(
        system,
        &variable.origin,
        "in this component",
        "declared here",
    );
    if !lefts.is_empty() {
        let others: Vec<String> = rights
            .iter()
            .take(6)
            .map(|&right| format!("`{}`", name(system, unknowns[right])))
            .collect();
        let more = if rights.len() > 6 { ", …" } else { "" };
        diagnostic = diagnostic.note(format!(
            "{} for the {} unknowns {}{more}",
            plural(lefts.len(), "equation"),
            rights.len(),
            others.join(", ")
        ));
        for &left in lefts.iter().take(3) {
            let origin = origin(system, nodes[left]);
            let text = match origin.instance.as_str() {
                "" => "this equation is among them".to_owned(),
                instance => format!("this equation of `{instance}` is among them"),
            };
            diagnostic = diagnostic.label(origin.span, text);
        }
    }
    let help = match variable.flow {
        true => "connect its connector, or give the force a law".to_owned(),
        false => format!("add an equation for it: `{} = …;`", short(&variable.name)),
    };
    diagnostic.help(help)
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
        return Diagnostic::error(Code::TooManyEquations, "this equation is redundant")
            .placed(
                system,
                &origin,
                "an equation too many in this component",
                "other equations determine all its variables",
            )
            .help("remove it, or the equations that determine its variables");
    }
    let list: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    let diagnostic = Diagnostic::error(
        Code::Constrained,
        format!("{} are constrained to each other", list.join(" and ")),
    )
    .label(origin.span, "this equation determines one from the others");
    if sides(system, node)
        .iter()
        .any(|(range, ..)| *range != Range::SCALAR)
    {
        return diagnostic
            .note("a constraint between whole arrays can be differentiated if it is solved for one of them: `x[i] = …`")
            .help("solve it for one of the arrays, or put a stiffness between the parts");
    }
    diagnostic
        .note("each of them is a state with an equation for its derivative: the model needs index reduction")
        .help("put a spring between the parts, or describe the joined parts by one of the states")
}

/// Labels in the user's own file for what lies in a component of a library.
trait Placed: Sized {
    /// The declaration of the component first, then the place itself; at the top the place alone.
    fn placed(self, system: &System, origin: &Origin, component: &str, here: &str) -> Self;
    /// The declaration of the component after the other labels; nothing at the top.
    fn in_component(self, system: &System, origin: &Origin) -> Self;
}

impl Placed for Diagnostic {
    fn placed(self, system: &System, origin: &Origin, component: &str, here: &str) -> Self {
        match system.component(origin) {
            Some((_, span)) => self.label(span, component).label(origin.span, here),
            None => self.label(origin.span, here),
        }
    }

    fn in_component(self, system: &System, origin: &Origin) -> Self {
        match system.component(origin) {
            Some((_, span)) => self.label(span, format!("in `{}`", origin.instance)),
            None => self,
        }
    }
}

fn too_many(
    system: &System,
    nodes: &[Node],
    unknowns: &[Segment],
    lefts: &[usize],
    rights: &[usize],
) -> Diagnostic {
    let names: Vec<String> = rights
        .iter()
        .take(6)
        .map(|&right| format!("`{}`", name(system, unknowns[right])))
        .collect();
    let more = if rights.len() > 6 { ", …" } else { "" };
    let message = format!(
        "{} for {}: {}{more}",
        plural(lefts.len(), "equation"),
        plural(rights.len(), "unknown"),
        names.join(", ")
    );
    let mut diagnostic = Diagnostic::error(Code::TooManyEquations, message);
    let mut instances: Vec<String> = Vec::new();
    for &left in lefts.iter().take(8) {
        let origin = origin(system, nodes[left]);
        let text = match origin.instance.as_str() {
            "" => "one of the equations".to_owned(),
            instance => format!("one of the equations, of `{instance}`"),
        };
        diagnostic = diagnostic.label(origin.span, text);
        let instance = origin.instance.as_str().to_owned();
        if !instance.is_empty() && !instances.contains(&instance) {
            instances.push(instance);
        }
    }
    if !instances.is_empty() {
        let list: Vec<String> = instances
            .iter()
            .map(|instance| format!("`{instance}`"))
            .collect();
        diagnostic = diagnostic.note(format!("in {}", list.join(", ")));
    }
    diagnostic
        .help("remove one of them, or put a spring between the parts that both of them constrain")
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

pub(crate) fn plural(count: usize, word: &str) -> String {
    if count == 1 {
        format!("1 {word}")
    } else {
        format!("{count} {word}s")
    }
}

pub(crate) fn short(name: &str) -> &str {
    // `screw.q.left` is shown as `q.left`.
    match name.rsplit_once('.') {
        Some((before, "left" | "right")) => &name[before.rfind('.').map_or(0, |at| at + 1)..],
        Some((_, last)) => last,
        None => name,
    }
}
