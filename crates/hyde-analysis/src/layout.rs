//! Gives every variable its place and every unknown its row.
//!
//! The solver's vector holds scalars in the order declared, then arrays, each in one piece. The memory holds the truths
//! of relations, the modes of automata, then discrete, clocked and held variables.

use crate::explicit::{Order, access};
use crate::held_speed::holds_speed;
use crate::matching::{Matched, Node, origin};
use crate::reduce;
use crate::segments::Segment;
use crate::solve::solve_for;
use crate::system::{Cell, System};
use hyde_ir::dae::{
    Alias, Automaton, Dae, Definition, Place, Residual, Selection, Space, Start, Unknown,
};
use hyde_ir::{Expr, ExprId, Id as _, IdVec, Index, Range, StateChoice, VarId, VariableKind};
use std::collections::BTreeSet;

/// Builds the DAE with its places, definitions and residuals; pins exchange rows later.
pub(crate) fn place(system: &mut System, matched: &Matched, order: &Order) -> Dae {
    let mut dae = Dae {
        name: system.flat.name.clone(),
        ..Dae::default()
    };
    dae.exprs = std::mem::take(&mut system.flat.exprs);
    dae.variables = system.flat.variables.clone();
    dae.parameters = system.flat.parameters.clone();
    dae.parameter_order = system.flat.parameter_order.clone();
    dae.columns = system.flat.columns.clone();
    dae.delays = system.flat.delays.clone();
    dae.foreign = system.flat.foreign.clone();
    dae.experiment = system.flat.experiment.clone();
    dae.relations = system.relations.clone();
    dae.notes = system.notes.clone();
    dae.aliases = system
        .aliases
        .iter()
        .filter(|((var, _), _)| dae.variables[*var].len.is_none())
        .map(|((var, _), alias)| (*var, *alias))
        .collect();
    let mut next = 0;
    dae.parameter_places = dae
        .parameters
        .iter()
        .map(|parameter| {
            let place = next;
            next += parameter.size();
            place
        })
        .collect();
    dae.n_parameters = (next, next);
    dae.places = variable_places(system, matched, order, &mut dae);
    memory(system, &mut dae);
    for (number, &unknown) in matched.unknowns.iter().enumerate() {
        let (true, Some(place)) = (order.in_vector[number], dae.places[unknown.var]) else {
            continue;
        };
        dae.unknowns.push(Unknown {
            var: unknown.var,
            first: unknown.first,
            len: unknown.len(),
            offset: place.base + unknown.first,
            differential: unknown.state,
        });
    }
    std::mem::swap(&mut dae.exprs, &mut system.flat.exprs);
    for (number, unknown) in (0..matched.unknowns.len())
        .filter(|&n| order.in_vector[n])
        .zip(dae.unknowns.ids())
    {
        let own = matched.unknowns[number];
        let base = dae.places[own.var].map_or(0, |place| place.base);
        // A constraint takes the row of a variable that it need not read, which may be an element of an array.
        let element = Index::fixed(i32::try_from(own.first).unwrap_or(0));
        let (range, index) = access(system, matched, number).unwrap_or((Range::SCALAR, element));
        let row = Index {
            offset: index.offset + i32::try_from(base).unwrap_or(0),
            ..index
        };
        let node = matched.equation_of[number];
        let value = residual(system, node);
        let origins = match node {
            Node::Equation(_) => vec![origin(system, node)],
            Node::Slot(slot) => system.slots[slot]
                .branches
                .iter()
                .map(|branch| branch.origin.clone())
                .collect(),
        };
        dae.residuals.push(Residual {
            unknown,
            range,
            row,
            value,
            origins,
        });
    }
    for explicit in &order.definitions {
        let unknown = matched.unknowns[explicit.unknown];
        dae.definitions.push(Definition {
            var: unknown.var,
            range: explicit.range,
            index: explicit.index,
            value: explicit.value,
            slope: false,
            origin: origin(system, matched.equation_of[explicit.unknown]),
        });
    }
    selections(system, matched, &mut dae);
    dae.dependent = std::mem::take(&mut system.dependent);
    std::mem::swap(&mut dae.exprs, &mut system.flat.exprs);
    starts(system, &mut dae);
    dae
}

/// What an eliminated scalar stands for; they are in the order of variables.
pub(crate) fn alias(dae: &Dae, var: VarId) -> Option<Alias> {
    let found = dae.aliases.binary_search_by_key(&var, |(known, _)| *known);
    found.ok().map(|number| dae.aliases[number].1)
}

