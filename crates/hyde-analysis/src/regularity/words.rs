//! What a conflict of equations means for a drive: held twice, floating, connected to nothing, a parameter as unknown.

use crate::matching::{self, Node, plural, sides};
use crate::system::System;
use hyde_diag::{Code, Diagnostic, MadeBy, Origin, Span};
use hyde_ir::{Expr, VarId};
use hyde_units::Dimension;

/// Equations of which each follows from the others, with the unknowns that are open for it.
pub(super) struct Conflict {
    equations: Vec<Node>,
    /// The components that have one of them, in the order of the model, with their declarations.
    parts: Vec<(String, Span)>,
    /// Unknowns that no equation determines.
    pub(super) open: Vec<VarId>,
}

impl Conflict {
    pub(super) fn new(system: &System, equations: Vec<Node>) -> Self {
        let mut parts: Vec<(String, Span)> = Vec::new();
        for &node in &equations {
            let origin = matching::origin(system, node);
            let part = system.component(&origin);
            if let (true, Some(part)) = (says_something(&origin), part)
                && !parts.contains(&part)
            {
                parts.push(part);
            }
        }
        parts.sort_by_key(|(_, span)| span.start);
        Self {
            equations,
            parts,
            open: Vec::new(),
        }
    }

    /// Whether a variable belongs to a component of the conflict, or is named in it.
    pub(super) fn concerns(&self, system: &System, var: VarId) -> bool {
        let part = system.component(&system.flat.variables[var].origin);
        part.is_some_and(|part| self.parts.contains(&part))
            || named(system, &self.equations).contains(&var)
    }

    /// Whether several components have a part in it.
    pub(super) fn is_of_several(&self) -> bool {
        self.parts.len() > 1
    }

    fn of(&self, system: &System, made_by: MadeBy) -> Vec<(Node, Origin)> {
        let origins = self
            .equations
            .iter()
            .map(|&node| (node, matching::origin(system, node)));
        origins
            .filter(|(_, origin)| origin.made_by == made_by)
            .collect()
    }

    /// The equations that the top of the model says itself.
    fn own(&self, system: &System) -> Vec<Origin> {
        let origins = self
            .equations
            .iter()
            .map(|&node| matching::origin(system, node));
        origins
            .filter(|origin| says_something(origin) && system.component(origin).is_none())
            .collect()
    }
}

/// No connection and no open end: an equation of somebody.
fn says_something(origin: &Origin) -> bool {
    !matches!(origin.made_by, MadeBy::Connection | MadeBy::Unconnected)
}

/// A parameter that stands where an unknown was meant: `need = M*der(v)` with `parameter Force need`.
pub(super) fn parameter(system: &System, conflict: &Conflict) -> Option<Diagnostic> {
    let exprs = &system.flat.exprs;
    for &node in &conflict.equations {
        let origin = matching::origin(system, node);
        if origin.made_by != MadeBy::Source || system.component(&origin).is_some() {
            continue;
        }
        for (_, lhs, rhs) in sides(system, node) {
            let Expr::Param(param, _) = exprs[lhs] else {
                continue;
            };
            if !exprs.any(rhs, |expr| expr.access().is_some()) {
                continue;
            }
            let parameter = &system.flat.parameters[param];
            let name = &parameter.name;
            return Some(
                Diagnostic::error(
                    Code::TooManyEquations,
                    format!("`{name}` is a parameter: this equation cannot determine it"),
                )
                .label(origin.span, "other equations determine all its variables")
                .label(parameter.origin.span, "its value is given here")
                .help(format!(
                    "if the equation should determine `{name}`, declare it without `parameter` and without a value"
                )),
            );
        }
    }
    None
}

/// A component of which the ends lead nowhere.
pub(super) fn loose(system: &System, conflict: &Conflict) -> Option<Diagnostic> {
    let ends = conflict.of(system, MadeBy::Unconnected);
    let [(part, span)] = conflict.parts.as_slice() else {
        return None;
    };
    if ends.is_empty() || !conflict.own(system).is_empty() {
        return None;
    }
    let list: Vec<String> = ends
        .iter()
        .map(|(_, origin)| format!("`{}`", origin.instance))
        .collect();
    let is = if list.len() == 1 { "is" } else { "are" };
    let open = conflict.open.iter().copied();
    let open = open
        .map(|var| &system.flat.variables[var])
        .find(|variable| !variable.flow);
    let mut diagnostic = Diagnostic::error(
        Code::TooManyEquations,
        format!("{} {is} connected to nothing", list.join(" and ")),
    )
    .label(*span, format!("`{part}` is not connected at this end"));
    if let Some(variable) = open {
        diagnostic = diagnostic.note(format!(
            "the flow at an unconnected connector is 0, so no equation determines `{}`",
            variable.name
        ));
    }
    Some(diagnostic.help(format!(
        "connect {}, or remove `{part}`",
        if list.len() == 1 { "it" } else { "one of them" }
    )))
}

