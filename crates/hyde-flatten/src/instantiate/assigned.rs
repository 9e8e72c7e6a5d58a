//! Which variables are discrete: those that an event assigns.

use hyde_syntax::ast::{Element, Equation, EquationKind, ExprKind};

/// The names that events assign in an element: in `when`, at exits, on entering and leaving a mode.
pub(super) fn at_events(element: &Element) -> Vec<&str> {
    match element {
        Element::Equation(equation) => in_when(equation),
        Element::Modes(modes) => modes
            .modes
            .iter()
            .flat_map(|mode| {
                let exits = mode.exits.iter().flat_map(|exit| &exit.actions);
                exits.chain(&mode.enter).chain(&mode.leave)
            })
            .filter_map(name)
            .collect(),
        Element::Declaration(_)
        | Element::Extends(..)
        | Element::Domain(_)
        | Element::Discretize(_)
        | Element::Clocked(_)
        | Element::InitialEquation(_)
        | Element::Wrap(..)
        | Element::Add(_)
        | Element::Replace(..)
        | Element::Signature(_)
        | Element::Confounds(_)
        | Element::Measure(_)
        | Element::Account(..) => Vec::new(),
    }
}

fn in_when(equation: &Equation) -> Vec<&str> {
    match &equation.kind {
        EquationKind::When(branches) => {
            let equations = branches.iter().flat_map(|(_, list)| list);
            equations.filter_map(name).collect()
        }
        EquationKind::For { equations, .. } => equations.iter().flat_map(in_when).collect(),
        EquationKind::If {
            branches,
            otherwise,
        } => {
            let inside = branches.iter().flat_map(|(_, list)| list);
            inside.chain(otherwise).flat_map(in_when).collect()
        }
        EquationKind::Connect(_)
        | EquationKind::Equality { .. }
        | EquationKind::Assert(..)
        | EquationKind::Reinit(..) => Vec::new(),
    }
}

/// The name on the left of an action, of an element of an array that of the array.
fn name(action: &Equation) -> Option<&str> {
    if let EquationKind::Equality { lhs, .. } = &action.kind
        && let ExprKind::Reference(target) = &lhs.kind
        && let [only] = target.parts.as_slice()
    {
        Some(only.name.text.as_str())
    } else {
        None
    }
}