/// Where the variables, constraints and factors of each group lie.
fn selections(system: &System, matched: &Matched, dae: &mut Dae) {
    for (number, group) in system.groups.iter().enumerate() {
        let Some(factors) = group.factors.and_then(|factors| dae.places[factors]) else {
            continue;
        };
        let position = |cell: Cell| Some(dae.places[cell.0]?.base + cell.1);
        let constraints = matched.unknowns.iter().zip(&matched.equation_of);
        let constraints = constraints
            .filter(|(_, node)| matches!(node, Node::Equation(equation) if reduce::group_of(system, *equation) == Some(number)))
            .filter_map(|(unknown, _)| position((unknown.var, unknown.first)))
            .collect();
        let candidates = group.candidates.iter();
        let weights = group
            .candidates
            .iter()
            .map(|(cell, _)| weight(system.flat.variables[cell.0].state));
        let weights = weights.collect();
        dae.selections.push(Selection {
            weights,
            candidates: candidates.filter_map(|(cell, _)| position(*cell)).collect(),
            constraints,
            factors: factors.base,
        });
    }
}

/// How a choice counts among the columns of constraints: a preference is given up where the rest is a hundred times nearer
/// to singular.
fn weight(choice: StateChoice) -> f64 {
    match choice {
        StateChoice::Always => 0.0,
        StateChoice::Prefer => 1e-2,
        StateChoice::Open => 1.0,
        StateChoice::Avoid => 1e2,
        StateChoice::Never => 1e12,
    }
}

/// `lhs - rhs`; of a slot by mode, with zero where a mode fixes a state (its row is exchanged later).
fn residual(system: &mut System, node: Node) -> ExprId {
    match node {
        Node::Equation(number) => {
            let (lhs, rhs) = (system.equations[number].lhs, system.equations[number].rhs);
            system.flat.exprs.minus(lhs, rhs)
        }
        Node::Slot(number) => {
            let branches = system.slots[number].branches.clone();
            let automaton = system.slots[number].automaton;
            let arena = &mut system.flat.exprs;
            let mut value: Option<ExprId> = None;
            for (mode, branch) in branches.iter().enumerate().rev() {
                let own = if branch.pin.is_some() {
                    arena.constant(0.0)
                } else {
                    arena.minus(branch.lhs, branch.rhs)
                };
                value = Some(match value {
                    None => own,
                    Some(others) => {
                        let in_mode = arena.add(Expr::InMode(
                            automaton,
                            u32::try_from(mode).unwrap_or(u32::MAX),
                        ));
                        arena.if_else(in_mode, own, others)
                    }
                });
            }
            value.unwrap_or_else(|| arena.constant(0.0))
        }
    }
}

fn variable_places(
    system: &System,
    matched: &Matched,
    order: &Order,
    dae: &mut Dae,
) -> IdVec<VarId, Option<Place>> {
    let mut places: IdVec<VarId, Option<Place>> = dae.variables.iter().map(|_| None).collect();
    let unknowns = matched.unknowns.iter().zip(&order.in_vector);
    let (kept, given): (Vec<_>, Vec<_>) = unknowns.partition(|(_, kept)| **kept);
    let variables = |list: Vec<(&Segment, &bool)>| -> BTreeSet<VarId> {
        list.into_iter().map(|(unknown, _)| unknown.var).collect()
    };
    let (kept, given) = (variables(kept), variables(given));
    let mut unknowns = Vec::new();
    for (id, variable) in system.flat.variables.enumerate() {
        if variable.kind == VariableKind::Continuous && kept.contains(&id) {
            unknowns.push((variable.len.is_some(), id));
        } else if variable.kind == VariableKind::Continuous && given.contains(&id) {
            places[id] = Some(Place {
                space: Space::Work,
                base: dae.n_work,
            });
            dae.n_work += variable.size();
        }
    }
    unknowns.sort_unstable();
    for (_, id) in unknowns {
        places[id] = Some(Place {
            space: Space::Unknown,
            base: dae.n_unknowns,
        });
        dae.n_unknowns += system.flat.variables[id].size();
    }
    places
}

fn memory(system: &System, dae: &mut Dae) {
    dae.n_memory = dae.relations.len();
    for automaton in system.flat.automata.iter() {
        dae.automata.push(Automaton {
            name: automaton.name.clone(),
            modes: automaton
                .modes
                .iter()
                .map(|mode| mode.name.clone())
                .collect(),
            holds_speed: automaton
                .modes
                .iter()
                .map(|mode| holds_speed(&dae.exprs, &dae.variables, mode))
                .collect(),
            initial: automaton.initial,
            place: dae.n_memory,
            origin: automaton.origin.clone(),
        });
        dae.n_memory += 1;
    }
    for (id, variable) in system.flat.variables.enumerate() {
        let remembered = matches!(
            variable.kind,
            VariableKind::Discrete | VariableKind::Clocked(_) | VariableKind::Held(..)
        );
        if remembered {
            dae.places[id] = Some(Place {
                space: Space::Memory,
                base: dae.n_memory,
            });
            dae.n_memory += variable.size();
        }
    }
}