/// Parts that hang on nothing: their flows sum to zero whatever the potentials are.
pub(super) fn floating(system: &System, conflict: &Conflict) -> Option<Diagnostic> {
    let flow = |&var: &VarId| system.flat.variables[var].flow;
    let flows_alone = named(system, &conflict.equations).iter().all(flow);
    let potential = conflict.open.iter().copied().find(|var| !flow(var));
    let potential = potential.filter(|_| flows_alone)?;
    let connections = conflict.of(system, MadeBy::Connection);
    if connections.is_empty() {
        return None;
    }
    let variable = &system.flat.variables[potential];
    let what = noun(variable.quantity.dimension);
    let mut parts: Vec<(String, Span)> = Vec::new();
    for &var in &conflict.open {
        let part = system.component(&system.flat.variables[var].origin);
        if let Some(part) = part
            && !parts.contains(&part)
        {
            parts.push(part);
        }
    }
    parts.sort_by_key(|(_, span)| span.start);
    let names: Vec<String> = parts.iter().map(|(name, _)| format!("`{name}`")).collect();
    let mut diagnostic = Diagnostic::error(
        Code::TooFewEquations,
        format!("no equation fixes the {what} of {}", and(&names)),
    );
    for (number, (part, span)) in parts.iter().take(4).enumerate() {
        let text = match number {
            0 => format!("the {what} of `{part}` is defined only relative to the others"),
            _ => format!("and that of `{part}`"),
        };
        diagnostic = diagnostic.label(*span, text);
    }
    let repair = match what {
        "voltage" => "connect a `Ground` to one node of the circuit".to_owned(),
        "angle" | "place" => {
            "connect one of them to a body with mass or to a `Fixed`; springs alone do not define a position"
                .to_owned()
        }
        _ => format!("connect a component that defines its {what}"),
    };
    Some(
        diagnostic
            .note("their flows already sum to 0 in each of these connections")
            .help(repair),
    )
}

/// Several parts that fix the same motion, voltage or flow.
pub(super) fn held_twice(system: &System, conflict: &Conflict) -> Option<Diagnostic> {
    let parts = &conflict.parts;
    if parts.len() < 2 || !conflict.own(system).is_empty() {
        return None;
    }
    let connections = conflict.of(system, MadeBy::Connection);
    let (node, connection) = connections.last()?;
    let joined = named(system, &[*node]);
    let &var = joined.first()?;
    let variable = &system.flat.variables[var];
    let what = noun(variable.quantity.dimension);
    let names: Vec<String> = parts.iter().map(|(name, _)| format!("`{name}`")).collect();
    // The body that is held: what else is in the connection.
    let others = joined_to(system, connection, var).into_iter();
    let body = others
        .filter_map(|var| system.component(&system.flat.variables[var].origin))
        .find(|part| !parts.contains(part));
    let place = match &body {
        Some((body, _)) => format!("the {what} of `{body}`"),
        None => format!("the {what} at `{}`", connector(&variable.name)),
    };
    let fix = match names.len() {
        2 => format!("{} both fix {place}", and(&names)),
        _ => format!("{} fix {place} once too often", and(&names)),
    };
    let mut diagnostic = Diagnostic::error(Code::TooManyEquations, fix);
    for (number, (part, span)) in parts.iter().take(6).enumerate() {
        let text = match number {
            0 => "one part that fixes it".to_owned(),
            _ => format!("`{part}` fixes it too"),
        };
        diagnostic = diagnostic.label(*span, text);
    }
    diagnostic = diagnostic.label(connection.span, "they are joined here");
    for &node in &conflict.equations {
        let origin = matching::origin(system, node);
        if says_something(&origin) && origin.made_by == MadeBy::Source {
            let text = format!("an equation of `{}`", origin.instance);
            let known = diagnostic.labels.iter().any(|l| l.span == origin.span);
            if !known && diagnostic.labels.len() < 8 {
                diagnostic = diagnostic.label(origin.span, text);
            }
        }
    }
    let open = conflict.open.iter().copied();
    if let Some(open) = open
        .map(|var| &system.flat.variables[var])
        .find(|variable| variable.flow)
    {
        diagnostic = diagnostic.note(format!(
            "the distribution of the {} at `{}` is not determined",
            noun(open.quantity.dimension),
            connector(&open.name)
        ));
    }
    let repair = match what {
        "voltage" => "remove one, or put a resistance between them",
        "current" => "remove one, or give the current at the node another path",
        "temperature" => "remove one, or put a thermal resistance between them",
        "angle" | "place" | "speed" => "remove one, or put a spring between them",
        _ => "remove one of them",
    };
    Some(diagnostic.help(repair))
}

