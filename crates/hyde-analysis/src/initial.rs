//! The initial system: which states start where, and which equations hold at the start (I1 to I3).
//!
//! One condition is needed for each state that no initial mode fixes. Fixed start values and initial equations come
//! first; what is missing is filled from the start values of states, what is too much is reported.

use crate::graph::{Bipartite, Matching};
use crate::system::{Cell, System};
use hyde_diag::{Code, Diagnostic, Diagnostics};
use hyde_ir::dae::{Dae, InitialCondition, Reason, Space};
use hyde_ir::{Expr, ExprId, Range, VarId};

/// Fills in the initial conditions of the DAE.
pub(crate) fn conditions(dae: &mut Dae, system: &mut System, diagnostics: &mut Diagnostics) {
    refuse_conflicts(dae, system, diagnostics);
    let pinned: Vec<usize> = dae
        .pins
        .iter()
        .filter(|pin| dae.automata[pin.automaton].initial == pin.mode)
        .map(|pin| pin.state)
        .collect();
    // The states that need a condition, in blocks: position, length, whether the start value is fixed.
    let mut fixed: Vec<(usize, usize)> = Vec::new();
    let mut free: Vec<usize> = Vec::new();
    for block in dae.unknowns.iter().filter(|block| block.differential) {
        let array = dae.variables[block.var].len.is_some();
        if array && block.len > 1 {
            if dae.variables[block.var].fixed {
                fixed.push((block.offset, block.len));
            } else {
                free.extend(block.offset..block.offset + block.len);
            }
            continue;
        }
        let given = system
            .starts
            .get(&(block.var, block.first))
            .is_some_and(|list| list.iter().any(|(_, fixed, _)| *fixed));
        let pinned = pinned.contains(&block.offset);
        if pinned && !given {
            continue;
        }
        if given || (array && dae.variables[block.var].fixed) {
            fixed.push((block.offset, 1));
        } else {
            free.push(block.offset);
        }
    }
    let equations: Vec<(Range, ExprId, hyde_diag::Origin)> = system
        .flat
        .initial_equations
        .iter()
        .map(|equation| {
            let value = dae.exprs.minus(equation.lhs, equation.rhs);
            (equation.range, value, equation.origin.clone())
        })
        .collect();
    let mut equations = equations;
    let needed: usize = equations.iter().map(|(range, ..)| range.len()).sum();
    let open = free.len() - taken(&take(dae, &[], &free));
    if needed > open {
        too_many(dae, &equations, &fixed, open, diagnostics);
        return;
    }
    // Start values given for this model come before those that parts declare for every use.
    let in_group = |position: usize| {
        let mut groups = dae.selections.iter();
        groups.any(|group| group.candidates.contains(&position))
    };
    let weak: Vec<usize> = fixed
        .iter()
        .filter(|&&(position, len)| {
            len == 1 && !in_group(position) && !given(dae, system, position)
        })
        .map(|&(position, _)| position)
        .collect();
    let with_weak: Vec<usize> = free.iter().chain(&weak).copied().collect();
    let mut checks: Vec<(VarId, ExprId, ExprId)> = Vec::new();
    for start in starts_of_algebraic(dae, system) {
        let given = dae.variables[start.given_by].start_given;
        let open: &[usize] = if given { &with_weak } else { &free };
        let before = taken(&take(dae, &equations, open));
        let equation = (Range::SCALAR, start.condition, start.origin.clone());
        equations.push(equation);
        if taken(&take(dae, &equations, open)) == before {
            equations.pop();
            if given {
                checks.push((start.given_by, start.value, start.start));
            }
        }
    }
    let overruled: Vec<usize> = take(dae, &equations, &with_weak)
        .of_right
        .iter()
        .zip(&with_weak)
        .filter(|(taken, position)| taken.is_some() && weak.contains(position))
        .map(|(_, position)| *position)
        .collect();
    fixed.retain(|(position, _)| !overruled.contains(position));
    free.extend(overruled);
    checks.extend(starts_in_groups(dae, system));
    let known = system.known_starts.iter().copied();
    checks.extend(known.filter(|(given_by, ..)| dae.variables[*given_by].start_given));
    let filled = fill(dae, &equations, &free);
    for (state, len) in fixed {
        dae.initial.push(InitialCondition::Fixed {
            state,
            len,
            reason: Reason::Declared,
        });
    }
    for (range, value, origin) in equations {
        dae.initial.push(InitialCondition::Equation {
            range,
            value,
            origin,
        });
    }
    for state in filled {
        dae.initial.push(InitialCondition::Fixed {
            state,
            len: 1,
            reason: Reason::Filled,
        });
    }
    for (var, value, start) in checks {
        dae.initial
            .push(InitialCondition::Check { var, value, start });
    }
}