/// Start values of the vector and the memory.
fn starts(system: &System, dae: &mut Dae) {
    for id in dae.variables.ids().collect::<Vec<_>>() {
        let Some(place) = dae.places[id] else {
            continue;
        };
        if place.space == Space::Work {
            continue;
        }
        let variable = &dae.variables[id];
        let list: Vec<ExprId> = match variable.len {
            Some(_) => variable.start.clone(),
            None => match (system.starts.get(&(id, 0)), variable.kind) {
                (Some(given), _) => vec![best_start(given)],
                // What is held starts as its source does.
                (None, VariableKind::Held(_, source)) => dae.variables[source].start.clone(),
                (None, _) => variable.start.clone(),
            },
        };
        let size = variable.size();
        let last = i32::try_from(size).unwrap_or(i32::MAX) - 1;
        match list.as_slice() {
            [] => {}
            // One value serves all elements.
            [value] if size > 1 => dae.starts.push(Start {
                place,
                range: Range { first: 0, last },
                index: Index::COUNTER,
                value: *value,
            }),
            values => dae.starts.extend(
                (0..size)
                    .zip(values)
                    .map(|(element, &value)| start(place, element, value)),
            ),
        }
        // An element of an array that is joined to a component starts as the component does.
        if dae.variables[id].len.is_some() {
            for (&(_, element), given) in system.starts.range((id, 0)..(id, size)) {
                dae.starts.push(start(place, element, best_start(given)));
            }
        }
    }
    guesses_of_definitions(system, dae);
    for automaton in dae.automata.iter() {
        let place = Place {
            space: Space::Memory,
            base: automaton.place,
        };
        let value = dae.exprs.constant(automaton.initial as f64);
        dae.starts.push(start(place, 0, value));
    }
    let entries = system.flat.automata.iter();
    for action in entries.flat_map(|automaton| &automaton.initial_actions) {
        if let hyde_ir::flat::Action::Assign(var, index, value) = action
            && let Some(place) = dae.places[*var]
        {
            dae.starts.push(Start {
                place,
                range: Range::SCALAR,
                index: *index,
                value: *value,
            });
        }
    }
}

/// The guess of a variable that is computed from one unknown without a guess is that unknown's: `big = 100*u`.
fn guesses_of_definitions(system: &System, dae: &mut Dae) {
    for number in 0..dae.definitions.len() {
        let Definition {
            var, range, value, ..
        } = dae.definitions[number];
        let Some(given) = system.starts.get(&(var, 0)) else {
            continue;
        };
        if range != Range::SCALAR || dae.variables[var].len.is_some() {
            continue;
        }
        let read = dae.exprs.below(&[value]).into_iter();
        let mut leaves = read.filter_map(|id| Some((dae.exprs[id], dae.exprs[id].access()?)));
        let (Some((leaf, (unknown, _, derivative))), None) = (leaves.next(), leaves.next()) else {
            continue;
        };
        let place = dae.places[unknown].filter(|place| place.space == Space::Unknown);
        let (Some(place), None) = (place, dae.variables[unknown].len) else {
            continue;
        };
        let mut blocks = dae.unknowns.iter();
        let is_state = blocks.any(|block| block.var == unknown && block.differential);
        if derivative || is_state || system.starts.contains_key(&(unknown, 0)) {
            continue;
        }
        let solved = solve_for(&mut dae.exprs, best_start(given), value, leaf);
        if let Some(value) = solved.filter(|&value| dae.exprs.is_parametric(value)) {
            dae.starts.push(start(place, 0, value));
        }
    }
}

/// The start value of one element.
fn start(place: Place, element: usize, value: ExprId) -> Start {
    Start {
        place,
        range: Range::SCALAR,
        index: Index::fixed(i32::try_from(element).unwrap_or(0)),
        value,
    }
}

/// Of the start values given to joined variables a fixed one before a guess.
fn best_start(given: &[(ExprId, bool, VarId)]) -> ExprId {
    given
        .iter()
        .find(|(_, fixed, _)| *fixed)
        .or_else(|| given.first())
        .map_or_else(|| ExprId::from_index(0), |(value, ..)| *value)
}
