//! Which entries of the Jacobian sliding takes beside the equations' own.
//!
//! While the run slides on a surface g = 0, one of the rows that switch there becomes g = 0, and the others lose their
//! share of it: rows are added to each other. So all rows that read one switch keep entries for the columns of all of
//! them and of g, in every mode: the pattern does not change when the run begins to slide.

use hyde_ir::dae::{Dae, Function, ReactionKind, RelationUse, Wrt};
use hyde_ir::{Expr, ExprId, Id as _, RelationId, VarId};
use std::collections::{BTreeMap, BTreeSet};

/// More rows than this are not added to each other: such a switch does not slide.
const MAX_ROWS: usize = 24;

/// What takes another value across a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Switch {
    /// The truth of a relation in the equations.
    Relation(RelationId),
    /// The mode of an automaton.
    Mode(usize),
}

/// Rows that are added to each other, and the columns of their surfaces.
#[derive(Clone, Debug, Default)]
struct Cluster {
    rows: BTreeSet<usize>,
    columns: BTreeSet<usize>,
}

/// The entries, row and column, that sliding may take, in the solver's vector.
#[must_use]
pub fn sliding_cells(dae: &Dae) -> Vec<(usize, usize)> {
    let surfaces = surfaces(dae);
    if surfaces.is_empty() {
        return Vec::new();
    }
    let mut clusters: Vec<Cluster> = Vec::new();
    for (switch, rows) in rows_that_read(dae, &surfaces) {
        let Some(columns) = surfaces.get(&switch) else {
            continue;
        };
        let mut cluster = Cluster {
            rows,
            columns: columns.clone(),
        };
        // Switches that share a row are solved for together.
        let (shared, apart): (Vec<_>, Vec<_>) = clusters
            .into_iter()
            .partition(|other| !other.rows.is_disjoint(&cluster.rows));
        for other in shared {
            cluster.rows.extend(other.rows);
            cluster.columns.extend(other.columns);
        }
        clusters = apart;
        clusters.push(cluster);
    }
    let of_row = columns_of_rows(dae);
    let mut cells = Vec::new();
    for cluster in clusters.iter().filter(|c| c.rows.len() <= MAX_ROWS) {
        let mut columns = cluster.columns.clone();
        let known = cluster.rows.iter().filter_map(|row| of_row.get(row));
        known.for_each(|more| columns.extend(more));
        for &row in &cluster.rows {
            cells.extend(columns.iter().map(|&column| (row, column)));
        }
    }
    cells
}

/// The switches that may slide, each with the states that its surface depends on: relations of equations, and automata
/// with two modes that lead to each other and fix nothing.
fn surfaces(dae: &Dae) -> BTreeMap<Switch, BTreeSet<usize>> {
    let mut found: BTreeMap<Switch, BTreeSet<usize>> = BTreeMap::new();
    for (id, relation) in dae.relations.enumerate() {
        let switch = match relation.used {
            RelationUse::Equation => Switch::Relation(id),
            RelationUse::Exit(automaton, _) if leads_back(dae, automaton) => {
                Switch::Mode(automaton)
            }
            RelationUse::Exit(..) | RelationUse::When | RelationUse::Assert => continue,
        };
        if relation.time_event.is_some() {
            continue;
        }
        if let Some(columns) = states_of(dae, id) {
            found.entry(switch).or_default().extend(columns);
        }
    }
    found
}

/// Whether an automaton has two modes with exits to each other that fix no state and set nothing.
fn leads_back(dae: &Dae, automaton: usize) -> bool {
    let plain = |mode: usize| {
        let mut pins = dae.pins.iter();
        !pins.any(|pin| pin.automaton.index() == automaton && pin.mode == mode)
    };
    let exits: Vec<(usize, usize)> = dae
        .reactions
        .iter()
        .filter_map(|reaction| match reaction.kind {
            ReactionKind::Transition {
                automaton: of,
                from,
                to,
                ..
            } if of == automaton && reaction.assignments.is_empty() => Some((from, to)),
            ReactionKind::Transition { .. }
            | ReactionKind::When { .. }
            | ReactionKind::Edge(_)
            | ReactionKind::Assert(_) => None,
        })
        .collect();
    exits
        .iter()
        .any(|&(a, b)| a != b && plain(a) && plain(b) && exits.contains(&(b, a)))
}