/// Whether the fixed start of a state is given for this model.
fn given(dae: &Dae, system: &System, position: usize) -> bool {
    let inside = |b: &&hyde_ir::dae::Unknown| (b.offset..b.offset + b.len).contains(&position);
    let Some(block) = dae.unknowns.iter().find(inside) else {
        return true;
    };
    let starts = system.starts.get(&(block.var, block.first));
    starts.is_none_or(|list| {
        let mut fixed = list.iter().filter(|(_, fixed, _)| *fixed);
        fixed.any(|(.., given_by)| dae.variables[*given_by].start_given)
    })
}

/// Start values given for this model of variables that constraints tie: the run chooses which of them are conditions.
fn starts_in_groups(dae: &mut Dae, system: &System) -> Vec<(VarId, ExprId, ExprId)> {
    let mut found = Vec::new();
    let cells = system.groups.iter().flat_map(|group| &group.candidates);
    for (cell, _) in cells {
        for (start, fixed, given_by) in system.starts.get(cell).into_iter().flatten() {
            if *fixed && dae.variables[*given_by].start_given {
                let leaf = Expr::Var(cell.0, System::cell_index(*cell));
                let value = dae.exprs.add(leaf);
                found.push((*given_by, value, *start));
            }
        }
    }
    found
}

/// A fixed start value of a variable that is no state.
struct AlgebraicStart {
    given_by: VarId,
    value: ExprId,
    start: ExprId,
    condition: ExprId,
    origin: hyde_diag::Origin,
}

/// Fixed start values of variables that are no states: each is an equation, if it determines a state that is still free.
/// Those given for this model first.
fn starts_of_algebraic(dae: &mut Dae, system: &System) -> Vec<AlgebraicStart> {
    let mut found = Vec::new();
    for (&(var, element), starts) in &system.starts {
        let is_state = dae.unknowns.iter().any(|block| {
            block.differential
                && block.var == var
                && (block.first..block.first + block.len).contains(&element)
        });
        let Some(&(start, _, given_by)) = starts.iter().find(|(_, fixed, _)| *fixed) else {
            continue;
        };
        if is_state || dae.places[var].is_none() {
            continue;
        }
        let value = dae
            .exprs
            .add(Expr::Var(var, System::cell_index((var, element))));
        found.push(AlgebraicStart {
            given_by,
            value,
            start,
            condition: dae.exprs.minus(value, start),
            origin: dae.variables[var].origin.clone(),
        });
    }
    found.sort_by_key(|start| !dae.variables[start.given_by].start_given);
    found
}

/// The free states that no initial equation and no constraint takes: those keep their start values.
fn fill(dae: &Dae, equations: &[(Range, ExprId, hyde_diag::Origin)], free: &[usize]) -> Vec<usize> {
    let needed: usize = equations.iter().map(|(range, ..)| range.len()).sum();
    let constraints = taken(&take(dae, &[], free));
    let matching = take(dae, equations, free);
    let unplaced = needed - (taken(&matching) - constraints).min(needed);
    let mut left: Vec<usize> = (0..free.len())
        .filter(|&number| matching.of_right[number].is_none())
        .map(|number| free[number])
        .collect();
    // Equations that name no free state directly determine some through the others: take the last ones declared.
    left.truncate(left.len().saturating_sub(unplaced));
    left
}

/// How many free states are taken.
fn taken(matching: &Matching) -> usize {
    matching.of_right.iter().flatten().count()
}

