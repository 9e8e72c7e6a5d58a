//! What a conflict of equations means for a drive: held twice, floating, connected to nothing, a parameter as unknown.

use crate::matching::{self, Node, sides};
use crate::refusals::conflicts as refused;
use crate::refusals::words::short;
use crate::system::System;
use hyde_diag::{Diagnostic, MadeBy, Origin, Span};
use hyde_ir::flat::Action;
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
            return Some(refused::determines_parameter(
                &parameter.name,
                origin.span,
                parameter.origin.span,
            ));
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
        .map(|(_, origin)| origin.instance.as_str().to_owned())
        .collect();
    let open = conflict.open.iter().copied();
    let open = open
        .map(|var| &system.flat.variables[var])
        .find(|variable| !variable.flow);
    let open = open.map(|variable| variable.name.as_str());
    Some(refused::loose((part, *span), &list, open))
}

/// A variable that has an equation though a `when` sets it: what such an equation determines is another unknown.
pub(super) fn assigned(system: &System, conflict: &Conflict) -> Option<Diagnostic> {
    let setting = |var: VarId| {
        let sets = |action: &Action| matches!(action, Action::Assign(of, ..) if *of == var);
        let mut whens = system.flat.whens.iter();
        whens.find(|when| when.branches.iter().any(|(_, all)| all.iter().any(sets)))
    };
    let given = conflict.equations.iter().find_map(|&node| {
        let mut sides = sides(system, node).into_iter();
        sides.find_map(|(_, lhs, _)| {
            let Expr::Var(var, _) = system.flat.exprs[lhs] else {
                return None;
            };
            Some((node, var, setting(var)?))
        })
    });
    let (node, var, when) = given?;
    let name = short(&system.flat.variables[var].name);
    let equation = matching::origin(system, node).span;
    Some(refused::equation_of_assigned(
        name,
        equation,
        when.origin.span,
    ))
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
    Some(refused::floating(what, &parts))
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
    // The body that is held: what else is in the connection.
    let others = joined_to(system, connection, var).into_iter();
    let body = others
        .filter_map(|var| system.component(&system.flat.variables[var].origin))
        .find(|part| !parts.contains(part));
    let place = match &body {
        Some((body, _)) => format!("the {what} of `{body}`"),
        None => format!("the {what} at `{}`", connector(&variable.name)),
    };
    // Each place is shown once, and no more than can be read.
    let mut places: Vec<Span> = parts.iter().take(6).map(|(_, span)| *span).collect();
    places.push(connection.span);
    let mut equations: Vec<Origin> = Vec::new();
    for &node in &conflict.equations {
        let origin = matching::origin(system, node);
        let says = says_something(&origin) && origin.made_by == MadeBy::Source;
        if says && !places.contains(&origin.span) && places.len() < 8 {
            places.push(origin.span);
            equations.push(origin);
        }
    }
    let open = conflict.open.iter().copied();
    let open = open
        .map(|var| &system.flat.variables[var])
        .find(|variable| variable.flow);
    let open = open.map(|open| (noun(open.quantity.dimension), connector(&open.name)));
    let joined = connection.span;
    Some(refused::held_twice(
        (what, &place),
        parts,
        joined,
        &equations,
        open,
    ))
}

/// Equations that depend on each other, as they are.
pub(super) fn generic(system: &System, conflict: &Conflict) -> Diagnostic {
    let unknowns = named(system, &conflict.equations);
    let names: Vec<String> = unknowns
        .iter()
        .filter(|&&var| !system.flat.variables[var].flow || unknowns.len() < 4)
        .take(6)
        .map(|&var| system.flat.variables[var].name.clone())
        .collect();
    let mut joined: Vec<Span> = Vec::new();
    for (_, origin) in conflict.of(system, MadeBy::Connection) {
        if !joined.contains(&origin.span) && joined.len() < 3 {
            joined.push(origin.span);
        }
    }
    let unconnected = conflict.of(system, MadeBy::Unconnected).into_iter();
    let ends = unconnected.map(|(node, origin)| {
        let what = named(system, &[node]).first().map_or("flow", |&var| {
            noun(system.flat.variables[var].quantity.dimension)
        });
        let span = system
            .component(&origin)
            .map_or(origin.span, |(_, span)| span);
        (origin.instance.as_str().to_owned(), what, span)
    });
    let ends: Vec<_> = ends.collect();
    let open = conflict.open.iter();
    let open: Vec<String> = open
        .map(|&var| system.flat.variables[var].name.clone())
        .collect();
    refused::conflicting(
        (conflict.equations.len(), unknowns.len(), &names),
        &conflict.own(system),
        &conflict.parts,
        &joined,
        &ends,
        &open,
        set_for_all_times(system, conflict).as_deref(),
    )
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
    Some(short(name).to_owned())
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
    let parts: Vec<(String, Span)> = conflict.parts.iter().filter(of_body).cloned().collect();
    let place = body.as_ref().map_or_else(
        || format!("`{}`", variable.name),
        |(body, _)| format!("the {what} of `{body}`"),
    );
    let mut places: Vec<Span> = parts.iter().take(6).map(|(_, span)| *span).collect();
    let mut equations: Vec<Span> = Vec::new();
    for (_, origin) in conflict.of(system, MadeBy::Source) {
        let of_part = system
            .component(&origin)
            .is_some_and(|part| parts.contains(&part));
        if of_part && !places.contains(&origin.span) {
            places.push(origin.span);
            equations.push(origin.span);
        }
    }
    refused::jammed(&place, &variable.name, &parts, &equations)
}
