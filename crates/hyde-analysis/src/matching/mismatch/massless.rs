//! Parts without mass between what is set-valued: a clutch that slips says what force it gives, not how its ends move, and
//! two of them one behind the other say the same force twice, while what is between them moves as it likes.

use crate::matching::node::{Node, origin, sides};
use crate::refusals::unmatched as refused;
use crate::system::System;
use hyde_diag::{Diagnostic, MadeBy, Span};
use hyde_units::{Agreement, Dimension};

/// What two or more parts say twice of one force, where a mode of one of them fixes a motion.
pub(super) fn between(system: &System, nodes: &[Node], lefts: &[usize]) -> Option<Diagnostic> {
    let fixes = |node: &Node| match node {
        Node::Slot(slot) => {
            let branches = &system.slots[*slot].branches;
            branches.iter().any(|branch| branch.pin.is_some())
        }
        Node::Equation(_) => false,
    };
    let nodes = || lefts.iter().map(|&left| nodes[left]);
    if !nodes().any(|node| fixes(&node)) {
        return None;
    }
    let mut parts: Vec<(String, Span)> = Vec::new();
    for node in nodes() {
        let origin = origin(system, node);
        let says = !matches!(origin.made_by, MadeBy::Connection | MadeBy::Unconnected);
        if let (true, Some(part)) = (says, system.component(&origin))
            && !parts.contains(&part)
        {
            parts.push(part);
        }
    }
    parts.sort_by_key(|(_, span)| span.start);
    let body = body(system, nodes())?;
    (!parts.is_empty()).then(|| refused::no_inertia(&parts, body))
}

/// The body that is missing where there is a torque, else where there is a force.
fn body(system: &System, nodes: impl Iterator<Item = Node>) -> Option<&'static str> {
    let sides = nodes.flat_map(|node| sides(system, node));
    let below = sides.flat_map(|(_, lhs, rhs)| system.flat.exprs.below(&[lhs, rhs]));
    let dimensions: Vec<Dimension> = below
        .filter_map(|id| system.flat.exprs[id].access())
        .map(|(var, ..)| system.flat.variables[var].quantity.dimension)
        .collect();
    let has = |si: [i16; 7]| {
        let wanted = Dimension::si(si, 0);
        let mut all = dimensions.iter();
        all.any(|dimension| dimension.agreement(wanted) == Agreement::Same)
    };
    match (has([1, 2, 0, -2, 0, 0, 0]), has([1, 1, 0, -2, 0, 0, 0])) {
        (true, _) => Some("an `Inertia`"),
        (false, true) => Some("a `Mass`"),
        (false, false) => None,
    }
}