/// Which free state each constraint between states takes, and each initial equation, of those it reads itself or through
/// definitions.
fn take(dae: &Dae, equations: &[(Range, ExprId, hyde_diag::Origin)], free: &[usize]) -> Matching {
    let mut edges = Vec::new();
    for selection in &dae.selections {
        let own: Vec<usize> = (0..free.len())
            .filter(|&number| selection.candidates.contains(&free[number]))
            .collect();
        edges.extend(std::iter::repeat_n(own, selection.constraints.len()));
    }
    for (range, value, _) in equations {
        let mut own = Vec::new();
        let mut pending = vec![*value];
        let mut read = Vec::new();
        while let Some(root) = pending.pop() {
            for id in dae.exprs.below(&[root]) {
                let (Expr::Var(var, index) | Expr::Der(var, index)) = dae.exprs[id] else {
                    continue;
                };
                if !read.contains(&var) {
                    read.push(var);
                    let of = dae.definitions.iter().filter(|d| d.var == var);
                    pending.extend(of.map(|definition| definition.value));
                }
                let Some(place) = dae.places[var].filter(|place| place.space == Space::Unknown)
                else {
                    continue;
                };
                let (first, last) = System::interval(index, *range);
                let cells = place.base + first..=place.base + last;
                own.extend((0..free.len()).filter(|&number| cells.contains(&free[number])));
            }
        }
        // What stands first in the list is taken first.
        own.sort_unstable();
        own.dedup();
        // An equation over a range takes as many states as it has values.
        edges.extend(std::iter::repeat_n(own, range.len()));
    }
    let graph = Bipartite {
        edges,
        n_right: free.len(),
    };
    graph.maximum_matching()
}

fn too_many(
    dae: &Dae,
    equations: &[(Range, ExprId, hyde_diag::Origin)],
    fixed: &[(usize, usize)],
    free: usize,
    diagnostics: &mut Diagnostics,
) {
    let mut diagnostic = Diagnostic::error(
        Code::TooManyConditions,
        format!(
            "{} for {free} states that are not fixed",
            crate::matching::plural(equations.len(), "initial equation")
        ),
    );
    for (_, _, origin) in equations {
        diagnostic = diagnostic.label(origin.span, "an initial equation");
    }
    let names: Vec<String> = fixed
        .iter()
        .take(8)
        .filter_map(|(offset, _)| dae.unknowns.iter().find(|block| block.offset == *offset))
        .map(|block| format!("`{}`", dae.variables[block.var].element_name(block.first)))
        .collect();
    if !names.is_empty() {
        diagnostic = diagnostic.note(format!("fixed by their declaration: {}", names.join(", ")));
    }
    diagnostics.push(
        diagnostic
            .help("take `fixed = true` from the states that an initial equation is to determine"),
    );
}

/// Joined states with different fixed start values (I1).
fn refuse_conflicts(dae: &Dae, system: &mut System, diagnostics: &mut Diagnostics) {
    // Values are compared with declared parameters; the expressions live in the DAE now.
    system.flat.exprs = dae.exprs.clone();
    let declared = system.declared_values();
    let starts: Vec<(Cell, Vec<(ExprId, VarId)>)> = system
        .starts
        .iter()
        .map(|(cell, list)| {
            let fixed = list
                .iter()
                .filter(|(_, fixed, _)| *fixed)
                .map(|(value, _, var)| (*value, *var));
            (*cell, fixed.collect())
        })
        .collect();
    for (cell, fixed) in starts {
        let Some(&(first, given_first)) = fixed.first() else {
            continue;
        };
        let value = system.value_with(&declared, first);
        for &(other, given_by) in &fixed[1..] {
            let second = system.value_with(&declared, other);
            let equal = other == first
                || matches!((value, second), (Some(a), Some(b)) if (a - b).abs() <= 1e-12 * a.abs().max(b.abs()));
            if equal {
                continue;
            }
            let (a, b) = (&dae.variables[given_first], &dae.variables[given_by]);
            let show = |value: Option<f64>| {
                value.map_or("another value".to_owned(), |value| value.to_string())
            };
            let place = |variable: &hyde_ir::Variable| {
                let component = system.component(&variable.origin);
                component.map_or(variable.origin.span, |(_, span)| span)
            };
            diagnostics.push(
                Diagnostic::error(
                    Code::ConflictingStarts,
                    format!(
                        "`{}` and `{}` are joined and start at different values",
                        a.name, b.name
                    ),
                )
                .label(place(a), format!("`{}` starts at {}", a.name, show(value)))
                .label(place(b), format!("`{}` starts at {}", b.name, show(second)))
                .note(format!(
                    "both are `{}`",
                    dae.variables[cell.0].element_name(cell.1)
                ))
                .help("give both the same start value, or take `fixed` from one"),
            );
        }
    }
}
