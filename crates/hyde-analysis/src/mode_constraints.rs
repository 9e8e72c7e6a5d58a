//! Modes that would need differentiations of their own are refused (M6): index reduction is done once for all modes.
//!
//! `phi1 = phi2` in one mode, both angles states, determines nothing that is unknown there. `w1 = 0` does: it is a pin.

use crate::refusals::states as refused;
use crate::segments::Segment;
use crate::system::{Branch, System};
use hyde_diag::Diagnostics;
use hyde_ir::{Expr, VarId};
use std::collections::BTreeMap;

/// Reports every equation of a mode that relates states alone; whether there was one.
pub(crate) fn refuse(system: &System, unknowns: &[Segment], diagnostics: &mut Diagnostics) -> bool {
    let mut found = false;
    let mut of_variable: BTreeMap<VarId, Vec<&Segment>> = BTreeMap::new();
    for unknown in unknowns {
        of_variable.entry(unknown.var).or_default().push(unknown);
    }
    let relates_unknowns = |branch: &Branch| relates_unknowns(system, &of_variable, branch);
    for slot in &system.slots {
        let several = slot.branches.iter().any(&relates_unknowns);
        for (mode, branch) in slot.branches.iter().enumerate() {
            if branch.pin.is_some() || !several || relates_unknowns(branch) {
                continue;
            }
            let states = states(system, branch);
            if states.is_empty() {
                continue;
            }
            found = true;
            let automaton = &system.flat.automata[slot.automaton];
            let name = automaton
                .modes
                .get(mode)
                .map_or("", |mode| mode.name.as_str());
            let part = system.component(&branch.origin);
            let equation = branch.origin.span;
            diagnostics.push(refused::constrained_in_mode(name, &states, equation, part));
        }
    }
    found
}

/// Whether an equation of a mode has anything in it that the mode can determine.
fn relates_unknowns(
    system: &System,
    unknowns: &BTreeMap<VarId, Vec<&Segment>>,
    branch: &Branch,
) -> bool {
    let leaves = system.flat.exprs.below(&[branch.lhs, branch.rhs]);
    leaves.into_iter().any(|id| {
        let Some((var, index, derivative)) = system.flat.exprs[id].access() else {
            return false;
        };
        let Some(cell) = System::cell(var, index) else {
            return true;
        };
        let mut of_variable = unknowns.get(&var).into_iter().flatten();
        of_variable
            .any(|unknown| unknown.overlaps(cell.1, cell.1) && (!unknown.state || derivative))
    })
}

/// The names of the continuous variables in an equation.
fn states(system: &System, branch: &Branch) -> Vec<String> {
    let mut names = Vec::new();
    for id in system.flat.exprs.below(&[branch.lhs, branch.rhs]) {
        if let Expr::Var(var, index) = system.flat.exprs[id]
            && system.is_continuous(var)
            && let Some(cell) = System::cell(var, index)
        {
            let name = system.cell_name(cell);
            if !names.contains(&name) {
                names.push(name);
            }
        }
    }
    names
}