/// Equations that depend on each other, as they are.
pub(super) fn generic(system: &System, conflict: &Conflict) -> Diagnostic {
    let unknowns = named(system, &conflict.equations);
    let names: Vec<String> = unknowns
        .iter()
        .filter(|&&var| !system.flat.variables[var].flow || unknowns.len() < 4)
        .take(6)
        .map(|&var| format!("`{}`", system.flat.variables[var].name))
        .collect();
    let more = if unknowns.len() > names.len() {
        ", …"
    } else {
        ""
    };
    let count = conflict.equations.len();
    let message = match (count, unknowns.len()) {
        (1, 0) => "this equation determines no variable".to_owned(),
        (_, unknown) if count > unknown => format!(
            "{} for {}: {}{more}",
            plural(count, "equation"),
            plural(unknown, "unknown"),
            names.join(", ")
        ),
        _ => format!(
            "one of the {count} equations of {}{more} is redundant",
            names.join(", ")
        ),
    };
    let mut diagnostic = Diagnostic::error(Code::TooManyEquations, message);
    // The model's own lines first, then the components that have the rest.
    for origin in conflict.own(system).iter().take(4) {
        let text = match diagnostic.labels.len() {
            0 => "one of these is redundant",
            _ => "one of them",
        };
        diagnostic = diagnostic.label(origin.span, text);
    }
    for (part, span) in conflict.parts.iter().take(4) {
        diagnostic = diagnostic.label(*span, format!("the equations of `{part}` are among them"));
    }
    let mut joined: Vec<Span> = Vec::new();
    for (_, origin) in conflict.of(system, MadeBy::Connection) {
        if !joined.contains(&origin.span) && joined.len() < 3 {
            diagnostic = diagnostic.label(origin.span, "this connection is among them");
            joined.push(origin.span);
        }
    }
    for (node, origin) in conflict.of(system, MadeBy::Unconnected) {
        let what = named(system, &[node]).first().map_or("flow", |&var| {
            noun(system.flat.variables[var].quantity.dimension)
        });
        let span = system
            .component(&origin)
            .map_or(origin.span, |(_, span)| span);
        let text = format!(
            "`{}` is not connected: its {what} is already 0",
            origin.instance
        );
        diagnostic = diagnostic.label(span, text);
    }
    let open: Vec<String> = conflict
        .open
        .iter()
        .take(4)
        .map(|&var| format!("`{}`", system.flat.variables[var].name))
        .collect();
    if !open.is_empty() {
        let more = if conflict.open.len() > 4 { ", …" } else { "" };
        diagnostic = diagnostic.note(format!("no equation determines {}{more}", open.join(", ")));
    }
    if let Some(name) = set_for_all_times(system, conflict) {
        return diagnostic.help(format!(
            "remove one of them; the declaration of `{name}` holds at every time: write `{name}(start = …)` where only its start is meant"
        ));
    }
    diagnostic.help(match (conflict.parts.is_empty(), open.is_empty()) {
        (true, true) => "remove one of them",
        (true, false) => "remove one of them, or rewrite it so that it determines the open unknown",
        (false, _) => {
            "remove one of them, or put a spring between the parts that both fix a motion"
        }
    })
}

/// A variable with a derivative in these equations, to which its declaration gives a value that reads no other one.
fn set_for_all_times(system: &System, conflict: &Conflict) -> Option<String> {
    let sides_of = |node| sides(system, node).into_iter();
    let moves = |var: VarId| {
        let sides = conflict.equations.iter().flat_map(|&node| sides_of(node));
        let mut below = sides.flat_map(|(_, lhs, rhs)| system.flat.exprs.below(&[lhs, rhs]));
        below.any(|id| matches!(system.flat.exprs[id], Expr::Der(of, _) if of == var))
    };
    let set = |&node: &Node| {
        let own = matching::origin(system, node).made_by == MadeBy::Binding;
        match named(system, &[node])[..] {
            [var] if own && moves(var) => Some(&system.flat.variables[var].name),
            _ => None,
        }
    };
    let name = conflict.equations.iter().find_map(set)?;
    Some(matching::short(name).to_owned())
}

