//! Connection sets: potentials equal, flows sum to zero.
//!
//! A connector counts once from inside its component's parent (inside, flow into the component) and once from its own
//! model (outside, flow out of it). `connect(a, b, c)` joins; of each set all potentials are equal, and the flows of the
//! inside ones minus those of the outside ones sum to zero. A connector in no set has zero flow (U4).

mod connection;

pub(crate) use connection::Connection;

use crate::equation::can_unroll;
use crate::instance::{Elementwise, InstanceId, Member, Position, Scope, Setting, Typed};
use crate::instantiate::InstanceTree;
use crate::model::Model;
use crate::model::lower::Resolved;
use crate::refusals::connect as refused;
use connection::Side;
use hyde_diag::{MadeBy, Origin, Span};
use hyde_ir::flat::{Equation, Flow};
use hyde_ir::{Expr as Ir, FlatModel, Index, Range, VarId, VariableKind};
use hyde_syntax::ast::{ClassKind, Reference};
use std::collections::hash_map::Entry;
use std::collections::{BTreeSet, HashMap};

/// Lowers `connect(a, b, …)`; whole arrays are connected element by element.
pub(crate) fn connection<'a>(
    model: &mut Model<'a, '_>,
    sides: &'a [Reference],
    scope: &Scope<'a>,
    span: Span,
) {
    let errors = model.diagnostics.error_count();
    let mut lengths = Vec::new();
    for side in sides {
        lengths.push((side, model.length_of(side, scope)));
    }
    if model.diagnostics.error_count() > errors {
        return;
    }
    let array = lengths.iter().find_map(|&(side, len)| Some((side, len?)));
    let Some((array, len)) = array else {
        connect_one(model, sides, scope, span);
        return;
    };
    if let Some((side, other)) = lengths.iter().find(|(_, other)| *other != Some(len)) {
        let array = (array.span, len);
        model.report(match *other {
            Some(other) => refused::lengths_differ((side, other), array),
            None => refused::array_with_one(side, array),
        });
        return;
    }
    if can_unroll(model.diagnostics, len, span) {
        for at in 0..len {
            let one = Elementwise::One(Position { at, of: len });
            connect_one(model, sides, &scope.elements(one), span);
        }
    }
}

