//! [`Node`]: an equation of the system, or the slot of a `modes` block, as what one unknown is matched to.

use crate::system::{Equation, Slot, System};
use hyde_diag::Origin;
use hyde_ir::{ExprId, Range};

/// An equation node: a number of the list of equations, or of the slots.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Node {
    Equation(usize),
    Slot(usize),
}

/// The sides of a node with their range; of a slot those of the modes that pin nothing, or of all if all pin.
pub(crate) fn sides(system: &System, node: Node) -> Vec<(Range, ExprId, ExprId)> {
    match node {
        Node::Equation(number) => {
            let Equation {
                range, lhs, rhs, ..
            } = system.equations[number];
            vec![(range, lhs, rhs)]
        }
        Node::Slot(number) => {
            let branches = &system.slots[number].branches;
            let free: Vec<_> = branches
                .iter()
                .filter(|branch| branch.pin.is_none())
                .collect();
            let list = if free.is_empty() {
                branches.iter().collect()
            } else {
                free
            };
            list.into_iter()
                .map(|branch| (Range::SCALAR, branch.lhs, branch.rhs))
                .collect()
        }
    }
}

/// The origin of a node.
pub(crate) fn origin(system: &System, node: Node) -> Origin {
    match node {
        Node::Equation(number) => system.equations[number].origin.clone(),
        Node::Slot(number) => {
            let Slot {
                branches,
                automaton,
            } = &system.slots[number];
            branches.first().map_or_else(
                || system.flat.automata[*automaton].origin.clone(),
                |b| b.origin.clone(),
            )
        }
    }
}