/// The continuous variables in equations, in the order of the model.
fn named(system: &System, equations: &[Node]) -> Vec<VarId> {
    let mut found = std::collections::BTreeSet::new();
    for &node in equations {
        for (_, lhs, rhs) in sides(system, node) {
            for id in system.flat.exprs.below(&[lhs, rhs]) {
                if let Some((var, ..)) = system.flat.exprs[id].access()
                    && system.is_continuous(var)
                {
                    found.insert(var);
                }
            }
        }
    }
    found.into_iter().collect()
}

/// The variables of the kind of `var` that its connection joins, in the order of the model.
fn joined_to(system: &System, connection: &Origin, var: VarId) -> Vec<VarId> {
    let dimension = system.flat.variables[var].quantity.dimension;
    let same = system
        .equations
        .iter()
        .enumerate()
        .filter(|(_, equation)| equation.origin == *connection);
    let nodes: Vec<Node> = same.map(|(number, _)| Node::Equation(number)).collect();
    let mut found = named(system, &nodes);
    found.retain(|&other| system.flat.variables[other].quantity.dimension == dimension);
    // A body first: what has a state.
    found.sort_by_key(|&other| !has_state(system, other));
    found
}

/// Whether the component of a variable has a derivative.
fn has_state(system: &System, var: VarId) -> bool {
    let Some((part, _)) = system.component(&system.flat.variables[var].origin) else {
        return false;
    };
    system.equations.iter().any(|equation| {
        let own = system.component(&equation.origin);
        own.is_some_and(|(name, _)| name == part)
            && [equation.lhs, equation.rhs].iter().any(|&side| {
                let derivative = |expr| matches!(expr, Expr::Der(..));
                system.flat.exprs.any(side, derivative)
            })
    })
}

/// `wall.a` of `wall.a.phi`.
fn connector(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(before, _)| before)
}

/// A list of names as words.
pub(crate) fn and(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [only] => only.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// What a quantity is called.
pub(crate) fn noun(dimension: Dimension) -> &'static str {
    let known: [([i16; 7], i16, &str); 9] = [
        ([0, 0, 0, 0, 0, 0, 0], 1, "angle"),
        ([0, 1, 0, 0, 0, 0, 0], 0, "place"),
        ([0, 0, 0, -1, 0, 0, 0], 1, "speed"),
        ([0, 1, 0, -1, 0, 0, 0], 0, "speed"),
        ([1, 2, -1, -3, 0, 0, 0], 0, "voltage"),
        ([0, 0, 1, 0, 0, 0, 0], 0, "current"),
        ([0, 0, 0, 0, 1, 0, 0], 0, "temperature"),
        ([1, 1, 0, -2, 0, 0, 0], 0, "force"),
        ([1, 2, 0, -2, 0, 0, 0], 0, "torque"),
    ];
    let is = |base: [i16; 7], angle: i16| {
        hyde_units::Agreement::Same == dimension.agreement(Dimension::si(base, angle))
    };
    let found = known.iter().find(|(base, angle, _)| is(*base, *angle));
    found.map_or("value", |(.., name)| name)
}

/// Rigid parts of which each fixes another ratio.
pub(super) fn jammed(system: &System, conflict: &Conflict, var: VarId) -> Diagnostic {
    let variable = &system.flat.variables[var];
    let what = noun(variable.quantity.dimension);
    let body = system.component(&variable.origin);
    let of_body = |part: &&(String, Span)| body.as_ref() != Some(*part);
    let parts: Vec<&(String, Span)> = conflict.parts.iter().filter(of_body).collect();
    let names: Vec<String> = parts.iter().map(|(name, _)| format!("`{name}`")).collect();
    let place = body.as_ref().map_or_else(
        || format!("`{}`", variable.name),
        |(body, _)| format!("the {what} of `{body}`"),
    );
    let both = if names.len() == 2 { "both fix" } else { "fix" };
    let mut diagnostic = Diagnostic::error(
        Code::Jammed,
        format!(
            "{} {both} {place} in contradictory ways: nothing can move",
            and(&names)
        ),
    );
    for (number, (part, span)) in parts.iter().take(6).enumerate() {
        let text = match number {
            0 => "one rigid part".to_owned(),
            _ => format!("`{part}` is rigid too, with another ratio"),
        };
        diagnostic = diagnostic.label(*span, text);
    }
    for (_, origin) in conflict.of(system, MadeBy::Source) {
        let of_part = system
            .component(&origin)
            .is_some_and(|part| parts.contains(&&part));
        if of_part && diagnostic.labels.iter().all(|l| l.span != origin.span) {
            diagnostic = diagnostic.label(origin.span, "holds its ends in one ratio");
        }
    }
    diagnostic
        .note(format!("together they force `{}` to be 0", variable.name))
        .help("remove one, give it the ratio of the others, or put a spring between them")
}
