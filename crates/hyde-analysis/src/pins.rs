//! Modes that fix a state: `w = 0` in a mode, where w is a state (M3).
//!
//! ```text
//! row of w:      M*der(w) = tau               in the mode:  der(w) = 0
//! row of tau:    tau = s*grip + b*w           in the mode:  M*der(w) = tau
//! ```
//! The state's row becomes der(w) = 0 and its former equation moves to the row of the unknown that the block determines
//! otherwise: the force that holds the state. The diagonal stays structurally sound in every mode, and w stays what it
//! is to the last bit.

mod inlined;
mod mark;

use crate::explicit::Order;
use crate::matching::{Matched, Node};
use crate::refusals::{place_of, states as refused};
use crate::system::{Cell, System};
use hyde_diag::{Diagnostic, Diagnostics, MadeBy};
use hyde_ir::dae::{Dae, Pin};
use hyde_ir::{AutomatonId, Expr, ExprId, VarId};
pub(crate) use inlined::Values;
pub(crate) use mark::mark;
use rustc_hash::FxHashMap;
use std::collections::BTreeSet;

/// Exchanges the rows of pinned states with those of the forces that hold them.
pub(crate) fn exchange_rows(
    dae: &mut Dae,
    system: &mut System,
    matched: &Matched,
    order: &Order,
    diagnostics: &mut Diagnostics,
) {
    refuse_two_pins(dae, system, diagnostics);
    let rows = Rows::new(dae, order);
    for (number, node) in matched.equation_of.iter().enumerate() {
        let Node::Slot(slot) = *node else { continue };
        let branches = system.slots[slot].branches.clone();
        if branches.iter().all(|branch| branch.pin.is_none()) {
            continue;
        }
        let automaton = system.slots[slot].automaton;
        let slot_row = rows.of_unknown[number];
        for (mode, branch) in branches.iter().enumerate() {
            let Some((cell, value)) = branch.pin else {
                continue;
            };
            let Some(state_row) = rows.of_state.get(&cell).copied() else {
                continue;
            };
            let arena = &mut dae.exprs;
            let in_mode = arena.add(Expr::InMode(
                automaton,
                u32::try_from(mode).unwrap_or(u32::MAX),
            ));
            let rate = arena.add(Expr::Der(cell.0, System::cell_index(cell)));
            let former = dae.residuals[state_row].value;
            dae.residuals[state_row].value = arena.if_else(in_mode, rate, former);
            let pin_origin = branch.origin.made_by(MadeBy::Pin);
            if state_row != slot_row {
                if !rows.depends(dae, former, slot_row) {
                    diagnostics.push(no_force(dae, system, automaton, mode, cell, slot_row));
                    continue;
                }
                let own = dae.residuals[slot_row].value;
                dae.residuals[slot_row].value = dae.exprs.if_else(in_mode, former, own);
                let moved = dae.residuals[state_row].origins.clone();
                dae.residuals[slot_row].origins.extend(moved);
            }
            dae.residuals[state_row].origins.push(pin_origin.clone());
            let state = dae.unknowns[dae.residuals[state_row].unknown].offset
                + (cell.1 - dae.unknowns[dae.residuals[state_row].unknown].first);
            dae.pins.push(Pin {
                automaton,
                mode,
                state,
                value,
                origin: pin_origin,
            });
        }
    }
}

fn refuse_two_pins(dae: &Dae, system: &System, diagnostics: &mut Diagnostics) {
    let mut seen: FxHashMap<Cell, (AutomatonId, hyde_diag::Origin)> = FxHashMap::default();
    for slot in &system.slots {
        for branch in &slot.branches {
            let Some((cell, _)) = branch.pin else {
                continue;
            };
            match seen.get(&cell) {
                Some((automaton, _)) if *automaton == slot.automaton => {}
                Some((automaton, origin)) => {
                    let (a, b) = (
                        &system.flat.automata[*automaton].name,
                        &system.flat.automata[slot.automaton].name,
                    );
                    let state = dae.variables[cell.0].element_name(cell.1);
                    let declared = |origin| {
                        let (part, here) = place_of(system, origin);
                        part.unwrap_or(here)
                    };
                    let second = (b.as_str(), declared(&branch.origin));
                    let first = (a.as_str(), declared(origin));
                    let equation = branch.origin.span;
                    diagnostics.push(refused::two_pins(&state, second, first, equation));
                }
                None => drop(seen.insert(cell, (slot.automaton, branch.origin.clone()))),
            }
        }
    }
}

/// Which residual and which definition belongs to what.
struct Rows {
    /// Of each unknown: the number of the residuals before its own, if it stays in the vector.
    of_unknown: Vec<usize>,
    /// The residuals of single states.
    of_state: FxHashMap<Cell, usize>,
    /// The residuals of algebraic variables.
    of_algebraic: FxHashMap<VarId, Vec<usize>>,
    /// The definitions.
    definitions: FxHashMap<VarId, Vec<usize>>,
}

impl Rows {
    fn new(dae: &Dae, order: &Order) -> Self {
        let mut before = 0;
        let of_unknown = order.in_vector.iter().map(|&kept| {
            before += usize::from(kept);
            before - usize::from(kept)
        });
        let of_unknown = of_unknown.collect();
        let mut of_state = FxHashMap::default();
        let mut of_algebraic: FxHashMap<VarId, Vec<usize>> = FxHashMap::default();
        for (row, residual) in dae.residuals.iter().enumerate() {
            let block = &dae.unknowns[residual.unknown];
            match (block.differential, block.len) {
                (true, 1) => drop(of_state.insert((block.var, block.first), row)),
                (true, _) => {}
                (false, _) => of_algebraic.entry(block.var).or_default().push(row),
            }
        }
        Self {
            of_unknown,
            of_state,
            of_algebraic,
            definitions: dae.definitions_of_variables(),
        }
    }

    /// Whether an expression depends on the unknown of a row, through definitions and the rows of other algebraic unknowns:
    /// along such a path each row takes over the unknown of the next, and the last one the force.
    fn depends(&self, dae: &Dae, root: ExprId, row: usize) -> bool {
        let block = &dae.unknowns[dae.residuals[row].unknown];
        let mut pending = vec![root];
        let mut visited = BTreeSet::new();
        while let Some(id) = pending.pop() {
            for below in dae.exprs.below(&[id]) {
                let Expr::Var(var, _) = dae.exprs[below] else {
                    continue;
                };
                if var == block.var {
                    return true;
                }
                if visited.insert(var) {
                    let own = self.definitions.get(&var).into_iter().flatten();
                    pending.extend(own.map(|&number| dae.definitions[number].value));
                    let own = self.of_algebraic.get(&var).into_iter().flatten();
                    pending.extend(own.map(|&row| dae.residuals[row].value));
                }
            }
        }
        false
    }
}

fn no_force(
    dae: &Dae,
    system: &System,
    automaton: AutomatonId,
    mode: usize,
    cell: Cell,
    row: usize,
) -> Diagnostic {
    let block = &dae.unknowns[dae.residuals[row].unknown];
    let state = dae.variables[cell.0].element_name(cell.1);
    let force = dae.variables[block.var].element_name(block.first);
    let name = &system.flat.automata[automaton].modes[mode].name;
    let origin = &system.flat.automata[automaton].modes[mode].origin;
    refused::no_force(name, &state, (&force, origin.span))
}