/// The states that a root function depends on; `None` if it depends on anything else that moves, or on nothing.
fn states_of(dae: &Dae, relation: RelationId) -> Option<BTreeSet<usize>> {
    let row = i32::try_from(relation.index()).ok()?;
    let mut states = BTreeSet::new();
    for partial in dae.partials(Function::Roots) {
        if partial.row.offset != row {
            continue;
        }
        match partial.wrt {
            Wrt::Unknown(index) => {
                let column = usize::try_from(index.offset).ok()?;
                let mut blocks = dae.unknowns.iter();
                let state = blocks.any(|block| {
                    block.differential && (block.offset..block.offset + block.len).contains(&column)
                });
                states.insert(state.then_some(column)?);
            }
            Wrt::Derivative(_) => return None,
            Wrt::Delayed(_) | Wrt::Time | Wrt::Parameter(_) | Wrt::Memory(_) => {}
        }
    }
    (!states.is_empty()).then_some(states)
}

/// The rows of the residual that read each switch, through explicit variables too. A switch that an array equation reads
/// is left out.
fn rows_that_read(
    dae: &Dae,
    surfaces: &BTreeMap<Switch, BTreeSet<usize>>,
) -> BTreeMap<Switch, BTreeSet<usize>> {
    let mut defined: BTreeMap<VarId, BTreeSet<Switch>> = BTreeMap::new();
    let reads = |value: ExprId, defined: &BTreeMap<VarId, BTreeSet<Switch>>| {
        let mut found = BTreeSet::new();
        for id in dae.exprs.below(&[value]) {
            let expr = dae.exprs[id];
            if let Expr::Relation(relation) = expr {
                found.insert(Switch::Relation(relation));
            } else if let Expr::InMode(automaton, _) = expr {
                found.insert(Switch::Mode(automaton.index()));
            } else if let Expr::Var(var, _) = expr {
                found.extend(defined.get(&var).into_iter().flatten());
            }
        }
        found.retain(|switch| surfaces.contains_key(switch));
        found
    };
    for definition in &dae.definitions {
        let found = reads(definition.value, &defined);
        if !found.is_empty() {
            defined.entry(definition.var).or_default().extend(found);
        }
    }
    let mut rows: BTreeMap<Switch, BTreeSet<usize>> = BTreeMap::new();
    let mut in_arrays = BTreeSet::new();
    for residual in &dae.residuals {
        let found = reads(residual.value, &defined);
        if residual.range.len() > 1 {
            in_arrays.extend(found);
            continue;
        }
        let Ok(row) = usize::try_from(residual.row.at(residual.range.first)) else {
            continue;
        };
        for switch in found {
            rows.entry(switch).or_default().insert(row);
        }
    }
    rows.retain(|switch, _| !in_arrays.contains(switch));
    rows
}

/// The columns of the Jacobian in the rows of scalar equations.
fn columns_of_rows(dae: &Dae) -> BTreeMap<usize, BTreeSet<usize>> {
    let mut found: BTreeMap<usize, BTreeSet<usize>> = BTreeMap::new();
    for partial in dae.partials(Function::Residual) {
        let (Wrt::Unknown(index) | Wrt::Derivative(index)) = partial.wrt else {
            continue;
        };
        if partial.range.len() > 1 {
            continue;
        }
        let counter = partial.range.first;
        let at = |index: hyde_ir::Index| usize::try_from(index.at(counter));
        if let (Ok(row), Ok(column)) = (at(partial.row), at(index)) {
            found.entry(row).or_default().insert(column);
        }
    }
    found
}