/// Connectors are kept for the sets, signals are equated at once.
fn connect_one<'a>(
    model: &mut Model<'a, '_>,
    sides: &'a [Reference],
    scope: &Scope<'a>,
    span: Span,
) {
    let mut connectors = Vec::new();
    let mut signals: Vec<(VarId, Index, &'a Reference)> = Vec::new();
    for side in sides {
        match model.resolve(side, scope) {
            Some(Resolved::Instance(instance))
                if model.tree[instance].class.kind == ClassKind::Connector =>
            {
                let outside = model.tree[instance].parent == Some(scope.instance);
                let inside_part = model.tree[instance]
                    .parent
                    .and_then(|parent| model.tree[parent].parent);
                if !outside
                    && inside_part != Some(scope.instance)
                    && model.tree[scope.instance].outer.is_none()
                {
                    model.report(refused::too_deep(side));
                    return;
                }
                connectors.push((instance, !outside, side));
            }
            Some(Resolved::Variable(var, index)) => {
                let len = model.flat.variables[var].len;
                let Some(index) = model.whole(index, len, scope, side.span) else {
                    return;
                };
                signals.push((var, index, side));
            }
            Some(Resolved::Instance(instance)) => {
                let class = model.tree[instance].class.name.text.clone();
                let known: Vec<&str> = model.tree[instance]
                    .members
                    .iter()
                    .filter(|(_, member)| is_connector(&model.tree, member))
                    .map(|(name, _)| *name)
                    .collect();
                model.report(refused::component(side, &class, &known));
                return;
            }
            Some(_) => {
                model.report(refused::not_a_connector(side));
                return;
            }
            None => return,
        }
    }
    match (connectors.first().copied(), signals.first().copied()) {
        (Some((_, _, connector)), Some((_, _, signal))) => {
            model.report(refused::connector_and_signal(connector.span, signal.span))
        }
        (Some((first, ..)), None) => {
            let same = |instance: InstanceId| {
                std::ptr::eq(model.tree[instance].class, model.tree[first].class)
            };
            if let Some((other, _, side)) = connectors
                .iter()
                .copied()
                .find(|(instance, ..)| !same(*instance))
            {
                let (a, b) = (
                    &model.tree[first].class.name.text,
                    &model.tree[other].class.name.text,
                );
                let first = (connectors[0].2.span, a.as_str());
                model.report(refused::types_differ(first, (side.span, b)));
                return;
            }
            let twice = connectors.iter().enumerate().find(|(at, (instance, ..))| {
                connectors[..*at]
                    .iter()
                    .any(|(before, ..)| before == instance)
            });
            if let Some((_, (.., side))) = twice {
                model.report(refused::connected_to_itself(side));
                return;
            }
            let sides = connectors
                .iter()
                .map(|(instance, inside, _)| (*instance, *inside))
                .collect();
            let origin = model
                .tree
                .origin(scope.instance, span)
                .made_by(MadeBy::Connection);
            model.connections.push(Connection { sides, origin });
        }
        (None, Some((first, of_first, written))) => {
            let mut equations = Vec::new();
            for &(other, index, side) in &signals[1..] {
                let lhs = model.flat.exprs.add(Ir::Var(other, index));
                let rhs = model.flat.exprs.add(Ir::Var(first, of_first));
                let left = Typed {
                    truth: model.flat.variables[other].boolean,
                    ..model.typed(lhs, model.dim(other), side.span)
                };
                let right = Typed {
                    truth: model.flat.variables[first].boolean,
                    ..model.typed(rhs, model.dim(first), written.span)
                };
                model.same_kind(&left, &right);
                model.agree(&left, &right, "`connect` joins", scope.instance);
                let origin = model
                    .tree
                    .origin(scope.instance, span)
                    .made_by(MadeBy::Connection);
                equations.push(Equation {
                    range: Range::SCALAR,
                    lhs,
                    rhs,
                    origin,
                });
            }
            let clocked = matches!(model.flat.variables[first].kind, VariableKind::Clocked(_));
            match (clocked, model.clock_of(scope.instance)) {
                (true, Some(clock)) if scope.setting == Setting::Clocked => {
                    let list = equations
                        .into_iter()
                        .map(|equation| hyde_ir::flat::ClockedEquation { clock, equation });
                    model.flat.clocked_equations.extend(list);
                }
                _ => model.flat.equations.extend(equations),
            }
        }
        (None, None) => {}
    }
}

/// Turns all connections into equations.
pub(crate) fn connect(model: &mut Model<'_, '_>) {
    let sets = connection_sets(model);
    let mut connected_inside = vec![false; model.tree.len()];
    for (members, origin) in &sets {
        for &(instance, inside) in members {
            connected_inside[instance] |= inside;
        }
        set_equations(model, members, origin);
        flows(&model.tree, &mut model.flat, members);
    }
    for (id, connected) in connected_inside.into_iter().enumerate() {
        if model.tree[id].class.kind != ClassKind::Connector || connected {
            continue;
        }
        // A top-level connector, and one that no parent connects: nothing flows in.
        for var in variables_of(&model.tree, id) {
            if !model.flat.variables[var].flow {
                continue;
            }
            let lhs = model.flat.exprs.var(var);
            let rhs = model.flat.exprs.constant(0.0);
            let origin = model
                .tree
                .origin(id, model.tree[id].span)
                .made_by(MadeBy::Unconnected);
            model.flat.equations.push(Equation {
                range: Range::SCALAR,
                lhs,
                rhs,
                origin,
            });
        }
    }
}

/// The sets of joined connectors, in the order of the last `connect` that joined any.
fn connection_sets(model: &mut Model<'_, '_>) -> Vec<(Vec<Side>, Origin)> {
    let mut sets: Vec<Option<(Vec<Side>, Origin)>> = Vec::new();
    // The set that each side was put in, and the later set that each set went into.
    let mut set_of: HashMap<Side, usize> = HashMap::new();
    let mut into: Vec<usize> = Vec::new();
    for connection in std::mem::take(&mut model.connections) {
        let known = connection.sides.iter().filter_map(|side| set_of.get(side));
        let joined: BTreeSet<usize> = known.map(|&set| latest(&mut into, set)).collect();
        let number = sets.len();
        let mut merged: Vec<Side> = Vec::new();
        let mut origin = connection.origin;
        for set in joined {
            into[set] = number;
            if let Some((members, first)) = sets[set].take() {
                match merged.is_empty() {
                    true => merged = members,
                    false => merged.extend(members),
                }
                origin = first;
            }
        }
        for side in connection.sides {
            if let Entry::Vacant(vacant) = set_of.entry(side) {
                vacant.insert(number);
                merged.push(side);
            }
        }
        sets.push(Some((merged, origin)));
        into.push(number);
    }
    sets.into_iter().flatten().collect()
}

fn set_equations(model: &mut Model<'_, '_>, members: &[Side], origin: &Origin) {
    let Some(&(first, _)) = members.first() else {
        return;
    };
    for (position, var) in variables_of(&model.tree, first).into_iter().enumerate() {
        let of = |model: &Model<'_, '_>, instance: InstanceId| {
            variables_of(&model.tree, instance).get(position).copied()
        };
        if model.flat.variables[var].flow {
            let mut sum = model.flat.exprs.constant(0.0);
            for &(instance, inside) in members {
                let Some(flow) = of(model, instance) else {
                    continue;
                };
                let term = model.flat.exprs.var(flow);
                sum = if inside {
                    model.flat.exprs.plus(sum, term)
                } else {
                    model.flat.exprs.minus(sum, term)
                };
            }
            let rhs = model.flat.exprs.constant(0.0);
            model.flat.equations.push(Equation {
                range: Range::SCALAR,
                lhs: sum,
                rhs,
                origin: origin.clone(),
            });
            continue;
        }
        for &(instance, _) in &members[1..] {
            let Some(other) = of(model, instance) else {
                continue;
            };
            if other == var {
                continue;
            }
            let (lhs, rhs) = (model.flat.exprs.var(other), model.flat.exprs.var(var));
            model.flat.equations.push(Equation {
                range: Range::SCALAR,
                lhs,
                rhs,
                origin: origin.clone(),
            });
        }
    }
}

/// Notes what goes from one of the joined connectors to another. That of a component whose connector leads on to one
/// part of it is told where the component is connected.
fn flows(tree: &InstanceTree<'_>, flat: &mut FlatModel, members: &[Side]) {
    let told: Vec<(InstanceId, String)> = match *members {
        [_] => return,
        [(from, true), (to, true)] => {
            let (from, to) = (&tree[from].path, to);
            vec![(to, format!("{from} to {}", tree[to].path))]
        }
        [_, _] => return,
        _ => {
            let inside = members.iter().filter(|(_, inside)| *inside);
            let told = |&(id, _): &Side| (id, format!("into {}", tree[id].path));
            inside.map(told).collect()
        }
    };
    for (connector, name) in told {
        let variables = variables_of(tree, connector).into_iter();
        let flows: Vec<VarId> = variables
            .filter(|&var| {
                let variable = &flat.variables[var];
                variable.flow && variable.len.is_none()
            })
            .collect();
        for &var in &flows {
            let variable = &flat.variables[var].name;
            let last = variable.rsplit('.').next().unwrap_or(variable);
            let name = match flows.len() {
                1 => name.clone(),
                _ => format!("{name}.{last}"),
            };
            flat.experiment.flows.push(Flow { name, var });
        }
    }
}

/// The variables of a connector in the order of their names.
fn variables_of(tree: &InstanceTree<'_>, connector: InstanceId) -> Vec<VarId> {
    let members = tree[connector].members.values();
    members
        .filter_map(|member| match member {
            Member::Variable(var) => Some(*var),
            Member::Parameter(_)
            | Member::Instance(_)
            | Member::Instances(_)
            | Member::Domain(_) => None,
        })
        .collect()
}

fn is_connector(tree: &InstanceTree<'_>, member: &Member) -> bool {
    matches!(member, Member::Instance(id) if tree[*id].class.kind == ClassKind::Connector)
}

/// The set that a set went into at last; the way there becomes shorter for the next time.
fn latest(into: &mut [usize], set: usize) -> usize {
    let mut at = set;
    while into[at] != at {
        into[at] = into[into[at]];
        at = into[at];
    }
    at
}
